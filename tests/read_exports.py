"""Compares the exports of a record, as other programs read them, with the record as h5py reads it.

Usage: python3 read_exports.py RECORD FOLDER EVERY
where FOLDER holds the exports of RECORD in all formats, all but the dump of one state in EVERY. Where
spheres come and go there is no dump.
"""

import csv
import pathlib
import re
import sys
import xml.etree.ElementTree

import ase.io
import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def main(record_path, folder, every):
    folder = pathlib.Path(folder)
    name = pathlib.Path(record_path).stem
    with h5py.File(record_path, "r") as record:
        states = record["trajectory" if "trajectory" in record else "snapshots"]
        whole = {quantity: states[quantity][()] for quantity in states}
        spheres = {quantity: record["spheres"][quantity][()] for quantity in ("radius", "mass")}
        observations = {
            key: values[()] for key, values in record["observations"].items() if values.ndim == 1
        }
    some = {quantity: values[:: int(every)] for quantity, values in whole.items()}
    assert len(some["time"]) > 2 and len(spheres["radius"]) >= 8
    # The spheres that are in, state by state: of others nothing is a number.
    inside = [numpy.flatnonzero(~numpy.isnan(centres[:, 0])) for centres in some["position"]]
    flows = "released" in observations
    assert flows == any(len(here) < len(spheres["radius"]) for here in inside)
    fixed = check_fixed(folder, name) if flows else {}
    check_xyz(folder / f"{name}.xyz", some, spheres, inside, flows)
    check_vtk(folder / f"{name}.pvd", some, spheres, inside, flows, fixed)
    check_npy(folder / name, some, spheres, fixed)
    check_csv(folder / f"{name}.csv", some, spheres, inside)
    check_observations(folder / f"{name}-observations.csv", observations)
    dumps = list(folder.glob("dump_r*_p*_f*.npy"))
    assert len(dumps) == (0 if flows else 1)
    for dump in dumps:
        check_dump(dump, whole, spheres)


def same(found, expected):
    numpy.testing.assert_array_equal(numpy.asarray(found), expected, strict=True)


def check_fixed(folder, name):
    """Returns the arrays of fixed spheres (x, y, z, radius), which all formats agree on."""
    fixed = {part: numpy.load(folder / name / f"{part}.npy") for part in ("walls", "door")}
    everything = numpy.concatenate([fixed["walls"], fixed["door"]])
    with open(folder / f"{name}-fixed.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    same([[float(row[key]) for key in ("x", "y", "z", "radius")] for row in rows], everything)
    kinds = [row["kind"] for row in rows]
    assert kinds == ["wall"] * len(fixed["walls"]) + ["door"] * len(fixed["door"])
    atoms = ase.io.read(folder / f"{name}-fixed.xyz", format="extxyz")
    same(numpy.column_stack([atoms.positions, atoms.arrays["radius"]]), everything)
    same(atoms.arrays["door"] == 1, numpy.array(kinds) == "door")
    for part, spheres in fixed.items():
        centres, data = read_points(folder / name / f"{part}.vtp")
        same(numpy.column_stack([centres, data["radius"]]), spheres)
    return fixed


def check_xyz(path, states, spheres, inside, flows):
    frames = ase.io.read(path, index=":", format="extxyz")
    same([frame.info["Time"] for frame in frames], states["time"])
    for index, (frame, here) in enumerate(zip(frames, inside, strict=True)):
        same(frame.positions, states["position"][index][here])
        if len(here) == 0:
            continue
        same(frame.arrays["velo"], states["velocity"][index][here])
        same(frame.arrays["radius"], spheres["radius"][here])
        same(frame.arrays["mass"], spheres["mass"][here])
        assert ("omega" in frame.arrays) == ("spin" in states)
        if "spin" in states:
            same(frame.arrays["omega"], states["spin"][index][here])
        assert ("id" in frame.arrays) == flows
        if flows:
            same(frame.arrays["id"].astype(here.dtype), here)
        assert not frame.pbc.any()
        low = numpy.asarray(frame.info["Origin"])
        high = low + frame.cell.lengths()
        reach = spheres["radius"][here, None] * (1 - 1e-9)
        assert (frame.positions - reach >= low).all() and (frame.positions + reach <= high).all()


def read_points(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    count = data.GetNumberOfPoints()
    assert data.GetNumberOfVerts() == count, path
    if count > 0:
        same(vtk_to_numpy(data.GetVerts().GetConnectivityArray()), numpy.arange(count))
    arrays = data.GetPointData()
    found = {
        arrays.GetArrayName(number): vtk_to_numpy(arrays.GetArray(number))
        for number in range(arrays.GetNumberOfArrays())
    }
    centres = vtk_to_numpy(data.GetPoints().GetData()) if count > 0 else numpy.zeros((0, 3))
    return centres, found


def check_vtk(path, states, spheres, inside, flows, fixed):
    series = xml.etree.ElementTree.parse(path).getroot().find("Collection").findall("DataSet")
    parts = [[entry for entry in series if entry.get("part") == part] for part in "012"]
    same([float(entry.get("timestep")) for entry in parts[0]], states["time"])
    assert len(parts[1]) == (len(states["time"]) if fixed else 0)
    # The door is there, and then it is not any more.
    assert 0 < len(parts[2]) < len(parts[1]) if fixed else not parts[2]
    for entry, other in zip(parts[2], parts[1]):
        assert entry.get("timestep") == other.get("timestep")
    for index, (entry, here) in enumerate(zip(parts[0], inside, strict=True)):
        centres, found = read_points(path.parent / entry.get("file"))
        same(centres, states["position"][index][here])
        expected = {name: values[here] for name, values in spheres.items()}
        expected["velocity"] = states["velocity"][index][here]
        if "spin" in states:
            expected["spin"] = states["spin"][index][here]
        if flows:
            expected["id"] = here
        assert sorted(found) == sorted(expected)
        for name, values in expected.items():
            if len(here) > 0:
                same(found[name], values)


def check_npy(folder, states, spheres, fixed):
    expected = dict(states, **spheres, **fixed)
    assert sorted(path.stem for path in folder.glob("*.npy")) == sorted(expected)
    for name, values in expected.items():
        same(numpy.load(folder / f"{name}.npy"), values)


def check_csv(path, states, spheres, inside):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    state = numpy.repeat(numpy.arange(len(inside)), [len(here) for here in inside])
    sphere = numpy.concatenate(inside)

    def column(name):
        return numpy.array([float(row[name]) for row in rows])

    same(column("time"), states["time"][state])
    same(column("sphere"), sphere.astype(float))
    same(column("radius"), spheres["radius"][sphere])
    same(column("mass"), spheres["mass"][sphere])
    for quantity, prefix in [("position", ""), ("velocity", "v"), ("spin", "w")]:
        for axis, name in enumerate("xyz"):
            if quantity in states:
                same(column(prefix + name), states[quantity][state, sphere, axis])
            else:
                assert all(row[prefix + name] == "" for row in rows)


def check_observations(path, observations):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert sorted(rows[0]) == sorted(observations)
    for name, values in observations.items():
        same(numpy.array([row[name] for row in rows]).astype(values.dtype), values)


def check_dump(path, states, spheres):
    dump = numpy.load(path)
    assert dump.dtype == numpy.float64
    same(dump[:, :, :3], states["position"])
    energy = 0.5 * spheres["mass"] * (states["velocity"] ** 2).sum(axis=2)
    if "spin" in states:
        inertia = 0.4 * spheres["mass"] * spheres["radius"] ** 2
        energy += 0.5 * inertia * (states["spin"] ** 2).sum(axis=2)
    energy += spheres["mass"] * 9.8 * states["position"][:, :, 2]
    numpy.testing.assert_allclose(dump[:, :, 3], energy, rtol=1e-12)
    radius, density, omega = re.fullmatch(r"dump_r(.{6,})_p(.{7,})_f(.{5,})", path.stem).groups()
    numpy.testing.assert_allclose(float(radius), spheres["radius"].mean(), rtol=1e-12)
    assert (float(density), float(omega)) == (3750.0, 4.0), path.name


if __name__ == "__main__":
    main(*sys.argv[1:])
