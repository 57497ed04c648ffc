"""A large map in short: regions and their crossings, worked out once a map and good for any number of queries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import grid_kernels
from antnav.kernels.graph import Graph, slots_along
from antnav.world.cost import CostField
from antnav.world.grid import GridMap
from antnav.world.grid_graph import KEPT, checked_node
from antnav.world.kept import Kept
from antnav.world.moves import CornerRule, octile
from antnav.world.path_cost import PathCost
from antnav.world.terrain import Terrain

#: Side of a block in cells.
BLOCK = 16


@dataclass(frozen=True, eq=False, repr=False)
class Abstraction:
    """The graph of a map's regions: connected components of free cells inside square blocks.

    Two cells are connected on the map exactly where their regions are connected in the graph. Lengths between regions
    are octile lengths through the best crossing, so they guide, and say nothing exact.

    Attributes
    ----------
    block : int
        Side of a block in cells.
    moves : ndarray of uint8, flat
        Legal moves on the padded map; see `moves.legal_moves`.
    width : int
        Columns of the padded map.
    objective : PathCost
        What a move costs.
    region : ndarray of int32, flat
        Region of each cell of the padded map, -1 where nobody can move.
    centre : ndarray of int32, shape (regions,)
        Flat cell that stands for each region.
    price : ndarray of float64, shape (regions,)
        Mean price of each region's cheapest cells, as many as a block's side; 1 where cost is length.
    first, other, leave, enter, length
        Crossings, region by region; see `grid_kernels.crossings`.
    owner, node, slot
        How regions and crossings lie in `graph`; see `grid_kernels.region_table`.
    crossing : ndarray of int32, shape (n, 8)
        Crossing of each edge of `graph`, -1 for none.
    graph : Graph
    """

    block: int
    moves: NDArray[np.uint8]
    width: int
    objective: PathCost
    region: NDArray[np.int32]
    centre: NDArray[np.int32]
    price: NDArray[np.float64]
    first: NDArray[np.int32]
    other: NDArray[np.int32]
    leave: NDArray[np.int32]
    enter: NDArray[np.int32]
    length: NDArray[np.float64]
    owner: NDArray[np.int32]
    node: NDArray[np.int32]
    slot: NDArray[np.uint8]
    crossing: NDArray[np.int32]
    graph: Graph

    @classmethod
    def of(cls, terrain: Terrain, block: int) -> Abstraction:
        """The abstraction of a terrain, worked out once and kept with its map."""
        return terrain.kept.of(cls, block, lambda: cls._of(terrain.flat_moves, terrain.width, block, terrain.objective))

    @classmethod
    def _of(cls, flat: NDArray[np.uint8], width: int, block: int, objective: PathCost) -> Abstraction:
        region, centre = grid_kernels.regions(flat, width, block)
        price = _least_prices(objective, region, len(centre), block)
        first, other, leave, enter, length = grid_kernels.crossings(
            flat, width, block, region, centre, price, objective.prices.heights
        )
        owner, node, slot, *table = grid_kernels.region_table(first, other, length)
        crossings = (first, other, leave, enter, length)
        crossing = np.full((len(owner), 8), -1, np.int32)
        crossing[node, slot] = np.arange(len(node))
        table = Graph(*table)
        return cls(block, flat, width, objective, region, centre, price, *crossings, owner, node, slot, crossing, table)

    def __repr__(self) -> str:
        return f"Abstraction({len(self)} regions, {len(self.other) // 2} crossings, blocks of {self.block} cells)"

    def __len__(self) -> int:
        """Number of regions."""
        return len(self.centre)

    def between(self, start: int, goal: int) -> RegionGraph | None:
        """The graph for one query: the regions of two flat cells lie where these cells are, not at their centres.

        None where the map does not connect the cells.
        """
        if self.region[start] < 0 or self.region[goal] < 0:
            return None
        lengths = self.graph.lengths.copy()
        ends = {}
        for cell in (start, goal):
            here = int(self.region[cell])
            ends[here] = cell
            crossings = slice(self.first[here], self.first[here + 1])
            there = np.array([ends.get(int(region), self.centre[region]) for region in self.other[crossings]], np.int32)
            here_price, there_price = self.price[here], self.price[self.other[crossings]]
            lengths[self.node[crossings], self.slot[crossings]] = (
                self._apart(self.leave[crossings], cell) * here_price
                + self._apart(self.leave[crossings], self.enter[crossings]) * (0.5 * (here_price + there_price))
                + self._apart(self.enter[crossings], there) * there_price
                + self._climb(cell, self.leave[crossings], self.enter[crossings], there)
            )
            self._mirror(lengths, crossings)
        flat = self.centre[self.owner]
        for region, cell in ends.items():
            flat[self.owner == region] = cell
        cells = np.stack((flat // self.width - 1, flat % self.width - 1), axis=-1).astype(np.int64)
        nodes = tuple(int(np.searchsorted(self.owner, self.region[cell])) for cell in (start, goal))
        graph = RegionGraph(self.graph._replace(lengths=lengths), cells, nodes[0], nodes[1])
        return graph if graph.distances_to(graph.goal)[graph.start] < np.inf else None

    def _mirror(self, lengths: NDArray[np.float64], crossings: slice) -> None:
        """Give the way back the length of the way there."""
        node, slot = self.node[crossings], self.slot[crossings]
        lengths[self.graph.neighbours[node, slot], self.graph.reverse[node, slot]] = lengths[node, slot]

    def _apart(self, one: Any, other: Any) -> NDArray[np.float64]:
        """Octile distance between flat cells."""
        return octile(one // self.width - other // self.width, one % self.width - other % self.width)

    def _climb(self, *way: Any) -> Any:
        """Sum of the differences in `Prices.heights` from flat cell to flat cell."""
        heights = self.objective.prices.heights
        return sum(np.abs(heights[one] - heights[other]) for one, other in pairwise(way)) if len(heights) else 0.0

    def on_map(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """The values of the graph's nodes at the cells of their regions, shape (rows, cols), nan elsewhere."""
        of_region = np.full(len(self) + 1, np.nan, np.float32)
        of_region[self.owner[::-1]] = values[::-1]  # of a chain, its first node's
        return of_region[self.region].reshape(-1, self.width)[1:-1, 1:-1]

    def stops(self, nodes: NDArray[np.int32], start: int, goal: int) -> NDArray[np.int32]:
        """The cells at which a route enters and leaves each of its regions: start, ..., goal, flat.

        Parameters
        ----------
        nodes : ndarray of int32
            A path over the nodes of `graph`.
        """
        slots = slots_along(self.graph, nodes)
        crossings = self.crossing[nodes[:-1], slots]
        crossings = crossings[crossings >= 0]  # edges inside a region cross nothing
        between = np.stack((self.leave[crossings], self.enter[crossings]), axis=1).ravel()
        return np.concatenate(([start], between, [goal])).astype(np.int32)


@dataclass(frozen=True, eq=False)
class RegionGraph:
    """The graph of regions for one query. A region with many neighbours is a chain of several nodes."""

    graph: Graph
    cells: NDArray[np.int64]  #: (n, 2) row and column of the cell that stands for each node
    start: int  #: node
    goal: int  #: node
    distances: Kept[int, NDArray[np.float64]] = field(default_factory=lambda: Kept(KEPT), repr=False)  #: by node

    def __len__(self) -> int:
        return len(self.cells)

    @property
    def turning(self) -> float:
        """Turns between regions say nothing of those on cells."""
        return 0.0

    @property
    def dear(self) -> bool:
        """Moves between regions have lengths only, however those were worked out."""
        return False

    def lengths_of(self, paths: Sequence[NDArray[np.int32]]) -> NDArray[np.float64]:
        """Length of each of some paths over nodes."""
        lengths = self.graph.lengths
        return np.array([lengths[path[:-1], slots_along(self.graph, path)].sum() for path in paths])

    def distances_to(self, node: int) -> NDArray[np.float64]:
        """Length of a shortest path in this graph from every node to `node`, shape (n,)."""
        node, (neighbours, lengths, _) = checked_node(node, self), self.graph
        return self.distances.of(node, lambda: grid_kernels.distances(neighbours, lengths, node))


def _least_prices(objective: PathCost, region: NDArray[np.int32], count: int, block: int) -> NDArray[np.float64]:
    """Mean price of each region's cheapest cells, about as many as a path across it has [ours].

    With the mean of all, routes go round regions that a cheap corridor leads through.
    """
    if objective.field is None:
        return np.ones(count)
    cells = np.flatnonzero(region >= 0)
    cells = cells[np.lexsort((objective.prices.cells[cells], region[cells]))]
    first = np.searchsorted(region[cells], np.arange(count))
    cells = cells[np.arange(len(cells)) - first[region[cells]] < block]
    total = np.bincount(region[cells], objective.prices.cells[cells], count)
    return total / np.bincount(region[cells], minlength=count)


def prepare(
    grid: GridMap,
    corner_rule: CornerRule | str = CornerRule.FORBID,
    *,
    allow_unknown: bool = False,
    block: int = BLOCK,
    cost: CostField | None = None,
    turning: float = 0.0,
) -> Abstraction:
    """Work out a map's abstraction, for algorithms with `coarse` such as `paco_large`. It is kept with the map.

    `solve` does the same at the first query on a map; call this to have it done before.

    Parameters
    ----------
    grid : GridMap
    corner_rule, allow_unknown, cost, turning
        As in the problems to come.
    block : int
        Side of a block in cells, 4 to 128; the algorithm's `coarse`.
    """
    terrain = Terrain.of(grid, corner_rule, allow_unknown, PathCost(cost, turning))
    if isinstance(block, bool) or not isinstance(block, int) or not 4 <= block <= 128:
        raise ParameterError(f"block {shown(block)}", "a block has 4 to 128 cells a side", "give one, such as 16")
    if terrain.objective.plain:
        _ = terrain.jumps
    return Abstraction.of(terrain, block)
