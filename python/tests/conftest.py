"""Scenes that take milliseconds."""

from __future__ import annotations

import copy
import pathlib
from typing import Any

import pytest

REPOSITORY = pathlib.Path(__file__).parents[2]
RESULTS = REPOSITORY / "results"

SCENE: dict[str, Any] = {
    "spheres": {"count": 8, "radius": 0.004, "density": 3750.0},
    "tank": {"radius": 0.03, "floor": 0.0},
    "start": {"kind": "random", "z_min": 0.01, "z_max": 0.05, "speed": 0.005},
    "contact": {
        "law": "hertz",
        "young_modulus": 5e5,
        "poisson_ratio": 0.3,
        "dissipation_time": 1e-3,
    },
    "gravity": {"acceleration": 9.8},
    "time": {"dt": 1e-4, "duration": 4.0, "frame_interval": 1e-2},
    "output": {"snapshot_interval": 1.0},
}


@pytest.fixture
def scene() -> dict[str, Any]:
    """Eight spheres that fall to the floor of a tank."""
    return copy.deepcopy(SCENE)


@pytest.fixture
def sweep(scene: dict[str, Any]) -> dict[str, Any]:
    """The same over three radii and two seeds."""
    return {
        "title": "Falling spheres",
        "scene": scene,
        "axis": [
            {"key": "spheres.radius", "values": [0.003, 0.004, 0.005]},
            {"key": "gravity.acceleration", "name": "g", "values": [1.6, 9.8]},
        ],
        "seeds": {"count": 2},
    }
