"""rustworkx."""

from __future__ import annotations

from typing import Any

from .graph import cells, graph_of, nodes, octile
from .task import Peer, Points, Task


class Rustworkx(Peer):
    """A* of rustworkx."""

    distribution = "rustworkx"

    def build(self, task: Task) -> Any:
        """A directed graph."""
        import rustworkx

        graph = rustworkx.PyDiGraph()
        graph.add_nodes_from(range(task.blocked.size))
        graph.add_edges_from(list(zip(*(part.tolist() for part in graph_of(task.blocked)), strict=True)))
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """Its nodes call back into Python."""
        import rustworkx

        start, goal = nodes(task)
        path = rustworkx.digraph_astar_shortest_path(
            state, start, lambda node: node == goal, float, lambda node: octile(task, node)
        )
        return cells(path, task)
