"""pyastar2d."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Pyastar2d(Peer):
    """A* of pyastar2d, to which a diagonal move costs no more than a straight one."""

    distribution = "pyastar2d"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return np.where(task.blocked, np.inf, 1.0).astype(np.float32)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """With diagonals."""
        import pyastar2d

        path = pyastar2d.astar_path(state, task.start, task.goal, allow_diagonal=True)
        return None if path is None else path.tolist()
