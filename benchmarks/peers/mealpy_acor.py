"""mealpy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .task import Peer, Points, Task


class Mealpy(Peer):
    """Ants for continuous numbers (ACOR) of mealpy on six points of a path; this encoding is ours."""

    distribution = "mealpy"
    corner = "any angle"
    largest = 256

    def build(self, task: Task) -> Any:
        """The map itself."""
        return task.blocked

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """50 ants, 50 iterations; a blocked sample of the way costs 1000."""
        from mealpy import ACOR, FloatVar

        rows, cols = state.shape
        along = np.linspace(0, 1, 4 * max(rows, cols))[:, None]

        def points(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.vstack((task.start, numbers.reshape(-1, 2), task.goal)).astype(float)

        def cost(numbers: NDArray[np.float64]) -> float:
            way = points(numbers)
            legs = np.diff(way, axis=0)
            samples = np.concatenate([first + along * leg for first, leg in zip(way, legs, strict=False)])
            near = np.clip(np.rint(samples).astype(int), 0, [rows - 1, cols - 1])
            return float(np.linalg.norm(legs, axis=1).sum() + 1000.0 * state[near[:, 0], near[:, 1]].sum())

        bounds = FloatVar(lb=[0.0] * 12, ub=[rows - 1.0, cols - 1.0] * 6)
        problem = {"obj_func": cost, "minmax": "min", "log_to": None, "bounds": bounds}
        best = ACOR.OriginalACOR(epoch=50, pop_size=50).solve(problem, seed=seed)
        found: Points = points(best.solution).tolist()
        return found if best.target.fitness < 1000 else None
