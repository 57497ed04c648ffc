"""Grades: the occupancy values of a map, which a `GridMap` does not keep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.world.grid import GridMap


@dataclass(frozen=True, eq=False)
class Grades:
    """Occupancy values that a map server would publish, and where they lie.

    Attributes
    ----------
    values : ndarray of int8, shape (rows, cols), read-only
        0 free to 100 occupied, -1 unknown; row 0 is the top.
    grid : GridMap
        The map of the same file, for its place in the world: cells of 1..99 are free in it.
    """

    values: NDArray[np.int8]
    grid: GridMap

    def __repr__(self) -> str:
        return f"Grades({self.grid!r}, {self.values.min()}..{self.values.max()})"
