"""Compares a run record, as xarray reads it, with what h5py reads and with what should be in it.

Usage: python3 read_axes.py RECORD EXPECTED
where EXPECTED is a JSON file: attributes of the record, its coordinates, and axes, units and name
of some of its datasets. Warnings are errors.
"""

import json
import sys
import warnings

import h5py
import numpy
import xarray


def main(record_path, expected_path):
    warnings.simplefilter("error")
    with open(expected_path, encoding="utf-8") as file:
        expected = json.load(file)
    with h5py.File(record_path) as record:
        for engine in ["h5netcdf", "netcdf4"]:
            with xarray.open_datatree(record_path, engine=engine) as tree:
                check_tree(tree, record, expected)
            for name in record:
                if isinstance(record[name], h5py.Group):
                    check_group(record_path, engine, name, record[name])


def check_tree(tree, record, expected):
    for name, value in expected["attributes"].items():
        assert tree.attrs[name] == value, (name, tree.attrs[name], value)
    for path, values in expected["coordinates"].items():
        group, _, name = path.rpartition("/")
        assert name in tree[group or "/"].coords, path
        numpy.testing.assert_array_equal(tree[path].values, values)
    for path, (axes, units, long_name) in expected["datasets"].items():
        data = tree[path]
        assert list(data.dims) == axes, (path, data.dims)
        assert data.attrs["units"] == units, (path, data.attrs)
        assert data.attrs["long_name"] == long_name, (path, data.attrs)
        numpy.testing.assert_array_equal(data.values, record[path][()])


def check_group(path, engine, name, group):
    """Every dataset of a group is there, with axes that have names, and its values."""
    with xarray.open_dataset(path, group=name, engine=engine) as dataset:
        assert sorted(dataset.variables) == sorted(group)
        assert not any(axis.startswith("phony") for axis in dataset.dims), dataset.dims
        for variable, data in dataset.variables.items():
            numpy.testing.assert_array_equal(data.values, group[variable][()])
            assert data.attrs["unit"] == group[variable].attrs["unit"].decode()
            assert data.attrs["description"] == group[variable].attrs["description"].decode()


if __name__ == "__main__":
    main(*sys.argv[1:])
