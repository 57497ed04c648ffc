"""Algorithm: ants as a planner."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np

from antnav.ants import warmup
from antnav.ants.accounts import heat, joined_history, memory
from antnav.ants.run import carried_out
from antnav.ants.strategies import Context, Found, improved
from antnav.colony import own
from antnav.colony.parameters import Settings
from antnav.errors import ParameterError
from antnav.planner.call import Call
from antnav.planner.facts import Knows
from antnav.planner.plan import Plan, Status, StoppedBy
from antnav.planner.planner import KINDS, Planner, Recorded
from antnav.search.abstraction import Abstraction
from antnav.world.problem import Problem


class Algorithm(Settings, Planner):  # noqa: D101 - that of its base
    # no dataclass of its own: it has the fields of its base, and each dataclass costs half a millisecond at import
    __doc__ = Settings.__doc__

    kind: ClassVar[str] = "ants"

    @property
    def outline(self) -> str:
        """Name and heuristic."""
        return f"{self.name}, heuristic {self.heuristic}"

    @property
    def schedule(self) -> str:
        """Iterations and ants."""
        return f" of {self.iterations}, {self.ants} ants"

    @property
    def remembers(self) -> bool:
        """Ants on cells do; a graph of regions is another for each query."""
        return not self.coarse

    def prepare(self, problem: Problem | None = None) -> float:
        """Compile the kernels that it needs; work out the graph of the map, or its abstraction."""
        rules = own.rules_of(self)
        asks, walking = bool(rules), own.asked_walking(rules)
        seconds = warmup.kernels(
            windows=self.windows > 0,
            regions=self.coarse > 0,
            ants=not (asks or self.searches),
            searches=self.searches and not asks,
            own=asks and not walking,
            walking=walking,
            gaps=Knows.GAPS in self.knows,
        )
        own.prepare(self)
        if problem is not None and self.windows and problem.objective.plain:
            _ = problem.terrain.jumps
        if problem is not None and self.coarse:
            Abstraction.of(problem.terrain, self.coarse)
        elif problem is not None:
            _ = problem.graph
        return seconds

    @property
    def walks(self) -> int:
        """Walks of all ants of all colonies.

        Where no ant arrives in stage one, or a level has no cell, a run has others.
        """
        if self.coarse:
            return 2 * self.ants * self.iterations
        if self.decomposition is None:
            return self.ants * self.iterations * self.colonies
        stage_one, pieces = self.decomposition.stage_one, self.decomposition.pieces
        return self.ants * (2 * stage_one + pieces * (self.iterations - stage_one))

    def with_walks(self, wanted: int) -> Self:
        """With iterations of about so many walks: ants, stage one and pieces stay, so that their count is rounded."""
        split, rounds = self.decomposition, wanted / self.ants
        if self.coarse:
            return replace(self, iterations=max(1, round(rounds / 2)))
        if split is None:
            return replace(self, iterations=max(1, round(rounds / self.colonies)))
        rest = round((rounds - 2 * split.stage_one) / split.pieces)
        if rest < 1:
            raise ParameterError(
                f"{self.name} with {wanted} ant walks",
                f"stage one alone has {2 * split.stage_one * self.ants}",
                "give the baseline more iterations, or this one fewer ants",
            )
        return replace(self, iterations=split.stage_one + rest)

    def plan(self, problem: Problem, call: Call) -> Plan:
        """Let its colonies walk."""
        run = Context(problem, self, call)
        try:
            found = improved(run, carried_out(run))
        except BaseException:
            call.cancel.failed = True  # colonies in other threads end at their next look
            raise
        return told(run, found)


def read(document: dict[str, Any]) -> Planner:
    """The algorithm of a document; `Recorded` where a rule in it is a user's that nobody has registered here."""
    return Algorithm.of(document) if Algorithm.can_be_made(document) else Recorded(document)


KINDS["ants"] = read


def told(run: Context, found: Found) -> Plan:
    """What is told about a run that is over."""
    seconds, problem = run.call.began.seconds(), run.problem
    status = Status.FOUND if found.flat is not None else Status.NO_ANT_ARRIVED
    if not found.reachable:
        status = Status.UNREACHABLE
    ending = StoppedBy.CRITERION if run.stopped else StoppedBy.SCHEDULE
    auxiliary = None if found.auxiliary is None else problem.graph.cells[found.auxiliary]
    return Plan(
        cells=None if found.flat is None else problem.from_flat(found.flat).astype(np.int32),
        status=status,
        stopped_by=StoppedBy.CANCELLED if run.call.cancel.is_set() else ending,
        auxiliary_cell=None if auxiliary is None else (int(auxiliary[0]), int(auxiliary[1])),
        stages=tuple(stage.stage() for stage in run.runs),
        history=joined_history(run.runs),
        estimated=run.algorithm.coarse > 0,
        heat=heat(problem, run.runs, run.algorithm.coarse),
        memory=memory(problem, run.runs, run.algorithm.tau0, found.flat, run.call.warm) if run.call.remember else None,
        notes=tuple(run.notes),
        seconds=seconds,
        cpu_seconds=sum(outcome.cpu_seconds for stage in run.runs for outcome in stage.outcomes),
    )
