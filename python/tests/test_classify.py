"""Other labels of the same runs."""

from __future__ import annotations

import pathlib
from typing import Any

import pytest
import xarray
from conftest import RESULTS

import phase

Table = dict[str, Any]


def content(folder: pathlib.Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def test_the_same_thresholds_give_the_same_labels(sweep: Table, tmp_path: pathlib.Path) -> None:
    runs = phase.sweep(sweep, out=tmp_path)
    assert phase.classify(tmp_path).identical(runs)
    assert phase.classify(runs).identical(runs)


def test_a_part_of_a_folder_is_labelled_by_itself(sweep: Table, tmp_path: pathlib.Path) -> None:
    runs = phase.sweep(sweep, out=tmp_path)
    point = runs.sel(radius=0.004)
    assert phase.classify(point).identical(point)
    last = runs.isel(radius=[-1])
    assert phase.classify(last).identical(last)


def test_other_thresholds_change_labels_and_no_file(sweep: Table, tmp_path: pathlib.Path) -> None:
    runs = phase.sweep(sweep, out=tmp_path)
    before = content(tmp_path)
    assert set(runs.label.values.ravel()) == {"pinned", "settled"}
    strict = phase.classify(tmp_path, sieves={"pinned": {"hole": 50.0}})
    assert "pinned" not in set(strict.label.values.ravel())
    assert strict.settle_time.equals(runs.settle_time)
    assert content(tmp_path) == before


def test_thresholds_that_are_not_given_stay(sweep: Table, tmp_path: pathlib.Path) -> None:
    sweep["sieves"] = {"pinned": {"hole": 0.01}}
    runs = phase.sweep(sweep, out=tmp_path)
    same = phase.classify(tmp_path, sieves={"pinned": {"share": 0.5}})
    assert same.label.equals(runs.label)


def test_rules_label_a_folder_and_a_run(sweep: Table, tmp_path: pathlib.Path) -> None:
    phase.sweep(sweep, out=tmp_path)
    label = [{"name": "low", "when": "last(height_max) < 0.0045[m]"}]
    ruled = phase.classify(tmp_path, label=label)
    assert set(ruled.label.sel(radius=0.004).values.ravel()) == {"low"}
    assert set(ruled.label.sel(radius=0.005).values.ravel()) == {"other"}
    assert ruled.low_margin.attrs["units"] == "1"
    record = phase.open(tmp_path / "records" / f"{ruled.id.values[0, 0, 0]}.h5")
    measure = [{"name": "highest", "value": "max(height_max)"}]
    single = phase.classify(record, label=label, measure=measure)
    assert single.label.item() == "low"
    assert single.highest.item() == float(record.height_max.max())
    assert single.highest.attrs["units"] == "m"


def test_a_run_in_memory_is_labelled(sweep: Table) -> None:
    run = phase.run(sweep["scene"])
    label = phase.classify(run)
    assert label.label.item() == run.attrs["label"]
    assert label.hole_radius.item() == run.attrs["hole_radius"]
    strict = phase.classify(run, sieves={"pinned": {"hole": 0.01}})
    assert strict.label.item() == "pinned"


def test_what_is_wrong_has_its_line(sweep: Table) -> None:
    run = phase.run(sweep["scene"])
    with pytest.raises(phase.RefusalError, match="did you mean") as caught:
        phase.classify(run, sieves={"pinned": {"whole": 1.5}})
    assert caught.value.line is not None
    with pytest.raises(phase.RefusalError, match="kg"):
        phase.classify(run, label=[{"name": "hot", "when": "last(height_max) > 3[kg]"}])
    with pytest.raises(phase.RefusalError, match="does not say of which"):
        phase.classify(xarray.Dataset())


def test_results_without_records_are_refused() -> None:
    with pytest.raises(phase.RefusalError, match="no run has a record"):
        phase.classify(RESULTS / "theoretical-9x9")
