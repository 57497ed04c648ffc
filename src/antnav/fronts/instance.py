"""Instance: a problem and its objectives as arrays of whole numbers, the one thing that all methods search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.kernels import front_kernels
from antnav.objectives.objective import Objective, Prices
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import Problem
from antnav.world.terrain import Terrain

#: Whole steps that all cells of a map may cost together, each at the dearest move: sums stay far below 64 bits.
LARGEST = 2**41


@dataclass(frozen=True, eq=False)
class Instance:
    """A multi-objective shortest path problem on a graph; prices are whole steps of each objective.

    Attributes
    ----------
    graph : GridGraph
        Cells that can be reached from the start.
    costs : ndarray of int32, shape (n, 8, k)
        Price of each move.
    turns : ndarray of int32, shape (9, 8, k), or (0, 8, k)
        What a move costs more, by the last move + 1; empty where no objective looks at turns.
    start, goal : int
        Nodes; goal is -1 where it cannot be reached.
    prices : tuple of Prices
        The same before rounding, one for each objective.
    """

    graph: GridGraph
    costs: NDArray[np.int32]
    turns: NDArray[np.int32]
    start: int
    goal: int
    prices: tuple[Prices, ...]

    @classmethod
    def of(cls, problem: Problem, objectives: Sequence[Objective]) -> Instance:
        """Ask each objective for its prices.

        Raises
        ------
        ParameterError
            A price that is none, or a map on which sums could overflow.
        """
        terrain = Terrain.of(problem.grid, problem.corner_rule, problem.allow_unknown)
        graph = terrain.graph(problem.start_cell)
        prices = tuple(Prices.of(objective, terrain, graph) for objective in objectives)
        costs = np.stack([np.rint(each.edges / each.step) for each in prices], axis=-1).astype(np.int32)
        turns = np.stack([np.rint(each.turns / each.step) for each in prices], axis=-1).astype(np.int32)
        most = int(costs.max(initial=0)) + int(turns.max(initial=0))
        if most * len(graph) > LARGEST:
            rule = f"{len(graph)} cells of up to {most} steps could overflow"
            raise ParameterError(f"a map of {problem.grid.rows} x {problem.grid.cols} cells", rule, "crop the map")
        start, goal = graph.node(problem.start_cell), graph.node(problem.goal_cell) if problem.connected else -1
        return cls(graph, costs, turns if turns.any() else turns[:0], start, goal, prices)

    @property
    def k(self) -> int:
        """Number of objectives."""
        return len(self.prices)

    @property
    def arrays(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
        """Neighbours, costs and turns, as kernels take them."""
        return self.graph.graph.neighbours, self.costs, self.turns

    @cached_property
    def ideal(self) -> NDArray[np.int64]:
        """Least steps to the goal from each node in each objective by itself, without turns, shape (n, k)."""
        found: NDArray[np.int64] = front_kernels.ideal(self.graph.graph.neighbours, self.costs, self.goal)
        return found

    def steps(self, paths: Sequence[NDArray[np.int32]]) -> NDArray[np.int64]:
        """Values of paths, given as nodes, in whole steps, shape (p, k)."""
        turns = self.turns if self.turns.size else np.zeros((9, 8, self.k), np.int32)
        return self._totals(self.costs, turns, paths, np.zeros((len(paths), self.k), np.int64))

    def values(self, paths: Sequence[NDArray[np.int32]]) -> NDArray[np.float64]:
        """Values of paths in the objectives' units, shape (p, k), added up move by move."""
        edges, turns = (np.stack([getattr(each, name) for each in self.prices], axis=-1) for name in ("edges", "turns"))
        return self._totals(edges, turns, paths, np.zeros((len(paths), self.k)))

    def _totals(
        self,
        edges: NDArray[Any],
        turns: NDArray[Any],
        paths: Sequence[NDArray[np.int32]],
        sums: NDArray[Any],
    ) -> NDArray[Any]:
        lengths = np.array([len(path) for path in paths], np.int32)
        nodes = np.concatenate([np.empty(0, np.int32), *paths])
        front_kernels.totals(self.graph.graph.neighbours, edges, turns, lengths, nodes, sums)
        return sums
