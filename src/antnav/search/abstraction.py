"""A large map in short: regions and their crossings, worked out once a map and good for any number of queries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import grid_kernels
from antnav.kernels.graph import Graph, slots_along
from antnav.world.cost import CostField
from antnav.world.grid import GridMap
from antnav.world.grid_graph import KEPT, checked_node
from antnav.world.kept import Kept
from antnav.world.moves import CornerRule
from antnav.world.path_cost import PathCost
from antnav.world.terrain import Terrain

if TYPE_CHECKING:
    from antnav.kernels.corridor_kernels import Crossings

#: Side of a block in cells.
BLOCK = 16
#: Crossings from the cheapest route up to which regions count as near: ants choose among ways through these.
REACH = 3


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
    objective : PathCost
        What a move costs.
    crossings : corridor_kernels.Crossings
        Regions, -1 for cells where nobody can move; flat cells that stand for them; the mean price of each region's
        cheapest cells, as many as a block's side, 1 where cost is length; and the crossings between them.
    part : ndarray of int32, shape (regions,)
        Connected component of each region.
    """

    block: int
    moves: NDArray[np.uint8]
    objective: PathCost
    crossings: Crossings
    part: NDArray[np.int32]

    @classmethod
    def of(cls, terrain: Terrain, block: int) -> Abstraction:
        """The abstraction of a terrain, worked out once and kept with its map."""
        return terrain.kept.of(cls, block, lambda: cls._of(terrain.flat_moves, terrain.width, block, terrain.objective))

    @classmethod
    def _of(cls, flat: NDArray[np.uint8], width: int, block: int, objective: PathCost) -> Abstraction:
        from antnav.kernels import corridor_kernels  # milliseconds that an import need not take

        region, centre = grid_kernels.regions(flat, width, block)
        price = _least_prices(objective, region, len(centre), block)
        first, *crossings = grid_kernels.crossings(flat, width, block, region, centre, price, objective.prices.heights)
        short = corridor_kernels.Crossings(width, region, centre, price, first, *crossings)
        return cls(block, flat, objective, short, corridor_kernels.parts(first, short.other))

    def __repr__(self) -> str:
        number = len(self.crossings.other) // 2
        return f"Abstraction({len(self)} regions, {number} crossings, blocks of {self.block} cells)"

    def __len__(self) -> int:
        """Number of regions."""
        return len(self.crossings.centre)

    def between(self, start: int, goal: int, reach: int = REACH) -> RegionGraph | None:
        """The graph for one query, of the regions near a cheapest route between two flat cells.

        Their regions lie where these cells are, not at their centres. None where the map does not connect them.

        Parameters
        ----------
        reach : int
            Crossings from the route at most.
        """
        from antnav.kernels import corridor_kernels

        one, other = self.crossings.region[start], self.crossings.region[goal]
        if one < 0 or other < 0 or self.part[one] != self.part[other]:
            return None
        heights = self.objective.prices.heights
        owner, flat, crossing, first, last, *table = corridor_kernels.corridor(
            self.crossings, heights, start, goal, reach
        )
        rows, cols = np.divmod(flat, self.crossings.width)
        cells = np.stack((rows - 1, cols - 1), axis=-1)
        return RegionGraph(Graph(*table), cells, first, last, owner, crossing)

    def on_map(self, values: NDArray[np.float32], owner: NDArray[np.int32]) -> NDArray[np.float32]:
        """The values of nodes that belong to some regions at the cells of these, shape (rows, cols), nan elsewhere."""
        of_region = np.full(len(self) + 1, np.nan, np.float32)
        of_region[owner[::-1]] = values[::-1]  # of a chain, its first node's
        field: NDArray[np.float32] = of_region[self.crossings.region].reshape(-1, self.crossings.width)[1:-1, 1:-1]
        return field

    def stops(self, route: NDArray[np.int32], graph: RegionGraph, start: int, goal: int) -> NDArray[np.int32]:
        """The cells at which a route enters and leaves each of its regions: start, ..., goal, flat.

        Parameters
        ----------
        route : ndarray of int32
            A path over the nodes of `graph`.
        graph : RegionGraph
            As `between` gives it.
        """
        slots = slots_along(graph.graph, route)
        crossings = graph.crossing[route[:-1], slots]
        crossings = crossings[crossings >= 0]  # edges inside a region cross nothing
        stops = np.empty(2 * len(crossings) + 2, np.int32)
        stops[0], stops[-1] = start, goal
        stops[1:-1:2], stops[2:-1:2] = self.crossings.leave[crossings], self.crossings.enter[crossings]
        return stops


@dataclass(frozen=True, eq=False)
class RegionGraph:
    """The graph of regions for one query. A region with many neighbours is a chain of several nodes."""

    graph: Graph
    cells: NDArray[np.int64]  #: (n, 2) row and column of the cell that stands for each node
    start: int  #: node
    goal: int  #: node
    owner: NDArray[np.int32]  #: (n,) region of each node
    crossing: NDArray[np.int32]  #: (n, 8) crossing of each edge, -1 for none
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
