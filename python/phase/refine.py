"""Borders of any function, from few calls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy
import numpy.typing
import xarray

from phase import _lib
from phase.errors import RefusalError
from phase.open import dataset
from phase.types import Path

Point = dict[str, float]
"""A point: the value on each axis by its name, and ``seed`` if points have several."""


class Refinement:
    """A diagram that is refined by asking for points and telling their labels.

    `refine` makes one. First a coarse grid is asked for, then batches where the label is least
    certain. All follows from the axes, the settings and the labels, whatever the order in which the
    points of a batch are told.
    """

    def __init__(self, asked: _lib.Refinement) -> None:
        self._asked = asked

    def ask(self) -> list[Point]:
        """The points of the batch that are not told yet.

        Once all are told, the next batch; an empty list at the end.
        """
        return [self._point(values, seed) for values, seed in self._asked.ask()]

    def tell(self, point: Mapping[str, float], label: object) -> None:
        """Take the label of a point.

        Parameters
        ----------
        point : mapping
            A point as `ask` gives it, or any other one of the grid.
        label : str, int or bool
            Its label, of which the text counts: 1 and "1" are equal.

        Raises
        ------
        RefusalError
            If the point is none of the grid, has another label already, or the label is none.
        """
        axes = self._asked.axes
        several = self._asked.replicates > 1
        known = [*axes, "seed"] if several else axes
        missing = [name for name in known if name not in point]
        if missing:
            help = "tell points as `ask` gives them"
            raise RefusalError(f"the point has no {', '.join(missing)}; {help}", help=help)
        other = [str(name) for name in point if name not in known]
        if other:
            help = f"a point has {', '.join(known)}"
            raise RefusalError(f"{', '.join(other)} is no axis; {help}", help=help)
        values = [float(point[axis]) for axis in axes]
        seed = int(point["seed"]) if several else self._asked.first_seed
        self._asked.tell(values, seed, _text(label))

    @property
    def done(self) -> bool:
        """Whether nothing more is asked for."""
        return not self._asked.ask()

    @property
    def end(self) -> Literal["budget", "width", "complete"] | None:
        """Why nothing more is asked for; None before."""
        return self._asked.end

    @property
    def runs(self) -> int:
        """Number of labels that were told."""
        return self._asked.runs

    def labels(self) -> xarray.Dataset:
        """What is known of all points of the grid.

        Returns
        -------
        xarray.Dataset
            On the axes: ``label``, the most probable one; ``p_NAME``, the probability of each
            label; ``runs``, how many labels of the point were told.
        """
        return dataset(self._asked.labels())

    def borders(self, axis: str | None = None) -> xarray.Dataset:
        """Where the most probable label changes along an axis.

        Parameters
        ----------
        axis : str, optional
            The axis that is crossed. Default: the last one.

        Returns
        -------
        xarray.Dataset
            On ``crossing``: the place of the border by the names of the axes; ``below`` and
            ``above``, its labels; ``low_68``, ``high_68``, ``low_95`` and ``high_95``, the ends of
            its intervals of 68 and 95 % on the crossed axis, in its unit; ``width_95``, the length
            of the latter as a share of the axis.
        """
        return dataset(self._asked.borders(self._asked.axes[-1] if axis is None else axis))

    def _point(self, values: Sequence[float], seed: int) -> Point:
        point = dict(zip(self._asked.axes, values, strict=True))
        return {**point, "seed": seed} if self._asked.replicates > 1 else point


# What points and data sets call otherwise.
_TAKEN = {"seed", "label", "runs"}


def _values(name: str, values: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """The values of an axis."""
    if name in _TAKEN or not name:
        help = "choose another name"
        raise RefusalError(f"an axis cannot be called `{name}`; {help}", help=help)
    try:
        found = numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        found = numpy.empty(0)
    if found.ndim != 1 or found.size == 0:
        help = "give a list of numbers"
        raise RefusalError(f"the values of the axis `{name}` are no numbers; {help}", help=help)
    return found


def _text(label: object) -> str:
    """The text of a label."""
    is_label = isinstance(label, str | int | numpy.bool_ | numpy.integer | numpy.str_)
    if not is_label or label == "":
        help = "a label is a text that is not empty, a whole number or a truth value"
        raise RefusalError(f"{label!r} is no label; {help}", help=help)
    return str(label)


def refine(
    what: Mapping[str, numpy.typing.ArrayLike] | Path,
    *,
    budget: int | None = None,
    width: float | None = None,
    start: int | Sequence[int] = 6,
    round: int = 8,
    replicates: int = 1,
    seed: int = 1,
    exploring: float = 0.125,
    model: Literal["propagation", "regression"] = "propagation",
) -> Refinement:
    """Refine a function, or what the runs of a results folder tell.

    Parameters
    ----------
    what : mapping or path
        The values of each axis, by its name: one to four axes, all points of whose grid may be
        asked for. Or a results folder, whose sweep gives the axes and settings and whose runs are
        told already; then no other argument counts.
    budget : int
        Most points in total. Needed for a function.
    width : float, optional
        Wanted mean width of the 95 % band of every border, as a share of the axis. Default: the
        budget is spent.
    start : int or sequence of ints
        Values of each axis in the coarse grid: of all axes, or of each.
    round : int
        Points of one batch. Labels of a batch do not change its other points.
    replicates : int
        Largest number of seeds of a point, for functions whose labels are left to chance: above 1,
        points have a ``seed``.
    seed : int
        The first seed.
    exploring : float
        Share of the points after the coarse grid that are far from all others.
    model : str
        How probabilities are learnt: ``regression`` is faster with many points.

    Raises
    ------
    RefusalError
        If an axis or a setting is wrong, or the folder is none.

    Examples
    --------
    >>> axis = [0.0, 0.25, 0.5, 0.75, 1.0]
    >>> refinement = refine({"x": axis, "y": axis}, budget=20, start=3)
    >>> while points := refinement.ask():
    ...     for point in points:
    ...         refinement.tell(point, point["x"] > point["y"])
    >>> refinement.end
    'budget'
    """
    if not isinstance(what, Mapping):
        return Refinement(_lib.Refinement.of_folder(what))
    axes = {str(name): _values(name, values) for name, values in what.items()}
    if not 1 <= len(axes) <= 4:
        help = "give one to four axes"
        raise RefusalError(f"there are {len(axes)} axes; {help}", help=help)
    settings = {
        "budget": budget,
        "width": width,
        "start": [start] if isinstance(start, int) else list(start),
        "round": round,
        "replicates": replicates,
        "first_seed": seed,
        "exploring": exploring,
        "model": model,
    }
    if budget is None:
        help = "give `budget`, the largest number of points"
        raise RefusalError(f"nothing says when to end; {help}", help=help)
    given = {key: value for key, value in settings.items() if value is not None}
    pairs = [(name, values.tolist()) for name, values in axes.items()]
    return Refinement(_lib.Refinement(pairs, _lib.to_toml(given)))
