"""LiveTerrain: a terrain that can be altered, and says where its moves are others now."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.kernels import grid_kernels, live_kernels, region_kernels
from antnav.kernels.grid_kernels import Prices
from antnav.world.cost import LARGEST, CostField
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem
from antnav.world.terrain import Terrain

#: Free cells that a diagonal move needs beside it.
_SIDES = {CornerRule.ALLOW: 0, CornerRule.GRAZE: 1, CornerRule.FORBID: 2}
_NONE = np.empty(0, np.int32)


class LiveTerrain:
    """Legal moves and prices of a map that changes, as kernels take them: the same arrays for its whole life.

    Parameters
    ----------
    problem : Problem
        Whose map, corner rule, unknown cells and costs it begins with.
    radius : float
        Of the robot in metres, >= 0: cells near occupied ones are closed, and opened again where the obstacle goes.
    strict : bool
        What near means, see `GridMap.inflated`.

    Attributes
    ----------
    moves : ndarray of uint8, flat
        Legal moves on the padded map; see `moves.legal_moves`.
    width : int
        Columns of the padded map.
    prices : Prices
        What moves cost; `cheapest` is 1 throughout. Empty where cost is length.
    opened : ndarray of int32
        Of the latest alteration, the flat cells that have a move which they had not, or cost less.
    raised : ndarray of int32
        Those that cost more.
    version : int
        Number of alterations.
    """

    def __init__(self, problem: Problem, radius: float = 0.0, strict: bool = False) -> None:
        check_type("strict", strict, bool | np.bool_, "give True or False")
        grid = problem.grid
        inflated = grid.inflated(radius, strict=bool(strict))
        if problem.turning:
            rule = "plans that are mended know no cost of turns"
            raise ParameterError(f"turning {problem.turning:g}", rule, "leave it out, or call solve() for each map")
        if not radius and (grid.cells == Cell.INFLATED).any() and not _kept_out(problem):
            warnings.warn(
                "the map is inflated for a robot, and obstacles to come will not be: give the map before inflated(), "
                "and radius=",
                UserWarning,
                stacklevel=3,
            )
        self.shape = grid.shape
        self.width = grid.cols + 2
        self._origin = grid
        self._problem = problem
        self._radius, self._strict = float(radius), bool(strict)
        reach = min(self._radius / grid.resolution, math.hypot(*self.shape) + 1)  # farther there is no map
        self._disc = _disc(reach, self._strict)
        self._kind = np.pad(grid.cells, 1, constant_values=Cell.OCCUPIED).ravel()
        begun = Terrain.of(inflated, problem.corner_rule, problem.allow_unknown)
        self.passable = np.pad(begun.passable, 1).astype(np.uint8).ravel()
        self.moves = begun.flat_moves.copy()
        cost = problem.cost
        self._slope = None if cost is None else cost.slope
        self.objective = problem.objective
        self.prices = Prices(self.objective.prices.cells.copy(), 1.0, self.objective.prices.heights.copy())
        self.opened, self.raised = _NONE, _NONE
        self.version = 0

    def to_flat(self, cell: tuple[int, int]) -> int:
        """Index of a cell of the map in the flattened padded map."""
        row, col = self._origin.checked_cell(cell)
        return (row + 1) * self.width + col + 1

    def cells_of(self, flat: NDArray[Any]) -> NDArray[np.int32]:
        """Rows and columns of flat cells, shape (k, 2)."""
        return np.stack((flat // self.width - 1, flat % self.width - 1), axis=-1).astype(np.int32)

    def flat_of(self, what: str, given: Any) -> NDArray[np.int32]:
        """Flat cells of rows and columns, shape (k, 2), or of a mask, shape (rows, cols).

        Raises
        ------
        ParameterError
            It is neither, or a cell lies outside the map.
        """
        if given is None:
            return _NONE
        rule = "it is rows and columns, shape (k, 2), or a mask of the map's shape"
        try:
            array = np.asarray(given)
        except (TypeError, ValueError, OverflowError):
            array = np.empty(0, object)
        if array.dtype == np.bool_ and array.shape == self.shape:
            array = np.argwhere(array)
        if array.size == 0 and array.dtype != object:
            return _NONE
        if array.ndim == 1 and array.shape == (2,):
            array = array[None]
        if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
            raise ParameterError(f"{what} {shown(given)}", rule, "give whole numbers, such as [(3, 4), (3, 5)]")
        outside = ((array < 0) | (array >= self.shape)).any(axis=1)
        if outside.any():
            cell = tuple(array[int(np.argmax(outside))].tolist())
            self._origin.checked_cell(cell)
        flat: NDArray[np.int32] = ((array[:, 0] + 1) * self.width + array[:, 1] + 1).astype(np.int32)
        return flat

    def alter(self, blocked: NDArray[np.int32] = _NONE, freed: NDArray[np.int32] = _NONE) -> NDArray[np.int32]:
        """Occupy flat cells, then free others. Returns the flat cells whose moves are others now."""
        self.version += 1
        self.raised = _NONE
        changed: NDArray[np.int32]
        changed, self.opened = live_kernels.alter(
            self._kind,
            self.passable,
            self.moves,
            self.width,
            _SIDES[self._problem.corner_rule],
            self._problem.allow_unknown,
            self._disc,
            blocked,
            freed,
        )
        return changed

    @property
    def priced(self) -> bool:
        """Whether cells have prices."""
        return self.prices.cells.size > 0

    def price(self, cells: NDArray[np.int32], values: NDArray[np.float64]) -> NDArray[np.int32]:
        """Give flat cells of a map with prices other costs per metre. Returns those whose price is another now."""
        self.version += 1
        prices = 1.0 + values
        other = self.prices.cells[cells] != prices
        self.opened = np.concatenate((self.opened, cells[prices < self.prices.cells[cells]]))
        self.raised = cells[prices > self.prices.cells[cells]]
        self.prices.cells[cells] = prices
        repriced: NDArray[np.int32] = cells[other]
        return repriced

    def begin_prices(self) -> None:
        """Give every cell of a map without costs the price 1, so that it can get others."""
        self.prices = Prices(np.ones(self.moves.size), 1.0, np.empty(0))

    def costs(self, given: Any) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Flat cells and their costs per metre, of a pair (cells, values) or a whole `CostField`.

        Raises
        ------
        ParameterError
            It is neither, a value is out of range, the field blocks cells or has another slope.
        """
        if isinstance(given, CostField):
            given.check_fits(self._origin)
            if given.blocked.any():
                raise ParameterError(f"cost {given.name!r}", "it blocks cells", "name those in blocked=")
            if given.slope is not None and given.slope is not self._slope:
                raise ParameterError(f"cost {given.name!r}", "its slope is another one", "slopes stay as they are")
            return self.flat_of("cost", np.ones(self.shape, np.bool_)), given.values.ravel()
        rule = "it is a CostField, or cells and their costs per metre"
        try:
            cells, values = given
            flat = self.flat_of("cost", cells)
            numbers = np.broadcast_to(np.asarray(values, np.float64), flat.shape)
        except ParameterError:
            raise
        except (TypeError, ValueError, OverflowError):
            raise ParameterError(f"cost {shown(given)}", rule, "give (cells, values)") from None
        if not ((numbers >= 0) & (numbers <= LARGEST)).all():
            worst = numbers[~((numbers >= 0) & (numbers <= LARGEST))][0]
            raise ParameterError(f"cost {worst}", f"a cell costs 0 to {LARGEST:g} per metre", "mend the values")
        return flat, numbers

    def is_open(self, flat: int) -> bool:
        """Whether the robot may stand on a cell."""
        return bool(self.passable[flat])

    def open_near(self, flat: int, tolerance: float) -> int:
        """The open cell whose centre is nearest to a cell's, within so many metres; the cell itself where none is."""
        if tolerance <= 0 or self.passable[flat]:
            return flat
        reach = int(min(tolerance / self._origin.resolution * (1 + 1e-12), max(self.shape)))
        row, col = divmod(flat, self.width)
        top, left = max(row - reach, 0), max(col - reach, 0)
        window = self.passable.reshape(-1, self.width)[top : row + reach + 1, left : col + reach + 1]
        away = np.hypot(*np.ogrid[top - row : top - row + len(window), left - col : left - col + window.shape[1]])
        away = np.where((window > 0) & (away * self._origin.resolution <= tolerance * (1 + 1e-12)), away, np.inf)
        nearest = int(np.argmin(away))
        if not away.flat[nearest] < np.inf:
            return flat
        return int((top + nearest // window.shape[1]) * self.width + left + nearest % window.shape[1])

    @property
    def grid(self) -> GridMap:
        """The map of the moment, a copy, with the robot's radius."""
        cells = self._kind.reshape(-1, self.width)[1:-1, 1:-1]
        origin = self._origin
        raw = GridMap(cells, origin.resolution, origin.origin, origin.name)
        return raw.inflated(self._radius, strict=self._strict)

    def problem(self, start: int, goal: int) -> Problem:
        """The problem of the moment between two flat cells, a copy.

        Raises
        ------
        OccupiedError
            One of them is closed now.
        """
        (start_cell, goal_cell), given = self.cells_of(np.array([start, goal])).tolist(), self._problem
        return Problem.from_cells(
            self.grid,
            tuple(start_cell),
            tuple(goal_cell),
            corner_rule=given.corner_rule,
            allow_unknown=given.allow_unknown,
            cost=self.cost,
        )

    @property
    def cost(self) -> CostField | None:
        """The costs of the moment, a copy; None without any."""
        if not self.priced:
            return None
        values = self.prices.cells.reshape(-1, self.width)[1:-1, 1:-1] - 1.0
        return CostField(np.maximum(values, 0.0), slope=self._slope)

    def broken(self, path: NDArray[np.int32]) -> int | None:
        """Number of the first move of a path between cells of the map that is not legal; None where all are."""
        good, _ = region_kernels.legal_ends(path, self.moves, self.width)
        return None if good == len(path) - 1 else int(good)

    def cost_along(self, path: NDArray[np.int32]) -> float:
        """Cost in cells of a path over flat cells, from its start to its end."""
        cost = float(grid_kernels.cost_along(path, self.width, self.prices))
        return cost + self.objective.lift(int(path[0]), int(path[-1]))


def _kept_out(problem: Problem) -> bool:
    """Whether all that is closed as inflated cells are is what the costs keep out."""
    closed = problem.grid.cells == Cell.INFLATED
    return problem.cost is not None and bool((closed <= problem.cost.blocked).all())


def _disc(radius: float, strict: bool) -> NDArray[np.int32]:
    """Rows and columns to the cells that an occupied one closes, shape (m, 2); see `GridMap.inflated`."""
    side = math.ceil(radius + 0.5) if radius else 0
    rows, cols = np.mgrid[-side : side + 1, -side : side + 1]
    if strict:
        away = np.hypot(np.maximum(np.abs(rows) - 0.5, 0), np.maximum(np.abs(cols) - 0.5, 0))
        within = away < radius * (1 - 1e-12)
    else:
        within = np.hypot(rows, cols) <= radius * (1 + 1e-12)
    within |= (rows == 0) & (cols == 0)
    return np.ascontiguousarray(np.argwhere(within) - side, np.int32)  # one layout, one compilation
