"""Problem: a map, a start, a goal and a corner rule, validated once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import EndpointError, OccupiedError, OutsideMapError, ParameterError, check_type, shown
from antnav.values import finite_number
from antnav.world.cost import CostField, check_weight
from antnav.world.grid import Cell, GridMap, whole_pair
from antnav.world.grid_graph import GridGraph
from antnav.world.kept import KeptByKind
from antnav.world.moves import CornerRule
from antnav.world.path_cost import PathCost
from antnav.world.terrain import Terrain

_GRID_REMEDY = "make one with GridMap(array), or load one with load_map"

CellIndex = tuple[int, int]
Point = tuple[float, float]


#: What a copy or a pickle of a problem works out anew.
_WORKED_OUT = {"terrain", "graph", "kept"}


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
    start_tolerance : float
        Metres, >= 0. Where the start is not free, as for a robot that stands within its own radius of a wall, the
        nearest free cell centre within this distance becomes the start: one from which the goal can be reached where
        there is one, and none behind occupied cells. A free start is never moved, even where it leads nowhere.
    cost : CostField or None
        What crossing each cell costs beside the way, see `PathCost`; default: nothing. Cells that it blocks are closed
        in `grid`.
    turning : float
        What a turn by one radian costs, in cells, 0 to 1e9; default 0.

    Attributes
    ----------
    start_cell, goal_cell : (row, col)
    requested_start, requested_goal : (x, y) or None
        What was asked for, where a tolerance moved it.
    connected : bool
        Whether any path exists. A problem without one is valid: planners answer "unreachable" at once.

    Raises
    ------
    OutsideMapError, OccupiedError
        The start or the goal is outside the map or not on a passable cell.
    ParameterError
        No `GridMap`, an unknown corner rule, a coordinate or tolerance that is not a finite number.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem(an.maps.builtin("equiv20"), start=(0.5, 19.5), goal=(19.5, 0.5), corner_rule="allow")
    >>> problem.start_cell, problem.connected
    ((0, 0), True)
    """

    grid: GridMap
    start: Point
    goal: Point
    corner_rule: CornerRule = CornerRule.FORBID
    allow_unknown: bool = False
    goal_tolerance: float = 0.0
    start_tolerance: float = 0.0
    cost: CostField | None = None
    turning: float = 0.0
    start_cell: CellIndex = field(init=False)
    goal_cell: CellIndex = field(init=False)
    requested_start: Point | None = field(init=False, default=None)
    requested_goal: Point | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        check_type("map", self.grid, GridMap, _GRID_REMEDY)
        if self.cost is not None:
            check_type("cost", self.cost, CostField, "make one with antnav.costs")
            self.cost.check_fits(self.grid)
            self._set("grid", self.grid.closed(self.cost.blocked))
        self._set("turning", check_weight("turning", self.turning))
        terrain = self._terrain()
        self._set("terrain", terrain)
        self._set("corner_rule", terrain.corner_rule)
        self._set("allow_unknown", terrain.allow_unknown)
        for end in ("start", "goal"):
            self._set(end, check_point(end, getattr(self, end)))
            self._set(f"{end}_tolerance", _tolerance(end, getattr(self, f"{end}_tolerance")))
        start_cell, goal_cell = self._cell_of("start", self.start), self._cell_of("goal", self.goal)
        if self.start_tolerance > 0 and not terrain.is_open(start_cell):
            start_cell = self._moved("start", start_cell, self._free_near(start_cell, goal_cell))
        self._check_passable("start", start_cell)
        self._set("start_cell", start_cell)
        if self.goal_tolerance > 0 and not terrain.joins(start_cell, goal_cell):
            goal_cell = self._moved("goal", goal_cell, self._reachable_near(goal_cell))
        self._check_passable("goal", goal_cell)
        self._set("goal_cell", goal_cell)

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name not in _WORKED_OUT}

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
        start_tolerance: float = 0.0,
        cost: CostField | None = None,
        turning: float = 0.0,
    ) -> Self:
        """The same from (row, col), counted from 0 at the top left; start and goal are the cells' centres."""
        check_type("map", grid, GridMap, _GRID_REMEDY)
        points = []
        for end, given in (("start", start), ("goal", goal)):
            cell = whole_pair(end, given)
            if not grid.contains(cell):
                raise _outside(end, f"{end} cell {shown(cell)}", grid)
            x, y = grid.cell_to_world(cell)
            points.append((float(x), float(y)))
        rule = CornerRule.of(corner_rule)
        return cls(grid, points[0], points[1], rule, allow_unknown, goal_tolerance, start_tolerance, cost, turning)

    @cached_property
    def terrain(self) -> Terrain:
        """The map as the robot sees it, shared by all problems on the map with these choices."""
        return self._terrain()

    @property
    def objective(self) -> PathCost:
        """What a path costs."""
        return self.terrain.objective

    def cost_along(self, flat: NDArray[Any]) -> float:
        """Cost in cells of a path over flat cells of the padded map."""
        return self.terrain.cost_along(flat)

    def _terrain(self) -> Terrain:
        return Terrain.of(self.grid, self.corner_rule, self.allow_unknown, PathCost(self.cost, self.turning))

    @cached_property
    def kept(self) -> KeptByKind:
        """What rooms above have worked out from this problem, such as `search.exact`."""
        return KeptByKind()

    @property
    def passable(self) -> NDArray[np.bool_]:
        """See `Terrain.passable`."""
        return self.terrain.passable

    @property
    def moves(self) -> NDArray[np.uint8]:
        """See `Terrain.moves`."""
        return self.terrain.moves

    @property
    def flat_moves(self) -> NDArray[np.uint8]:
        """See `Terrain.flat_moves`."""
        return self.terrain.flat_moves

    @property
    def width(self) -> int:
        """Columns of the padded map."""
        return self.terrain.width

    def to_flat(self, cell: CellIndex) -> int:
        """Index of a cell of the map in the flattened padded map."""
        return self.terrain.to_flat(cell)

    def from_flat(self, flat: ArrayLike) -> NDArray[np.int64]:
        """(row, col) of flat indices, shape (..., 2)."""
        return self.terrain.from_flat(flat)

    @cached_property
    def graph(self) -> GridGraph:
        """The graph of all cells that can be reached from the start; see `Terrain.graph`."""
        return self.terrain.graph(self.start_cell)

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """Cells that can be reached from the start, shape (rows, cols)."""
        return self.terrain.reached(self.start_cell)

    @cached_property
    def flat_ends(self) -> tuple[int, int]:
        """Indices of the start and the goal in the flattened padded map."""
        return self.to_flat(self.start_cell), self.to_flat(self.goal_cell)

    @cached_property
    def connected(self) -> bool:
        """Whether the goal can be reached from the start."""
        return self.terrain.joins(self.start_cell, self.goal_cell)

    @property
    def moved_ends(self) -> tuple[str, ...]:
        """What the tolerances did, in words."""
        told = []
        for end, asked, got in (("start", self.requested_start, self.start), ("goal", self.requested_goal, self.goal)):
            if asked:
                moved = math.dist(asked, got)
                told.append(
                    f"the {end} ({asked[0]:g}, {asked[1]:g}) m was moved by {moved:.3g} m to ({got[0]:g}, {got[1]:g}) m"
                )
        return tuple(told)

    def _cell_of(self, end: str, point: Point) -> CellIndex:
        try:
            return self.grid.checked_cell(self.grid.world_to_cell(point).tolist())
        except ParameterError:
            raise _outside(end, f"{end} ({point[0]!r}, {point[1]!r}) m", self.grid) from None

    def _check_passable(self, end: str, cell: CellIndex) -> None:
        if self.terrain.is_open(cell):
            return
        kind = Cell(int(self.grid.cells[cell]))
        rule = {
            Cell.OCCUPIED: "an obstacle is there",
            Cell.UNKNOWN: "nothing is known there",
            Cell.INFLATED: "it is nearer to an obstacle than the robot's radius and margin",
            Cell.FREE: "",
        }[kind]
        kept_out = self.cost is not None and bool(self.cost.blocked[cell])
        if kept_out:
            rule = "it is kept out by the cells that the cost blocks"
        remedy = "choose a free cell" + (", or allow unknown cells" if kind is Cell.UNKNOWN else "")
        if kind is Cell.INFLATED and not kept_out:
            remedy += " or a smaller radius or margin"
        larger = "a larger" if getattr(self, f"{end}_tolerance") > 0 else "a"
        remedy += f", or give {larger} {end} tolerance"
        x, y = getattr(self, end)
        raise OccupiedError(end, f"{end} ({x:g}, {y:g}) m = cell {cell}", rule, remedy)

    def _moved(self, end: str, asked: CellIndex, got: CellIndex) -> CellIndex:
        """The cell that an end gets; where it is another than was asked for, its centre becomes the end."""
        if got != asked:
            self._set(f"requested_{end}", getattr(self, end))
            x, y = self.grid.cell_to_world(got)
            self._set(end, (float(x), float(y)))
        return got

    def _reachable_near(self, goal: CellIndex) -> CellIndex:
        """Nearest cell within the tolerance that can be reached from the start; the goal itself where none is."""
        near = _Window(self.grid, goal, self.goal_tolerance)
        components = self.terrain.components
        component = components[self.to_flat(self.start_cell)]
        reached = (near.of_padded(components) == component) & (component > 0)
        return near.nearest(reached | near.only(self.start_cell), self.goal) or goal

    def _free_near(self, start: CellIndex, goal: CellIndex) -> CellIndex:
        """Nearest free cell within the tolerance and not behind a wall; the start itself where none is.

        One from which the goal, or what its tolerance allows instead, can be reached goes before others.
        """
        from scipy import ndimage

        near = _Window(self.grid, start, self.start_tolerance)
        around_goal = _Window(self.grid, goal, self.goal_tolerance)
        cells, here = near.of(self.grid.cells), near.only(start)
        parts, _ = ndimage.label((cells != Cell.OCCUPIED) | here)  # side by side: nobody squeezes between two corners
        free = near.of(self.terrain.passable) & (parts == parts[here])
        components = self.terrain.components
        goals = around_goal.of_padded(components)
        close = (around_goal.distances(self.goal) <= self.goal_tolerance) | around_goal.only(goal)
        leads = np.isin(near.of_padded(components), np.setdiff1d(goals[close], 0)) | near.only(goal)
        return near.nearest(free & leads, self.start) or near.nearest(free, self.start) or start


class _Window:
    """The part of a map within some metres of a cell."""

    def __init__(self, grid: GridMap, cell: CellIndex, metres: float) -> None:
        self.grid, self.metres = grid, metres
        side = int(min(metres / grid.resolution, max(grid.shape))) + 1
        self.top, self.left = max(cell[0] - side, 0), max(cell[1] - side, 0)
        self.bottom, self.right = cell[0] + side + 1, cell[1] + side + 1

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """The window of an array, shape (rows, cols)."""
        return values[self.top : self.bottom, self.left : self.right]

    def of_padded(self, values: NDArray[Any]) -> NDArray[Any]:
        """The window of an array on the padded map, flat."""
        return self.of(values.reshape(self.grid.rows + 2, -1)[1:-1, 1:-1])

    def only(self, cell: CellIndex) -> NDArray[np.bool_]:
        """One cell of the map, where the window holds it."""
        rows, cols = np.ogrid[self.top : min(self.bottom, self.grid.rows), self.left : min(self.right, self.grid.cols)]
        only: NDArray[np.bool_] = (rows == cell[0]) & (cols == cell[1])
        return only

    def distances(self, point: Point) -> NDArray[np.float64]:
        """Metres from a point to the centre of each cell."""
        rows, cols = self.of(self.grid.cells).shape
        cells = np.indices((rows, cols)) + np.array((self.top, self.left))[:, None, None]
        away = self.grid.cell_to_world(np.moveaxis(cells, 0, -1)) - np.array(point)
        distances: NDArray[np.float64] = np.hypot(away[..., 0], away[..., 1])
        return distances

    def nearest(self, wanted: NDArray[np.bool_], point: Point) -> CellIndex | None:
        """The wanted cell whose centre is nearest to a point and within reach, ties by row and column."""
        distances = np.where(wanted, self.distances(point), np.inf)
        row, col = np.unravel_index(int(np.argmin(distances)), distances.shape)
        return (self.top + int(row), self.left + int(col)) if distances[row, col] <= self.metres else None


def check_problem(given: object) -> None:
    """Refuse what is not a `Problem`."""
    check_type("problem", given, Problem, "make one from a map, a start and a goal")


def check_point(end: str, given: Any) -> Point:
    """A start or goal in metres as two floats, or a `ParameterError`."""
    try:
        x, y = (finite_number(part) for part in given)
    except (TypeError, ValueError):
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ParameterError(f"{end} {shown(given)}", "a point is two finite numbers, x and y in metres", "give both")
    return x, y


def _tolerance(end: str, given: Any) -> float:
    number = finite_number(given)
    if not number >= 0:
        rule = "a tolerance is a finite number of metres, >= 0"
        raise ParameterError(f"{end} tolerance {shown(given)}", rule, "give one, or 0")
    return number


def _outside(end: str, given: str, grid: GridMap) -> EndpointError:
    cells = f"rows are 0..{grid.rows - 1}, columns 0..{grid.cols - 1}"
    corners = grid.corners().tolist()
    (x0, y0), (x1, y1) = corners[0], corners[2]
    if grid.origin[2] == 0:
        metres = f"{x0:.12g} <= x < {x1:.12g} m, {y0:.12g} <= y < {y1:.12g} m"
    else:
        places = ", ".join(f"({x:.12g}, {y:.12g})" for x, y in corners)
        metres = f"it is turned by {math.degrees(grid.origin[2]):.6g} degrees, and its corners are {places} m"
    return OutsideMapError(end, given, f"it lies outside the map ({cells}; {metres})", "choose a point inside")
