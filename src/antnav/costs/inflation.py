"""nav2's inflation layer as a cost field."""

from __future__ import annotations

import math

import numpy as np

from antnav.costs.walls import check_radius
from antnav.errors import check_type
from antnav.world.cost import CostField, check_weight
from antnav.world.grid import Cell, GridMap


def inflation(
    grid: GridMap,
    inflation_radius: float,
    cost_scaling_factor: float,
    inscribed_radius: float,
    weight: float = 1.0,
) -> CostField:
    """The costs of nav2's inflation layer, by its parameters' names.

    nav2 gives a cell the cost 252 exp(-cost_scaling_factor (d - inscribed_radius)), with d the distance in metres
    between its centre and that of the nearest occupied cell, 253 where d is at most inscribed_radius, and 0 where d
    is more than inflation_radius, rounded up to whole cells. Here 252 and more are `weight`, and costs are not cut to
    whole numbers. Nothing is blocked: `grid.inflated(inscribed_radius)` closes what the robot cannot enter. Unknown
    and inflated cells and the map's edge are no walls, as with nav2's defaults.

    Parameters
    ----------
    grid : GridMap
        Without occupied cells the field is 0 everywhere.
    inflation_radius : float
        Metres, above 0; nav2's default is 0.55.
    cost_scaling_factor : float
        Per metre, 0 to 1e9; nav2's default is 10.
    inscribed_radius : float
        Metres, 0 to 1e9: of the largest circle within the robot's footprint.
    weight : float
        Cost per metre within the inscribed radius, 0 to 1e9.

    Returns
    -------
    CostField
        Values 0 to `weight`.

    Raises
    ------
    ParameterError
        A number outside its range, or what is no map.

    References
    ----------
    https://docs.nav2.org/configuration/packages/costmap-plugins/inflation.html, and `computeCost` in
    nav2_costmap_2d/include/nav2_costmap_2d/inflation_layer.hpp, github.com/ros-navigation/navigation2.
    """
    check_type("grid", grid, GridMap, "load or make a map first")
    radius = check_radius("inflation_radius", inflation_radius)
    scaling = check_weight("cost_scaling_factor", cost_scaling_factor)
    inscribed, weight = check_weight("inscribed_radius", inscribed_radius), check_weight("weight", weight)
    values, occupied = np.zeros(grid.shape), grid.cells == Cell.OCCUPIED
    if occupied.any():
        from scipy import ndimage

        distance = ndimage.distance_transform_edt(~occupied)  # in cells
        near = distance <= math.ceil(min(radius / grid.resolution, grid.rows + grid.cols))
        beyond = np.maximum(distance[near] * grid.resolution - inscribed, 0.0)
        values[near] = weight * np.exp(-scaling * beyond)
    return CostField(values, name="inflation")
