"""Zones in which the robot has to be slow."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from antnav.costs.masks import laid_on
from antnav.errors import ParameterError, check_type, shown
from antnav.maps.grades import Grades
from antnav.values import finite_number
from antnav.world.cost import CostField, table
from antnav.world.grid import GridMap


def speed(
    mask: Grades | ArrayLike,
    grid: GridMap | None = None,
    *,
    base: float = 100.0,
    multiplier: float = -1.0,
    full_speed: float = 100.0,
) -> CostField:
    """A field of the time that nav2's speed filter costs: minimal cost is minimal time at the allowed speeds.

    Where the mask has a value v from 1 to 100, the speed limit is base + multiplier v, and a metre takes
    full_speed / limit times as long as at full speed: the cost per metre is full_speed / limit - 1. It is 0 where there
    is no limit: where v is 0, -1 (unknown) or outside the mask; where the limit is at least the full speed; and, as in
    nav2, where it comes out at 0 or below. So the darkest cells of a mask, v = 100, do not slow down with nav2's usual
    numbers; to close cells there is `keepout`.

    Parameters
    ----------
    mask : Grades or array_like of int, shape (rows, cols)
        -1 to 100: `maps.load_grades` reads nav2's filter masks.
    grid : GridMap, optional
        The map that the field is for: see `keepout`. Default: the mask lies on the map cell by cell.
    base, multiplier : float
        Of nav2's CostmapFilterInfo. The defaults are those of nav2's examples, in which v is per cent to be slower;
        those of the message are 0 and 1.
    full_speed : float
        The robot's greatest speed in the unit of the limit, above 0: 100 for per cent (nav2's filter type 1), metres
        per second for filter type 2.

    Returns
    -------
    CostField
        Limits so near to 0 that a cost exceeds 1e9 are refused.

    Raises
    ------
    ParameterError
        Not a mask, or with values outside -1..100; a number that is not finite; an array of another shape than `grid`;
        a mask in which no cell of `grid` lies; a cost above 1e9.

    References
    ----------
    https://docs.nav2.org/configuration/packages/costmap-plugins/speed_filter.html and
    https://docs.nav2.org/tutorials/docs/navigation2_with_speed_filter.html; `SpeedFilter` and `NO_SPEED_LIMIT` in
    nav2_costmap_2d, github.com/ros-navigation/navigation2.
    """
    values = table("mask", mask.values if isinstance(mask, Grades) else mask, "iu", "a whole number")
    if values.min() < -1 or values.max() > 100:
        given = f"mask of {values.min()} to {values.max()}"
        raise ParameterError(given, "its values are -1 to 100", "give occupancy values, as of maps.load_grades")
    costs = _costs(_number("base", base), _number("multiplier", multiplier), _number("full_speed", full_speed))
    field = CostField(costs[values.astype(np.int64)], name="speed")
    if grid is None:
        return field
    check_type("grid", grid, GridMap, "load or make a map first")
    if isinstance(mask, Grades):
        return CostField(laid_on(field.values, mask.grid, grid), name="speed")
    field.check_fits(grid)
    return field


def _costs(base: float, multiplier: float, full_speed: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Cost per metre by value of a mask, 0 to 100, and of -1 at the end."""
    if full_speed <= 0:
        raise ParameterError(f"full_speed {full_speed}", "full_speed is above 0", "leave it at 100 for per cent")
    costs = np.zeros(102)
    with np.errstate(over="ignore", divide="ignore"):
        limits = base + multiplier * np.arange(1.0, 101.0)
        costs[1:101] = np.where(limits > 0, np.maximum(full_speed / limits - 1, 0.0), 0.0)
    return costs


def _number(name: str, value: Any) -> float:
    number = finite_number(value)
    if math.isnan(number):
        raise ParameterError(f"{name} {shown(value)}", f"{name} is a finite number", "give one, such as 100")
    return number
