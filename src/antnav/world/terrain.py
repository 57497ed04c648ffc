"""Terrain: where a robot may go on a map, and what planners need to know of the whole of it, worked out once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.kernels import grid_kernels
from antnav.values import read_only
from antnav.world.grid import Cell, GridMap
from antnav.world.grid_graph import GridGraph
from antnav.world.kept import Choice, KeptByKind, PricedChoice
from antnav.world.moves import CornerRule, legal_moves
from antnav.world.path_cost import LENGTH, PathCost

if TYPE_CHECKING:
    from antnav.kernels.jump_kernels import Jumps


@dataclass(frozen=True, eq=False)
class Terrain:
    """A map as a robot sees it: which cells are open to it, and which moves between them are legal.

    `Terrain.of` gives the one terrain of a map for these choices; `Problem.terrain` is the same. What it works out is
    kept with the map, shared by all queries, and in no copy or pickle of it.

    Parameters
    ----------
    grid : GridMap
    corner_rule : CornerRule or str
        When a diagonal move may pass obstacles: "forbid" (default), "graze" or "allow" (the paper's).
    allow_unknown : bool
        Whether the robot may cross unknown cells.
    objective : PathCost
        What a move costs; default: its length.

    Raises
    ------
    ParameterError
        No `GridMap`, an unknown corner rule, an `allow_unknown` that is neither true nor false.
    """

    grid: GridMap
    corner_rule: CornerRule = CornerRule.FORBID
    allow_unknown: bool = False
    objective: PathCost = LENGTH

    def __post_init__(self) -> None:
        check_type("map", self.grid, GridMap, "make one with GridMap(array), or load one with load_map")
        object.__setattr__(self, "corner_rule", CornerRule.of(self.corner_rule))
        unknown: Any = self.allow_unknown
        if not isinstance(unknown, bool | np.bool_):
            raise ParameterError(f"allow_unknown {shown(unknown)}", "it is true or false", "give one of them")
        object.__setattr__(self, "allow_unknown", bool(unknown))
        check_type("objective", self.objective, PathCost, "leave it out, or give PathCost(field)")
        object.__setattr__(self, "objective", self.objective.on(self.grid))

    @classmethod
    def of(
        cls,
        grid: GridMap,
        corner_rule: CornerRule | str = CornerRule.FORBID,
        allow_unknown: bool = False,
        objective: PathCost = LENGTH,
    ) -> Terrain:
        """The one terrain of a map for these choices."""
        check_type("objective", objective, PathCost, "leave it out, or give PathCost(field)")
        check_type("map", grid, GridMap, "make one with GridMap(array), or load one with load_map")
        kept = LENGTH if objective.plain else grid.kept.objectives.of(objective.key, lambda: objective.on(grid))
        terrain = cls(grid, CornerRule.of(corner_rule), allow_unknown, kept)
        return grid.kept.terrains.of(terrain._priced, lambda: terrain)

    def __reduce__(self) -> tuple[Any, ...]:
        return Terrain.of, (self.grid, self.corner_rule, self.allow_unknown, self.objective)

    @property
    def _choice(self) -> Choice:
        return self.corner_rule, self.allow_unknown

    @property
    def _priced(self) -> PricedChoice:
        return self._choice, self.objective.key

    @property
    def kept(self) -> KeptByKind:
        """What rooms above have worked out from this terrain, such as `search.abstraction`."""
        return self.grid.kept.by_terrain.of(self._priced, KeptByKind)

    def is_open(self, cell: tuple[int, int]) -> bool:
        """Whether the robot may stand on a cell of the map."""
        kind = self.grid.cells[self.grid.checked_cell(cell)]
        return bool(kind == Cell.FREE or (self.allow_unknown and kind == Cell.UNKNOWN))

    @property
    def passable(self) -> NDArray[np.bool_]:
        """Cells that the robot may enter, shape (rows, cols). Read-only."""
        grid, unknown = self.grid, self.allow_unknown
        return grid.kept.passable.of(unknown, lambda: read_only(grid.passable(unknown=unknown)))

    @property
    def moves(self) -> NDArray[np.uint8]:
        """Legal moves as bits on the padded map, shape (rows + 2, cols + 2); see `moves.legal_moves`. Read-only."""
        return read_only(self._moves.view())

    @property
    def flat_moves(self) -> NDArray[np.uint8]:
        """The same flat, for kernels: writeable, because Numba compiles one anew for read-only arrays."""
        return self._moves.ravel()

    @property
    def _moves(self) -> NDArray[np.uint8]:
        return self.grid.kept.moves.of(self._choice, lambda: legal_moves(self.passable, self.corner_rule))

    @property
    def jumps(self) -> Jumps:
        """Where the jumps of jump point search end, for kernels."""
        from antnav.kernels.jump_kernels import Jumps  # milliseconds that an import need not take
        from antnav.world.jumps import jump_ends, onward

        ends = self.grid.kept.jump_ends.of(self._choice, lambda: jump_ends(self._moves, self.corner_rule))
        return Jumps(ends, -(-self.width // 64), -(-(self.grid.rows + 2) // 64), onward(self.corner_rule))

    @property
    def width(self) -> int:
        """Columns of the padded map."""
        return self.grid.cols + 2

    def to_flat(self, cell: tuple[int, int]) -> int:
        """Index of a cell of the map in the flattened padded map."""
        row, col = self.grid.checked_cell(cell)
        return (row + 1) * self.width + col + 1

    def from_flat(self, flat: ArrayLike) -> NDArray[np.int64]:
        """(row, col) of flat indices, shape (..., 2)."""
        try:
            flat = np.asarray(flat, np.int64)
        except (TypeError, ValueError, OverflowError) as error:
            raise ParameterError(f"index {shown(flat)}", "flat indices are whole numbers", "give them") from error
        return np.stack((flat // self.width - 1, flat % self.width - 1), axis=-1)

    def cost_along(self, flat: NDArray[Any]) -> float:
        """Cost in cells of a path over flat cells of the padded map."""
        quick = isinstance(flat, np.ndarray) and flat.dtype == np.int32 and flat.ndim == 1 and flat.flags.writeable
        if quick and self.objective.plain:
            length = float(grid_kernels.length_inside(flat, self.width, self.grid.rows))
            if not math.isnan(length):
                return length
        cells = self.from_flat(flat)
        if cells.ndim != 2 or not ((cells >= 0) & (cells < self.grid.shape)).all():
            raise ParameterError(f"path {shown(flat)}", "it is a row of flat cells of the map", "give such indices")
        return self.objective.of(cells.astype(np.int32), self.grid)

    @property
    def components(self) -> NDArray[np.int32]:
        """Connected component of each cell of the padded map, flat: 1, 2, ..., 0 where nobody can move. Read-only."""
        return self.grid.kept.components.of(
            self._choice, lambda: read_only(grid_kernels.components(self.flat_moves, self.width))
        )

    def joins(self, one: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether a path leads from one cell to another."""
        start, end = self.to_flat(one), self.to_flat(other)
        return start == end or bool(self.components[start] == self.components[end] > 0)

    def reached(self, start: tuple[int, int]) -> NDArray[np.bool_]:
        """Cells that can be reached from a cell, itself among them, shape (rows, cols)."""
        return self._reached(self.to_flat(start)).reshape(-1, self.width)[1:-1, 1:-1]

    def _reached(self, start: int) -> NDArray[np.bool_]:
        seen: NDArray[np.bool_] = (self.components == self.components[start]) & (self.components > 0)
        seen[start] = True
        return seen

    def graph(self, start: tuple[int, int]) -> GridGraph:
        """The graph of all cells that can be reached from an open cell: one, and one numbering, for all of them.

        Raises
        ------
        ParameterError
            The cell lies outside the map or is not open to the robot.
        """
        flat = self.to_flat(start)
        component = int(self.components[flat]) or -flat  # a cell without a move is a graph of its own
        if component < 0 and not self.is_open(start):
            raise ParameterError(f"cell {shown(start)}", "the robot may not stand there", "choose a free cell")
        return self.grid.kept.graphs.of((self._priced, component), lambda: self._graph(flat))

    def _graph(self, start: int) -> GridGraph:
        seen = self._reached(start)
        return GridGraph.of(self.flat_moves, self.width, seen.view(np.uint8), int(seen.sum()), self.objective)
