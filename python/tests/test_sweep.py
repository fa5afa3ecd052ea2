"""Sweeps and results folders."""

from __future__ import annotations

import csv
import pathlib
from typing import Any

import numpy
import pytest
import xarray
from conftest import RESULTS

import phase
from phase import _lib

Table = dict[str, Any]


def check_against_labels(runs: xarray.Dataset, folder: pathlib.Path) -> int:
    """Compares a data set with each row of its table, and gives the number of rows."""
    with open(folder / "labels.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    axes = [str(name) for name in runs.label.dims[:-1]]
    for row in rows:
        point: dict[str, object] = {axis: _value(row[axis]) for axis in axes}
        run = runs.sel({**point, "seed": int(row["seed"])})
        for name, text in row.items():
            if name not in runs.dims:
                known = text if name in ("id", "label") else _value(text)
                assert _text(run[name].item()) == _text(known), (row["id"], name)
    assert int((runs.label != "").sum()) == len(rows)
    return len(rows)


def _value(text: str) -> object:
    try:
        return float({"true": "1", "false": "0", "": "nan"}.get(text, text))
    except ValueError:
        return text


def _text(value: object) -> str:
    return repr(float(value)) if isinstance(value, int | float) else str(value)


@pytest.mark.parametrize(
    ("name", "rows"),
    [
        ("theoretical-9x9", 243),
        ("silo", 180),
        ("density-friction", 180),
        ("realistic-steady", 81),
        ("theoretical-refined", 116),
        ("silo-fillings", 24),
    ],
)
def test_published_results_are_their_tables(name: str, rows: int) -> None:
    runs = phase.open(RESULTS / name)
    assert check_against_labels(runs, RESULTS / name) == rows


def test_a_data_set_has_units_and_missing_values() -> None:
    runs = phase.open(RESULTS / "theoretical-refined")
    assert runs.label.dims == ("radius", "omega", "seed")
    assert runs.sizes == {"radius": 41, "omega": 41, "seed": 3}
    assert runs.radius.attrs["units"] == "m" and runs.omega.attrs["units"] == "rad/s"
    assert runs.omega.attrs["key"] == "swirl.omega"
    assert runs.settle_time.attrs["units"] == "s" and runs.settle_time.attrs["long_name"]
    missing = runs.label == ""
    assert bool(missing.any())
    assert bool((runs.code.where(missing, drop=True).fillna(-128) == -128).all())
    assert bool(runs.hole_radius.where(missing).isnull().all())
    meanings = dict(
        zip(runs.code.attrs["flag_meanings"].split(), runs.code.attrs["flag_values"], strict=True)
    )
    made = runs.label.values[~missing.values]
    codes = runs.code.values[~missing.values]
    assert all(meanings[label] == code for label, code in zip(made, codes, strict=True))


def test_a_sweep_from_a_dict_is_that_of_its_file(sweep: Table, tmp_path: pathlib.Path) -> None:
    of_dict = phase.sweep(sweep, out=tmp_path / "dict", threads=2)
    file = tmp_path / "falling.toml"
    file.write_text(_lib.to_toml(sweep))
    of_file = phase.sweep(file, out=tmp_path / "file", threads=1)
    assert of_dict.identical(of_file)
    tables = [(tmp_path / name / "labels.csv").read_bytes() for name in ("dict", "file")]
    assert tables[0] == tables[1]
    assert check_against_labels(of_dict, tmp_path / "dict") == 12
    assert of_dict.attrs["title"] == "Falling spheres"


def test_the_folder_follows_from_the_name(
    sweep: Table, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pathlib.Path("falling.toml").write_text(_lib.to_toml(sweep))
    phase.sweep("falling.toml")
    assert pathlib.Path("results/falling/labels.csv").is_file()


def test_runs_that_are_there_are_not_made_again(sweep: Table, tmp_path: pathlib.Path) -> None:
    phase.sweep(sweep, out=tmp_path)
    records = {path: path.stat().st_mtime_ns for path in (tmp_path / "records").iterdir()}
    assert len(records) == 12
    sweep["seeds"]["count"] = 3
    runs = phase.sweep(sweep, out=tmp_path)
    assert runs.sizes["seed"] == 3
    for path, time in records.items():
        assert path.stat().st_mtime_ns == time


def test_variants_are_names(sweep: Table, tmp_path: pathlib.Path) -> None:
    sweep["variant"] = [
        {"name": "as it is", "set": {"contact.poisson_ratio": 0.3}},
        {"name": "softer", "set": {"contact.young_modulus": 4e5}},
    ]
    del sweep["axis"][0]
    runs = phase.sweep(sweep, out=tmp_path)
    assert list(runs.variant.values) == ["as it is", "softer"]
    assert check_against_labels(runs, tmp_path) == 8


def test_a_sweep_can_be_refined(sweep: Table, tmp_path: pathlib.Path) -> None:
    sweep["axis"] = [
        {"key": "gravity.acceleration", "name": "g", "from": 1.0, "to": 12.0, "count": 12}
    ]
    sweep["label"] = [
        {"name": "high", "when": "max(height_max) > 0.1[m]"},
        {"name": "fast", "when": "max(speed_mean) > 0.6[m/s]"},
    ]
    sweep["refine"] = {"budget": 8, "start": [3], "replicates": 1}
    del sweep["seeds"]
    runs = phase.sweep(sweep, out=tmp_path)
    assert int((runs.label != "").sum()) == 8
    assert (tmp_path / "borders.csv").is_file()
    check_against_labels(runs, tmp_path)


def test_seeds_and_axes_select(sweep: Table, tmp_path: pathlib.Path) -> None:
    runs = phase.sweep(sweep, out=tmp_path)
    single = runs.sel(radius=0.004, g=9.8, seed=2)
    scene = sweep["scene"]
    run = phase.run(scene, seed=2)
    assert single.id.item() == run.attrs["identity"]
    assert single.label.item() == run.attrs["label"]
    assert numpy.isclose(single.hole_radius.item(), run.attrs["hole_radius"], rtol=0, atol=0)
    record = phase.open(tmp_path / "records" / f"{single.id.item()}.h5")
    assert numpy.array_equal(record.kinetic, run.kinetic)
