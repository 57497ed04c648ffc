"""Sweep: one exact search for each of many weighted sums of the objectives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.fronts.weights import best, ends, lattice, scaled
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.values import whole_in


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
    draws: ClassVar[bool] = False

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
        weights = np.random.default_rng(0).permutation(lattice(k, parts))  # an end in time leaves no corner out
        ending = None
        for done, vector in enumerate(weights):
            ending = call.ending(done, math.inf)
            if ending:
                break
            paths.append(best(instance, scaled(vector, ranges)))
        work = {"searches": len(paths)}
        return Found(paths=paths, stopped_by=ending or StoppedBy.SCHEDULE, work=work)
