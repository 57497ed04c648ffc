"""Watch: the account of one search, and the place where it is told to end."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy


class Halted(Exception):  # noqa: N818 - not an error: it unwinds a library that knows no other way to stop
    """The stopping criterion was reached, or the search was cancelled."""


class Watch:
    """Counts steps and iterations, keeps the best path, and raises `Halted` when the search is to end.

    Attributes
    ----------
    steps : int
        Cost evaluations, or moves of a potential field's robot.
    best, cells : float, ndarray or None
        Cost (length, without costs) and flat cells of the best path so far; inf and None before the first.
    history : list of float
        `best` by iteration.
    steps_by_iteration : list of int
    walks : int or None
        Paths that were tried; None: as many as steps.
    stopped_by : StoppedBy
    """

    def __init__(self, call: Call) -> None:
        self._call, self._improved = call, 0
        self.steps = 0
        self.walks: int | None = None
        self.steps_by_iteration: list[int] = []
        self.best = math.inf
        self.cells: NDArray[np.int64] | None = None
        self.history: list[float] = []
        self.stopped_by = StoppedBy.SCHEDULE

    def found(self, length: float, cells: NDArray[np.int64]) -> None:
        """Keep a path that is shorter than the best so far."""
        if length < self.best:
            self.best, self.cells = length, cells
            self._improved = len(self.history)

    def iteration(self) -> None:
        """Close an iteration.

        Raises
        ------
        Halted
            The search is to end.
        """
        self.history.append(self.best)
        self.steps_by_iteration.append(self.steps - sum(self.steps_by_iteration))
        iterations = len(self.history)
        stagnant = iterations - 1 - self._improved if math.isfinite(self.best) else 0
        ending = self._call.ending(iterations, self.best, stagnant)
        if ending:
            self.stopped_by = ending
            raise Halted
