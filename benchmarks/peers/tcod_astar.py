"""tcod."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Tcod(Peer):
    """A* of tcod, which counts in whole numbers: 70 a straight move, 99 a diagonal one."""

    distribution = "tcod"
    corner = "allow"

    def build(self, task: Task) -> Any:
        """Costs."""
        return (~task.blocked).astype(np.int8)

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """The path ends where it begins if there is none."""
        import tcod.path

        finder = tcod.path.Pathfinder(tcod.path.SimpleGraph(cost=state, cardinal=70, diagonal=99))
        finder.add_root(task.start)
        path: Points = finder.path_to(task.goal).tolist()
        return path if len(path) > 1 else None
