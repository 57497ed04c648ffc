"""OMPL."""

from __future__ import annotations

import math
from typing import Any

from .task import Peer, Points, Task


class Ompl(Peer):
    """RRTConnect of OMPL with its simplification, for a point at any angle."""

    distribution = "ompl"
    corner = "any angle"

    def build(self, task: Task) -> Any:
        """The map itself."""
        return task.blocked

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """At most 30 s."""
        from ompl import base, geometric, util

        util.setLogLevel(util.LogLevel.LOG_NONE)
        rows, cols = state.shape
        space, bounds = base.RealVectorStateSpace(2), base.RealVectorBounds(2)
        for axis, side in enumerate(state.shape):
            bounds.setLow(axis, -0.5)
            bounds.setHigh(axis, side - 0.5)
        space.setBounds(bounds)
        setup = geometric.SimpleSetup(space)
        information = setup.getSpaceInformation()
        information.setStateValidityCheckingResolution(0.25 / math.hypot(rows, cols))

        def is_free(point: Any) -> bool:
            row, col = int(point[0] + 0.5), int(point[1] + 0.5)
            return not state[min(rows - 1, max(0, row)), min(cols - 1, max(0, col))]

        setup.setStateValidityChecker(is_free)
        ends = [space.allocState(), space.allocState()]
        for end, cell in zip(ends, (task.start, task.goal), strict=True):
            end[0], end[1] = map(float, cell)
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(geometric.RRTConnect(information))
        if not setup.solve(30.0) or not setup.haveExactSolutionPath():
            return None
        setup.simplifySolution()
        return [(point[0], point[1]) for point in setup.getSolutionPath().getStates()]
