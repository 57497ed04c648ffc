"""Cells near walls are dear."""

from __future__ import annotations

import numpy as np

from antnav.costs.walls import check_radius, distance_to_edges
from antnav.errors import check_type
from antnav.world.cost import CostField, check_weight
from antnav.world.grid import GridMap


def clearance(grid: GridMap, radius: float, weight: float = 1.0, decay: float | None = None) -> CostField:
    """A field that keeps paths off walls: cells nearer to one than a radius cost more, the nearer the more.

    With d, the distance in metres from a cell's centre to the edge of the nearest occupied cell:

    - without `decay`: weight (1 - d / radius) for d < radius, else 0
    - with `decay`: weight exp(-decay d) for d < radius, else 0: the shape of nav2's inflation layer, see `inflation`

    Occupied cells have d = 0; a cell beside a wall has half a cell's side. Unknown and inflated cells and the map's
    edge are no walls.

    Parameters
    ----------
    grid : GridMap
        Without occupied cells the field is 0 everywhere.
    radius : float
        Metres, above 0. From where on walls do not matter.
    weight : float
        Cost per metre at a wall, 0 to 1e9: with 1, a metre there counts twice.
    decay : float, optional
        Per metre, 0 to 1e9.

    Returns
    -------
    CostField
        Values 0 to `weight`.

    Raises
    ------
    ParameterError
        A number outside its range, or what is no map.
    """
    check_type("grid", grid, GridMap, "load or make a map first")
    radius, weight = check_radius("radius", radius), check_weight("weight", weight)
    distance = distance_to_edges(grid, radius)
    near = distance < radius
    share = 1 - distance[near] / radius if decay is None else np.exp(-check_weight("decay", decay) * distance[near])
    values = np.zeros(grid.shape)
    values[near] = weight * share
    return CostField(values, name="clearance")
