"""Masks that lie elsewhere than the map, or have other cells."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.world.grid import GridMap

Values = TypeVar("Values", bound=NDArray[Any])


def laid_on(values: Values, frame: GridMap, grid: GridMap) -> Values:
    """Values of the mask's cells in which the centres of the map's cells lie; 0 outside the mask.

    Parameters
    ----------
    values : ndarray, shape of `frame`
    frame : GridMap
        Where the mask lies.
    grid : GridMap
        The map.

    Returns
    -------
    ndarray, shape of `grid`

    Raises
    ------
    ParameterError
        No cell of the map lies in the mask.
    """
    if (frame.shape, frame.resolution, frame.origin) == (grid.shape, grid.resolution, grid.origin):
        return values
    laid, met, cols = np.zeros(grid.shape, values.dtype), False, np.arange(grid.cols)
    for row in range(grid.rows):  # a row at a time: coordinates take much more memory than cells
        cells = frame.world_to_cell(grid.cell_to_world(np.stack((np.full_like(cols, row), cols), axis=-1)))
        within = ((cells >= 0) & (cells < frame.shape)).all(axis=1)
        laid[row, within] = values[tuple(cells[within].T)]
        met = met or bool(within.any())
    if not met:
        rule = f"no cell of the map {grid!r} lies in it"
        raise ParameterError(f"mask {frame!r}", rule, "compare their origins and resolutions")
    return laid  # type: ignore[return-value]
