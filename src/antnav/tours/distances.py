"""What the way from each place of a tour to each other costs, by one exact search from each."""

from __future__ import annotations

from concurrent.futures import Executor, ThreadPoolExecutor
from functools import partial

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import grid_kernels, tour_kernels
from antnav.run.spmd import CORES, run_jobs
from antnav.world.terrain import Terrain


def between(terrain: Terrain, places: NDArray[np.int32], executor: Executor | None = None) -> NDArray[np.float64]:
    """Costs in cells from each place to each other, shape (n, n), but for climbs that the way back gives back.

    Symmetric; inf where there is no way. `lifted` puts the rest on it.

    Parameters
    ----------
    places : ndarray of int32
        Flat cells.
    executor : Executor, optional
        Threads to search in; in other executors nothing is.
    """
    costs = np.zeros((len(places), len(places)))
    shares = [range(first, len(places) - 1, CORES) for first in range(CORES)]
    threads = executor if isinstance(executor, ThreadPoolExecutor) else None
    run_jobs(partial(_fill, costs, terrain, places), shares, threads)
    costs += costs.T
    return costs


def lifted(costs: NDArray[np.float64], terrain: Terrain, places: NDArray[np.int32]) -> NDArray[np.float64]:
    """The costs with the climbs that depend on the direction, from the row's place to the column's."""
    first = int(places[0])
    heights = np.array([terrain.objective.lift(first, int(place)) for place in places])
    directed: NDArray[np.float64] = np.maximum(costs + (heights - heights[:, None]), 0.0)
    return directed


def _fill(costs: NDArray[np.float64], terrain: Terrain, places: NDArray[np.int32], sources: range) -> None:
    """The costs from some places to those behind them."""
    moves, width, objective = terrain.flat_moves, terrain.width, terrain.objective
    turns = objective.turns()
    size = moves.size if turns is None and objective.plain else 0
    scratch = np.empty(size, np.int64), np.empty(size, np.uint8)
    for number in sources:
        source, others = int(places[number]), places[number + 1 :]
        if turns is not None:
            found = tour_kernels.turning_costs(moves, width, source, others, objective.prices, turns)
        elif objective.plain:
            found = tour_kernels.lengths(moves, width, source, others, *scratch)
        else:
            found = grid_kernels.search(moves, width, source, -1, False, objective.prices)[0][others]
        costs[number, number + 1 :] = found
