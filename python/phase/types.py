"""Types that several functions share."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy

Path = str | os.PathLike[str]
"""Path of a file or folder."""

Table = Mapping[str, Any]
"""A table of a TOML file: texts, numbers, truth values, lists and tables by their keys."""

Source = Table | Path
"""A scene or a sweep: a dict with the keys of its file, or the path of the file."""


Variable = tuple[tuple[str, ...], numpy.ndarray[Any, Any], dict[str, Any]]
"""Dimensions, values and attributes of a variable."""

Parts = tuple[dict[str, Variable], dict[str, Variable], dict[str, Any]]
"""Variables, coordinates and attributes of a data set."""


class Wishes(TypedDict):
    """What is asked of a run besides its scene."""

    seed: int | None
    trajectory: bool
    ledger: bool
    snapshot_interval: float | None


class Manner(TypedDict):
    """How a run is made."""

    out: str | None
    resume: bool
    threads: int


def plain(source: Source) -> dict[str, Any] | Path:
    """A mapping as a dict, and a path as it is."""
    return dict(source) if isinstance(source, Mapping) else source
