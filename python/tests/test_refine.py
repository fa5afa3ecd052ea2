"""Refining functions and folders."""

from __future__ import annotations

import csv
import random
from collections.abc import Callable

import numpy
import pytest
from conftest import RESULTS

import phase
from phase.refine import Point

AXIS = numpy.linspace(0.0, 1.5, 31)


def circle(x: float, y: float) -> str:
    return "inside" if x**2 + y**2 < 1.0 else "outside"


def refined(
    order: Callable[[list[Point]], None] = lambda points: None, budget: int = 60
) -> phase.Refinement:
    refinement = phase.refine({"x": AXIS, "y": AXIS}, budget=budget)
    while points := refinement.ask():
        order(points)
        for point in points:
            refinement.tell(point, circle(**point))
    return refinement


def test_a_border_lies_in_its_band() -> None:
    refinement = refined()
    assert refinement.done and refinement.end == "budget" and refinement.runs == 60
    borders = refinement.borders("y")
    assert set(borders.below.values) == {"inside"} and set(borders.above.values) == {"outside"}
    true = numpy.sqrt(1.0 - borders.x**2)
    held = (borders.low_95 <= true) & (true <= borders.high_95)
    assert float(held.mean()) >= 0.95
    labels = refinement.labels()
    right = [[circle(x, y) for y in AXIS] for x in AXIS]
    assert float((labels.label == right).mean()) > 0.97
    total = labels.p_inside + labels.p_outside
    assert numpy.allclose(total, 1.0)
    assert int(labels.runs.sum()) == 60


def test_the_order_of_a_batch_changes_no_bit() -> None:
    chance = random.Random(3)
    first = refined()
    for order in (chance.shuffle, list.reverse):
        other = refined(order)
        assert other.labels().identical(first.labels())
        assert other.borders().identical(first.borders())


def test_looking_changes_nothing() -> None:
    looked = phase.refine({"x": AXIS, "y": AXIS}, budget=45)
    while points := looked.ask():
        for point in points:
            looked.tell(point, circle(**point))
            looked.labels()
    assert looked.labels().identical(refined(budget=45).labels())


def test_a_batch_is_asked_until_it_is_told() -> None:
    refinement = phase.refine({"x": AXIS}, budget=10, start=4)
    points = refinement.ask()
    assert len(points) == 4 and refinement.ask() == points
    refinement.tell(points[1], True)
    assert refinement.ask() == [points[0], *points[2:]]
    assert not refinement.done and refinement.end is None
    assert set(refinement.labels().label.values) == {"True"}


def test_points_beyond_the_batch_count() -> None:
    refinement = phase.refine({"x": AXIS}, budget=7, start=4)
    refinement.tell({"x": float(AXIS[3])}, "low")
    while points := refinement.ask():
        for point in points:
            refinement.tell(point, "low" if point["x"] < 0.7 else "high")
    assert refinement.runs == 7
    border = float(refinement.borders().x[0])
    assert abs(border - 0.7) < 0.1


def test_seeds_tell_of_chance() -> None:
    refinement = phase.refine({"x": AXIS}, budget=30, replicates=5, seed=11)
    seeds = set()
    while points := refinement.ask():
        for point in points:
            seeds.add(point["seed"])
            chance = random.Random(f"{point}").gauss(0.0, 0.3)
            refinement.tell(point, point["x"] + chance > 0.7)
    assert min(seeds) == 11 and max(seeds) > 11
    borders = refinement.borders()
    assert float((borders.high_95 - borders.low_95).max()) > 0.3


def test_bands_end_it() -> None:
    refinement = phase.refine({"x": AXIS}, budget=31, start=4, width=0.2)
    while points := refinement.ask():
        for point in points:
            refinement.tell(point, point["x"] > 0.7)
    assert refinement.end == "width" and refinement.runs < 31


def test_what_is_wrong_is_refused() -> None:
    refinement = phase.refine({"x": AXIS, "y": AXIS}, budget=60)
    with pytest.raises(phase.RefusalError, match="no y"):
        refinement.tell({"x": 0.0}, "inside")
    with pytest.raises(phase.RefusalError, match="no point of the axes"):
        refinement.tell({"x": 0.0123, "y": 0.0}, "inside")
    refinement.tell({"x": 0.0, "y": 0.0}, "inside")
    with pytest.raises(phase.RefusalError, match="replicates") as caught:
        refinement.tell({"x": 0.0, "y": 0.0}, "outside")
    assert caught.value.help is not None
    with pytest.raises(phase.RefusalError, match="no axis `z`"):
        refinement.borders("z")
    with pytest.raises(phase.RefusalError, match="budget"):
        phase.refine({"x": AXIS})
    with pytest.raises(phase.RefusalError, match="coarse grid"):
        phase.refine({"x": AXIS, "y": AXIS}, budget=20)
    with pytest.raises(phase.RefusalError, match="exploring"):
        phase.refine({"x": AXIS}, budget=20, exploring=2.0)
    with pytest.raises(phase.RefusalError, match="not finite"):
        phase.refine({"x": [0.0, numpy.nan]}, budget=20)
    with pytest.raises(phase.RefusalError, match="no labels"):
        phase.refine({"x": AXIS}, budget=20).labels()


def test_a_folder_tells_the_borders_of_its_table() -> None:
    folder = RESULTS / "theoretical-refined"
    refinement = phase.refine(folder)
    assert refinement.runs == 116 and refinement.end is None
    assert refinement.done and refinement.end == "budget"
    borders = refinement.borders("omega")
    with open(folder / "borders.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["along"] == "omega"]
    assert len(rows) == borders.sizes["crossing"]
    for name in ("radius", "omega", "low_68", "high_68", "low_95", "high_95", "width_95"):
        assert list(borders[name].values) == [float(row[name]) for row in rows], name
    for name in ("below", "above"):
        assert list(borders[name].values) == [row[name] for row in rows]
    labels = refinement.labels()
    assert labels.omega.attrs["units"] == "rad/s" and int(labels.runs.sum()) == 116


def test_a_full_grid_tells_borders_too() -> None:
    refinement = phase.refine(RESULTS / "theoretical-9x9")
    borders = refinement.borders("omega")
    assert "pinned" in set(borders.below.values) | set(borders.above.values)


def test_a_point_counts_once() -> None:
    refinement = phase.refine({"x": AXIS}, budget=7, start=4)
    point = refinement.ask()[0]
    for _ in range(3):
        refinement.tell(point, "low")
    assert refinement.runs == 1 and int(refinement.labels().runs.sum()) == 1
    while points := refinement.ask():
        for point in points:
            refinement.tell(point, "low")
            refinement.tell(point, "low")
    assert refinement.runs == 7


@pytest.mark.parametrize("label", [None, float("nan"), "", 0.5, [1], numpy.zeros(2)])
def test_what_is_no_label_is_refused(label: object) -> None:
    refinement = phase.refine({"x": AXIS}, budget=7, start=4)
    with pytest.raises(phase.RefusalError, match="is no label"):
        refinement.tell(refinement.ask()[0], label)


@pytest.mark.parametrize("name", ["seed", "label", "runs", ""])
def test_names_that_points_have_are_no_axes(name: str) -> None:
    with pytest.raises(phase.RefusalError, match="cannot be called"):
        phase.refine({name: AXIS}, budget=7, start=4)


def test_axes_and_points_that_are_wrong_are_refused() -> None:
    with pytest.raises(phase.RefusalError, match="five|5 axes"):
        phase.refine({name: AXIS for name in "abcde"}, budget=50, start=2)
    with pytest.raises(phase.RefusalError, match="are no numbers"):
        phase.refine({"x": [AXIS, AXIS]}, budget=7, start=4)
    with pytest.raises(phase.RefusalError, match="are no numbers"):
        phase.refine({"x": ["a", "b"]}, budget=7, start=4)
    refinement = phase.refine({"x": AXIS}, budget=7, start=4)
    with pytest.raises(phase.RefusalError, match="y is no axis"):
        refinement.tell({"x": 0.0, "y": 1.0}, "low")
    several = phase.refine({"x": AXIS}, budget=20, start=4, replicates=2)
    with pytest.raises(phase.RefusalError, match="has no seed"):
        several.tell({"x": 0.0}, "low")
