"""Ground: what a user's rules see of a problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts.places import at_neighbour
from antnav.errors import RuleError, shown
from antnav.kernels.graph import PlacedGraph
from antnav.plugins.source import Source
from antnav.values import read_only

#: Nodes at which own cuts may divide the way: as many as 64 pieces have.
MOST_CUTS = 63


@dataclass(frozen=True, eq=False)
class Ground:
    """The graph that ants walk on, from where to where. Its n nodes are cells, or regions of a coarse map.

    Attributes
    ----------
    cells : ndarray of int64, shape (n, 2)
        Row and column of each node, in map order.
    neighbours : ndarray of int32, shape (n, 8)
        Node at the end of each move: up left, up, up right, left, right, down left, down, down right; n where there is
        none.
    lengths : ndarray of float64, shape (n, 8)
        Length of each move in cells; its cost where cells cost.
    start, goal : int
        Nodes.
    tau0 : float
        The algorithm's initial pheromone.
    """

    placed: PlacedGraph
    start: int
    goal: int
    tau0: float

    @property
    def cells(self) -> NDArray[np.int64]:  # noqa: D102 - above
        return read_only(self.placed.cells.view())

    @property
    def neighbours(self) -> NDArray[np.int32]:  # noqa: D102
        return read_only(self.placed.graph.neighbours.view())

    @property
    def lengths(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.placed.graph.lengths.view())

    def __len__(self) -> int:
        return len(self.placed)

    def distances_to(self, node: int) -> NDArray[np.float64]:
        """Exact distance, or cost of the way, from every node to `node`, shape (n,); whoever calls this knows it."""
        return self.placed.distances_to(node)

    def at_neighbours(self, values: NDArray[np.float64], none: float = 1.0) -> NDArray[np.float64]:
        """Values of nodes, shape (n,), seen along each move: shape (n, 8), `none` where there is no move."""
        return at_neighbour(self.placed, values, none)


def checked_nodes(given: Any, ground: Ground, source: Source) -> list[int]:
    """What a rule returned as up to 63 different nodes, neither the start nor the goal.

    Raises
    ------
    RuleError
        It is something else.
    """
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):
        found = np.empty((0, 0))
    nodes: list[int] = found.tolist() if found.ndim == 1 and found.dtype.kind in "iu" else []
    if not (
        (nodes or found.shape == (0,))
        and len(nodes) <= MOST_CUTS
        and len(set(nodes)) == len(nodes)
        and all(0 <= node < len(ground) and node not in (ground.start, ground.goal) for node in nodes)
    ):
        rule = f"it returns up to {MOST_CUTS} different nodes in 0..{len(ground) - 1}, neither the start nor the goal"
        raise RuleError(f"own rule {source}, what it returned: {shown(given)}", rule, "mend the rule")
    return nodes


def checked_values(
    given: Any, ground: Ground, source: Source, shapes: Sequence[tuple[int, ...]]
) -> NDArray[np.float64]:
    """What a rule returned as numbers of one of these shapes, finite and at least 0; 1 where there is no move.

    Raises
    ------
    RuleError
        It is something else.
    """
    wanted = " or ".join(map(str, shapes))
    rule, remedy = f"it returns finite numbers of at least 0, of shape {wanted}", "mend the rule"
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):
        found = np.empty(0, object)
    if found.dtype.kind not in "biuf":
        raise RuleError(f"own rule {source}, what it returned: {shown(given)}", rule, remedy)
    if found.shape not in shapes:
        raise RuleError(f"own rule {source}, shape {found.shape}", rule, remedy)
    values = found.astype(np.float64)
    if values.shape == (len(ground), 8):
        values[ground.neighbours == len(ground)] = 1.0
    if not (np.isfinite(values) & (values >= 0)).all():
        place = np.unravel_index(np.argmin(np.isfinite(values) & (values >= 0)), values.shape)
        node = "" if not place else f" at node {place[0]}, cell {tuple(ground.cells[place[0]].tolist())}"
        raise RuleError(f"own rule {source}, {values[place]}{node}", rule, remedy)
    return values
