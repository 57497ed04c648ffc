"""NetworkX."""

from __future__ import annotations

from typing import Any

from .graph import cells, graph_of, nodes, octile
from .task import Peer, Points, Task


class Networkx(Peer):
    """A* of NetworkX."""

    distribution = "networkx"

    def build(self, task: Task) -> Any:
        """An undirected graph."""
        import networkx

        source, target, length = graph_of(task.blocked)
        once = source < target
        graph = networkx.Graph()
        graph.add_weighted_edges_from(
            zip(source[once].tolist(), target[once].tolist(), length[once].tolist(), strict=True)
        )
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With the octile heuristic."""
        import networkx

        start, goal = nodes(task)
        return cells(networkx.astar_path(state, start, goal, heuristic=lambda node, _: octile(task, node)), task)
