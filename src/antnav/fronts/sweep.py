"""Sweep: one exact search for each of many weighted sums of the objectives."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.kernels import front_kernels
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.values import whole_in

#: The ranges of all objectives are this many weight units wide.
_SCALE = 10**9


def lattice(k: int, parts: int) -> NDArray[np.float64]:
    """Weight vectors of k parts that sum to 1, in steps of 1 / parts, shape (w, k) (Das & Dennis 1998)."""
    if k == 1:
        return np.array([[1.0]])
    rows = []
    for share in range(parts + 1):
        rest = lattice(k - 1, parts - share) if share < parts else np.zeros((1, k - 1))
        rows.append(np.column_stack((np.full(len(rest), share / parts), rest * (1 - share / parts))))
    return np.concatenate(rows)


def scaled(weights: NDArray[np.float64], ranges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Weights in whole numbers, each objective's divided by its range; at least 1, so that no path found is beaten."""
    whole = np.rint(_SCALE * weights / np.maximum(ranges, 1)).astype(np.int64)
    return np.maximum(whole, 1)


def ends(instance: Instance) -> tuple[list[NDArray[np.int32]], NDArray[np.int64], NDArray[np.int64]]:
    """A best path for each objective by itself, the least of each objective, and the range over these paths."""
    paths = []
    for j in range(instance.k):
        weights = np.ones(instance.k, np.int64)
        weights[j] = _SCALE
        paths.append(best(instance, weights))
    values = np.array([instance.steps(path) for path in paths])
    return paths, values.min(axis=0), values.max(axis=0) - values.min(axis=0)


def best(instance: Instance, weights: NDArray[np.int64]) -> NDArray[np.int32]:
    """A path of least weighted sum, in nodes."""
    found: NDArray[np.int32] = front_kernels.weighted(
        *instance.arrays, weights, instance.ideal, instance.start, instance.goal
    )
    return found


@dataclass(frozen=True)
class Sweep(Method):
    """Exact A* for weighted sums of the objectives, weights spread evenly over all that there are.

    What it finds is on the front, but it can only find what some weighted sum likes best: parts of a front that bend
    inwards stay unseen, whatever the weights (Das & Dennis 1997).

    Parameters
    ----------
    searches : int
        About how many weight vectors, 1 to 100,000.
    """

    searches: int = 100

    def __post_init__(self) -> None:
        whole_in("searches", self.searches, 1, 100_000)

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "sweep"

    @property
    def certainty(self) -> str:
        """Where it comes from."""
        return "exact for each weighted sum; blind to parts of the front that bend inwards (Das & Dennis 1997)"

    def find(self, instance: Instance, call: Call) -> Found:
        """Search for each weight vector in turn."""
        paths, _, ranges = ends(instance)
        k, parts = instance.k, 1
        while math.comb(parts + k, k - 1) <= self.searches:
            parts += 1
        weights = lattice(k, parts)
        ending = None
        for done, vector in enumerate(weights):
            ending = call.ending(done, math.inf)
            if ending:
                break
            paths.append(best(instance, scaled(vector, ranges)))
        work = {"searches": len(paths)}
        return Found(paths=paths, stopped_by=ending or StoppedBy.SCHEDULE, work=work)
