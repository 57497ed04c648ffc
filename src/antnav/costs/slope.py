"""Climbing costs."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike

from antnav.files import as_path
from antnav.maps.elevation import read_elevation
from antnav.world.cost import CostField, Slope


def slope(elevation: str | os.PathLike[str] | ArrayLike, *, up: float = 10.0, down: float = 0.0) -> CostField:
    """A field of what it costs to go up and down: the only one whose way back costs other than the way.

    A move that leads up by dz metres costs `up` dz metres more, one that leads down `down` ``|dz|``. With 1 / `up` the
    coefficient of rolling resistance, that is the energy in metres of level ground: m g (mu s + dz) / (m g mu).

    Parameters
    ----------
    elevation : path-like, or array_like of numbers, shape (rows, cols)
        Metres, finite, -1e9 to 1e9, row 0 is the top of the map; only differences count. A file is .npy, .csv or .txt
        with these numbers, or a gray image whose levels they are.
    up, down : float
        Metres of level ground for a metre up or down, 0 to 1e9, one of them above 0. Sane: `up` 1 / mu, 10 on soil
        and grass to 70 for wheels on a hard floor; 8 for people (Naismith 1892); `down` 0 for a robot that brakes.

    Returns
    -------
    CostField
        Values 0, and the slope.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The file is missing; damaged, or no numbers; too large.
    ParameterError
        Heights that are none, such as nan; a number outside its range.

    References
    ----------
    Rowe & Ross 1990, IEEE Transactions on Robotics and Automation 6(5):540-553; Sun & Reif 2005, IEEE Transactions on
    Robotics 21(1):102-114.
    """
    given = read_elevation(as_path(elevation)) if isinstance(elevation, str | os.PathLike) else elevation
    ground = Slope(given, up, down)  # type: ignore[arg-type]  # it converts
    return CostField(np.zeros(ground.elevation.shape), name="slope", slope=ground)
