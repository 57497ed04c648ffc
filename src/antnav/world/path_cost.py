"""PathCost: what a path costs, the one notion that every search and every figure asks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.errors import check_type
from antnav.kernels.graph import SQRT2, Graph
from antnav.kernels.grid_kernels import Prices
from antnav.world.cost import CostField, Slope, check_weight
from antnav.world.grid import GridMap
from antnav.world.moves import SLOT_ANGLES

#: Number of the move by its step, shape (3, 3).
_SLOTS = np.array([[0, 1, 2], [3, -1, 4], [5, 6, 7]])
#: Prices of a map on which every cell costs the same: none, so that lengths stay counts of moves.
FREE = Prices(np.empty(0), 1.0, np.empty(0))


@dataclass(frozen=True, eq=False)
class PathCost:
    """What a move costs: its length in cells times 1 + the mean of the fields of its two cells, and its climb.

    ::

        cost(a -> b) = |a - b| * (1 + (field(a) + field(b)) / 2) + up max(0, h_b - h_a) + down max(0, h_a - h_b)

    with heights h in cells, and each turn its angle in radians times `turning`. Without any of them, that is the
    length, kept as exact counts of straight and diagonal moves.

    Parameters
    ----------
    field : CostField or None
    turning : float
        Cost in cells of a turn by one radian, 0 to 1e9: what each change of direction adds.
    resolution : float
        Metres of a cell, for heights; `on` takes the map's.

    Notes
    -----
    The climb is symmetric but for a potential::

        up max(0, d) + down max(0, -d) = (up + down) / 2 |d| + (up - down) / 2 d

    and the last term adds up to the same on every path between two cells. So searches price moves alike either way
    (`prices`), and `towards` puts the rest on what they say of a whole way.
    """

    field: CostField | None = None
    turning: float = 0.0
    resolution: float = 1.0

    def __post_init__(self) -> None:
        check_type("cost", self.field, CostField | None, "make one with antnav.costs")
        object.__setattr__(self, "turning", check_weight("turning", self.turning))

    def on(self, grid: GridMap) -> PathCost:
        """The same on a map, whose cells have a size; a `ParameterError` where the field is not of its shape."""
        if self.field is not None:
            self.field.check_fits(grid)
        if self._slope is None or self.resolution == grid.resolution:
            return self
        return replace(self, resolution=grid.resolution)

    @property
    def backwards(self) -> PathCost:
        """What the same moves cost the other way: itself where that is the same."""
        field, slope = self.field, self._slope
        if field is None or slope is None or slope.up == slope.down:
            return self
        return replace(self, field=replace(field, slope=replace(slope, up=slope.down, down=slope.up)))

    @property
    def _slope(self) -> Slope | None:
        return None if self.field is None else self.field.slope

    def _heights(self, factor: float) -> NDArray[np.float64]:
        """Heights above the lowest cell of the padded map, flat, in cells times a factor."""
        assert self._slope is not None
        elevation = self._slope.elevation
        heights: NDArray[np.float64] = np.pad((elevation - elevation.min()) * (factor / self.resolution), 1).ravel()
        return heights

    @property
    def plain(self) -> bool:
        """Whether cost is length."""
        return self.field is None and self.turning == 0

    @property
    def key(self) -> str:
        """What tells objectives of one map apart."""
        return "" if self.plain else f"{self.field.digest if self.field else ''} {self.turning!r}"

    @cached_property
    def prices(self) -> Prices:
        """What kernels are told. Cost is at least the least price times length, which guides exact search."""
        if self.field is None:
            return FREE
        cells = np.pad(1.0 + self.field.values, 1, constant_values=1.0).ravel()
        slope = self._slope
        heights = FREE.heights if slope is None else self._heights((slope.up + slope.down) / 2)
        return Prices(cells, 1.0 + float(self.field.values.min()), heights)

    def towards(self, source: int, costs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cost of the way from every cell of the padded map to one, all flat, of what a search from there says."""
        potential = self._potential
        if potential is None:
            return costs
        directed: NDArray[np.float64] = costs + (potential[source] - potential)
        return directed

    def lift(self, start: int, goal: int) -> float:
        """What `towards` puts on the cost of a way from one cell of the padded map to another, flat."""
        return 0.0 if self._potential is None else float(self._potential[goal] - self._potential[start])

    @cached_property
    def _potential(self) -> NDArray[np.float64] | None:
        slope = self._slope
        return None if slope is None or slope.up == slope.down else self._heights((slope.up - slope.down) / 2)

    def edges(self, graph: Graph, flat: NDArray[np.int32]) -> NDArray[np.float64]:
        """Cost of each edge of a graph whose nodes are these flat cells, shape (n, 8), as kernels take it."""
        if self.field is None:
            return graph.lengths
        price = np.append(self.prices.cells[flat], 0.0)  # the node that stands for none
        costs: NDArray[np.float64] = graph.lengths * (0.5 * (price[:-1, None] + price[graph.neighbours]))
        if self._slope is not None:
            height = np.append(self._heights(1.0)[flat], 0.0)
            costs += self._slope.climb(height[graph.neighbours] - height[:-1, None])
        return costs

    def turns(self) -> NDArray[np.float64] | None:
        """Cost of each pair of moves, shape (9, 8): by the last move + 1, 0 before the first, and the next one.

        None where turns cost nothing.
        """
        if self.turning == 0:
            return None
        return np.concatenate((np.zeros((1, 8)), self.turning * SLOT_ANGLES))

    def of(self, cells: NDArray[np.int32], grid: GridMap) -> float:
        """Cost in cells of a sequence of neighbouring cells, shape (k, 2), move by move from the start."""
        steps = np.diff(cells, axis=0)
        diagonal = np.all(steps != 0, axis=1)
        if self.field is None or len(cells) < 2:
            cost = max(0, len(cells) - 1 - int(diagonal.sum())) + SQRT2 * int(diagonal.sum())
        else:
            price = self.prices.cells.reshape(grid.rows + 2, -1)[cells[:, 0] + 1, cells[:, 1] + 1]
            costs = np.where(diagonal, SQRT2, 1.0) * (0.5 * (price[:-1] + price[1:]))
            if self._slope is not None:
                costs += self._slope.climb(np.diff(self._slope.elevation[tuple(cells.T)]) / self.resolution)
            cost = float(np.cumsum(costs)[-1])
        if self.turning == 0 or len(steps) < 2:
            return cost
        slots = _SLOTS[steps[:, 0] + 1, steps[:, 1] + 1]
        return cost + self.turning * float(np.cumsum(SLOT_ANGLES[slots[:-1], slots[1:]])[-1])


#: Cost is length.
LENGTH = PathCost()
