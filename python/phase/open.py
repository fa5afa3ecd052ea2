"""Results as data sets."""

from __future__ import annotations

import os

import xarray

from phase import _lib
from phase.types import Parts, Path


def open(path: Path) -> xarray.Dataset:
    """Open the results of a sweep, or the record of one run.

    Parameters
    ----------
    path : path
        A results folder of `sweep` or of the program, or the record of a run (HDF5).

    Returns
    -------
    xarray.Dataset
        Of a folder: a variable for each column of ``labels.csv``, by the same name, on the axes of
        the sweep and on ``seed``. ``label`` is a text, ``code`` its number, and margins, evidence
        and measures are numbers with units. Where no run was made, ``label`` is empty, ``code`` is
        -128 and measures are not numbers.
        Of a record: what `run` returned.

    Raises
    ------
    RefusalError
        If nothing of the kind is there.
    """
    if os.path.isfile(path):
        return dataset_of_record(_lib.read_record(path), path)
    return dataset(_lib.open_folder(path), path)


def dataset(parts: Parts, source: Path | None = None) -> xarray.Dataset:
    """The data set of its parts, which were read from `source`."""
    made = xarray.Dataset(*parts)
    if source is not None:
        made.encoding["source"] = os.path.abspath(source)
    return made


def dataset_of_record(record: _lib.Record, source: Path | None = None) -> xarray.Dataset:
    """The data set of a record. It keeps the record, if this lies in no file."""
    made = dataset(record.table(), source)
    if source is None:
        made.encoding["record"] = record
    return made
