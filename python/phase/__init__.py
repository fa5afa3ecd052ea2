"""From a scene to a phase diagram.

Discrete element simulations of spheres in a vortex or of grains in a silo, run over a grid of
parameters, labelled, and refined: the engine of the program ``phase`` with results as data sets of
xarray. Units are SI.
"""

from phase.classify import classify
from phase.errors import Error, FailureError, RefusalError
from phase.open import open
from phase.refine import Refinement, refine
from phase.run import run
from phase.sweep import sweep

__all__ = [
    "Error",
    "FailureError",
    "Refinement",
    "RefusalError",
    "classify",
    "open",
    "refine",
    "run",
    "sweep",
]
