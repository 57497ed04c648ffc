"""Objectives of pairs of moves: how often, and how far, a path turns."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.objectives.objective import Objective
from antnav.world.moves import SLOT_ANGLES


@dataclass(frozen=True)
class Turns(Objective):
    """How often the direction changes, as `Path.turns`."""

    name: str = "turns"
    unit: str = ""
    step: float | None = 1.0

    def turns(self) -> NDArray[np.float64]:
        """1 for each change of direction."""
        return np.concatenate((np.zeros((1, 8)), 1.0 - np.eye(8)))


@dataclass(frozen=True)
class TurningAngle(Objective):
    """Sum of all changes of direction in radians, as `Path.turning_angle`."""

    name: str = "turning angle"
    unit: str = "rad"
    step: float | None = math.pi / 4

    def turns(self) -> NDArray[np.float64]:
        """The angle between two moves."""
        return np.concatenate((np.zeros((1, 8)), SLOT_ANGLES))
