"""Path: the cells that a planner returns, what can be measured on them, and a check that trusts nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import PathError, check_type
from antnav.kernels import grid_kernels
from antnav.kernels.graph import SQRT2
from antnav.values import read_only
from antnav.world.grid import MAX_CELLS, Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Point, Problem, check_point, check_problem


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

    Raises
    ------
    PathError, ParameterError
        Cells that are no pairs of whole numbers; a map, a start or a goal that is none.

    Notes
    -----
    `length` counts moves between centres, in cells, as all planners do. Metres are measured on what a robot gets, the
    polyline `points` from the exact start to the exact goal.
    """

    cells: NDArray[np.int32] = field(repr=False)
    grid: GridMap
    start: Point | None = None
    goal: Point | None = None

    def __post_init__(self) -> None:
        check_type("map", self.grid, GridMap, "make one with GridMap(array), or load one with load_map")
        for end in ("start", "goal"):
            point = getattr(self, end)
            object.__setattr__(self, end, None if point is None else check_point(end, point))
        given = _whole_pairs(self.cells)
        cells = given.astype(np.int32)
        if (cells != given).any():
            raise _broken(f"cells up to {given.max()}", "a map has fewer rows and columns")
        object.__setattr__(self, "cells", read_only(cells))

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        read_only(self.cells)  # pickling drops the flag

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
        """Length in cells between centres: straight moves + sqrt(2) times diagonal moves."""
        return length_of(self.cells)

    @cached_property
    def length_m(self) -> float:
        """Length in metres of the polyline `points`, from the exact start to the exact goal."""
        return float(np.hypot(*np.diff(self.points, axis=0).T).sum())

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """World coordinates (x, y) in metres of the cell centres, shape (k, 2); the ends are exactly start and goal.

        Two points where start and goal are different points of one cell.
        """
        points = self.grid.cell_to_world(self.cells)
        if not len(points):
            return read_only(points)
        start = points[0] if self.start is None else np.array(self.start)
        goal = points[-1] if self.goal is None else np.array(self.goal)
        if len(points) == 1 and not np.array_equal(start, goal):
            points = np.stack((start, goal))
        points[0] = start
        if len(points) > 1:
            points[-1] = goal
        return read_only(points)

    @cached_property
    def headings(self) -> NDArray[np.float64]:
        """World direction in radians of each segment; the last one is repeated for the goal. Shape of `points`."""
        if len(self.points) < 2:
            return read_only(np.full(len(self.points), self.grid.origin[2]))
        dx, dy = np.diff(self.points, axis=0).T
        heading = np.arctan2(dy, dx)
        return read_only(np.append(heading, heading[-1]))

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
        return self._to_walls(self.cells, squares=False) * self.grid.resolution

    @cached_property
    def wall_distance(self) -> float:
        """Least distance in metres from the polyline `points` to the squares of occupied cells; inf without any.

        What a robot's radius takes is taken from this: the rest is the margin that is kept.
        """
        line = self._in_cells()
        if self.clearance == math.inf or not (line[[0, -1]] % 1).any():
            return self._to_walls(self.cells, squares=True) * self.grid.resolution
        least = self._to_walls(self.cells[1:-1], squares=True)
        window = self.clearance / self.grid.resolution + 2.0  # what is nearest to the whole path does not lie farther
        for one, other in ((line[0], line[:2][-1]), (line[-2:][0], line[-1])):
            least = min(least, _to_squares(one, other, self._occupied_near(one, other, window)))
        return least * self.grid.resolution

    def _to_walls(self, cells: NDArray[np.int32], *, squares: bool) -> float:
        distance = float(grid_kernels.distance_to_walls(self.grid.rows_to_wall, cells, squares))
        return distance if distance < MAX_CELLS else math.inf

    def _in_cells(self) -> NDArray[np.float64]:
        """The polyline in rows and columns, whole numbers at centres of cells."""
        cells = self.cells.repeat(2, axis=0) if len(self.points) > len(self.cells) else self.cells
        (dx, dy), yaw = (self.points - self.grid.cell_to_world(cells)).T / self.grid.resolution, self.grid.origin[2]
        aside, up = math.cos(yaw) * dx + math.sin(yaw) * dy, math.cos(yaw) * dy - math.sin(yaw) * dx
        line: NDArray[np.float64] = cells + np.stack((-up, aside), axis=-1)
        return line

    def _occupied_near(self, one: NDArray[np.float64], other: NDArray[np.float64], window: float) -> NDArray[np.int64]:
        """Row and column of the occupied cells in a window around two points."""
        low = np.maximum(np.floor(np.minimum(one, other) - window), 0).astype(int)
        high = np.ceil(np.maximum(one, other) + window).astype(int) + 1
        return low + np.argwhere(self.grid.cells[low[0] : high[0], low[1] : high[1]] == Cell.OCCUPIED)


def _to_squares(one: NDArray[np.float64], other: NDArray[np.float64], squares: NDArray[np.int64]) -> float:
    """Least distance between a segment and squares of side 1 around some centres; inf without any.

    A square's distance is convex along the segment, and quadratic between the places where the segment passes a line
    along one of its sides: it is least at an end, at such a place, or opposite a corner.
    """
    step = other - one
    sides = squares[:, None] + np.array([-0.5, 0.5])[:, None] - one  # (m, 2, 2), seen from `one`
    passing = np.divide(sides, step, out=np.zeros_like(sides), where=step != 0).reshape(-1, 4)
    corners = np.stack([sides[:, (i, j), (0, 1)] for i in (0, 1) for j in (0, 1)], axis=1)
    opposite = corners @ step / max(float(step @ step), 1e-300)
    share = np.clip(
        np.concatenate((passing, opposite, np.zeros_like(passing[:, :1]), np.ones_like(passing[:, :1])), 1), 0, 1
    )
    gaps = np.maximum(np.abs(one + share[..., None] * step - squares[:, None]) - 0.5, 0.0)
    return float(np.hypot(*gaps.T).min(initial=math.inf))


def length_of(cells: NDArray[np.int32]) -> float:
    """Length in cells of a sequence of neighbouring cells."""
    diagonal = int(np.all(np.diff(cells, axis=0) != 0, axis=1).sum())
    return max(0, len(cells) - 1 - diagonal) + SQRT2 * diagonal


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
    check_problem(problem)
    cells = [(int(row), int(col)) for row, col in _whole_pairs(path.cells if isinstance(path, Path) else path)]
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


def check_cost(path: Path, problem: Problem, claimed: float) -> None:
    """Verify a path's cost, added up anew cell by cell from the field itself, sharing no code with the planners.

    Raises
    ------
    PathError
        It is another one.
    """
    field = np.zeros(problem.grid.shape) if problem.cost is None else problem.cost.values
    slope = None if problem.cost is None else problem.cost.slope
    total = 0.0
    for one, other in pairwise(map(tuple, path.cells.tolist())):
        total += math.dist(one, other) * (1 + (float(field[one]) + float(field[other])) / 2)
        if slope:
            rise = float(slope.elevation[other]) - float(slope.elevation[one])
            total += rise * (slope.up if rise > 0 else -slope.down) / problem.grid.resolution
    headings = [math.atan2(row, col) for row, col in np.diff(path.cells, axis=0).tolist()]
    total += problem.turning * sum(abs(math.remainder(b - a, math.tau)) for a, b in pairwise(headings))
    if not math.isclose(claimed, total, rel_tol=1e-9, abs_tol=1e-9):
        raise _broken(f"cost {claimed}", f"the moves add up to {total}")


def _whole_pairs(cells: ArrayLike) -> NDArray[Any]:
    """Cells as whole numbers, shape (k, 2), or a `PathError`."""
    try:
        array = np.asarray(cells)
    except ValueError:
        array = np.empty(0, object)
    if array.size == 0 and array.dtype != object:
        return np.empty((0, 2), np.int32)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise _broken(f"cells of shape {array.shape} and type {array.dtype}", "a path is whole numbers, shape (k, 2)")
    return array


def _broken(given: str, rule: str) -> PathError:
    return PathError(given, rule, "report this as an error of the planner that made the path")
