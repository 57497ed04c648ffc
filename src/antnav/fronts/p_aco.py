"""P-ACO: Pareto ant colony optimization, published for portfolios, here for paths."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.fronts import archive as archives
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.fronts.weights import ends, simplex
from antnav.kernels import front_ant_kernels as kernels
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.values import finite_number, whole_in

#: Nodes of paths that the archive has room for, and its paths.
_POOL, _SIZE = 1 << 24, 20_000
#: What the best and the second best of an objective lay on their moves; on a move of both 15.
_BEST, _SECOND = 10.0, 5.0


@dataclass(frozen=True)
class PAco(Method):
    """P-ACO (Doerner, Gutjahr, Hartl, Strauss & Stummer 2004, doi:10.1023/B:ANOR.0000039513.99038.c6) [reconstruction].

    A pheromone matrix for each objective; each ant draws weights, and goes by the weighted sum of the matrices::

        p_ij ~ (sum_k w_k tau_ij^k)^alpha eta_ij^beta,   or with probability q0 to the largest
        after a move:        tau^k <- (1 - rho) tau^k + rho tau_0
        after an iteration:  tau^k <- (1 - rho) tau^k + rho D^k
        D^k: 10 on moves of the iteration's best path for objective k, 5 of the second best, 15 of both

    alpha is 1. Ours, as portfolios have no paths: no cell is visited twice; the visibility eta = 1 / (1 + detour), as
    the heuristic "detour", by the ant's weighted sum of exact distances of each objective by itself; the archive begins
    with the best path for each objective, as other methods' do.

    Parameters
    ----------
    iterations : int
        1 to 10**6.
    ants : int
        1 to 100,000.
    q0, rho : float
        0 to 1.
    tau0 : float
        Above 0.
    beta : int
        0 to 20.
    unit : float
        The detour that halves eta, as a share of the objectives' ranges, above 0.
    """

    iterations: int = 200
    ants: int = 20
    q0: float = 0.4
    rho: float = 0.1
    tau0: float = 1.0
    beta: int = 2
    unit: float = 0.01

    def __post_init__(self) -> None:
        whole_in("iterations", self.iterations, 1, 10**6)
        whole_in("ants", self.ants, 1, 100_000)
        whole_in("beta", self.beta, 0, 20)
        for name in ("q0", "rho"):
            if not 0 <= finite_number(getattr(self, name)) <= 1:
                raise ParameterError(
                    f"{name} {shown(getattr(self, name))}", f"{name} lies in 0 to 1", "give such as 0.1"
                )
        for name in ("tau0", "unit"):
            if not finite_number(getattr(self, name)) > 0:
                raise ParameterError(f"{name} {shown(getattr(self, name))}", f"{name} is above 0", "give such as 1")

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "p-aco"

    @property
    def certainty(self) -> str:
        """Where it comes from."""
        return "P-ACO (Doerner et al. 2004), a reconstruction: published for portfolios, its visibility on maps is ours"

    def find(self, instance: Instance, call: Call) -> Found:
        """Iterate until the call or the schedule ends it."""
        paths, _, ranges = ends(instance)
        k, n = instance.k, len(instance.graph)
        archive = archives.empty(_SIZE, _POOL, ranges, np.zeros(k, np.int64))
        archive = archives.taken(archive, archives.joined(instance, paths), _SIZE)
        chance = np.random.default_rng(call.seed)
        tau = np.full((k, n, 8), self.tau0)
        walks = arrived = done = 0
        ending = None
        scale = np.maximum(ranges, 1).astype(np.float64)
        while done < self.iterations and not (ending := call.ending(done, math.inf)):
            weights = np.array([simplex(chance, k) for _ in range(self.ants)])
            found = kernels.iterate(
                *instance.arrays,
                instance.ideal,
                scale,
                float(self.unit),
                tau,
                weights,
                (instance.start, instance.goal),
                float(self.q0),
                float(self.rho),
                float(self.tau0),
                self.beta,
                np.uint64(call.seed),
                done,
            )
            self._update(instance, tau, found)
            archive = archives.taken(archive, found, _SIZE)
            walks, arrived, done = walks + self.ants, arrived + len(found[1]), done + 1
        return Found(
            paths=archives.split(archive),
            notes=archives.left_out(archive, instance),
            stopped_by=ending or StoppedBy.SCHEDULE,
            work={"walks": walks, "arrived": arrived, "searches": k},
        )

    def _update(self, instance: Instance, tau: NDArray[np.float64], found: archives.Paths) -> None:
        """The best and the second best path of the iteration for each objective lay pheromone."""
        values, lengths, nodes = found
        kernels.evaporate(tau, float(self.rho))
        ways = np.split(nodes, np.cumsum(lengths)[:-1])
        for j, matrix in enumerate(tau):
            ranking = np.argsort(values[:, j], kind="stable")
            for amount, at in zip((_BEST, _SECOND), ranking, strict=False):
                kernels.deposit(instance.graph.graph.neighbours, matrix, ways[at], self.rho * amount)
