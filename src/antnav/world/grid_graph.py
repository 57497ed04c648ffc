"""GridGraph: cells of a map as the nodes of a graph that ants walk on."""

from __future__ import annotations

from collections.abc import Sized
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import grid_kernels
from antnav.kernels.graph import Graph
from antnav.values import read_only
from antnav.world.grid import whole_pair
from antnav.world.kept import Kept
from antnav.world.path_cost import LENGTH, PathCost

#: Distance fields that a graph keeps: start and goal, and a few more.
KEPT = 4


@dataclass(frozen=True, eq=False)
class GridGraph:
    """A `Graph` whose nodes are cells of a map, in map order."""

    graph: Graph
    flat: NDArray[np.int32]  #: (n,) index of each node in the flattened padded map
    cells: NDArray[np.int64]  #: (n, 2) row and column of each node
    moves: NDArray[np.uint8]  #: the padded map of legal moves, flat
    width: int  #: columns of the padded map
    objective: PathCost = LENGTH  #: what the edges cost
    distances: Kept[int, NDArray[np.float64]] = field(default_factory=lambda: Kept(KEPT), repr=False)  #: by node
    _turned: Kept[None, GridGraph] = field(default_factory=lambda: Kept(1), repr=False)

    @classmethod
    def of(
        cls, moves: NDArray[np.uint8], width: int, seen: NDArray[np.uint8], count: int, objective: PathCost = LENGTH
    ) -> Self:
        """The graph of the `count` cells whose flag in `seen` is set; both arrays flat and padded."""
        flat, *table = grid_kernels.neighbour_table(moves, width, seen, count)
        cells = np.stack((flat // width - 1, flat % width - 1), axis=-1).astype(np.int64)
        graph = Graph(*table)
        graph = graph._replace(lengths=objective.edges(graph, flat))
        return cls(graph, read_only(flat), read_only(cells), moves, width, objective)

    @property
    def dear(self) -> bool:
        """Whether moves have prices beside their lengths."""
        return self.objective.field is not None

    @property
    def turning(self) -> float:
        """Cost in cells of a turn by one radian."""
        return self.objective.turning

    def __len__(self) -> int:
        return len(self.flat)

    def node(self, cell: tuple[int, int]) -> int:
        """Node of a cell that is in the graph, or a `ParameterError`."""
        row, col = whole_pair("cell", cell)
        flat = (row + 1) * self.width + col + 1
        if not (0 <= col < self.width - 2 and flat in self):
            raise ParameterError(f"cell {(row, col)}", "it is none of the graph's", "choose one of graph.cells")
        return int(np.searchsorted(self.flat, flat))

    def part(self, inside: NDArray[np.bool_], node: int) -> GridGraph:
        """The graph of what can be reached from a node over nodes that are `inside`, shape (n,)."""
        moves = self.moves.copy()
        moves[self.flat[~inside]] = 0
        seen, _ = grid_kernels.flood(moves, self.width, int(self.flat[node]))
        seen[self.flat[~inside]] = 0
        return GridGraph.of(moves, self.width, seen, int(seen.sum()), self.objective)

    @property
    def backwards(self) -> GridGraph:
        """The same nodes, for walks against the way: each edge costs what its way back does."""
        return self if self.objective.backwards is self.objective else self._turned.of(None, self._backwards)

    def _backwards(self) -> GridGraph:
        objective, lengths = self.objective.backwards, self.graph.lengths
        padded = np.append(lengths, lengths[:1], axis=0)  # of the node that stands for none
        turned = self.graph._replace(lengths=padded[self.graph.neighbours, self.graph.reverse])
        return replace(self, graph=turned, objective=objective, distances=Kept(KEPT), _turned=Kept(1))

    def __contains__(self, flat: int) -> bool:
        """Whether a flat cell is one of the nodes."""
        return bool(self.flat[min(int(np.searchsorted(self.flat, flat)), len(self) - 1)] == flat)

    def on_map(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """The nodes' values at their cells, shape (rows, cols), nan elsewhere."""
        field = np.full((len(self.moves) // self.width - 2, self.width - 2), np.nan, np.float32)
        field[tuple(self.cells.T)] = values
        return field

    def distances_to(self, node: int) -> NDArray[np.float64]:
        """Exact distance, or cost of the way, from every node to `node`, shape (n,). The latest few are kept."""
        node = checked_node(node, self)
        return self.distances.of(node, lambda: self._distances_to(node))

    def _distances_to(self, node: int) -> NDArray[np.float64]:
        source = int(self.flat[node])
        length, _, _ = grid_kernels.search(self.moves, self.width, source, -1, False, self.objective.prices)
        distances: NDArray[np.float64] = self.objective.towards(source, length)[self.flat]
        return read_only(distances)


def checked_node(node: int, graph: Sized) -> int:
    """A node of a graph, or a `ParameterError`."""
    if isinstance(node, bool) or not isinstance(node, int | np.integer) or not 0 <= node < len(graph):
        raise ParameterError(f"node {shown(node)}", f"nodes are 0..{len(graph) - 1}", "choose one of them")
    return int(node)
