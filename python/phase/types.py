"""Types of arguments that several functions share."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

Path = str | os.PathLike[str]
"""Path of a file or folder."""

Table = Mapping[str, Any]
"""A table of a TOML file: texts, numbers, truth values, lists and tables by their keys."""

Source = Table | Path
"""A scene or a sweep: a dict with the keys of its file, or the path of the file."""


def plain(source: Source) -> dict[str, Any] | Path:
    """A mapping as a dict, and a path as it is."""
    return dict(source) if isinstance(source, Mapping) else source
