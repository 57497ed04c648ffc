"""Study: which algorithms run on which maps under which seeds; from Python, or from a TOML file."""

from __future__ import annotations

import hashlib
import json
import math
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

from antnav.errors import ParameterError
from antnav.plan.solve import solve
from antnav.plan.warmup import warmup
from antnav.planner.facts import Certainty
from antnav.planner.plan import StoppedBy
from antnav.planner.planner import Planner, identity
from antnav.planner.result import Result, versions
from antnav.run.stop import Iterations, Seconds, Stop
from antnav.search import exact
from antnav.study.budget import Budget, with_walks
from antnav.study.record import Kept, Mark, Record
from antnav.study.sources import sources
from antnav.values import check_seed
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Problem

R = TypeVar("R", bound=Kept)

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
class AnyJob(Generic[R]):
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

    @property
    def stop(self) -> Stop | None:
        """What ends it in time."""
        limits = [self.seconds, self.allowed if self.budget is Budget.SECONDS else None]
        seconds = min((limit for limit in limits if limit is not None), default=None)
        return None if seconds is None else Seconds(seconds)

    def ending(self, seconds: float, *, exceeded: bool = False) -> Mark:
        """Which limit ended a run of so many seconds; `exceeded`: it spent more than its budget."""
        if exceeded:
            return Mark.EXCEEDED
        in_time = self.seconds is None or seconds < self.seconds
        return Mark.SPENT if self.budget is not None and in_time else Mark.LIMITED

    @property
    def shared(self) -> tuple[object, ...]:
        """What other jobs hold, too: it travels once to a worker."""
        return self.problem, self.algorithm

    def prepare(self) -> None:
        """Do beforehand what runs on one map share, so that the first one's time does not hold it."""
        self.algorithm.prepare(self.problem)

    def run(self, executor: Executor | None, cancel: threading.Event) -> R | None:
        """Do it; None once cancelled."""
        raise NotImplementedError

    @property
    def certainty(self) -> Certainty:
        """How sure it is that the algorithm is what its name says, on this map."""
        return Certainty.of(self.algorithm.suited(self.problem).certainty)

    def labelled(self, record: R, certainty: Certainty) -> R:
        """Its record under its labels: it may stem from another study, or from a job of another name."""
        labels = self.map_label, self.algorithm_label, certainty
        if (record.map, record.algorithm, record.certainty) == labels:
            return record
        return replace(record, map=self.map_label, algorithm=self.algorithm_label, certainty=certainty)


@dataclass(frozen=True)
class Job(AnyJob[Record]):
    """A run that looks for a path."""

    def prepare(self) -> None:
        """See `AnyJob.prepare`: the optimum, too."""
        exact.optimum(self.problem)
        super().prepare()

    def run(self, executor: Executor | None, cancel: threading.Event) -> Record | None:
        """Do it; None once cancelled."""
        result, stop = self._solved(self.stop, executor, cancel), self.stop
        within = int((result.history.steps.cumsum() <= self.allowed).sum()) if self.budget is Budget.STEPS else math.inf
        if within < result.iterations:  # again, up to there: the same seed makes the same steps
            ends = Iterations(max(1, int(within)))
            result = self._solved(ends if stop is None else stop | ends, executor, cancel)
        if result.stopped_by is StoppedBy.CANCELLED:
            return None
        if result.path is not None:
            check_path(result.path, self.problem)
            check_cost(result.path, self.problem, result.cost)
        record = Record.of(result, key=self.key, map_label=self.map_label, algorithm_label=self.algorithm_label)
        exceeded = self.budget is Budget.STEPS and result.steps > self.allowed
        limited = result.stopped_by is StoppedBy.CRITERION
        return replace(record, marks=(self.ending(result.seconds_run, exceeded=exceeded),) if limited else ())

    def _solved(self, stop: Stop | None, executor: Executor | None, cancel: threading.Event) -> Result:
        return solve(self.problem, self.algorithm, seed=self.seed, stop=stop, executor=executor, cancel=cancel)


@dataclass(frozen=True)
class AnyStudy(Generic[R]):
    """Every algorithm on every map under every seed, whatever they are to find.

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
                rule = "it does not say how many paths it tries"
                remedy = "give its class a property walks, or give seconds, or another baseline"
                raise ParameterError(f"{self.reference.label!r} with equal_budget walks", rule, remedy)
            equal = [AlgorithmEntry(one.label, with_walks(one.algorithm, wanted)) for one in self.algorithms]
            object.__setattr__(self, "algorithms", tuple(equal))
        for entry in self.algorithms:
            if self.equal_budget is Budget.STEPS and not entry.algorithm.ants:
                rule = "steps are moves of ants, and it has none"
                remedy = "give equal_budget walks or seconds, or leave it out"
                raise ParameterError(f"{entry.label!r} with equal_budget steps", rule, remedy)

    @property
    def keeps(self) -> type[R]:
        """What is kept of a run."""
        raise NotImplementedError

    def warmup(self) -> float:
        """Compile what the runs need, or load it; seconds that it took."""
        return warmup()

    def _outcome(self, place: MapEntry, planner: Planner) -> str:
        """Everything but the seed and limits that decides the outcome of a run, as text."""
        return outcome(place.problem, planner)

    def _drawn(self, planner: Planner, seed: int) -> str:
        """The part of the seed in that."""
        return str(seed)

    def _job(self, key: str, place: MapEntry, choice: AlgorithmEntry, seed: int) -> AnyJob[R]:
        raise NotImplementedError

    def jobs(self) -> list[AnyJob[R]]:
        """The runs in the order in which to do them.

        Under each seed all algorithms of a map follow each other, so that a machine that slows down meanwhile slows
        down all of them, and a study that is interrupted has done about as many runs of each.
        """
        pairs = [(place, choice) for place in self.maps for choice in self.algorithms]
        outcomes = [self._outcome(place, choice.algorithm) for place, choice in pairs]
        limit = "" if self.seconds is None else f" within {float(self.seconds)} s"
        jobs = [
            self._job(_digest(f"{outcome} {self._drawn(choice.algorithm, seed)}{limit}"), place, choice, seed)
            for seed in self.seeds
            for (place, choice), outcome in zip(pairs, outcomes, strict=True)
        ]
        return jobs if self.equal_budget in (None, Budget.WALKS) else self._within_budget(jobs)

    def _within_budget(self, jobs: Sequence[AnyJob[R]]) -> list[AnyJob[R]]:
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


@dataclass(frozen=True)
class Study(AnyStudy[Record]):
    """A study of paths; see `AnyStudy`."""

    @property
    def keeps(self) -> type[Record]:
        """See `AnyStudy.keeps`."""
        return Record

    def _job(self, key: str, place: MapEntry, choice: AlgorithmEntry, seed: int) -> Job:
        return Job(key, place.label, choice.label, place.problem, choice.algorithm, seed, self.seconds)


def _check_distinct(what: str, values: Sequence[object]) -> None:
    if not values:
        raise ParameterError(f"no {what}s", "a study has maps, algorithms and seeds", "give at least one of each")
    name = what if what == "seed" else f"{what} label"
    seen: set[object] = set()
    for value in values:
        if value in seen:
            remedy = "remove one" if what == "seed" else 'give one of them label = "..."'
            raise ParameterError(f"{name} {value!r} twice", f"each {name} stands for one thing", remedy)
        seen.add(value)


def outcome(problem: Problem, planner: Planner) -> str:
    """Everything but the seed that decides the outcome of a run, as text: other code of antnav runs anew.

    Numbers are written as floats, so that beta = 7 is beta = 7.0.
    """
    choices = json.loads(json.dumps(identity(planner, problem)), parse_int=float)
    query = [problem.grid.digest, problem.start_cell, problem.goal_cell, problem.corner_rule, problem.allow_unknown]
    query += [problem.objective.key]
    return json.dumps([versions()["antnav"], sources(), query, choices], sort_keys=True)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
