"""Study: which algorithms run on which maps under which seeds; from Python, or from a TOML file."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from antnav.errors import ParameterError
from antnav.planner.planner import Planner, identity
from antnav.planner.result import versions
from antnav.run.stop import Seconds
from antnav.study.budget import Budget, with_walks
from antnav.study.sources import sources
from antnav.values import check_seed
from antnav.world.problem import Problem

#: Runs of one study, so that a slip in a count or a sweep is refused and not run for years.
MAX_RUNS = 1_000_000


@dataclass(frozen=True)
class MapEntry:
    """A map with its start, goal and rules, under the name that tables show.

    `source` is what the study's file says of it: where it comes from, its ends if they are given, the robot's radius.
    """

    label: str
    problem: Problem
    source: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class AlgorithmEntry:
    """A planner, of ants or without, under the name that tables show."""

    label: str
    algorithm: Planner


@dataclass(frozen=True)
class Sweep:
    """Algorithms that differ in some parameters; `points` holds the values of these by the algorithm's label."""

    name: str
    points: Mapping[str, Mapping[str, float | str]]


@dataclass(frozen=True)
class Job:
    """One run of a study; `key` is the digest of everything that decides its outcome.

    With `budget` it ends when it has used what the run of key `reference` used of it, which is done before; `allowed`
    is that, once it is known.
    """

    key: str
    map_label: str
    algorithm_label: str
    problem: Problem
    algorithm: Planner
    seed: int
    seconds: float | None = None
    budget: Budget | None = None
    reference: str = ""
    allowed: float = math.inf


@dataclass(frozen=True)
class Study:
    """Every algorithm on every map under every seed.

    Attributes
    ----------
    title : str
    maps : sequence of MapEntry
    algorithms : sequence of AlgorithmEntry
    seeds : sequence of int
        The same for all, so that runs can be compared in pairs.
    sweeps : sequence of Sweep
        Which of the algorithms belong together in a heat map.
    baseline : str or None
        The algorithm that each other one is compared with. None: each with each, of many the first with the others.
    seconds : float or None
        Time limit of a run, > 0; the outcome then depends on the machine. None: the algorithms' own schedules.
    equal_budget : Budget or str or None
        In what every algorithm gets as much as the baseline, or without one as the first algorithm. "walks": their
        iterations are replaced. "steps", "seconds": each run ends with what the baseline's of the same map and seed
        used. None: each has its own schedule.
    text : str
        The file that it was read from, to be kept beside the results.

    Raises
    ------
    ParameterError
        One of them is empty or has the same label or seed twice; a bad seed, baseline, limit or budget; more than
        `MAX_RUNS` runs.
    """

    title: str
    maps: Sequence[MapEntry]
    algorithms: Sequence[AlgorithmEntry]
    seeds: Sequence[int]
    sweeps: Sequence[Sweep] = ()
    baseline: str | None = None
    seconds: float | None = None
    text: str = ""
    equal_budget: Budget | None = None

    def __post_init__(self) -> None:
        runs = len(self.maps) * len(self.algorithms) * len(self.seeds)
        if runs > MAX_RUNS:
            raise ParameterError(f"a study of {runs} runs", f"it has at most {MAX_RUNS}", "divide it")
        object.__setattr__(self, "maps", tuple(self.maps))
        object.__setattr__(self, "algorithms", tuple(self.algorithms))
        object.__setattr__(self, "seeds", tuple(check_seed(seed) for seed in self.seeds))
        names = [entry.label for entry in self.algorithms]
        _check_distinct("map", [entry.label for entry in self.maps])
        _check_distinct("algorithm", names)
        _check_distinct("seed", self.seeds)
        if self.baseline is not None and self.baseline not in names:
            rule = "it is the label of one of the algorithms"
            raise ParameterError(f"baseline {self.baseline!r}", rule, f"give one, such as {names[0]!r}")
        if self.seconds is not None:
            Seconds(self.seconds)  # checks it
        if self.equal_budget is not None:
            object.__setattr__(self, "equal_budget", Budget.of(self.equal_budget))
            self._check_budget()

    @property
    def reference(self) -> AlgorithmEntry:
        """The algorithm whose budget the others get: the baseline, or the first."""
        return next((entry for entry in self.algorithms if entry.label == self.baseline), self.algorithms[0])

    def _check_budget(self) -> None:
        """Give all the walks of the reference, or see that all have steps."""
        if self.equal_budget is Budget.WALKS:
            wanted = self.reference.algorithm.walks
            if wanted is None:
                rule, remedy = "it does not say how many paths it tries", "give seconds, or another baseline"
                raise ParameterError(f"{self.reference.label!r} with equal_budget walks", rule, remedy)
            equal = [AlgorithmEntry(one.label, with_walks(one.algorithm, wanted)) for one in self.algorithms]
            object.__setattr__(self, "algorithms", tuple(equal))
        for entry in self.algorithms:
            if self.equal_budget is Budget.STEPS and not entry.algorithm.ants:
                rule = "steps are moves of ants, and it has none"
                remedy = "give equal_budget walks or seconds, or leave it out"
                raise ParameterError(f"{entry.label!r} with equal_budget steps", rule, remedy)

    def jobs(self) -> list[Job]:
        """The runs in the order in which to do them.

        Under each seed all algorithms of a map follow each other, so that a machine that slows down meanwhile slows
        down all of them, and a study that is interrupted has done about as many runs of each.
        """
        pairs = [(entry, choice) for entry in self.maps for choice in self.algorithms]
        outcomes = [_outcome(entry.problem, choice.algorithm) for entry, choice in pairs]
        limit = "" if self.seconds is None else f" within {float(self.seconds)} s"
        jobs = [
            Job(
                _digest(f"{outcome} {seed}{limit}"),
                entry.label,
                choice.label,
                entry.problem,
                choice.algorithm,
                seed,
                self.seconds,
            )
            for seed in self.seeds
            for (entry, choice), outcome in zip(pairs, outcomes, strict=True)
        ]
        return jobs if self.equal_budget in (None, Budget.WALKS) else self._within_budget(jobs)

    def _within_budget(self, jobs: Sequence[Job]) -> list[Job]:
        """The jobs, those of other algorithms than the reference with its run as their budget."""
        name = self.reference.label
        references = {(job.map_label, job.seed): job.key for job in jobs if job.algorithm_label == name}
        found = []
        for job in jobs:
            key = references[job.map_label, job.seed]
            if job.key != key:
                own = _digest(f"{job.key} within the {self.equal_budget} of {key}")
                job = replace(job, key=own, budget=self.equal_budget, reference=key)  # noqa: PLW2901
            found.append(job)
        return found


def _check_distinct(what: str, values: Sequence[object]) -> None:
    if not values:
        raise ParameterError(f"no {what}s", "a study has maps, algorithms and seeds", "give at least one of each")
    name = what if what == "seed" else f"{what} label"
    seen: set[object] = set()
    for value in values:
        if value in seen:
            raise ParameterError(f"{name} {value!r} twice", f"each {name} stands for one thing", "change one of them")
        seen.add(value)


def _outcome(problem: Problem, planner: Planner) -> str:
    """Everything but the seed that decides the outcome of a run, as text: other code of antnav runs anew.

    Numbers are written as floats, so that beta = 7 is beta = 7.0.
    """
    choices = json.loads(json.dumps(identity(planner, problem.grid)), parse_int=float)
    query = [problem.grid.digest, problem.start_cell, problem.goal_cell, problem.corner_rule, problem.allow_unknown]
    query += [problem.objective.key]
    return json.dumps([versions()["antnav"], sources(), query, choices], sort_keys=True)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
