"""One run."""

from __future__ import annotations

import os

import xarray

from phase import _lib
from phase.open import dataset_of_record
from phase.progress import bar
from phase.types import Manner, Path, Source, Wishes, plain


def run(
    scene: Source,
    *,
    seed: int | None = None,
    trajectory: bool = False,
    ledger: bool = False,
    snapshot_interval: float | None = None,
    out: Path | None = None,
    resume: bool = False,
    threads: int = 1,
    progress: bool = True,
) -> xarray.Dataset:
    """Run one scene.

    Parameters
    ----------
    scene : mapping or path
        A dict with the keys of a scene file, or the path of a scene file (TOML).
    seed : int, optional
        Seed in place of the scene's.
    trajectory : bool
        Keep the states of all spheres at every frame.
    ledger : bool
        Balance the energy: dissipation, work of the air, the integrator's error.
    snapshot_interval : float, optional
        Time between states of all spheres (s); 0 for the last one only.
    out : path, optional
        Where the record is written (HDF5). The run then leaves checkpoints beside it: every two
        minutes, and when it is interrupted.
    resume : bool
        Go on from the checkpoint beside `out`, if there is one.
    threads : int
        Threads of the simulation; below 4096 spheres one is used. No bit depends on it.
    progress : bool
        Show a bar, if tqdm is installed.

    Returns
    -------
    xarray.Dataset
        Observables on ``time`` (s), one value per frame; ``profile`` on ``time`` and ``bin`` (m),
        ``rising`` on ``time``, ``rise_radius`` and ``rise_speed``; ``radius`` (m) and ``mass``
        (kg) on ``sphere``; ``position`` (m), ``velocity`` (m/s) and ``spin`` (rad/s) on
        ``snapshot`` (s), ``sphere`` and ``component``. What the scene does not name is not there.
        Attributes tell label, code and evidence of the run, its scene (JSON) and its outcome.

    Raises
    ------
    RefusalError
        If something is wrong with the scene; the text shows the line.
    FailureError
        If the run or its record fails.
    """
    wishes: Wishes = {
        "seed": seed,
        "trajectory": trajectory,
        "ledger": ledger,
        "snapshot_interval": snapshot_interval,
    }
    manner: Manner = {
        "out": None if out is None else os.fspath(out),
        "resume": resume,
        "threads": threads,
    }
    with bar(progress, "run") as show:
        record = _lib.run(plain(scene), wishes, manner, show)
    return dataset_of_record(record, out)
