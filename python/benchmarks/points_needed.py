"""Points that are needed until 95 % of the labels of a map are predicted rightly.

    python python/benchmarks/points_needed.py results/theoretical results/silo > table.md

Beside `phase.refine` it runs the sampler of AIPHAD (Terayama et al., Phys. Rev. Materials 3,
033802, 2019; Tamura et al., Commun. Mater. 5, 139, 2024; `pip install aiphad`) with its defaults:
label propagation, and one point at a time where the label is least certain. All candidates are the
points of the map, whose labels are those of its first seed.
"""

from __future__ import annotations

import argparse
import pathlib
import statistics
import warnings
from collections.abc import Iterator

import numpy
import numpy.typing
from aiphad import pdc_sampler

import phase
from phase.refine import Point

WANTED = 0.95

Labels = numpy.typing.NDArray[numpy.str_]
Indices = list[int]


class PublishedMap:
    """A map whose labels are known: points in steps of the grid, each axis from 0 to 1."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.name = folder.name
        label = phase.open(folder).label.isel(seed=0)
        self.axes = {str(name): numpy.arange(size) for name, size in label.sizes.items()}
        self.labels: Labels = label.values.ravel()
        if (self.labels == "").any():
            raise SystemExit(f"{folder}: not all points have a label")
        grid = numpy.meshgrid(*self.axes.values(), indexing="ij")
        self.points = numpy.stack([axis.ravel() for axis in grid], axis=1).astype(float)

    def right(self, predicted: Labels) -> float:
        """Share of the labels that are predicted rightly."""
        return float((predicted == self.labels).mean())

    def coarse(self, count: int) -> Indices:
        """The coarse grid of `phase.refine`, with that many values of each axis."""
        refinement = phase.refine(self.axes, budget=len(self.labels), start=count)
        return [self.place(point) for point in refinement.ask()]

    def place(self, point: Point) -> int:
        """Index of a point."""
        indices = tuple(int(point[axis]) for axis in self.axes)
        return int(numpy.ravel_multi_index(indices, [len(it) for it in self.axes.values()]))


def needed_by_phase(of: PublishedMap, first: Indices, start: int, round: int) -> int:
    """Points that `phase.refine` needs, counted at the ends of its batches.

    It is told these first ones, and asks for its own coarse grid.
    """
    budget = len(of.labels)
    refinement = phase.refine(of.axes, budget=budget, start=start, round=round)
    told = numpy.full(budget, "", dtype=of.labels.dtype)
    for place in first:
        told[place] = of.labels[place]
        point = dict(zip(of.axes, of.points[place], strict=True))
        refinement.tell(point, of.labels[place])
    while points := refinement.ask():
        for point in points:
            told[of.place(point)] = of.labels[of.place(point)]
            refinement.tell(point, of.labels[of.place(point)])
        predicted = refinement.labels().label.values.ravel()
        if of.right(numpy.where(told != "", told, predicted)) >= WANTED:
            break
    return refinement.runs


def needed_by_aiphad(of: PublishedMap, first: Indices, sampling: str) -> int:
    """Points that AIPHAD needs from these first ones on."""
    names, codes = numpy.unique(of.labels, return_inverse=True)
    told = numpy.full(len(codes), -1)
    told[first] = codes[first]
    while True:
        # It takes labels that are counted from 0 without a gap.
        known, dense = numpy.unique(told[told >= 0], return_inverse=True)
        labels = told.copy()
        labels[told >= 0] = dense
        if (told >= 0).all():
            return len(told)
        sampler = pdc_sampler(estimation="LP", sampling=sampling, proposal=1)
        with warnings.catch_warnings():
            # Label propagation warns where it divides by the weight 0 of far points.
            warnings.simplefilter("ignore")
            sampler.fit(of.points, list(labels))
            predicted = known[sampler.predicted_all_labels]
            if of.right(names[numpy.where(told >= 0, told, predicted)]) >= WANTED:
                return int((told >= 0).sum())
            sampler.us()
        told[sampler.proposals[0]] = codes[sampler.proposals[0]]


def random_start(of: PublishedMap, count: int, seed: int) -> Indices:
    """Points at random places."""
    chance = numpy.random.default_rng(seed)
    return [int(it) for it in chance.choice(len(of.labels), count, replace=False)]


def rows(of: PublishedMap, seeds: int, samplings: list[str]) -> Iterator[tuple[str, list[int]]]:
    """Each method with the numbers of points that it needs."""
    start = 6 if len(of.axes) < 3 else 2
    coarse = of.coarse(start)
    yield "phase, coarse grid, batches of 8", [needed_by_phase(of, [], start, 8)]
    yield "phase, coarse grid, one by one", [needed_by_phase(of, [], start, 1)]
    for sampling in samplings:
        yield f"AIPHAD {sampling}, same coarse grid", [needed_by_aiphad(of, coarse, sampling)]
    starts = [random_start(of, 10, seed) for seed in range(seeds)]
    needed = [needed_by_phase(of, first, 1, 1) for first in starts]
    yield "phase, 10 random points, one by one", needed
    for sampling in samplings:
        needed = [needed_by_aiphad(of, first, sampling) for first in starts]
        yield f"AIPHAD {sampling}, 10 random points", needed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="+", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--samplings", default="LC,MS,EA", help="strategies of AIPHAD")
    arguments = parser.parse_args()
    print("| map | points | method | needed | share |\n|---|---|---|---|---|", flush=True)
    for folder in arguments.folder:
        of = PublishedMap(folder)
        count = len(of.labels)
        for method, needed in rows(of, arguments.seeds, arguments.samplings.split(",")):
            middle = statistics.median(needed)
            span = f" ({min(needed)} to {max(needed)})" if len(needed) > 1 else ""
            share = f"{100 * middle / count:.0f} %"
            print(f"| {of.name} | {count} | {method} | {middle:g}{span} | {share} |", flush=True)


if __name__ == "__main__":
    main()
