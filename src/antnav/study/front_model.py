"""FrontStudy: which methods look for fronts, on which maps, for which objectives, under which seeds."""

from __future__ import annotations

import hashlib
import json
import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from antnav.errors import ParameterError, shown
from antnav.fronts import indicators
from antnav.fronts.instance import Instance
from antnav.fronts.method import Method
from antnav.fronts.pareto import check_unpriced, pareto, warmup
from antnav.objectives.objective import Objective, check_objectives
from antnav.planner.facts import Certainty
from antnav.planner.plan import StoppedBy
from antnav.planner.planner import Planner, code_outside
from antnav.study.front_record import FrontRecord
from antnav.study.model import AlgorithmEntry, AnyJob, AnyStudy, MapEntry
from antnav.world.grid import GridMap
from antnav.world.path import check_path
from antnav.world.problem import Problem


@dataclass(frozen=True)
class FrontPlanner(Planner):
    """A method of fronts as studies know planners: by its name, its parameters and its certainty. It plans no path."""

    method: Method

    @property
    def name(self) -> str:
        """The method's."""
        return self.method.name

    @property
    def certainty(self) -> str:
        """The method's."""
        return self.method.certainty

    @property
    def kind(self) -> str:
        """The method's class."""
        return f"{type(self.method).__module__}.{type(self.method).__qualname__}"

    def prepare(self, problem: Problem | None = None) -> float:
        """Compile and import what it needs."""
        return warmup(self.method)

    def versions(self) -> dict[str, str]:
        """The method's, and digests of its code where it is from outside antnav."""
        outside = {f"code {i}": str(digest) for i, digest in enumerate(code_outside(type(self.method)))}
        return self.method.versions() | outside

    def document(self) -> dict[str, Any]:
        """The method's parameters."""
        return {"kind": self.kind, "certainty": self.certainty} | self.method.document()

    def on(self, grid: GridMap) -> FrontPlanner:
        """As it is."""
        return self


def method_of(planner: Planner) -> Method:
    """The method of an entry, or a `ParameterError`."""
    if not isinstance(planner, FrontPlanner):
        remedy = "give FrontPlanner(method), a method of antnav.fronts"
        raise ParameterError(f"algorithm {shown(planner)}", "a study of fronts compares methods of fronts", remedy)
    return planner.method


@dataclass(frozen=True)
class FrontJob(AnyJob[FrontRecord]):
    """A run that looks for a front."""

    objectives: tuple[Objective, ...] = ()

    @property
    def shared(self) -> tuple[object, ...]:
        """See `AnyJob.shared`."""
        return *super().shared, self.objectives

    def run(self, executor: Executor | None, cancel: threading.Event) -> FrontRecord | None:
        """See `AnyJob.run`."""
        front = pareto(
            self.problem,
            self.objectives,
            algorithm=method_of(self.algorithm),
            seed=self.seed,
            stop=self.stop,
            executor=executor,
            cancel=cancel,
        )
        if front.stopped_by is StoppedBy.CANCELLED:
            return None
        for path in front.paths:
            check_path(path, self.problem)
        record = FrontRecord.of(front, key=self.key, map_label=self.map_label, algorithm_label=self.algorithm_label)
        limited = front.stopped_by is StoppedBy.CRITERION
        return replace(record, marks=(self.ending(front.seconds_run),) if limited else ())

    def labelled(self, record: FrontRecord, certainty: Certainty) -> FrontRecord:
        """See `AnyJob.labelled`: one run of a method that draws nothing at random stands for all seeds."""
        return replace(super().labelled(record, certainty), seed=self.seed)


@dataclass(frozen=True)
class FrontStudy(AnyStudy[FrontRecord]):
    """Every method on every map under every seed; see `AnyStudy`. Its algorithms are `FrontPlanner`.

    Attributes
    ----------
    objectives : mapping of str to sequence of Objective
        By map label, 2 to 6.

    Raises
    ------
    ParameterError
        As `AnyStudy`; no such objectives, a problem with costs of its own, an algorithm that is no method of fronts.
    """

    objectives: Mapping[str, Sequence[Objective]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for entry in self.algorithms:
            method_of(entry.algorithm)
        super().__post_init__()
        checked = {place.label: check_objectives(self.objectives.get(place.label)) for place in self.maps}
        object.__setattr__(self, "objectives", checked)
        for place in self.maps:
            check_unpriced(place.problem)

    @property
    def keeps(self) -> type[FrontRecord]:
        """See `AnyStudy.keeps`."""
        return FrontRecord

    def warmup(self) -> float:
        """See `AnyStudy.warmup`; also whether there are the libraries that methods and reports need."""
        indicators.require()
        for entry in self.algorithms:
            entry.algorithm.versions()  # whether its library is there
        return sum(entry.algorithm.prepare() for entry in self.algorithms)

    @cached_property
    def _prices(self) -> dict[str, str]:
        """Digest of all prices on each map, which are what a search knows of objectives."""
        return {place.label: _digest(place.problem, self.objectives[place.label]) for place in self.maps}

    def _outcome(self, place: MapEntry, planner: Planner) -> str:
        return json.dumps([super()._outcome(place, planner), self._prices[place.label]])

    def _drawn(self, planner: Planner, seed: int) -> str:
        return super()._drawn(planner, seed) if method_of(planner).draws else "whatever the seed"

    def _job(self, key: str, place: MapEntry, choice: AlgorithmEntry, seed: int) -> FrontJob:
        objectives = tuple(self.objectives[place.label])
        return FrontJob(
            key, place.label, choice.label, place.problem, choice.algorithm, seed, self.seconds, objectives=objectives
        )


def _digest(problem: Problem, objectives: Sequence[Objective]) -> str:
    digest = hashlib.sha256()
    for objective, prices in zip(objectives, Instance.of(problem, objectives).prices, strict=True):
        digest.update(f"{objective.label!r} {prices.step!r} {prices.edges.shape}".encode())
        digest.update(prices.edges.tobytes() + prices.turns.tobytes())
    return digest.hexdigest()
