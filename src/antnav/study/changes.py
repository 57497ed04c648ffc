"""Changes: how the maps of a dynamic study change, drawn by a seed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from antnav.errors import ParameterError, shown
from antnav.values import check_seed, finite_number, whole_in
from antnav.world.grid import Cell, GridMap
from antnav.world.problem import Problem

#: Draws of a change that leaves no way, before it is given up.
TRIES = 200


@dataclass(frozen=True, kw_only=True)
class Changes:
    """A sequence of changes of a map: each moves a share of the occupied cells, and leaves a way.

    Parameters
    ----------
    count : int
        Changes of a run, 1 to 1000.
    every : int
        Iterations before each change, and after the last one, 1 to 1,000,000.
    share : float
        Of the occupied cells, those that move to free cells drawn evenly, in (0, 1]; one at least.
    seed : int
        With the run's own it draws them, so that all algorithms meet the same changes under one seed.

    Raises
    ------
    ParameterError
        One is out of its range.
    """

    count: int = 10
    every: int = 20
    share: float = 0.03
    seed: int = 0

    def __post_init__(self) -> None:
        whole_in("count", self.count, 1, 1000)
        whole_in("every", self.every, 1, 1_000_000)
        if not 0 < finite_number(self.share) <= 1:
            raise ParameterError(f"share {shown(self.share)} of changes", "it is above 0, up to 1", "give such a share")
        check_seed(self.seed)

    def problems(self, first: Problem, seed: int) -> Iterator[Problem]:
        """The problem as it is, then after each change under the seed of a run.

        Raises
        ------
        ParameterError
            No draw leaves a way.
        """
        chance = np.random.default_rng([self.seed, seed])
        yield first
        for _ in range(self.count):
            first = self._changed(first, chance)
            yield first

    def _changed(self, problem: Problem, chance: np.random.Generator) -> Problem:
        cells = problem.grid.cells
        occupied, free = (np.flatnonzero(cells == kind) for kind in (Cell.OCCUPIED, Cell.FREE))
        ends = [row * cells.shape[1] + col for row, col in (problem.start_cell, problem.goal_cell)]
        free = np.setdiff1d(free, ends)
        count = min(max(1, round(self.share * len(occupied))), len(occupied), len(free))
        for _ in range(TRIES):
            changed = cells.copy()
            changed.flat[chance.choice(occupied, count, replace=False)] = Cell.FREE
            changed.flat[chance.choice(free, count, replace=False)] = Cell.OCCUPIED
            grid = GridMap(changed, problem.grid.resolution, problem.grid.origin, problem.grid.name)
            found = replace(problem, grid=grid)
            if found.connected:
                return found
        rule = f"in {TRIES} draws no change left a way from {problem.start_cell} to {problem.goal_cell}"
        raise ParameterError(
            f"changes of {problem.grid.name or 'a map'}", rule, "give a smaller share, or an opener map"
        )
