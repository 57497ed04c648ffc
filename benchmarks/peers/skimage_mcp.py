"""scikit-image."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Skimage(Peer):
    """Minimum-cost path of scikit-image."""

    distribution = "scikit-image"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return np.where(task.blocked, -1.0, 1.0)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """To one goal."""
        from skimage.graph import MCP_Geometric

        search = MCP_Geometric(state, fully_connected=True)
        search.find_costs([task.start], [task.goal])
        path: Points = search.traceback(task.goal)
        return path
