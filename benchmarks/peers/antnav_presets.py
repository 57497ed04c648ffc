"""antnav."""

from __future__ import annotations

from typing import Any

import numpy as np

from .task import Peer, Points, Task

#: The first planner of antnav in the list is exact; the others are these presets.
PRESETS = ("npaco", "paco", "paco_ls", "gao", "paco_large")


class Antnav(Peer):
    """antnav's A*, or a preset; the map and its legal moves can be used again."""

    distribution = "antnav"

    def __init__(self, preset: str | None = None) -> None:
        self.preset = preset

    def build(self, task: Task) -> Any:
        """The map, and what belongs to it."""
        import antnav as an

        grid = an.GridMap(task.blocked.view(np.uint8))
        _ = an.Problem.from_cells(grid, task.start, task.goal).moves
        if self.preset is not None and (block := an.preset(self.preset).coarse):
            an.prepare(grid, block=block)
        return grid

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """As a user would."""
        import antnav as an

        problem = an.Problem.from_cells(state, task.start, task.goal)
        if self.preset is None:
            path = an.exact.shortest_path(problem, "astar").path
        else:
            path = an.solve(problem, an.preset(self.preset), seed=seed).path
        return None if path is None else path.cells.tolist()
