"""Path: the cells that a planner returns, what can be measured on them, and a check that trusts nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import PathError
from antnav.grid import Cell, GridMap
from antnav.moves import SQRT2, CornerRule
from antnav.problem import Point, Problem


@dataclass(frozen=True, eq=False)
class Path:
    """A path over neighbouring cells.

    Parameters
    ----------
    cells : array_like of int, shape (k, 2)
        Row and column of each cell, start first.
    grid : GridMap
    start, goal : (x, y), optional
        Exact ends in metres; default: the centres of the first and last cell.
    """

    cells: NDArray[np.int32] = field(repr=False)
    grid: GridMap
    start: Point | None = None
    goal: Point | None = None

    def __post_init__(self) -> None:
        cells = np.array(self.cells, np.int32).reshape(-1, 2)
        cells.flags.writeable = False
        object.__setattr__(self, "cells", cells)

    def __len__(self) -> int:
        return len(self.cells)

    def __repr__(self) -> str:
        ends = f"{tuple(self.cells[0].tolist())} -> {tuple(self.cells[-1].tolist())}, " if len(self) else ""
        return f"Path({len(self)} cells, {ends}length={self.length:.4f} cells = {self.length_m:.3f} m)"

    def _repr_html_(self) -> str:
        from antnav.markup import map_html

        return map_html(self.grid.cells, repr(self), self.cells)

    @cached_property
    def length(self) -> float:
        """Length in cells: straight moves + sqrt(2) times diagonal moves."""
        return length_of(self.cells)

    @property
    def length_m(self) -> float:
        """Length in metres, between cell centres."""
        return self.length * self.grid.resolution

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """World coordinates (x, y) in metres of the cell centres, shape (k, 2); the ends are exactly start and goal."""
        points = self.grid.cell_to_world(self.cells)
        if self.start is not None:
            points[0] = self.start
        if self.goal is not None and len(points) > 1:
            points[-1] = self.goal
        return points

    @cached_property
    def headings(self) -> NDArray[np.float64]:
        """World direction in radians of each segment; the last one is repeated for the goal. Shape (k,)."""
        if len(self.cells) < 2:
            return np.full(len(self.cells), self.grid.origin[2])
        dx, dy = np.diff(self.points, axis=0).T
        heading = np.arctan2(dy, dx)
        return np.append(heading, heading[-1])

    @cached_property
    def turns(self) -> int:
        """How often the direction changes between two moves."""
        steps = np.diff(self.cells, axis=0)
        return int(np.any(steps[1:] != steps[:-1], axis=1).sum())

    @cached_property
    def turning_angle(self) -> float:
        """Sum of all changes of direction in radians."""
        steps = np.diff(self.cells, axis=0).astype(float)
        before, after = steps[:-1], steps[1:]
        cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        dot = (before * after).sum(axis=1)
        return float(np.abs(np.arctan2(cross, dot)).sum())

    @cached_property
    def clearance(self) -> float:
        """Least distance in metres between centres of a cell of the path and an occupied one; inf without any."""
        occupied = self.grid.cells == Cell.OCCUPIED
        if not occupied.any() or not len(self.cells):
            return math.inf
        from scipy import ndimage

        distance = ndimage.distance_transform_edt(~occupied)
        return float(distance[tuple(self.cells.T)].min()) * self.grid.resolution


def length_of(cells: NDArray[np.int32]) -> float:
    """Length in cells of a sequence of neighbouring cells."""
    diagonal = int(np.all(np.diff(cells, axis=0) != 0, axis=1).sum())
    return (len(cells) - 1 - diagonal) + SQRT2 * diagonal


def check_path(path: Path | ArrayLike, problem: Problem) -> float:
    """Verify a path against the raw map, sharing no code with the planners.

    Parameters
    ----------
    path : Path or array_like of int, shape (k, 2)
        Rows and columns, start first.
    problem : Problem

    Returns
    -------
    float
        The length in cells, added up anew move by move.

    Raises
    ------
    PathError
        The first rule that is broken, with the cell: wrong ends, outside, not free, not neighbours, corner cut, or a
        `Path` that claims another length.
    """
    cells = _whole_pairs(path.cells if isinstance(path, Path) else path)
    grid = problem.grid
    allowed = {Cell.FREE, Cell.UNKNOWN} if problem.allow_unknown else {Cell.FREE}

    def free(row: int, col: int) -> bool:
        return 0 <= row < grid.rows and 0 <= col < grid.cols and Cell(int(grid.cells[row, col])) in allowed

    if not cells or cells[0] != problem.start_cell or cells[-1] != problem.goal_cell:
        ends = f"{cells[0]} -> {cells[-1]}" if cells else "no cells"
        raise _broken(ends, f"the path must lead from {problem.start_cell} to {problem.goal_cell}")
    for cell in cells:
        if not free(*cell):
            raise _broken(f"cell {cell}", "it is outside the map or not free")
    total = 0.0
    for (row, col), (next_row, next_col) in pairwise(cells):
        step = (next_row - row, next_col - col)
        if step == (0, 0) or max(abs(step[0]), abs(step[1])) > 1:
            raise _broken(f"move {(row, col)} -> {(next_row, next_col)}", "the cells are not neighbours")
        if 0 not in step:
            sides = free(row, next_col) + free(next_row, col)
            needed = {CornerRule.ALLOW: 0, CornerRule.GRAZE: 1, CornerRule.FORBID: 2}[problem.corner_rule]
            if sides < needed:
                raise _broken(
                    f"move {(row, col)} -> {(next_row, next_col)}", f"it cuts a corner (rule {problem.corner_rule})"
                )
        total += math.hypot(*step)
    if isinstance(path, Path) and not math.isclose(path.length, total, rel_tol=1e-9, abs_tol=1e-9):
        raise _broken(f"length {path.length}", f"the moves add up to {total}")
    return total


def _whole_pairs(cells: ArrayLike) -> list[tuple[int, int]]:
    """Cells as pairs of whole numbers, or a `PathError`."""
    try:
        array = np.asarray(cells)
    except ValueError:
        array = np.empty(0, object)
    if array.size == 0 and array.dtype != object:
        return []
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise _broken(f"cells of shape {array.shape} and type {array.dtype}", "a path is whole numbers, shape (k, 2)")
    return [(int(row), int(col)) for row, col in array]


def _broken(given: str, rule: str) -> PathError:
    return PathError(given, rule, "report this as an error of the planner that made the path")
