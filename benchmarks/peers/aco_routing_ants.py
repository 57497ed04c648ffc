"""aco_routing."""

from __future__ import annotations

from typing import Any

from .graph import cells, graph_of, nodes
from .task import Peer, Points, Task


class AcoRouting(Peer):
    """aco_routing on the user's graph, 50 ants and 50 iterations."""

    distribution = "aco-routing"
    largest = 256

    def build(self, task: Task) -> Any:
        """A directed graph of named nodes."""
        import networkx

        source, target, length = graph_of(task.blocked)
        graph = networkx.DiGraph()
        edges = zip(map(str, source.tolist()), map(str, target.tolist()), length.tolist(), strict=True)
        graph.add_weighted_edges_from(edges, weight="cost")
        return graph

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With antnav's alpha and beta."""
        from aco_routing import ACO

        steps = task.blocked.size // 2
        colony = ACO(state, ant_max_steps=steps, num_iterations=50, ant_random_spawn=False, alpha=1.0, beta=7.0)
        start, goal = (str(node) for node in nodes(task))
        try:
            path, _ = colony.find_shortest_path(source=start, destination=goal, num_ants=50)
        except Exception:  # its way of saying that no ant arrived
            return None
        return cells(path, task)
