"""Compares a run record, as h5py reads it, with what should be in it.

Usage: python3 read_record.py RECORD EXPECTED
where EXPECTED is a JSON file of attributes, the scene, and every dataset bit by bit.
"""

import json
import sys

import h5py


def main(record_path, expected_path):
    with open(expected_path, encoding="utf-8") as file:
        expected = json.load(file)
    with h5py.File(record_path, "r") as record:
        for name, value in expected["attributes"].items():
            assert record.attrs[name] == value, (name, record.attrs[name], value)
            # Text must arrive as text: not as bytes, not as an array.
            assert isinstance(value, str) == isinstance(record.attrs[name], str), name
        assert json.loads(record.attrs["scene"]) == expected["scene"]
        # A scene whose spheres are in datasets has no TOML to run it from.
        if "start" in record:
            assert "scene_toml" not in record.attrs
        else:
            check_toml(record.attrs["scene_toml"], expected["scene"])

        found = []
        record.visititems(
            lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None
        )
        assert sorted(found) == sorted(expected["datasets"]), found
        for name, value in expected["datasets"].items():
            dataset = record[name]
            assert dataset.dtype.str == value["dtype"], (name, dataset.dtype.str)
            assert list(dataset.shape) == value["shape"], (name, dataset.shape)
            assert dataset[()].tobytes().hex() == value["bytes"], f"{name}: other values"
            assert isinstance(dataset.attrs["unit"].decode(), str), name
            assert len(dataset.attrs["description"].decode()) > 5, name


def check_toml(text, scene):
    try:
        import tomllib  # Python 3.11 and later
    except ImportError:
        return
    assert tomllib.loads(text) == scene


if __name__ == "__main__":
    main(*sys.argv[1:])
