"""The path encoding that all metaheuristics share: control points, joined by straight or by exact segments."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import grid_kernels, walk_kernels
from antnav.values import finite_number, is_whole
from antnav.world.problem import Problem


class Segments(StrEnum):
    """How two consecutive control cells are joined.

    - straight: by a digital straight line, which may run through obstacles
    - exact: by a cheapest path: every vector is feasible, and much of the work is A*'s
    """

    STRAIGHT = "straight"
    EXACT = "exact"


class Walk(NamedTuple):
    """What a vector stands for."""

    cells: NDArray[np.int64]  #: flat cells on the padded map, start first
    length: float  #: in cells; its cost, where the problem has costs
    illegal: int  #: moves that the map or the corner rule forbids; 0 means that this is a path


def check_encoding(points: int, penalty: float) -> None:
    """Refuse what `Encoding` cannot use.

    Raises
    ------
    ParameterError
        No whole number of control points above 0, or a penalty that is not a number above 0.
    """
    if not is_whole(points) or points < 1:
        raise ParameterError(
            f"{shown(points)} control points", "an encoding has a whole number >= 1", "give one, such as 5"
        )
    if not finite_number(penalty) > 0:
        raise ParameterError(f"penalty {shown(penalty)}", "it is a number of cells > 0", "give one, such as 10")


def nearest_cells(reachable: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Index on the flat padded map of the reachable cell nearest to each cell, shape (rows, cols)."""
    from scipy import ndimage

    rows, cols = ndimage.distance_transform_edt(~reachable, return_distances=False, return_indices=True)
    flat: NDArray[np.int64] = (rows.astype(np.int64) + 1) * (reachable.shape[1] + 2) + cols + 1
    return flat


def corners_of(shape: tuple[int, int], points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Least and largest vector of so many control points: the outer edges of the map's cells."""
    rows, cols = shape
    return np.full(2 * points, -0.5), np.tile([rows - 0.5, cols - 0.5], points)


@dataclass(frozen=True, eq=False)
class Encoding:
    """Vectors of k control points as walks from start to goal, and what they cost.

    A vector is (row_1, col_1, ..., row_k, col_k), real numbers in cells; the centre of cell (r, c) is (r, c). Each
    point becomes the nearest cell that can be reached from the start (ties: the distance transform's, always the
    same), so the walk visits start, k control cells and goal. Then ::

        cost = length + penalty * illegal moves

    is finite for every vector. A blocked cell on a straight line makes two illegal moves, into it and out of it; a
    corner cut against the problem's rule makes one.

    Parameters
    ----------
    problem : Problem
        Connected.
    points : int
        k, >= 1.
    segments : Segments
    penalty : float
        In cells, > 0.
    """

    problem: Problem
    points: int = 5
    segments: Segments = Segments.STRAIGHT
    penalty: float = 10.0

    def __post_init__(self) -> None:
        check_encoding(self.points, self.penalty)

    @property
    def dimension(self) -> int:
        """Numbers in a vector: 2 k."""
        return 2 * self.points

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Least and largest vector: the outer edges of the map's cells."""
        return corners_of(self.problem.grid.shape, self.points)

    @cached_property
    def nearest(self) -> NDArray[np.int64]:
        """Flat index of the reachable cell nearest to each cell, shape (rows, cols)."""
        return nearest_cells(self.problem.reachable)

    @cached_property
    def _moves(self) -> NDArray[np.uint8]:
        return self.problem.flat_moves

    def walk(self, vector: ArrayLike) -> Walk:
        """The walk of a vector, feasible or not."""
        stops = walk_kernels.stops_of(np.asarray(vector, np.float64), self.nearest, *self.problem.flat_ends)
        objective, width = self.problem.objective, self.problem.width
        if self.segments is Segments.STRAIGHT:
            walk = Walk(*walk_kernels.straight_walk(self._moves, width, stops))
        else:
            cells, cost = grid_kernels.joined(self._moves, width, stops, objective.prices)
            walk = Walk(cells, cost, 0)
        return walk if objective.plain else walk._replace(length=self.problem.cost_along(walk.cells))

    def cost_of(self, walk: Walk) -> float:
        """Length + penalty * illegal moves, in cells."""
        return walk.length + self.penalty * walk.illegal

    def decode(self, vector: ArrayLike) -> NDArray[np.int32]:
        """Row and column of each cell of the walk, shape (n, 2)."""
        return self.problem.from_flat(self.walk(vector).cells).astype(np.int32)
