"""Records as files that xarray opens."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any, ClassVar

import xarray
from xarray.backends import BackendEntrypoint

from phase import _lib
from phase.open import open


class Records(BackendEntrypoint):
    """Opens records of runs (HDF5) by ``xarray.open_dataset(path, engine="phase")``."""

    description: ClassVar[str] = "Records of runs of phase (HDF5)"
    url: ClassVar[str] = ""
    open_dataset_parameters: ClassVar[tuple[str, ...]] = ("filename_or_obj", "drop_variables")

    def open_dataset(
        self,
        filename_or_obj: Any,
        *,
        drop_variables: str | Iterable[str] | None = None,
    ) -> xarray.Dataset:
        """The record as `phase.run` returned it, without the variables to drop."""
        made = open(filename_or_obj)
        names = [drop_variables] if isinstance(drop_variables, str) else drop_variables
        return made if names is None else made.drop_vars(names, errors="ignore")

    def guess_can_open(self, filename_or_obj: Any) -> bool:
        """Whether it is the path of a record that can be read."""
        if not isinstance(filename_or_obj, str | os.PathLike):
            return False
        return os.path.isfile(filename_or_obj) and _lib.is_record(filename_or_obj)
