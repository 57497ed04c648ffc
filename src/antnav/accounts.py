"""What is told about a run once it is over: stages, history, pheromone. Kept out of the time that a run takes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.colony.colony import Outcome, Task
from antnav.colony.kernels import COUNTS, History, new_history
from antnav.problem import Problem
from antnav.result import ColonyReport, Stage


@dataclass(frozen=True, eq=False)
class Run:
    """Colonies that ran side by side.

    Attributes
    ----------
    name : str
    halves : bool
        Whether their paths are parts of one, so that lengths add up; else the better colony counts.
    seconds : float
        Wall time.
    tasks, outcomes
        In the same order.
    """

    name: str
    halves: bool
    seconds: float
    tasks: Sequence[Task]
    outcomes: Sequence[Outcome]

    def stage(self) -> Stage:
        """The account that goes into the result."""
        reports = []
        for task, outcome in zip(self.tasks, self.outcomes, strict=True):
            start, goal = ((int(row), int(col)) for row, col in task.grid_graph.cells[[task.start, task.goal]])
            length = outcome.length if math.isfinite(outcome.length) else None
            reports.append(
                ColonyReport(
                    start, goal, outcome.iterations, length, outcome.steps, outcome.seconds, outcome.cpu_seconds
                )
            )
        return Stage(self.name, self.seconds, tuple(reports))

    def history(self) -> History:
        """The colonies' histories as one; where one colony stopped before the other, its last values are held."""
        if len(self.outcomes) == 1:
            return self.outcomes[0].history
        length = max(outcome.iterations for outcome in self.outcomes)
        one, other = (_held(outcome.history, length) for outcome in self.outcomes)
        combine = np.add if self.halves else np.minimum
        mean = one.mean + other.mean
        if not self.halves:
            arrived = one.arrived + other.arrived
            total = np.nan_to_num(one.mean) * one.arrived + np.nan_to_num(other.mean) * other.arrived
            mean = np.where(arrived > 0, total / np.maximum(arrived, 1), np.nan)
        return History(
            best=combine(one.best, other.best),
            iteration_best=combine(one.iteration_best, other.iteration_best),
            mean=mean,
            arrived=one.arrived + other.arrived,
            lost=one.lost + other.lost,
            steps=one.steps + other.steps,
            entropy=(one.entropy + other.entropy) / 2,
        )


def _held(history: History, length: int) -> History:
    """The history continued to a length: the last values stay, and nobody walks any more."""
    more = length - len(history.best)
    nothing_yet = {"best": math.inf, "iteration_best": math.inf}
    held = []
    for name, array in zip(History._fields, history, strict=True):
        last = array[-1] if len(array) else nothing_yet.get(name, math.nan)
        held.append(np.append(array, np.full(more, 0 if name in COUNTS else last, array.dtype)))
    return History(*held)


def joined_history(runs: Sequence[Run]) -> History:
    """The histories of runs that followed each other."""
    histories = [run.history() for run in runs] or [new_history(0)]
    return History(*(np.concatenate(columns) for columns in zip(*histories, strict=True)))


def heat(problem: Problem, runs: Sequence[Run]) -> NDArray[np.float32]:
    """Mean pheromone of each cell's edges at the end of the last run, shape (rows, cols), nan where nobody could walk.

    The pheromone of halves is added up.
    """
    field = np.full(problem.grid.shape, np.nan, np.float32)
    if runs:
        last = runs[-1]
        graph = problem.graph
        tau = sum(outcome.tau for outcome in last.outcomes) if last.halves else last.outcomes[0].tau
        edges = graph.graph.neighbours < len(graph)
        mean = np.where(edges, tau, 0.0).sum(axis=1) / np.maximum(edges.sum(axis=1), 1)
        field[tuple(graph.cells.T)] = mean
    return field
