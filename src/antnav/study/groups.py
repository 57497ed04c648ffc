"""Groups: the records of a study by map and algorithm, and what one group says."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from antnav.planner.facts import Basis, Clause, Knows
from antnav.study.record import Kept, Mark, Record
from antnav.world.problem import CellIndex

R = TypeVar("R", bound=Kept)
GroupsOf = dict[str, dict[str, list[R]]]
Groups = GroupsOf[Record]


def grouped(records: Sequence[R]) -> GroupsOf[R]:
    """Records by map and algorithm, both in the order of their first appearance, each group by seed."""
    algorithms = dict.fromkeys(record.algorithm for record in records)
    groups: GroupsOf[R] = {}
    for record in records:
        groups.setdefault(record.map, {}).setdefault(record.algorithm, []).append(record)
    return {
        label: {name: sorted(group[name], key=lambda run: run.seed) for name in algorithms if name in group}
        for label, group in groups.items()
    }


def lengths(runs: Sequence[Record]) -> list[float]:
    """Costs in cells, which are lengths where the problem has no costs; inf without a path."""
    return [math.inf if run.cost is None else run.cost for run in runs]


@dataclass(frozen=True)
class Measure:
    """What runs are compared by, the less the better, and the words for it."""

    of: Callable[[Sequence[Any]], list[float]]
    what: str
    better: str
    worse: str


#: What runs that look for a path are compared by.
LENGTH = Measure(lengths, "length", "shorter", "longer")


def in_common(
    one: Sequence[R], other: Sequence[R], measure: Callable[[Sequence[Any]], list[float]] = lengths
) -> tuple[list[float], list[float]]:
    """What is measured of both in the seeds that both have."""
    left, right = ({run.seed: run for run in runs} for runs in (one, other))
    seeds = sorted(left.keys() & right.keys())
    return measure([left[seed] for seed in seeds]), measure([right[seed] for seed in seeds])


def optimum_of(runs: Sequence[Record]) -> float:
    """The optimum of a group's problem; inf where no path exists."""
    return next((run.optimum for run in runs if run.optimum is not None), math.inf)


def median(values: Sequence[float]) -> float:
    """Median of times and counts."""
    return float(np.median(values)) if values else math.nan


def loaded(runs: Iterable[Kept]) -> int:
    """How many of the runs shared the machine with others, so that their wall seconds are no measure."""
    return sum(Mark.LOADED in run.marks for run in runs)


def busy(runs: Iterable[Kept]) -> int:
    """How many of the runs ended while the machine had more to do than it has cores."""
    return sum(Mark.BUSY in run.marks for run in runs)


def wall_seconds(runs: Sequence[Kept]) -> float:
    """Median; nan where a run had company."""
    return math.nan if loaded(runs) else median([run.seconds for run in runs])


def percent_saved(ours: float, theirs: float) -> float:
    """By how much ours is below theirs, in per cent."""
    return 100 * (1 - ours / theirs) if theirs else math.nan


def most_frequent(runs: Sequence[Record]) -> tuple[CellIndex, int] | None:
    """The auxiliary cell that most runs chose, the first in map order among equals, with its count."""
    counts = Counter(run.auxiliary_cell for run in runs if run.auxiliary_cell is not None)
    return min(counts.items(), key=lambda item: (-item[1], item[0])) if counts else None


def certainty(runs: Sequence[Kept]) -> str:
    """Certainty of a group, as its records state it."""
    return "; ".join(dict.fromkeys(str(run.certainty) for run in runs))


def clauses(runs: Iterable[Record]) -> list[Clause]:
    """What is stated of the certainty of runs, each once."""
    return list(dict.fromkeys(clause for run in runs for clause in run.certainty))


def rests_on(basis: Basis, runs: Iterable[Record]) -> bool:
    """Whether one of the runs rests on that."""
    return any(basis in run.certainty.bases for run in runs)


def know(what: Knows, runs: Iterable[Record]) -> bool:
    """Whether one of the runs knew that."""
    return any(not set(what.names).isdisjoint(run.knows) for run in runs)
