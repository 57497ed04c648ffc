"""Where a robot may drive, in the plane of a map's cells: x is the column, y the row, whole numbers at centres."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.kernels.trajectory_kernels import Ground
from antnav.trajectories.footprint import Footprint
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import Problem

_APART = 1e-3  #: Cells that a footprint keeps beyond its margin: to touch is too near.


def ground_of(problem: Problem, *, body: bool, footprint: Footprint | None = None) -> Ground:
    """The squares of a problem's map, and the cells that a robot's centre keeps out of.

    Parameters
    ----------
    body : bool
        Whether the robot's radius is told, so that cells which were inflated for it are measured anew; else they are
        closed.
    footprint : Footprint, optional
        Of a robot that is no disc.
    """
    cells = problem.grid.cells
    price = np.zeros((0, 0))
    if problem.cost is not None and problem.cost.values.any():
        price = np.array(problem.cost.values, np.float64)
    if not body:
        return Ground(problem.grid.rows_to_wall, (~problem.passable).astype(np.uint8), price)
    closed = cells == Cell.OCCUPIED
    if not problem.allow_unknown:
        closed |= cells == Cell.UNKNOWN
        if problem.grid.covered is not None:
            closed |= problem.grid.covered & (cells == Cell.INFLATED)
    if problem.cost is not None:
        closed |= problem.cost.blocked
    ground = Ground(problem.grid.rows_to_wall, closed.astype(np.uint8), price)
    if footprint is None:
        return ground
    side = problem.grid.resolution
    return ground._replace(body=outline(footprint, problem.grid), inscribed=footprint.inscribed / side - _APART)


def outline(footprint: Footprint, grid: GridMap) -> NDArray[np.float64]:
    """A footprint's corners in the plane, in which left is to the right."""
    return footprint.corners * (1, -1) / grid.resolution


def turned(ground: Ground) -> Ground:
    """The ground for curves that are followed from their end: there the robot heads the other way."""
    return ground._replace(body=-ground.body)


def to_plane(grid: GridMap, points: ArrayLike) -> NDArray[np.float64]:
    """Points in metres as x and y in the plane."""
    return grid.world_to_plane(points)


def to_world(grid: GridMap, poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses in the plane, shape (k, 3), in metres and radians."""
    points = grid.cell_to_world(poses[:, 1::-1])
    return np.column_stack((points, np.remainder(grid.origin[2] - poses[:, 2] + math.pi, math.tau) - math.pi))
