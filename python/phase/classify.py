"""Labels by other thresholds and rules."""

from __future__ import annotations

import os
from collections.abc import Sequence

import xarray

from phase import _lib
from phase.errors import RefusalError
from phase.open import dataset
from phase.types import Path, Table


def classify(
    what: xarray.Dataset | Path,
    *,
    sieves: Table | None = None,
    label: Sequence[Table] | None = None,
    measure: Sequence[Table] | None = None,
    labels: str | None = None,
    threads: int | None = None,
) -> xarray.Dataset:
    """Label the same runs in another way. No file is changed.

    Parameters
    ----------
    what : xarray.Dataset or path
        A results folder, or the record of a run; or a data set of one.
    sieves : mapping, optional
        Thresholds of the sieves, such as ``{"pinned": {"hole": 1.5}}``. Others stay as they are.
    label : sequence of mappings, optional
        Labels by rules, the tables ``[[label]]`` of a sweep file. They replace those of before.
    measure : sequence of mappings, optional
        Measures by rules, the tables ``[[measure]]``. They replace those of before.
    labels : str, optional
        Family whose sieves label the runs of which no rule holds, such as ``"tank"``.
    threads : int, optional
        Threads that read records. Default: all cores.

    Returns
    -------
    xarray.Dataset
        Of a folder: what `phase.open` returns, with the new labels; of a part of its data set the
        same part. Of a run: label, code and measures without dimensions, from all of its frames.

    Raises
    ------
    RefusalError
        If a threshold or rule is wrong, or there are no records to label the runs from.
    """
    given = {"sieves": sieves, "label": label, "measure": measure, "labels": labels}
    changes = {key: value for key, value in given.items() if value is not None}
    found = _record_or_path(what)
    if isinstance(found, _lib.Record):
        return dataset(_lib.classify_record(found, changes))
    if os.path.isfile(found):
        return dataset(_lib.classify_record(_lib.read_record(found), changes))
    labelled = dataset(_lib.classify_folder(found, changes, threads), found)
    return _part(labelled, what) if isinstance(what, xarray.Dataset) else labelled


def _part(labelled: xarray.Dataset, chosen: xarray.Dataset) -> xarray.Dataset:
    """The part of the labels whose coordinates a data set of the same folder has."""
    own = {name: chosen[name].values for name in labelled.dims if name in chosen.coords}
    part = labelled.sel(own)
    part.encoding.update(labelled.encoding)
    return part


def _record_or_path(what: xarray.Dataset | Path) -> _lib.Record | Path:
    """The record that a data set keeps, or the path of its results."""
    if not isinstance(what, xarray.Dataset):
        return what
    found: _lib.Record | Path | None = what.encoding.get("record", what.encoding.get("source"))
    if found is None:
        help = "give the path, or what phase.run, phase.sweep or phase.open returned"
        raise RefusalError(f"this data set does not say of which results it is; {help}", help=help)
    return found
