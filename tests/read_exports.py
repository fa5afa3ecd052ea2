"""Compares the exports of a record, as other programs read them, with the record as h5py reads it.

Usage: python3 read_exports.py RECORD FOLDER EVERY
where FOLDER holds the exports of RECORD in all formats, all but the dump of one state in EVERY.
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
    assert len(some["time"]) > 2 and len(spheres["radius"]) == 8
    check_xyz(folder / f"{name}.xyz", some, spheres)
    check_vtk(folder / f"{name}.pvd", some, spheres)
    check_npy(folder / name, some, spheres)
    check_csv(folder / f"{name}.csv", some, spheres)
    check_observations(folder / f"{name}-observations.csv", observations)
    [dump] = folder.glob("dump_r*_p*_f*.npy")
    check_dump(dump, whole, spheres)


def same(found, expected):
    numpy.testing.assert_array_equal(numpy.asarray(found), expected, strict=True)


def check_xyz(path, states, spheres):
    frames = ase.io.read(path, index=":", format="extxyz")
    same([frame.info["Time"] for frame in frames], states["time"])
    for index, frame in enumerate(frames):
        same(frame.positions, states["position"][index])
        same(frame.arrays["velo"], states["velocity"][index])
        same(frame.arrays["radius"], spheres["radius"])
        same(frame.arrays["mass"], spheres["mass"])
        assert ("omega" in frame.arrays) == ("spin" in states)
        if "spin" in states:
            same(frame.arrays["omega"], states["spin"][index])
        assert not frame.pbc.any()
        low = numpy.asarray(frame.info["Origin"])
        high = low + frame.cell.lengths()
        reach = spheres["radius"][:, None] * (1 - 1e-9)
        assert (frame.positions - reach >= low).all() and (frame.positions + reach <= high).all()


def check_vtk(path, states, spheres):
    series = xml.etree.ElementTree.parse(path).getroot().find("Collection").findall("DataSet")
    same([float(entry.get("timestep")) for entry in series], states["time"])
    for index, entry in enumerate(series):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(path.parent / entry.get("file")))
        reader.Update()
        data = reader.GetOutput()
        count = len(spheres["radius"])
        assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == count
        same(vtk_to_numpy(data.GetVerts().GetConnectivityArray()), numpy.arange(count))
        same(vtk_to_numpy(data.GetPoints().GetData()), states["position"][index])
        arrays = data.GetPointData()
        found = {
            arrays.GetArrayName(number): vtk_to_numpy(arrays.GetArray(number))
            for number in range(arrays.GetNumberOfArrays())
        }
        expected = dict(spheres, velocity=states["velocity"][index])
        if "spin" in states:
            expected["spin"] = states["spin"][index]
        assert sorted(found) == sorted(expected)
        for name, values in expected.items():
            same(found[name], values)


def check_npy(folder, states, spheres):
    expected = dict(states, **spheres)
    assert sorted(path.stem for path in folder.glob("*.npy")) == sorted(expected)
    for name, values in expected.items():
        same(numpy.load(folder / f"{name}.npy"), values)


def check_csv(path, states, spheres):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    shape = states["position"].shape[:2]
    assert len(rows) == shape[0] * shape[1]

    def column(name):
        return numpy.array([float(row[name]) for row in rows]).reshape(shape)

    same(column("time"), numpy.broadcast_to(states["time"][:, None], shape))
    same(column("sphere"), numpy.broadcast_to(numpy.arange(float(shape[1])), shape))
    same(column("radius"), numpy.broadcast_to(spheres["radius"], shape))
    same(column("mass"), numpy.broadcast_to(spheres["mass"], shape))
    for quantity, prefix in [("position", ""), ("velocity", "v"), ("spin", "w")]:
        for axis, name in enumerate("xyz"):
            if quantity in states:
                same(column(prefix + name), states[quantity][:, :, axis])
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
