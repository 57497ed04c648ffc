"""pathplan."""

from __future__ import annotations

from typing import Any

from .task import Peer, Points, Task


class Pathplan(Peer):
    """A planner of pathplan; its metaheuristics place points of a path at any angle."""

    distribution = "pathplan"
    largest = 256

    def __init__(self, planner: str, corner: str, **options: int) -> None:
        self.planner, self.corner, self.options = planner, corner, options

    def build(self, task: Task) -> Any:
        """Its grid."""
        from pathplan.core import GridMap

        return GridMap(task.blocked.astype(float))

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """By the planner of that name."""
        if self.options:
            from pathplan import metaheuristic as planners
        else:
            from pathplan import classic as planners
        path, _ = getattr(planners, self.planner)(state, **self.options).plan(task.start, task.goal)
        return None if path is None else list(path)
