"""Cells that the robot may not enter."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from antnav.costs.masks import laid_on
from antnav.errors import check_type
from antnav.world.cost import CostField, table
from antnav.world.grid import Cell, GridMap


def keepout(mask: GridMap | ArrayLike, grid: GridMap | None = None) -> CostField:
    """A field that blocks cells and costs nothing elsewhere, as nav2's keepout filter.

    Parameters
    ----------
    mask : GridMap or array_like of bool, shape (rows, cols)
        A map blocks where it is occupied: `load_map` reads nav2's filter masks. Unknown cells of it do not block, as
        in nav2. An array blocks where it is true.
    grid : GridMap, optional
        The map that the field is for. A mask with another place, resolution or size is read at the centre of each
        cell of the map, and is free outside itself; what is thinner than a cell of the map can be missed. Default: the
        mask lies on the map cell by cell.

    Returns
    -------
    CostField
        Values 0.

    Raises
    ------
    ParameterError
        Not a mask; an array of another shape than `grid`; a mask in which no cell of `grid` lies.

    References
    ----------
    https://docs.nav2.org/configuration/packages/costmap-plugins/keepout_filter.html
    """
    blocked = mask.cells == Cell.OCCUPIED if isinstance(mask, GridMap) else table("mask", mask, "b", "a truth")
    field = CostField(np.zeros(blocked.shape), blocked, "keepout")
    if grid is None:
        return field
    check_type("grid", grid, GridMap, "load or make a map first")
    if isinstance(mask, GridMap):
        return CostField(np.zeros(grid.shape), laid_on(blocked, mask, grid), "keepout")
    field.check_fits(grid)
    return field
