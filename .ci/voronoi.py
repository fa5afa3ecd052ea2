#!/usr/bin/env python3
"""Compares a table of Voronoi cells, as examples/voronoi_cells.rs prints it, with those of Voro++
(Rycroft, Chaos 19, 041111, 2009) in the same box."""

import sys
import time

import numpy as np
import pandas
import pyvoro2

table = pandas.read_csv(sys.argv[1])
half_width, half_depth = float(sys.argv[2]), float(sys.argv[3])
box = pyvoro2.Box(
    (
        (-half_width, half_width),
        (-half_depth, half_depth),
        (0.0, float(table["top"][0])),
    )
)
start = time.perf_counter()
found = pyvoro2.compute(
    table[["x", "y", "z"]].to_numpy(),
    domain=box,
    return_vertices=False,
    return_adjacency=False,
    return_faces=True,
    output="cells",
)
seconds = time.perf_counter() - start
volume, faces = np.empty(len(table)), np.empty(len(table), dtype=int)
for cell in found:
    volume[cell["id"]], faces[cell["id"]] = cell["volume"], len(cell["faces"])
worst = np.max(np.abs(table["volume"] / volume - 1.0))
differ = int(np.sum(table["faces"] != faces))
print(
    f"{len(table)} Voronoi cells, Voro++ in {seconds:.2f} s: "
    f"volumes differ by {worst:.1e} at most, numbers of faces of {differ}"
)
# Faces of no area may be cut or not.
if worst > 1e-9 or differ > len(table) // 1000:
    sys.exit("the cells are not those of Voro++")
