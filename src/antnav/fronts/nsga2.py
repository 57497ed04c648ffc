"""NSGA-II on control points: the genetic algorithm that fronts are usually looked for with, by the library pygmo."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.kernels import front_kernels, grid_kernels, walk_kernels
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.rivals.encoding import corners_of, nearest_cells
from antnav.rivals.metaheuristics import pygmo_library
from antnav.values import whole_in
from antnav.world.path_cost import FREE


@dataclass(frozen=True)
class Nsga2(Method):
    """NSGA-II (Deb, Pratap, Agarwal & Meyarivan 2002) on control points that shortest paths join.

    A vector is (row_1, col_1, ..., row_k, col_k). Each point becomes the nearest cell that can be reached, and an exact
    search by length joins start, points and goal, so that every vector is a path. Crossover and mutation as in the
    paper: simulated binary and polynomial, both of index 20, with probability 0.9, and 1 / 2k for each number.

    Parameters
    ----------
    points : int
        Control points k, 1 to 100. Sane: 2 to 8; more on mazes.
    population : int
        A multiple of 4, 8 to 10,000. Sane: 40 to 200.
    generations : int
        After the first, random one, 0 to 1,000,000.
    """

    points: int = 4
    population: int = 100
    generations: int = 100
    extra: ClassVar[str] = "rivals"

    def __post_init__(self) -> None:
        whole_in("points", self.points, 1, 100)
        whole_in("population", self.population, 8, 10_000)
        whole_in("generations", self.generations, 0, 1_000_000)
        if self.population % 4:
            raise ParameterError(f"population {shown(self.population)}", "it is a multiple of 4", "give 100")

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "nsga2"

    @property
    def certainty(self) -> str:
        """Whose algorithm it is, and what is ours."""
        return (
            "[ours]: pygmo's NSGA-II (Deb, Pratap, Agarwal & Meyarivan 2002) on antnav's control points; no paper's "
            "planner is reproduced"
        )

    def versions(self) -> dict[str, str]:
        """That of pygmo."""
        return {"pygmo": pygmo_library().__version__}

    def find(self, instance: Instance, call: Call) -> Found:
        """Let generations follow each other; all paths that were tried count, not the last generation's alone."""
        pygmo = pygmo_library()
        trials = _Trials(instance, self.points)
        trials.fitness(np.tile(instance.graph.cells[instance.start], self.points))
        first, second = (int(word) for word in np.random.SeedSequence(call.seed).generate_state(2))
        ending = call.ending(0, math.inf)
        if ending is None:
            population = pygmo.population(pygmo.problem(trials), self.population, seed=first)
            mutation = 1 / (2 * self.points)
            algorithm = pygmo.algorithm(pygmo.nsga2(gen=1, cr=0.9, eta_c=20, m=mutation, eta_m=20, seed=second))
            for generation in range(1, self.generations + 1):
                ending = call.ending(generation, math.inf)
                if ending:
                    break
                population = algorithm.evolve(population)
                trials.prune()
        return Found(
            paths=list(trials.paths.values()),
            stopped_by=ending or StoppedBy.SCHEDULE,
            work={"evaluations": trials.count},
        )


class _Trials:
    """What a vector is worth, as pygmo asks; keeps the path of every vector of values that may belong to the front."""

    def __init__(self, instance: Instance, points: int) -> None:
        graph = instance.graph
        shape = (len(graph.moves) // graph.width - 2, graph.width - 2)
        reachable = np.zeros(shape, np.bool_)
        reachable[tuple(graph.cells.T)] = True
        self._instance, self._bounds = instance, corners_of(shape, points)
        self._nearest = nearest_cells(reachable)
        self._ends = int(graph.flat[instance.start]), int(graph.flat[instance.goal])
        self.paths: dict[tuple[int, ...], NDArray[np.int32]] = {}
        self.count = 0

    def __deepcopy__(self, memo: dict[int, Any]) -> _Trials:
        """Pygmo copies what it minimises; there must be one account."""
        return self

    def get_bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self._bounds

    def get_nobj(self) -> int:
        return self._instance.k

    def fitness(self, vector: NDArray[np.float64]) -> NDArray[np.float64]:
        graph = self._instance.graph
        stops = walk_kernels.stops_of(np.asarray(vector, np.float64), self._nearest, *self._ends)
        flat, _ = grid_kernels.joined(graph.moves, graph.width, stops, FREE)
        nodes = np.searchsorted(graph.flat, flat).astype(np.int32)
        steps: NDArray[np.int64] = self._instance.steps([nodes])[0]
        self.count += 1
        self.paths.setdefault(tuple(steps.tolist()), nodes)
        return steps.astype(np.float64)

    def prune(self) -> None:
        """Forget what others beat."""
        found = sorted(self.paths)
        kept = front_kernels.undominated(np.array(found, np.int64))
        self.paths = {steps: self.paths[steps] for steps, good in zip(found, kept.tolist(), strict=True) if good}
