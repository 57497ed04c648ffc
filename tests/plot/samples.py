"""Results to be drawn, and what can be read back from the axes on which they were."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import antnav as an
from antnav.kernels.ant_kernels import History
from antnav.planner.plan import ColonyReport, Stage
from antnav.planner.result import Result


def two_rooms(door: bool = True, **place) -> an.GridMap:
    """10 x 14 cells, a wall with or without a door in the middle; one unknown cell, one inflated."""
    cells = np.zeros((10, 14), np.uint8)
    cells[:, 6] = an.Cell.OCCUPIED
    if door:
        cells[4:6, 6] = an.Cell.FREE
    cells[0, 13], cells[9, 0] = an.Cell.UNKNOWN, an.Cell.INFLATED
    return an.GridMap(cells, **{"name": "two rooms"} | place)


def plan(grid: an.GridMap, algorithm: an.Algorithm | None = None, goal=(8, 12)) -> Result:
    problem = an.Problem.from_cells(grid, (1, 1), goal)
    return an.solve(problem, algorithm or an.paco(ants=10, iterations=12), seed=1)


def with_history(result: Result, best, iteration_best, mean, stages) -> Result:
    count = np.zeros(len(best), np.int64)
    history = History(
        *(np.array(values, float) for values in (best, iteration_best, mean)), count, count, count, count * np.nan
    )
    accounts = tuple(
        Stage(name, 0.1, tuple(ColonyReport((1, 1), (8, 12), n, None, 5, 0.1, 0.1) for n in iterations))
        for name, *iterations in stages
    )
    return replace(result, history=history, stages=accounts)


def line(ax, label: str):
    (found,) = [line for line in ax.lines if line.get_label() == label]
    return found


def texts(figure) -> str:
    from matplotlib.text import Text

    return "\n".join(text.get_text() for text in figure.findobj(Text))


def stairs(ax):
    from matplotlib.patches import StepPatch

    return [patch for patch in ax.patches if isinstance(patch, StepPatch)]
