"""How far cells are from walls, for the fields that make nearness dear."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.values import finite_number
from antnav.world.grid import GridMap


def distance_to_edges(grid: GridMap, reach: float) -> NDArray[np.float64]:
    """Metres from each cell's centre to the edge of the nearest occupied cell, 0 in occupied ones.

    Exact up to `reach`, more than that beyond; inf without walls. Takes time for each column within reach.

    Parameters
    ----------
    grid : GridMap
    reach : float
        Metres, > 0.

    Returns
    -------
    ndarray of float64, shape (rows, cols)
    """
    along = np.maximum(grid.rows_to_wall - 0.5, 0.0) ** 2  # squared, in cells, to the nearest one of the own column
    along[grid.rows_to_wall >= 2**29] = math.inf
    least = along.copy()
    for aside in range(1, min(math.ceil(min(reach / grid.resolution, grid.cols) + 0.5), grid.cols)):
        there = along + (aside - 0.5) ** 2
        np.minimum(least[:, aside:], there[:, :-aside], out=least[:, aside:])
        np.minimum(least[:, :-aside], there[:, aside:], out=least[:, :-aside])
    distance: NDArray[np.float64] = np.sqrt(least) * grid.resolution
    return distance


def check_radius(name: str, value: Any) -> float:
    """A radius in metres: a finite number above 0, or a `ParameterError`."""
    number = finite_number(value)
    if not number > 0:  # nan fails, too
        rule = f"{name} is a finite number of metres, above 0"
        raise ParameterError(f"{name} {shown(value)}", rule, "give one, such as 0.5")
    return number
