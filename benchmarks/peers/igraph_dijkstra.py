"""igraph."""

from __future__ import annotations

from typing import Any

import numpy as np

from .graph import cells, graph_of, nodes
from .task import Peer, Points, Task


class Igraph(Peer):
    """Dijkstra's algorithm of igraph."""

    distribution = "igraph"

    def build(self, task: Task) -> Any:
        """An undirected graph and its weights."""
        import igraph

        source, target, length = graph_of(task.blocked)
        once = source < target
        return igraph.Graph(n=task.blocked.size, edges=np.column_stack((source[once], target[once]))), length[once]

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """To one goal."""
        graph, weights = state
        start, goal = nodes(task)
        return cells(graph.get_shortest_paths(start, to=goal, weights=weights.tolist())[0], task)
