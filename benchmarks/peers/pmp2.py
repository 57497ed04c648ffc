"""python-motion-planning 2."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Pmp2(Peer):
    """A planner of python-motion-planning 2."""

    distribution = "python-motion-planning"
    majors = range(2, 3)

    def __init__(self, planner: str, corner: str = "forbid") -> None:
        self.planner, self.corner = planner, corner

    def build(self, task: Task) -> Any:
        """Its grid."""
        from python_motion_planning.common import TYPES
        from python_motion_planning.common import Grid as PmpGrid

        grid = PmpGrid(bounds=[[0, side] for side in task.blocked.shape])
        grid.type_map[:, :] = np.where(task.blocked, TYPES.OBSTACLE, TYPES.FREE)
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """By the planner of that name."""
        import python_motion_planning.path_planner as planners

        path, info = getattr(planners, self.planner)(map_=state, start=task.start, goal=task.goal).plan()
        return list(path) if info["success"] else None
