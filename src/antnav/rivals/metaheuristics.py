"""Metaheuristics on the shared path encoding.

GA, PSO, SA and GWO are run by pygmo (the extra `rivals`), WOA, MFO, SMA and HHO by `antnav.rivals.swarms`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import StrEnum
from importlib import import_module
from typing import Any, ClassVar, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.rivals import swarms
from antnav.rivals.encoding import Encoding, Segments, check_encoding
from antnav.rivals.rival import Rival
from antnav.rivals.watch import Watch
from antnav.values import is_whole
from antnav.world.problem import Problem

T = TypeVar("T", bound=StrEnum)


class Method(StrEnum):
    """Which metaheuristic. The first four are pygmo's, of its version 2.20; the others need no extra.

    - ga: genetic algorithm: tournaments of 2, exponential crossover, polynomial mutation, mu + lambda
    - pso: particle swarm with constriction factor (Clerc & Kennedy 2002), local best of 4 neighbours
    - sa: simulated annealing with adaptive ranges (Corana et al. 1987)
    - gwo: grey wolf optimizer (Mirjalili et al. 2014)
    - woa: whale optimization algorithm (Mirjalili & Lewis 2016)
    - sma: slime mould algorithm (Li et al. 2020)
    - mfo: moth-flame optimization (Mirjalili 2015)
    - hho: Harris hawks optimization (Heidari et al. 2019)
    """

    GA = "ga"
    PSO = "pso"
    SA = "sa"
    GWO = "gwo"
    WOA = "woa"
    SMA = "sma"
    MFO = "mfo"
    HHO = "hho"

    @property
    def from_pygmo(self) -> bool:
        """Whether pygmo runs it."""
        return self not in swarms.ALGORITHMS


@dataclass(frozen=True, kw_only=True)
class Metaheuristic(Rival):
    """A metaheuristic that searches for control points.

    Parameters
    ----------
    method : Method
    segments : Segments
        How control points are joined.
    points : int
        Control points k, >= 1; the search has 2 k dimensions. Sane: 3 to 10; more on mazes.
    penalty : float
        Cells for each illegal move, > 0. Sane: 3 to 50. Too low, and shortcuts through walls win; too high, and the
        search cannot cross a wall to better ground.
    population : int
        Individuals, >= 6; for `sa` the random vectors of which the best is annealed. Also how many evaluations make one
        entry of the history. Sane: 20 to 100.
    evaluations : int
        Budget, >= 5 populations: vectors whose cost is worked out. Every run uses at most that many.
    """

    method: Method
    segments: Segments = Segments.STRAIGHT
    points: int = 5
    penalty: float = 10.0
    population: int = 50
    evaluations: int = 10_000
    kind: ClassVar[str] = "metaheuristic"

    def __post_init__(self) -> None:
        object.__setattr__(self, "method", _member(Method, self.method))
        object.__setattr__(self, "segments", _member(Segments, self.segments))
        check_encoding(self.points, self.penalty)
        if not is_whole(self.population) or self.population < 6:
            rule = "at least 6 individuals are needed, a whole number"
            raise ParameterError(f"population {shown(self.population)}", rule, "give 50")
        if not is_whole(self.evaluations) or self.evaluations < 5 * self.population:
            raise ParameterError(
                f"{shown(self.evaluations)} evaluations of a population of {shown(self.population)}",
                "the budget must be at least 5 populations, a whole number",
                "give more evaluations or a smaller population",
            )

    @property
    def name(self) -> str:
        """Method and segments, as in "pso-straight"."""
        return f"{self.method}-{self.segments}"

    @property
    def certainty(self) -> str:
        """Whose algorithm it is, and what is ours."""
        source = "pygmo's algorithms with its defaults" if self.method.from_pygmo else "the papers' formulas"
        return f"[ours]: {source} on antnav's encoding; no paper's planner is reproduced"

    @property
    def walks(self) -> int:
        """Evaluations."""
        return self.evaluations

    def with_walks(self, wanted: int) -> Self:
        """With so many evaluations."""
        return replace(self, evaluations=wanted)

    def versions(self) -> dict[str, str]:
        """That of pygmo, where it runs."""
        return {"pygmo": pygmo_library().__version__} if self.method.from_pygmo else {}

    def search(self, problem: Problem, seed: int, watch: Watch) -> str:
        """Search until the budget is spent; returns why there is no path, "" where there is one."""
        encoding = Encoding(problem, self.points, self.segments, self.penalty)
        objective = _Objective(encoding, watch, self.population)
        if self.method.from_pygmo:
            self._evolve(objective, seed)
        else:
            swarms.minimise(
                self.method,
                objective.cost,
                encoding.bounds,
                population=self.population,
                evaluations=self.evaluations,
                seed=seed,
            )
        if math.isfinite(watch.best):
            return ""
        return f"none of {watch.steps} vectors was feasible; the best one makes {objective.least_illegal} illegal moves"

    def _evolve(self, objective: _Objective, seed: int) -> None:
        pygmo = pygmo_library()
        first, second = (int(word) for word in np.random.SeedSequence(seed).generate_state(2))
        population = pygmo.population(pygmo.problem(objective), self.population, seed=first)
        pygmo.algorithm(self._algorithm(pygmo, second)).evolve(population)

    def _algorithm(self, pygmo: Any, seed: int) -> Any:
        generations = self.evaluations // self.population - 1
        match self.method:
            case Method.GA:
                return pygmo.sga(gen=generations, m=1 / (2 * self.points), seed=seed)
            case Method.PSO:
                return pygmo.pso(gen=generations, seed=seed)
            case Method.GWO:
                return pygmo.gwo(gen=generations, seed=seed)
            case Method.SA:
                return pygmo.simulated_annealing(**self._annealing(), seed=seed)
            case _:
                raise AssertionError(self.method)

    def _annealing(self) -> dict[str, float]:
        """From one penalty down to 0.01 cells; as many temperatures as the budget allows."""
        bin_size, ranges = 10, 2
        moves = 2 * self.points * bin_size * ranges  # evaluations at one temperature
        temperatures = max(1, (self.evaluations - self.population) // moves)
        return {
            "Ts": self.penalty,
            "Tf": min(0.01, self.penalty),
            "n_T_adj": temperatures,
            "n_range_adj": ranges,
            "bin_size": bin_size,
        }


class _Objective:
    """The cost, also as pygmo calls it; tells the watch of every feasible vector and every full generation."""

    def __init__(self, encoding: Encoding, watch: Watch, generation: int) -> None:
        self.encoding, self.watch, self.generation = encoding, watch, generation
        self.least_illegal = np.iinfo(np.int64).max

    def __deepcopy__(self, memo: dict[int, Any]) -> _Objective:
        """Pygmo copies what it minimises; there must be one account."""
        return self

    def get_bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self.encoding.bounds

    def fitness(self, vector: NDArray[np.float64]) -> list[float]:
        return [self.cost(vector)]

    def cost(self, vector: NDArray[np.float64]) -> float:
        walk = self.encoding.walk(vector)
        self.watch.steps += 1
        self.least_illegal = min(self.least_illegal, walk.illegal)
        if walk.illegal == 0:
            self.watch.found(walk.length, walk.cells)
        if self.watch.steps % self.generation == 0:
            self.watch.iteration()
        return self.encoding.cost_of(walk)


def _member(kind: type[T], value: str) -> T:
    try:
        return kind(value)
    except ValueError:
        names = ", ".join(kind)
        raise ParameterError(f"{kind.__name__.lower()} {shown(value)}", f"it is one of {names}", "choose one") from None


def pygmo_library() -> Any:
    """The library, which is imported when it is needed: that takes a second.

    Raises
    ------
    ParameterError
        It is not installed.
    """
    try:
        return import_module("pygmo")
    except ImportError as error:
        raise ParameterError(
            "what pygmo runs",
            "pygmo is not installed",
            'pip install "antnav[rivals]" on Linux, conda install -c conda-forge pygmo elsewhere',
        ) from error
