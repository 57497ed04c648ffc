"""Any planner as a replanner: it plans anew after every change, ants with what they remember."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain
from antnav.plan.solve import solve
from antnav.planner.memory import Memory
from antnav.planner.planner import Planner


class Anew(Replanner):
    """`solve` for each map; planners that remember begin with the pheromone of the run before.

    What a change does to that pheromone is said by the algorithm's part `memory`. Each run has a seed of its own, the
    first one the seed that is given, the next one the seed after it, so that a repetition gives the same plans.

    Parameters
    ----------
    planner : Planner
    seed : int
    """

    exact: ClassVar[bool] = False
    certain = False
    source: ClassVar[str] = "see the planner"

    def __init__(self, planner: Planner, seed: int = 0) -> None:
        self.name = planner.name  # type: ignore[misc]
        self._planner, self._seed = planner, seed
        self.memory: Memory | None = None  #: pheromone of the latest run; None clears it

    def begin(self, terrain: LiveTerrain, start: int, goal: int) -> Path:
        """Solve."""
        self._terrain, self._goal = terrain, goal
        self._path: Path = None
        return self._solved(start)

    def changed(self, cells: NDArray[np.int32], start: int) -> Path:
        """Solve again, unless nothing is different."""
        return self.moved(start) if not len(cells) else self._solved(start)

    def moved(self, start: int) -> Path:
        """Go on along the path; solve again where the robot has left it."""
        if self._path is None or start not in self._path:
            return self._solved(start)
        self._path = self._path[int(np.argmax(self._path == start)) :]
        return self._path

    def improve(self, rounds: int) -> Path:
        """So many more runs; the cheapest path stays."""
        for _ in range(rounds):
            before = self._path
            if before is None:
                return None
            after = self._solved(int(before[0]))
            if after is None or self._terrain.cost_along(after) >= self._terrain.cost_along(before):
                self._path = before
        return self._path

    def _solved(self, start: int) -> Path:
        problem = self._terrain.problem(start, self._goal)
        remembers = self._planner.remembers
        result = solve(problem, self._planner, seed=self._seed, warm=self.memory, remember=remembers)
        self._seed = (self._seed + 1) % 2**64
        if remembers and result.memory is not None:
            self.memory = result.memory
        self._path = None
        if result.path is not None:
            cells = result.path.cells
            self._path = ((cells[:, 0] + 1) * self._terrain.width + cells[:, 1] + 1).astype(np.int32)
        return self._path
