"""Problem: a map, a start, a goal and a corner rule, validated once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav import grid_kernels
from antnav.errors import EndpointError, OccupiedError, OutsideMapError, ParameterError
from antnav.graph import Graph
from antnav.grid import Cell, GridMap, read_only
from antnav.moves import CornerRule, moves_on

#: Distance fields that a graph keeps: start and goal, and a few more.
KEPT = 4

CellIndex = tuple[int, int]
Point = tuple[float, float]


def components_on(grid: GridMap, rule: CornerRule, *, unknown: bool = False) -> NDArray[np.int32]:
    """Connected components of a map (`grid_kernels.components`), worked out once: one map sees many queries."""
    key = "components", rule, unknown
    if key not in grid.derived:
        moves = moves_on(grid, rule, unknown=unknown)
        grid.derived[key] = grid_kernels.components(moves.ravel(), moves.shape[1])
    components: NDArray[np.int32] = grid.derived[key]
    return components


@dataclass(frozen=True, eq=False)
class Problem:
    """Plan a path on `grid` from `start` to `goal`.

    Parameters
    ----------
    grid : GridMap
    start, goal : (x, y)
        World coordinates in metres. `Problem.from_cells` takes (row, col) instead.
    corner_rule : CornerRule or str
        When a diagonal move may pass obstacles: "forbid" (default), "graze" or "allow" (the paper's).
    allow_unknown : bool
        Whether the robot may cross unknown cells.
    goal_tolerance : float
        Metres, >= 0. Where the goal is not free or cannot be reached, the nearest reachable cell centre within this
        distance becomes the goal.

    Attributes
    ----------
    start_cell, goal_cell : (row, col)
    requested_goal : (x, y) or None
        What was asked for, where the tolerance moved the goal.
    connected : bool
        Whether any path exists. A problem without one is valid: planners answer "unreachable" at once.

    Raises
    ------
    OutsideMapError, OccupiedError
        The start or the goal is outside the map or not on a passable cell.
    ParameterError
        Unknown corner rule, a coordinate or tolerance that is not a finite number.
    """

    grid: GridMap
    start: Point
    goal: Point
    corner_rule: CornerRule = CornerRule.FORBID
    allow_unknown: bool = False
    goal_tolerance: float = 0.0
    start_cell: CellIndex = field(init=False)
    goal_cell: CellIndex = field(init=False)
    requested_goal: Point | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        self._set("corner_rule", CornerRule.of(self.corner_rule))
        self._set("start", check_point("start", self.start))
        self._set("goal", check_point("goal", self.goal))
        number = isinstance(self.goal_tolerance, int | float)
        if not (number and math.isfinite(self.goal_tolerance) and self.goal_tolerance >= 0):
            raise ParameterError(
                f"goal tolerance {self.goal_tolerance!r}",
                "a tolerance is a finite number of metres, >= 0",
                "give one, or 0",
            )
        self._set("start_cell", self._cell_of("start", self.start))
        goal_cell = self._cell_of("goal", self.goal)
        self._check_passable("start", self.start_cell)
        if self.goal_tolerance > 0 and not self._reaches(goal_cell):
            asked, goal_cell = goal_cell, self._nearest_reachable(goal_cell)
            if goal_cell != asked:
                self._set("requested_goal", self.goal)
                x, y = self.grid.cell_to_world(goal_cell)
                self._set("goal", (float(x), float(y)))
        self._check_passable("goal", goal_cell)
        self._set("goal_cell", goal_cell)

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    @classmethod
    def from_cells(
        cls,
        grid: GridMap,
        start: CellIndex,
        goal: CellIndex,
        *,
        corner_rule: CornerRule | str = CornerRule.FORBID,
        allow_unknown: bool = False,
        goal_tolerance: float = 0.0,
    ) -> Self:
        """The same from (row, col), counted from 0 at the top left; start and goal are the cells' centres."""
        points = []
        for end, cell in (("start", start), ("goal", goal)):
            if not _is_cell(cell):
                raise ParameterError(f"{end} {cell}", "a cell is a row and a column", "give two whole numbers")
            if not grid.contains(cell):
                raise _outside(end, f"{end} cell {tuple(int(part) for part in cell)}", grid)
            x, y = grid.cell_to_world(cell)
            points.append((float(x), float(y)))
        return cls(grid, points[0], points[1], CornerRule.of(corner_rule), allow_unknown, goal_tolerance)

    @cached_property
    def passable(self) -> NDArray[np.bool_]:
        """Cells that the robot may enter, shape (rows, cols)."""
        return read_only(self.grid.passable(unknown=self.allow_unknown))

    @cached_property
    def moves(self) -> NDArray[np.uint8]:
        """Legal moves as bits on the padded map, shape (rows + 2, cols + 2); see `moves.legal_moves`. Read-only."""
        return read_only(moves_on(self.grid, self.corner_rule, unknown=self.allow_unknown).view())

    @property
    def flat_moves(self) -> NDArray[np.uint8]:
        """The same flat, for kernels: writeable, because Numba compiles one anew for read-only arrays."""
        return moves_on(self.grid, self.corner_rule, unknown=self.allow_unknown).ravel()

    @property
    def width(self) -> int:
        """Columns of the padded map."""
        return self.grid.cols + 2

    def to_flat(self, cell: CellIndex) -> int:
        """Index of a cell in the flattened padded map."""
        return (cell[0] + 1) * self.width + cell[1] + 1

    def from_flat(self, flat: ArrayLike) -> NDArray[np.int64]:
        """(row, col) of flat indices, shape (..., 2)."""
        flat = np.asarray(flat, np.int64)
        return np.stack((flat // self.width - 1, flat % self.width - 1), axis=-1)

    @property
    def _components(self) -> NDArray[np.int32]:
        """Connected component of each cell of the padded map, flat; 0 where nobody can move."""
        return components_on(self.grid, self.corner_rule, unknown=self.allow_unknown)

    @property
    def _seen(self) -> NDArray[np.bool_]:
        """Cells of the padded map that can be reached from the start, flat."""
        start = self.to_flat(self.start_cell)
        component = self._components[start]
        seen: NDArray[np.bool_] = (self._components == component) & (component > 0)
        seen[start] = True
        return seen

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """Cells that can be reached from the start, shape (rows, cols)."""
        return self._seen.reshape(self.moves.shape)[1:-1, 1:-1]

    @property
    def connected(self) -> bool:
        """Whether the goal can be reached from the start."""
        return self._reaches(self.goal_cell)

    @cached_property
    def graph(self) -> GridGraph:
        """The graph of all cells that can be reached from the start."""
        seen = self._seen
        return GridGraph.of(self.flat_moves, self.width, seen.view(np.uint8), int(seen.sum()))

    def _reaches(self, cell: CellIndex) -> bool:
        components, start, other = self._components, self.to_flat(self.start_cell), self.to_flat(cell)
        return start == other or bool(components[start] == components[other] > 0)

    def _cell_of(self, end: str, point: Point) -> CellIndex:
        row, col = (int(part) for part in self.grid.world_to_cell(point))
        if not self.grid.contains((row, col)):
            raise _outside(end, f"{end} ({point[0]:g}, {point[1]:g}) m", self.grid)
        return row, col

    def _check_passable(self, end: str, cell: CellIndex) -> None:
        if self.passable[cell]:
            return
        kind = Cell(int(self.grid.cells[cell]))
        rule = {
            Cell.OCCUPIED: "an obstacle is there",
            Cell.UNKNOWN: "nothing is known there",
            Cell.INFLATED: "it is nearer to an obstacle than the robot's radius",
            Cell.FREE: "",
        }[kind]
        remedy = "choose a free cell" + (", or allow unknown cells" if kind is Cell.UNKNOWN else "")
        if kind is Cell.INFLATED:
            remedy += " or a smaller radius"
        if end == "goal":
            remedy += ", or give a larger goal tolerance" if self.goal_tolerance > 0 else ", or give a goal tolerance"
        x, y = self.start if end == "start" else self.goal
        raise OccupiedError(end, f"{end} ({x:g}, {y:g}) m = cell {cell}", rule, remedy)

    def _nearest_reachable(self, cell: CellIndex) -> CellIndex:
        """Nearest reachable cell centre within the tolerance, ties by row and column; `cell` itself where none is."""
        candidates = np.argwhere(self.reachable)
        distance = np.hypot(*(self.grid.cell_to_world(candidates) - np.array(self.goal)).T)
        best = int(np.argmin(distance))
        if distance[best] > self.goal_tolerance:
            return cell
        return int(candidates[best, 0]), int(candidates[best, 1])


@dataclass(frozen=True, eq=False)
class GridGraph:
    """A `Graph` whose nodes are cells of a map, in map order."""

    graph: Graph
    flat: NDArray[np.int32]  #: (n,) index of each node in the flattened padded map
    cells: NDArray[np.int64]  #: (n, 2) row and column of each node
    moves: NDArray[np.uint8]  #: the padded map of legal moves, flat
    width: int  #: columns of the padded map
    known: dict[int, NDArray[np.float64]] = field(default_factory=dict)  #: distances worked out so far

    @classmethod
    def of(cls, moves: NDArray[np.uint8], width: int, seen: NDArray[np.uint8], count: int) -> Self:
        """The graph of the `count` cells whose flag in `seen` is set; both arrays flat and padded."""
        flat, *table = grid_kernels.neighbour_table(moves, width, seen, count)
        cells = np.stack((flat // width - 1, flat % width - 1), axis=-1).astype(np.int64)
        return cls(Graph(*table), read_only(flat), read_only(cells), moves, width)

    def __len__(self) -> int:
        return len(self.flat)

    def node(self, cell: CellIndex) -> int:
        """Node of a cell that is in the graph."""
        return int(np.searchsorted(self.flat, (cell[0] + 1) * self.width + cell[1] + 1))

    def part(self, inside: NDArray[np.bool_], node: int) -> GridGraph:
        """The graph of what can be reached from a node over nodes that are `inside`, shape (n,)."""
        moves = self.moves.copy()
        moves[self.flat[~inside]] = 0
        seen, _ = grid_kernels.flood(moves, self.width, int(self.flat[node]))
        seen[self.flat[~inside]] = 0
        return GridGraph.of(moves, self.width, seen, int(seen.sum()))

    def __contains__(self, flat: int) -> bool:
        """Whether a flat cell is one of the nodes."""
        return bool(self.flat[min(int(np.searchsorted(self.flat, flat)), len(self) - 1)] == flat)

    def on_map(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """The nodes' values at their cells, shape (rows, cols), nan elsewhere."""
        field = np.full((len(self.moves) // self.width - 2, self.width - 2), np.nan, np.float32)
        field[tuple(self.cells.T)] = values
        return field

    def distances_to(self, node: int) -> NDArray[np.float64]:
        """Exact distance in cells from every node to `node`, shape (n,). The latest few are kept."""
        distances = self.known.get(node)
        if distances is None:
            length, _, _ = grid_kernels.search(self.moves, self.width, int(self.flat[node]), -1, False)
            distances = self.known[node] = read_only(length[self.flat])
            for old in list(self.known)[:-KEPT]:
                self.known.pop(old, None)
        return distances

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"known": {}}


def _is_cell(cell: object) -> bool:
    try:
        parts: tuple[Any, ...] = tuple(cell)  # type: ignore[arg-type]
        return len(parts) == 2 and all(int(part) == part for part in parts)
    except (TypeError, ValueError, OverflowError):
        return False


def check_point(end: str, point: Point) -> Point:
    """A start or goal in metres as two floats, or a `ParameterError`."""
    try:
        x, y = (float(part) for part in point)
    except (TypeError, ValueError):
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ParameterError(f"{end} {point!r}", "a point is two finite numbers, x and y in metres", "give both")
    return x, y


def _outside(end: str, given: str, grid: GridMap) -> EndpointError:
    corners = grid.cell_to_world(
        [(-0.5, -0.5), (grid.rows - 0.5, grid.cols - 0.5), (-0.5, grid.cols - 0.5), (grid.rows - 0.5, -0.5)]
    )
    (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
    extent = (
        f"rows are 0..{grid.rows - 1}, columns 0..{grid.cols - 1}; x lies in {x0:g}..{x1:g} m, y in {y0:g}..{y1:g} m"
    )
    return OutsideMapError(end, given, f"it lies outside the map ({extent})", "choose a point inside")
