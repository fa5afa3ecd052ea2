"""Errors have file, line and fix."""

from __future__ import annotations

import json
import pathlib
import pickle
from typing import Any

import pytest

import phase
from phase import _lib

Table = dict[str, Any]


def test_a_file_is_refused_with_its_line(scene: Table, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "scene.toml"
    scene["spheres"]["radius"] = -0.004
    text = _lib.to_toml(scene)
    file.write_text(text)
    with pytest.raises(phase.RefusalError) as caught:
        phase.run(file)
    error = caught.value
    line = text.splitlines().index("radius = -0.004") + 1
    assert (error.file, error.line, error.column) == (str(file), line, 10)
    assert error.help is not None and error.help in str(error)
    assert f"--> {file}:{line}:10" in str(error)


def test_a_dict_is_refused_with_the_text_of_its_line(scene: Table) -> None:
    scene["spheres"]["raduis"] = scene["spheres"].pop("radius")
    with pytest.raises(phase.RefusalError, match="raduis = 0.004") as caught:
        phase.run(scene)
    assert caught.value.file == "<dict>" and caught.value.line is not None
    assert "radius" in str(caught.value)


def test_a_sweep_is_refused_with_its_line(sweep: Table, tmp_path: pathlib.Path) -> None:
    sweep["axis"][0]["key"] = "spheres.raduis"
    with pytest.raises(phase.RefusalError, match="did you mean") as caught:
        phase.sweep(sweep, out=tmp_path / "out")
    assert caught.value.line is not None and caught.value.help is not None
    assert not (tmp_path / "out").exists()


def test_all_problems_are_told_at_once(scene: Table) -> None:
    scene["spheres"]["radius"] = -0.004
    scene["gravity"]["acceleration"] = -1.0
    with pytest.raises(phase.RefusalError) as caught:
        phase.run(scene)
    assert str(caught.value).count("-->") == 2


@pytest.mark.parametrize(
    ("value", "said"),
    [(None, "leave the key out"), (1j, "complex"), ({1, 2}, "set"), (float("nan"), "radius")],
)
def test_values_without_a_text_are_refused(scene: Table, value: object, said: str) -> None:
    scene["spheres"]["radius"] = value
    with pytest.raises(phase.RefusalError, match="spheres.radius|radius = nan") as caught:
        phase.run(scene)
    assert said in str(caught.value)


def test_keys_and_nests_without_a_text_are_refused(scene: Table) -> None:
    with pytest.raises(phase.RefusalError, match="no text"):
        phase.run({**scene, "tank": {3: 0.03}})
    scene["tank"]["tank"] = scene["tank"]
    with pytest.raises(phase.RefusalError, match="inside each other"):
        phase.run(scene)


def test_paths_that_lead_nowhere_are_refused(tmp_path: pathlib.Path) -> None:
    missing = tmp_path / "missing"
    for call in (phase.run, phase.open, phase.classify, phase.refine):
        with pytest.raises(phase.RefusalError) as caught:
            call(missing)
        assert caught.value.file == str(missing), call
    with pytest.raises(phase.RefusalError, match="cannot read"):
        phase.sweep(missing)
    with pytest.raises(phase.RefusalError, match="sweep.json"):
        phase.open(tmp_path)


def test_settings_out_of_range_are_refused(scene: Table, tmp_path: pathlib.Path) -> None:
    with pytest.raises(phase.RefusalError, match="`threads` is 0"):
        phase.run(scene, threads=0)
    with pytest.raises(phase.RefusalError, match="snapshot"):
        phase.run(scene, snapshot_interval=-1.0)
    with pytest.raises(phase.RefusalError, match="give `out`"):
        phase.sweep({"scene": scene})
    with pytest.raises(TypeError):
        phase.run(3)  # type: ignore[arg-type]


def test_files_of_others_are_kept(scene: Table, sweep: Table, tmp_path: pathlib.Path) -> None:
    record = tmp_path / "run.h5"
    record.write_text("mine")
    with pytest.raises(phase.RefusalError, match="no record"):
        phase.run(scene, out=record)
    labels = tmp_path / "labels.csv"
    labels.write_text("mine")
    with pytest.raises(phase.RefusalError, match="would overwrite"):
        phase.sweep(sweep, out=tmp_path)
    assert record.read_text() == labels.read_text() == "mine"


def test_results_of_studies_are_kept(sweep: Table, tmp_path: pathlib.Path) -> None:
    phase.sweep(sweep, out=tmp_path)
    file = tmp_path / "sweep.json"
    stored = json.loads(file.read_text())
    file.write_text(json.dumps({**stored, "study": "compared"}))
    with pytest.raises(phase.RefusalError, match="results of a study"):
        phase.sweep(sweep, out=tmp_path)
    with pytest.raises(phase.RefusalError, match="results of a study"):
        phase.open(tmp_path)


def test_damaged_records_are_refused(scene: Table, tmp_path: pathlib.Path) -> None:
    record = tmp_path / "run.h5"
    phase.run(scene, out=record)
    content = bytearray(record.read_bytes())
    content[len(content) // 2] ^= 1
    record.write_bytes(content)
    with pytest.raises(phase.RefusalError, match="damaged") as caught:
        phase.open(record)
    assert caught.value.file == str(record)


def test_scenes_with_programs_are_left_to_the_program(tmp_path: pathlib.Path) -> None:
    command = ["touch", str(tmp_path / "made")]
    scene = {"program": {"commands": [command], "read": [{"file": "a.csv", "time": "t"}]}}
    with pytest.raises(phase.RefusalError):
        phase.run(scene)
    assert not (tmp_path / "made").exists()


def test_errors_survive_pickling() -> None:
    error = phase.RefusalError("a", "b.toml", 3, 4, "c")
    copied = pickle.loads(pickle.dumps(error))
    assert (str(copied), copied.file, copied.line, copied.column, copied.help) == (
        "a",
        "b.toml",
        3,
        4,
        "c",
    )
    assert isinstance(copied, phase.Error)
