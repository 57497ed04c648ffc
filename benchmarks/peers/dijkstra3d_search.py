"""dijkstra3d."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Dijkstra3d(Peer):
    """Dijkstra's algorithm of dijkstra3d, from both ends."""

    distribution = "dijkstra3d"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs in its own order of memory."""
        return np.asfortranarray(np.where(task.blocked, np.inf, 1.0).astype(np.float32))

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With diagonals, at their length."""
        import dijkstra3d

        path: Points = dijkstra3d.dijkstra(
            state, task.start, task.goal, bidirectional=True, connectivity=8, anisotropy=(1.0, 1.0)
        ).tolist()
        return path
