"""The graph that ants walk on: a padded neighbour table. A grid is one graph; a coarse map may be another."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

#: Length in cells of a diagonal move.
SQRT2 = 2.0**0.5


class Graph(NamedTuple):
    """An undirected graph whose n nodes have at most 8 neighbours each.

    Arrays stay writeable, because Numba compiles a kernel anew for read-only ones; nobody writes to them.
    """

    neighbours: NDArray[np.int32]  #: (n, 8), n where there is none
    lengths: NDArray[np.float64]  #: (n, 8), length of the edge in cells; its cost, where moves have prices
    reverse: NDArray[np.uint8]  #: (n, 8), slot of the same edge as seen from the neighbour


def slots_along(graph: Graph, nodes: NDArray[Any]) -> NDArray[np.intp]:
    """Slot of each edge of a path, shape (k - 1,)."""
    slots: NDArray[np.intp] = np.argmax(graph.neighbours[nodes[:-1]] == nodes[1:, None], axis=1)
    return slots


class PlacedGraph(Protocol):
    """A graph whose n nodes have places on a map: what a colony is given."""

    @property
    def graph(self) -> Graph:
        """The neighbour table."""

    @property
    def dear(self) -> bool:
        """Whether moves have prices beside their lengths."""

    @property
    def turning(self) -> float:
        """Cost in cells of a turn by one radian."""

    @property
    def cells(self) -> NDArray[np.int64]:
        """Row and column of each node, shape (n, 2)."""

    def __len__(self) -> int: ...

    def distances_to(self, node: int) -> NDArray[np.float64]:
        """Length of a shortest path from every node to `node`, shape (n,)."""
