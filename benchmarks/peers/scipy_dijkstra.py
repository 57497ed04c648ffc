"""SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np

from .graph import cells, graph_of, nodes
from .task import Peer, Points, Task


class Scipy(Peer):
    """Dijkstra's algorithm of scipy.sparse.csgraph."""

    distribution = "scipy"

    def __init__(self, corner: str) -> None:
        self.corner = corner

    def build(self, task: Task) -> Any:
        """A sparse matrix."""
        from scipy.sparse import csr_array

        source, target, length = graph_of(task.blocked, allow=self.corner == "allow")
        return csr_array((length, (source, target)), shape=(task.blocked.size,) * 2)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """From the start to everywhere: it has no goal."""
        from scipy.sparse.csgraph import dijkstra

        start, goal = nodes(task)
        found: Any = dijkstra(state, indices=[start], return_predecessors=True)
        distance, before = (array[0] for array in found)
        if not np.isfinite(distance[goal]):
            return None
        path = [goal]
        while path[-1] != start:
            path.append(before[path[-1]])
        return cells(reversed(path), task)
