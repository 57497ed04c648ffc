"""Record: what a study keeps of one run."""

from __future__ import annotations

from dataclasses import Field, dataclass, replace
from enum import StrEnum
from typing import Any, ClassVar, Protocol, TypeVar

from antnav.planner.facts import Certainty
from antnav.planner.result import Result
from antnav.report.environment import machine_name
from antnav.world.problem import CellIndex


class Mark(StrEnum):
    """What a study has to say of a run beside its result.

    - loaded: other runs ran beside it: its wall seconds are no measure
    - busy: the load average was above the number of cores when it ended: its wall seconds are too many
    - limited: the study's time limit ended it
    - spent: it ended with the budget of the study's baseline
    - exceeded: it has more steps than that budget, for a run does one iteration at least
    """

    LOADED = "loaded"
    BUSY = "busy"
    LIMITED = "limited"
    SPENT = "spent"
    EXCEEDED = "exceeded"

    @property
    def sentence(self) -> str:
        """As reports print it."""
        return _SENTENCES[self]


_SENTENCES = {
    Mark.LOADED: "other runs ran beside this one: its wall seconds are no measure",
    Mark.BUSY: "load average above the number of cores: its wall seconds are too many",
    Mark.LIMITED: "ended by the time limit",
    Mark.SPENT: "ended by the equal budget",
    Mark.EXCEEDED: "its first iteration alone exceeds the equal budget",
}


class Kept(Protocol):
    """What all records have, of whatever they are; `table` names their place in a store."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    table: ClassVar[str]

    @property
    def key(self) -> str: ...  # noqa: D102
    @property
    def map(self) -> str: ...  # noqa: D102
    @property
    def algorithm(self) -> str: ...  # noqa: D102
    @property
    def seed(self) -> int: ...  # noqa: D102
    @property
    def seconds(self) -> float: ...  # noqa: D102
    @property
    def certainty(self) -> Certainty: ...  # noqa: D102
    @property
    def notes(self) -> tuple[str, ...]: ...  # noqa: D102
    @property
    def marks(self) -> tuple[Mark, ...]: ...  # noqa: D102
    @property
    def environment(self) -> dict[str, str]: ...  # noqa: D102


R = TypeVar("R", bound=Kept)


def without_times(record: R) -> R:
    """The part of a record that is the same for all runs of one key."""
    marks = tuple(mark for mark in record.marks if mark not in {Mark.LOADED, Mark.BUSY})
    times = {name: 0.0 for name in ("seconds", "cpu_seconds") if name in record.__dataclass_fields__}
    return replace(record, marks=marks, environment={}, **times)


@dataclass(frozen=True, kw_only=True)
class Record:
    """One run, as it is stored and as statistics, tables and figures see it.

    Attributes
    ----------
    key : str
        Hexadecimal digest of everything that decides the outcome: code, map, ends, corner rule, algorithm, seed.
    map, algorithm : str
        Labels of the study.
    seed : int
    status : str
        A `Status`.
    length, cost, optimum : float or None
        In cells; None for infinity. Where the problem has no costs, cost is length; the optimum is of the cost.
    gap : float or None
        cost / optimum - 1; None without a path.
    turns, clearance : int or None, float or None
        Of the path; clearance in metres.
    iterations, walks, steps, critical_steps : int
        Iterations one after the other; paths that were tried (walks of all ants of all colonies, cost evaluations of a
        metaheuristic, descents of a potential field); moves of all ants; moves on the critical path.
    seconds, cpu_seconds : float
        Wall and CPU time of the ants. Only these and the environment differ between two runs of one key.
    auxiliary_cell : (row, col) or None
    path : tuple of (row, col) or None
    best, lost : tuple
        By iteration: best length so far in cells (None before the first arrival, and where only estimates are known),
        lost ants.
    certainty : Certainty
    knows : tuple of str
        Exact distances that were used, see `Knows`.
    notes : tuple of str
        Of its result.
    marks : tuple of Mark
        Of the study.
    environment : dict of str to str
        Versions of Python and libraries, and the machine.
    """

    table: ClassVar[str] = "records"

    key: str
    map: str
    algorithm: str
    seed: int
    status: str
    length: float | None
    cost: float | None
    optimum: float | None
    gap: float | None
    turns: int | None
    clearance: float | None
    iterations: int
    walks: int
    steps: int
    critical_steps: int
    seconds: float
    cpu_seconds: float
    auxiliary_cell: CellIndex | None
    path: tuple[CellIndex, ...] | None
    best: tuple[float | None, ...]
    lost: tuple[int, ...]
    certainty: Certainty
    knows: tuple[str, ...] = ()
    notes: tuple[str, ...]
    marks: tuple[Mark, ...] = ()
    environment: dict[str, str]

    @classmethod
    def of(cls, result: Result, *, key: str, map_label: str, algorithm_label: str) -> Record:
        """The record of a result, found on this machine, under a study's labels."""
        document = result.to_dict(map_cells=False)
        best = document["history"]["best"]
        if result.estimated:
            best = [None] * len(best)
        return cls(
            key=key,
            map=map_label,
            algorithm=algorithm_label,
            seed=result.seed,
            status=document["status"],
            length=document["length"],
            cost=document["cost"],
            optimum=document["optimum"],
            gap=document["gap"],
            turns=document["turns"],
            clearance=document["clearance_m"],
            iterations=result.iterations,
            walks=result.walks,
            steps=result.steps,
            critical_steps=result.critical_steps,
            seconds=result.seconds_run,
            cpu_seconds=result.cpu_seconds,
            auxiliary_cell=result.auxiliary_cell,
            path=None if document["path"] is None else tuple((row, col) for row, col in document["path"]),
            best=tuple(best),
            lost=tuple(document["history"]["lost"]),
            certainty=Certainty.of(result.algorithm.certainty),
            knows=result.algorithm.knows.names,
            notes=result.notes,
            environment=document["versions"] | {"machine": machine_name()},
        )
