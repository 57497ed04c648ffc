"""python-motion-planning 1."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task


class Pmp1(Peer):
    """A planner of python-motion-planning 1, the last with ants."""

    distribution = "python-motion-planning"
    majors = range(1, 2)
    largest = 256

    def __init__(self, planner: str, **options: float) -> None:
        self.planner, self.options = planner, options

    def build(self, task: Task) -> Any:
        """Its grid, with walls around: it looks beyond the edge."""
        import matplotlib

        matplotlib.use("Agg")
        from python_motion_planning import Grid as PmpGrid

        walled = np.pad(task.blocked, 1, constant_values=True)
        grid = PmpGrid(*walled.shape)
        grid.update({(int(row), int(col)) for row, col in np.argwhere(walled)})
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """From either end; the path is turned the right way round."""
        import python_motion_planning

        start, goal = ((end[0] + 1, end[1] + 1) for end in (task.start, task.goal))
        path = getattr(python_motion_planning, self.planner)(start, goal, state, **self.options).plan()[1]
        shifted = [(row - 1, col - 1) for row, col in path or ()]
        return (shifted if shifted[0] == task.start else shifted[::-1]) if shifted else None
