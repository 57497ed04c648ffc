"""Compile or load the kernels once a process, and say how long it took."""

from __future__ import annotations

import threading
import time

import numpy as np

from antnav import exact
from antnav.colony import colony
from antnav.colony.presets import npaco
from antnav.grid import GridMap
from antnav.problem import Problem

_lock = threading.Lock()
_done = False


def warmup() -> float:
    """Compile every kernel, or load it from the disk cache; the second call in a process does nothing.

    Returns
    -------
    float
        Seconds that it took: seconds on a machine that has never run antnav, tenths later, 0 once done.
    """
    global _done  # noqa: PLW0603 - kernels are compiled once a process, and so is this flag
    with _lock:
        if _done:
            return 0.0
        begin = time.perf_counter()
        problem = Problem.from_cells(GridMap(np.zeros((2, 3), np.uint8)), (0, 0), (1, 2))
        exact.shortest_path(problem)
        colony.run(colony.whole_task(problem, npaco(ants=2, iterations=2), seed=0))
        _done = True
        return time.perf_counter() - begin
