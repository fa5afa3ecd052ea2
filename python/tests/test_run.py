"""One run: from dicts and files, in memory and in records."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy
import pytest
import xarray

import phase
from phase import _lib

Scene = dict[str, Any]


def without_times(run: xarray.Dataset) -> xarray.Dataset:
    """The run without the processor time that it took."""
    return run.drop_attrs(deep=False).assign_attrs(
        {name: value for name, value in run.attrs.items() if name != "cpu_seconds"}
    )


def same(one: xarray.Dataset, other: xarray.Dataset) -> bool:
    return without_times(one).identical(without_times(other))


def test_a_dict_and_its_file_give_the_same_run(scene: Scene, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(_lib.to_toml(scene))
    assert same(phase.run(scene), phase.run(file))


def test_numbers_of_numpy_are_numbers(scene: Scene) -> None:
    plain = phase.run(scene)
    scene["spheres"]["count"] = numpy.int64(8)
    scene["spheres"]["radius"] = numpy.float64(0.004)
    scene["output"]["rise_radii"] = numpy.array([0.5, 0.75, 1.0])
    assert same(phase.run(scene), plain)


def test_a_run_has_shapes_units_and_a_label(scene: Scene) -> None:
    run = phase.run(scene)
    assert run.sizes["time"] == 401 and run.sizes["sphere"] == 8 and run.sizes["snapshot"] == 5
    assert run.position.dims == ("snapshot", "sphere", "component")
    assert list(run.component.values) == ["x", "y", "z"]
    assert run.height_max.dtype == numpy.float32 and run.time.dtype == numpy.float64
    for name, variable in run.variables.items():
        if name != "component":
            assert variable.attrs["units"] and variable.attrs["long_name"], name
    assert run.height_max.attrs["units"] == "m"
    # At the end they lie on the floor, one radius above it.
    assert abs(float(run.height_max[-1]) - 0.004) < 1e-4
    assert run.attrs["label"] == "settled" and run.attrs["code"] == 1
    assert run.attrs["outcome"] == "completed"


def test_wishes_change_what_they_say(scene: Scene) -> None:
    run = phase.run(scene, seed=7, trajectory=True, ledger=True)
    assert run.attrs["seed"] == 7
    assert run.sizes["snapshot"] == run.sizes["time"] == 401
    assert "residual" in run
    other = phase.run(scene, snapshot_interval=2.0)
    assert list(other.snapshot.values) == pytest.approx([0.0, 2.0, 4.0])
    assert not numpy.array_equal(other.height_mean, run.height_mean)
    assert "residual" not in other


def test_threads_change_no_bit(scene: Scene) -> None:
    assert same(phase.run(scene, threads=2), phase.run(scene))


def test_a_record_is_the_run(scene: Scene, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "new" / "run.h5"
    run = phase.run(scene, out=file)
    assert same(phase.open(file), run)
    assert phase.open(file).identical(xarray.open_dataset(file, engine="phase"))
    assert phase.open(str(file)).encoding["source"] == str(file)
    lean = xarray.open_dataset(file, engine="phase", drop_variables=["profile"])
    assert "profile" not in lean and "kinetic" in lean
    assert not file.with_suffix(".checkpoint").exists()


def test_xarray_knows_a_record_and_nothing_else(scene: Scene, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "run.h5"
    phase.run(scene, out=file)
    backend = xarray.backends.list_engines()["phase"]
    assert backend.guess_can_open(file)
    other = tmp_path / "other.h5"
    other.write_bytes(b"\x89HDF\r\n\x1a\n and more")
    assert not backend.guess_can_open(other)
    assert not backend.guess_can_open(tmp_path / "missing.h5")


def test_a_run_can_be_stored_as_netcdf(scene: Scene) -> None:
    attributes = phase.run(scene).attrs.values()
    assert all(isinstance(value, str | int | float) for value in attributes)
