"""Compile or load the kernels once a process, and say how long it took."""

from __future__ import annotations

import threading
import time

import numpy as np

from antnav.ants.presets import npaco
from antnav.colony import colony
from antnav.colony.parameters import Algorithm
from antnav.errors import check_type
from antnav.kernels import grid_kernels
from antnav.search import exact
from antnav.search.abstraction import prepare
from antnav.world.grid import GridMap
from antnav.world.problem import Problem

_lock = threading.Lock()
_done: set[str] = set()


def warmup(algorithm: Algorithm | None = None) -> float:
    """Compile kernels, or load them from the disk cache; what this process has done before is not done again.

    Parameters
    ----------
    algorithm : Algorithm, optional
        Whose kernels are wanted; default: all kernels.

    Returns
    -------
    float
        Seconds that it took: seconds on a machine that has never run antnav, tenths later, 0 once done.
    """
    check_type("algorithm", algorithm, Algorithm | None, "call a preset, as in an.paco(), or give None")
    parts = {"ants": _ants}
    if algorithm is None or algorithm.windows:
        parts["windows"] = _windows
    if algorithm is None or algorithm.coarse:
        parts["regions"] = _regions
    with _lock:
        begin = time.perf_counter()
        missing = parts.keys() - _done
        for name, compile_part in parts.items():
            if name in missing:
                compile_part()
                _done.add(name)
        return time.perf_counter() - begin if missing else 0.0


def _problem() -> Problem:
    return Problem.from_cells(GridMap(np.zeros((2, 5), np.uint8)), (0, 0), (1, 4))


def _ants() -> None:
    problem = _problem()
    exact.shortest_path(problem)
    problem.graph.part(np.ones(len(problem.graph), np.bool_), 0)
    colony.run(colony.whole_task(problem, npaco(ants=2, iterations=2), seed=0))


def _windows() -> None:
    problem = _problem()
    path = problem.graph.flat[:5].copy()
    grid_kernels.reoptimise(problem.flat_moves, problem.width, path, 3, 0)


def _regions() -> None:
    problem = _problem()
    short = prepare(problem.grid, block=4)
    graph = short.between(*(problem.to_flat(cell) for cell in (problem.start_cell, problem.goal_cell)))
    assert graph is not None
    stops = short.stops(np.array([graph.start, graph.goal], np.int32), int(short.centre[0]), int(short.centre[1]))
    path = grid_kernels.thread_route(short.moves, short.width, short.block, stops)
    grid_kernels.length_along(path, short.width)
