"""Objective: what a path costs, the one notion that every search and every figure asks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.errors import check_type
from antnav.kernels.graph import SQRT2, Graph
from antnav.world.cost import CostField
from antnav.world.grid import GridMap

#: Prices of a map on which every cell costs the same: none, so that lengths stay counts of moves.
FREE = np.empty(0)


@dataclass(frozen=True, eq=False)
class Objective:
    """What a move costs: its length in cells times 1 + the mean of the fields of its two cells.

    ::

        cost(a -> b) = |a - b| * (1 + (field(a) + field(b)) / 2)

    Without a field that is the length, kept as exact counts of straight and diagonal moves.

    Parameters
    ----------
    field : CostField or None
    """

    field: CostField | None = None

    def __post_init__(self) -> None:
        check_type("cost", self.field, CostField | None, "make one with antnav.costs")

    @property
    def plain(self) -> bool:
        """Whether cost is length."""
        return self.field is None

    @property
    def key(self) -> str:
        """What tells objectives of one map apart."""
        return "" if self.field is None else self.field.digest

    @cached_property
    def prices(self) -> NDArray[np.float64]:
        """Cost of a cell's way through each cell of the padded map, flat, >= 1; empty where cost is length."""
        return FREE if self.field is None else np.pad(1.0 + self.field.values, 1, constant_values=1.0).ravel()

    @cached_property
    def cheapest(self) -> float:
        """The least price of a cell: cost is at least this times length, which guides exact search."""
        return 1.0 if self.field is None else 1.0 + float(self.field.values.min())

    def edges(self, graph: Graph, flat: NDArray[np.int32]) -> NDArray[np.float64]:
        """Cost of each edge of a graph whose nodes are these flat cells, shape (n, 8), as kernels take it."""
        if self.plain:
            return graph.lengths
        price = np.append(self.prices[flat], 0.0)  # the node that stands for none
        costs: NDArray[np.float64] = graph.lengths * (0.5 * (price[:-1, None] + price[graph.neighbours]))
        return costs

    def of(self, cells: NDArray[np.int32], grid: GridMap) -> float:
        """Cost in cells of a sequence of neighbouring cells, shape (k, 2), move by move from the start."""
        diagonal = np.all(np.diff(cells, axis=0) != 0, axis=1)
        if self.plain or len(cells) < 2:
            return max(0, len(cells) - 1 - int(diagonal.sum())) + SQRT2 * int(diagonal.sum())
        price = self.prices.reshape(grid.rows + 2, -1)[cells[:, 0] + 1, cells[:, 1] + 1]
        return float(np.cumsum(np.where(diagonal, SQRT2, 1.0) * (0.5 * (price[:-1] + price[1:])))[-1])


#: Cost is length.
LENGTH = Objective()
