"""Arrays of numbers from text and .npy files: what the numbers mean, and maps where 1 is passable."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.maps.occupancy import lost_grades, to_cells
from antnav.maps.source import MapWarning
from antnav.world.grid import Cell, GridMap

#: Values of `Cell`, or those of a ROS OccupancyGrid.
Values = Literal["cells", "occupancy"]


def to_grid(numbers: NDArray[Any], path: Path, values: Values, invert: bool, occupied_from: int) -> GridMap:
    """Make a map of the numbers of a file; resolution 1.

    Parameters
    ----------
    numbers : ndarray of int or bool, shape (rows, cols)
        -1 (or 255 in unsigned bytes) to 100 with `values` "occupancy", else values of `Cell`.
    path : Path
        Where they come from.
    values : {"cells", "occupancy"}
        What they mean.
    invert : bool
        Free and occupied change places, grades in between are counted from the other end; all else stays.
    occupied_from : int
        See `to_cells`; for "occupancy" only.

    Warns
    -----
    MapWarning
        Grades between free and occupied are lost.
    """
    if values == "occupancy":
        grades = numbers.astype(np.int8)
        if invert:
            grades = np.where(grades >= 0, 100 - grades, grades)
        lost = lost_grades(grades, occupied_from)
        if lost:
            warnings.warn(f"{path}: {lost}", MapWarning, stacklevel=4)  # the caller of load_map
        return GridMap(to_cells(grades, occupied_from), name=path.stem)
    cells = numbers.astype(np.uint8)
    if invert:
        cells = np.where(cells <= Cell.OCCUPIED, 1 - cells, cells)
    return GridMap(cells, name=path.stem)


def check_meaning(values: str, invert: bool) -> None:
    """Refuse a meaning of numbers that is neither of the two, and what is not a switch."""
    if not isinstance(values, str) or values not in ("cells", "occupancy"):
        remedy = "choose occupancy for -1 and 0 to 100, else leave it at cells"
        raise ParameterError(f"values {shown(values)}", "they are cells or occupancy", remedy)
    if not isinstance(invert, bool | np.bool_):
        raise ParameterError(f"invert {shown(invert)}", "it is True or False", "leave it at False where 1 is occupied")
