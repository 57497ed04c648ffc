"""Colonies: ants for many weighted sums of the objectives, and one archive."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.fronts import archive as archives
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.fronts.weights import SCALE, ends, scaled, simplex
from antnav.kernels import archive_kernels, front_kernels
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.run import spmd
from antnav.values import finite_number, whole_in

#: Largest shares of the objectives' ranges that a walk may give away in all; colonies have them in turn.
_SLACKS = (0.1, 0.05, 0.1, 0.3, 0.05, 0.1, 1.0)
#: Temperatures of the ants, as shares of the ranges.
_HEATS = (1e-5, 1e-4, 1e-3, 5e-3, 3e-2)
#: Nodes of paths that a colony can tell of in a round, and that the archive holds.
_ROOM, _POOL = 1 << 21, 1 << 24


def decay_table() -> NDArray[np.float64]:
    """exp(-i / 64) down to exp(-16), by multiplication: exp itself may differ between machines in its last bit."""
    factor, value, table = 0.984496437005408, 1.0, []  # exp(-1 / 64)
    for _ in range(16 * 64):
        table.append(value)
        value *= factor
    return np.array(table)


@dataclass(frozen=True, eq=False)
class Task:
    """What one colony does in a round; complete in itself."""

    number: int
    weights: NDArray[np.int64]
    nodes: NDArray[np.int32]  #: of known paths that suit the weights
    first: NDArray[np.int64]  #: where each begins
    near: int  #: how many of them, the first ones, lay pheromone
    archive: archive_kernels.Archive  #: what is known, without paths


@dataclass(frozen=True)
class Colonies(Method):
    """Colonies of ants over weighted sums, one archive [ours].

    Each round, each colony takes other weights, finds the best ways to the goal for their sum (exact, A* from the goal)
    and lets ants walk by them, greedy and exploring ones. What no other path beats enters the archive. Then paths
    of the archive that suit the weights are left at every cell for the best way on, and continued along each other
    where they part.

    Parameters
    ----------
    rounds : int
        1 to 10**6.
    colonies : int
        In each round, 1 to 10,000; they run side by side.
    ants : int
        Of each colony, 0 to 10**6.
    known : int
        Paths of the archive that a colony looks at, 0 to 10,000.
    pairs : int
        Pairs of them that are spliced, 0 to 10**6.
    alpha : float
        Power of the pheromone, 0 to 10; 0: none.
    size : int
        Paths in the archive, 10 to 10**6. Where there are more, paths that are better by less than a tolerance in every
        objective are no longer told apart.
    """

    rounds: int = 24
    colonies: int = 4
    ants: int = 200
    known: int = 64
    pairs: int = 200
    alpha: float = 0.0
    size: int = 20_000

    def __post_init__(self) -> None:
        whole_in("rounds", self.rounds, 1, 10**6)
        whole_in("colonies", self.colonies, 1, 10_000)
        whole_in("ants", self.ants, 0, 10**6)
        whole_in("known", self.known, 0, 10_000)
        whole_in("pairs", self.pairs, 0, 10**6)
        whole_in("size", self.size, 10, 10**6)
        if not 0 <= finite_number(self.alpha) <= 10:
            raise ParameterError(f"alpha {shown(self.alpha)}", "alpha lies in 0 to 10", "give such as 1")

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "ants"

    @property
    def certainty(self) -> str:
        """Where it comes from."""
        return "ours; a heuristic: paths of the front may be missing"

    def find(self, instance: Instance, call: Call) -> Found:
        """Round by round, until the call or the last round ends it."""
        paths, _, ranges = ends(instance)
        behind = front_kernels.ideal_from(instance.graph.graph.neighbours, instance.costs, instance.start)
        archive = archives.empty(self.size, _POOL, ranges, np.zeros(instance.k, np.int64))
        archive = archives.taken(archive, archives.joined(instance, paths), self.size)
        chance = np.random.default_rng(call.seed)
        work = np.zeros(4, np.int64)
        shares = _spread(instance.k, chance)
        ending, done = None, 0
        here = spmd.shares_memory(call.executor)  # elsewhere nobody can ask the clock or the caller
        while done < self.rounds and not (ending := call.ending(done, math.inf)):
            numbers = range(done * self.colonies, (done + 1) * self.colonies)
            tasks = [self._task(archive, ranges, next(shares), chance, number) for number in numbers]
            ended = partial(call.ending, done, math.inf) if here else None
            for found, counts in spmd.run_jobs(
                _forage, tasks, call.executor, self, instance, behind, np.uint64(call.seed), ended
            ):
                archive = archives.taken(archive, found, self.size)
                work += counts
            done += 1
        return Found(
            paths=archives.split(archive),
            notes=archives.left_out(archive, instance),
            stopped_by=ending or StoppedBy.SCHEDULE,
            work={
                "walks": int(work[0]),
                "arrived": int(work[1]),
                "looks": int(work[2]),
                "splices": int(work[3]),
                "searches": self.colonies * done + instance.k,
            },
        )

    def _task(
        self,
        archive: archive_kernels.Archive,
        ranges: NDArray[np.int64],
        share: NDArray[np.float64],
        chance: np.random.Generator,
        number: int,
    ) -> Task:
        """Pick the paths that suit the weights."""
        weights = scaled(share, ranges)
        places = archive_kernels.listed(archive)
        order = np.argsort(archive.values[places] @ weights, kind="stable")
        near = order[: (self.known + 1) // 2]
        others = chance.permutation(order[len(near) :])[: self.known // 2]
        chosen = places[np.append(near, others)]
        nodes = archive_kernels.gathered(archive, chosen)
        first = np.append(0, np.cumsum(archive.length[chosen], dtype=np.int64))
        return Task(number, weights, nodes, first, len(near), archive._replace(pool=np.empty(0, np.int32)))


def _spread(k: int, chance: np.random.Generator) -> Iterator[NDArray[np.float64]]:
    """Weights without end, each with the sum 1: in turn of all objectives, and of some drawn ones."""
    while True:
        yield simplex(chance, k)
        some = chance.permutation(k)[: chance.integers(1, k + 1)]
        share = np.zeros(k)
        share[some] = simplex(chance, len(some))
        yield share


def _forage(
    task: Task,
    method: Colonies,
    instance: Instance,
    behind: NDArray[np.int64],
    seed: np.uint64,
    ended: Callable[[], object] | None,
) -> tuple[archives.Paths, NDArray[np.int64]]:
    """One colony's round: paths that it found, and counts of its work; nothing where the run has ended before it."""
    if ended and ended():
        return archives.none(instance.k), np.zeros(4, np.int64)
    neighbours, costs, turns = instance.arrays
    start, goal = instance.start, instance.goal
    slack = int(_SLACKS[task.number % len(_SLACKS)] * SCALE)
    prices, corners = front_kernels.weighed(costs, turns, task.weights)
    ways = front_kernels.ways_home(neighbours, costs, turns, prices, corners, task.weights, behind, start, goal, slack)
    home = archive_kernels.Home(prices, corners, *ways)
    network = archive_kernels.Network(neighbours, costs, turns, start, goal)
    archive = archives.sketch(task.archive, _ROOM + len(neighbours))
    work = np.zeros(4, np.int64)
    heats = np.array([max(1, int(share * SCALE)) for share in _HEATS])
    known = (task.nodes, task.first)
    tau = archive_kernels.pheromone(network, *known, task.near, float(method.alpha))
    archive_kernels.walk(network, home, archive, tau, heats, decay_table(), slack, method.ants, seed, task.number, work)
    archive_kernels.stray(network, home, archive, *known, work)
    archive_kernels.splice(network, archive, *known, method.pairs, seed, task.number, work)
    return archives.paths_of(archive), work
