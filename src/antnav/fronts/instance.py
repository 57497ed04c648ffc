"""Instance: a problem and its objectives as arrays of whole numbers, the one thing that all methods search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.kernels import front_kernels
from antnav.objectives.objective import Objective, Prices
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import Problem
from antnav.world.terrain import Terrain

#: Largest value of a path in whole steps: longer sums could overflow.
LARGEST = 2**31 - 1


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
        if most * len(graph) > LARGEST * 1000:
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

    def slots(self, nodes: NDArray[np.int32]) -> NDArray[np.int64]:
        """Number of each move of a path."""
        found: NDArray[np.int64] = (self.graph.graph.neighbours[nodes[:-1]] == nodes[1:, None]).argmax(axis=1)
        return found

    def steps(self, nodes: NDArray[np.int32]) -> NDArray[np.int64]:
        """Value of a path in whole steps, shape (k,)."""
        slots = self.slots(nodes)
        total = self.costs[nodes[:-1], slots].sum(axis=0, dtype=np.int64)
        if self.turns.size and len(slots) > 1:
            total = total + self.turns[slots[:-1] + 1, slots[1:]].sum(axis=0, dtype=np.int64)
        found: NDArray[np.int64] = total
        return found

    def values(self, nodes: NDArray[np.int32]) -> NDArray[np.float64]:
        """Value of a path in the objectives' units, shape (k,), added up move by move."""
        slots = self.slots(nodes)
        pairs = np.insert(slots[:-1] + 1, 0, 0) if len(slots) else slots
        moves = [np.cumsum(each.edges[nodes[:-1], slots] + each.turns[pairs, slots]) for each in self.prices]
        return np.array([sums[-1] if len(sums) else 0.0 for sums in moves])
