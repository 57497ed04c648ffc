"""DynamicStudy: which algorithms, with which memories, on which maps that change, under which seeds."""

from __future__ import annotations

import json
import threading
from concurrent.futures import Executor
from dataclasses import astuple, dataclass, field

import numpy as np

from antnav.errors import ParameterError
from antnav.plan.solve import solve
from antnav.planner.facts import Certainty
from antnav.planner.memory import Memory
from antnav.planner.plan import StoppedBy
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.report.environment import machine_name
from antnav.run.stop import Iterations
from antnav.search import exact
from antnav.study.changes import Changes
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.model import AlgorithmEntry, AnyJob, AnyStudy, MapEntry
from antnav.world.path import check_cost, check_path


@dataclass(frozen=True)
class DynamicJob(AnyJob[DynamicRecord]):
    """A run that goes on from change to change, each search with the memory of the one before."""

    changes: Changes = field(default_factory=Changes)

    @property
    def shared(self) -> tuple[object, ...]:
        """See `AnyJob.shared`."""
        return *super().shared, self.changes

    def run(self, executor: Executor | None, cancel: threading.Event) -> DynamicRecord | None:
        """See `AnyJob.run`."""
        memory: Memory | None = None
        results: list[Result] = []
        for number, problem in enumerate(self.changes.problems(self.problem, self.seed)):
            result = solve(
                problem,
                self.algorithm,
                seed=(self.seed + number * 0x9E3779B97F4A7C15) % 2**64,  # far apart, so that no seed meets another's
                stop=Iterations(self.changes.every),
                executor=executor,
                cancel=cancel,
                warm=memory,
                remember=True,
            )
            if result.stopped_by is StoppedBy.CANCELLED:
                return None
            if result.path is not None:
                check_path(result.path, problem)
                check_cost(result.path, problem, result.cost)
            memory = result.memory
            results.append(result)
        return DynamicRecord(
            key=self.key,
            map=self.map_label,
            algorithm=self.algorithm_label,
            seed=self.seed,
            optima=tuple(exact.optimum(result.problem).cost for result in results),
            best=tuple(_by_iteration(result, self.changes.every) for result in results),
            steps=sum(result.steps for result in results),
            seconds=sum(result.seconds_run for result in results),
            certainty=Certainty.of(results[0].algorithm.certainty),
            notes=tuple(dict.fromkeys(note for result in results for note in result.notes)),
            environment=results[0].versions | {"machine": machine_name()},
        )


def _by_iteration(result: Result, count: int) -> tuple[float | None, ...]:
    """Best cost so far of so many iterations; the last one stays where there were fewer."""
    best = np.minimum.accumulate(result.history.best)  # PACO's second stage begins anew
    held = np.append(best, np.full(count - len(best), best[-1] if len(best) else np.inf))
    return tuple(cost if np.isfinite(cost) else None for cost in held.tolist())


@dataclass(frozen=True)
class DynamicStudy(AnyStudy[DynamicRecord]):
    """Every algorithm on every map under every seed, each run over a sequence of changes; see `AnyStudy`.

    Attributes
    ----------
    changes : Changes

    Raises
    ------
    ParameterError
        As `AnyStudy`; an algorithm that remembers nothing, a map without a way, a time limit or an equal budget.
    """

    changes: Changes = field(default_factory=Changes)

    def __post_init__(self) -> None:
        super().__post_init__()
        for entry in self.algorithms:
            if not entry.algorithm.remembers:
                rule, remedy = "it remembers no pheromone", "give ants on cells, such as npaco"
                raise ParameterError(f"{entry.label!r} with changes", rule, remedy)
        for place in self.maps:
            if not place.problem.connected or place.problem.start_cell == place.problem.goal_cell:
                rule = "a map that changes has a start and a goal that differ and are connected"
                raise ParameterError(f"map {place.label!r}", rule, "give others")
        if self.seconds is not None or self.equal_budget is not None:
            rule = "all algorithms have the iterations that changes leave"
            raise ParameterError("seconds or equal_budget with changes", rule, "leave them out")

    @property
    def keeps(self) -> type[DynamicRecord]:
        """See `AnyStudy.keeps`."""
        return DynamicRecord

    def _outcome(self, place: MapEntry, planner: Planner) -> str:
        return json.dumps([super()._outcome(place, planner), astuple(self.changes)])

    def _job(self, key: str, place: MapEntry, choice: AlgorithmEntry, seed: int) -> DynamicJob:
        return DynamicJob(key, place.label, choice.label, place.problem, choice.algorithm, seed, changes=self.changes)
