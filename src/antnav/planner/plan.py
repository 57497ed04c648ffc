"""Plan: what a planner found, and the account of how."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import Annotated

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.kernels.ant_kernels import COUNTS, History, new_history
from antnav.planner.memory import Memory
from antnav.values import read_only
from antnav.world.problem import CellIndex

#: What a file may say.
Count = Annotated[int, msgspec.Meta(ge=0, le=2**53)]
Measure = Annotated[float, msgspec.Meta(ge=0)]


class Status(StrEnum):
    """How a search ended.

    - found: there is a path
    - unreachable: no path exists; nothing was searched
    - no_ant_arrived: a path exists, but no ant found one
    - no_path: a path exists, but a planner without ants found none; the notes say why
    """

    FOUND = "found"
    UNREACHABLE = "unreachable"
    NO_ANT_ARRIVED = "no_ant_arrived"
    NO_PATH = "no_path"


class StoppedBy(StrEnum):
    """What ended the search.

    - schedule: all iterations were done, or none were needed
    - criterion: the stopping criterion
    - cancelled: somebody set `cancel`
    """

    SCHEDULE = "schedule"
    CRITERION = "criterion"
    CANCELLED = "cancelled"


class ColonyReport(msgspec.Struct, frozen=True):
    """Account of one colony, or of a search without ants.

    Its ends, iterations, `length` of its best path (its cost, where the problem has costs), moves of its ants (cost
    evaluations of a metaheuristic, cells that an exact search took from its queue), wall and CPU seconds; `walks` are
    the paths that were tried, arrived or not.
    """

    start: CellIndex
    goal: CellIndex
    iterations: Count
    length: Measure | None
    steps: Count
    seconds: Measure
    cpu_seconds: Measure
    walks: Count = 0


class Stage(msgspec.Struct, frozen=True):
    """Account of colonies that ran side by side; `seconds` is the wall time, t1 or t2 of the paper."""

    name: str
    seconds: Measure
    colonies: tuple[ColonyReport, ...]

    @property
    def balance(self) -> float:
        """Moves of the busiest colony's ants over the mean: 1 is even; nan without colonies."""
        steps = [colony.steps for colony in self.colonies]
        return max(steps) * len(steps) / sum(steps) if sum(steps) else math.nan


def iterations_of(stages: Iterable[Stage]) -> int:
    """Iterations done, one after the other: those of each stage's longest colony."""
    return sum(max((colony.iterations for colony in stage.colonies), default=0) for stage in stages)


def history_of(best: list[float], steps: list[int]) -> History:
    """The history of a planner without ants: best length so far and steps of each iteration; nobody is ever lost."""
    history = History(*(np.full(len(best), 0 if name in COUNTS else math.nan) for name in History._fields))
    columns = history._replace(best=np.array(best, np.float64), iteration_best=np.full(len(best), math.inf))
    columns = columns._replace(steps=np.array(steps, np.int64))
    return History(*(read_only(column) for column in columns))


class Plan(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a planner answers; only `cells` must be given.

    Attributes
    ----------
    cells : ndarray of int, shape (k, 2), or None
        (row, col) from the start to the goal, each a legal move from the one before; None: no path was found.
    status : Status or None
        None: "found" with a path; without one "unreachable" or "no_path", as the map says.
    stopped_by : StoppedBy
    auxiliary_cell : (row, col) or None
    stages : tuple of Stage
        Where steps, iterations and walks are counted.
    history : History
        One value an iteration.
    estimated : bool
        Whether the history's lengths are estimates on another graph than the map's.
    heat : callable or None
        Makes the pheromone's map.
    memory : Memory or None
        The pheromone for runs to come; only where the call says `remember`.
    notes : tuple of str
        What a reader must know.
    seconds, cpu_seconds : float or None
        Wall time of the run, without what is only told of it; CPU time. None: `solve` takes the time of the call.
    """

    cells: NDArray[np.int32] | None
    status: Status | None = None
    stopped_by: StoppedBy = StoppedBy.SCHEDULE
    auxiliary_cell: CellIndex | None = None
    stages: tuple[Stage, ...] = ()
    history: History = msgspec.field(default_factory=lambda: new_history(0))
    estimated: bool = False
    heat: Callable[[], NDArray[np.float32]] | None = None
    memory: Memory | None = None
    notes: tuple[str, ...] = ()
    seconds: float | None = None
    cpu_seconds: float | None = None
