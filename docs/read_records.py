#!/usr/bin/env python3
"""Reads a results folder with pandas, h5py and xarray, and prints what is in it.

    python3 docs/read_records.py results/quick
"""

import json
import sys
from pathlib import Path

import h5py
import numpy
import pandas
import xarray


def frames_of(record):
    """The scalar observables of a record: one row per frame, indexed by time (s)."""
    observations = record["observations"]
    scalars = {name: data[:] for name, data in observations.items() if data.ndim == 1}
    return pandas.DataFrame(scalars).set_index("time")


def chosen(labels):
    """The run with the widest hole, where there are holes, else the first."""
    holes = labels.get("hole_radius")
    if holes is None or holes.isna().all():
        return labels.iloc[0]
    return labels.loc[holes.idxmax()]


def print_surface(path):
    """The mean surface of a run in its last second over the distance from the axis."""
    with xarray.open_datatree(path) as run:
        profile = run["observations/profile"]
        if profile.size == 0:
            return
        last = profile.sel(time=slice(float(profile.time[-1]) - 1.0, None)).mean("time")
        print(f"the same of: {profile.attrs['long_name']} ({profile.attrs['units']})")
        print(last.to_series().to_string())


def main(folder):
    sweep = json.loads((folder / "sweep.json").read_text())
    axes = [axis["name"] for axis in sweep["axes"]]
    print(sweep.get("title") or folder.name, "over", " and ".join(axes) or "seeds")

    # Identities are texts, even where they look like numbers.
    labels = pandas.read_csv(folder / "labels.csv", dtype={"id": str})
    print(labels["label"].value_counts().to_string())
    if len(axes) == 2:
        print(labels.pivot_table(index=axes[1], columns=axes[0], values="code").to_string())

    run = chosen(labels)
    path = folder / "records" / f"{run['id']}.h5"
    if not path.exists():
        print("published without records; `phase sweep` makes them")
        return
    with h5py.File(path) as record:
        print(f"{path.name}: {run['label']}, {record.attrs['outcome']}")
        spheres = json.loads(record.attrs["scene"])["spheres"]
        print(spheres["count"], "spheres of radius", spheres["radius"], "m")

        frames = frames_of(record)
        print("mean of the last second:")
        for name, value in frames.loc[frames.index[-1] - 1.0 :].mean().items():
            data = record["observations"][name]
            unit, description = (data.attrs[it].decode() for it in ["unit", "description"])
            print(f"  {name:15} {value:12.4e} {unit:6} {description}")

        # Not a number where a sphere is not in.
        position = record["snapshots/position"][-1]
        position = position[~numpy.isnan(position[:, 0])]
        print(f"{len(position)} spheres are in at the end", end="")
        if len(position) > 0:
            distance = numpy.hypot(position[:, 0], position[:, 1])
            print(f", {distance.min():.4f} to {distance.max():.4f} m from the axis", end="")
        print()
    print_surface(path)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results/quick"))
