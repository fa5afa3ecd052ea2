"""Sweeps."""

from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Mapping

import xarray

from phase import _lib
from phase.errors import RefusalError
from phase.open import open
from phase.progress import bar
from phase.types import Path, Source, plain


def sweep(
    sweep: Source,
    *,
    out: Path | None = None,
    threads: int | None = None,
    progress: bool = True,
) -> xarray.Dataset:
    """Run what is missing of a sweep, label it, and open the results.

    Parameters
    ----------
    sweep : mapping or path
        A dict with the keys of a sweep file, or the path of a sweep file (TOML). With a table
        ``refine`` only the runs are made that the borders need.
    out : path, optional
        The results folder. Runs that it holds are not made again. Default for a file ``NAME.toml``:
        ``results/NAME``.
    threads : int, optional
        Runs at the same time. Default: all cores.
    progress : bool
        Show a bar, if tqdm is installed.

    Returns
    -------
    xarray.Dataset
        What `open` returns for the folder.

    Raises
    ------
    RefusalError
        If something is wrong with the sweep, or the folder holds something else.
    FailureError
        If the disk is full, for example.

    Warns
    -----
    RuntimeWarning
        If jobs failed; the folder lists them in ``failed.csv``.

    Notes
    -----
    Ctrl-C ends the runs under way within a second. They leave checkpoints, from which the same call
    continues.
    """
    folder = _folder_of(sweep) if out is None else out
    with bar(progress, "sweep") as show:
        failures = _lib.sweep(plain(sweep), folder, threads, show)
    if failures:
        message = f"{len(failures)} jobs failed, the first: {failures[0]}"
        warnings.warn(message, RuntimeWarning, stacklevel=2)
    return open(folder)


def _folder_of(sweep: Source) -> Path:
    """The results folder that the name of a sweep file gives."""
    if isinstance(sweep, Mapping):
        message = "the sweep has no file whose name gives a folder"
        raise RefusalError(f"{message}; give `out`", help="give `out`")
    return pathlib.Path("results") / pathlib.Path(os.fspath(sweep)).stem
