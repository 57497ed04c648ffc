"""plan: a problem and a rival in, a result out that a study can put beside those of the ants."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from antnav.colony.colony import check_seed
from antnav.planner.result import StoppedBy, versions
from antnav.rivals.encoding import Segments
from antnav.rivals.metaheuristics import Metaheuristic, Method
from antnav.rivals.potential_field import PotentialField
from antnav.rivals.watch import Halted, Watch
from antnav.run.stop import Iterations, Stop
from antnav.search import exact
from antnav.search.windows import straightened
from antnav.world.grid import GridMap
from antnav.world.path import Path
from antnav.world.problem import Problem


class Rival(Protocol):
    """A planner without ants; `Metaheuristic` and `PotentialField` are two."""

    @property
    def name(self) -> str:
        """As it stands in tables."""

    @property
    def certainty(self) -> str:
        """How sure we are that this is what was published."""

    def versions(self) -> dict[str, str]:
        """Versions of the libraries that it runs on."""

    def search(self, problem: Problem, seed: int, watch: Watch) -> str:
        """Search a connected problem, tell `watch` of every path; return why there is none, "" where there is one."""


class RivalStatus(StrEnum):
    """How a search ended; "found" and "unreachable" as in `Status`.

    - found: there is a path
    - unreachable: no path exists; nothing was searched
    - no_path: a path exists, but the rival found none; the notes say why
    """

    FOUND = "found"
    UNREACHABLE = "unreachable"
    NO_PATH = "no_path"


@dataclass(frozen=True, eq=False)
class History:
    """One value an iteration: best length so far, inf before the first; nobody is ever lost."""

    best: NDArray[np.float64]

    @property
    def lost(self) -> NDArray[np.int64]:
        """Zeros."""
        return np.zeros(len(self.best), np.int64)


@dataclass(frozen=True, eq=False, kw_only=True)
class RivalResult:
    """Outcome of `plan`, with the names of `Result`, so that `Record.of` takes either.

    Attributes
    ----------
    status : RivalStatus
    stopped_by : StoppedBy
    problem, algorithm, seed
        What was asked; the algorithm is the rival.
    path : Path or None
    optimum : float
        Length in cells of a shortest path; inf where none exists.
    history : History
    steps : int
        Cost evaluations of a metaheuristic; moves of the potential field's robot.
    notes : tuple of str
        Why there is no path.
    seconds_run, seconds_compile, seconds_exact, cpu_seconds : float
    versions : dict
        As in `Result`, and pygmo's where it ran.
    """

    status: RivalStatus
    stopped_by: StoppedBy
    problem: Problem
    algorithm: Rival
    seed: int
    path: Path | None
    optimum: float
    history: History
    steps: int
    notes: tuple[str, ...]
    seconds_run: float
    seconds_compile: float
    seconds_exact: float
    cpu_seconds: float
    versions: dict[str, str]

    auxiliary_cell = None

    def __repr__(self) -> str:
        found = f", path={self.path!r}" if self.path else ""
        return f"RivalResult({self.status}{found}, {self.algorithm.name}, seed={self.seed}, {self.steps} steps)"

    @property
    def length(self) -> float:
        """Length in cells; inf without a path."""
        return self.path.length if self.path else math.inf

    @property
    def gap(self) -> float:
        """Length / optimum - 1; nan without a path."""
        if self.path is None:
            return math.nan
        return self.length / self.optimum - 1.0 if self.optimum > 0 else 0.0

    @property
    def iterations(self) -> int:
        """Entries of the history."""
        return len(self.history.best)

    @property
    def critical_steps(self) -> int:
        """All steps: nothing runs side by side."""
        return self.steps

    def to_dict(self, *, map_cells: bool = False) -> dict[str, Any]:
        """What a record keeps, as JSON types, infinities and nan as None; the map itself never goes along."""
        path = self.path
        return {
            "status": self.status.value,
            "stopped_by": self.stopped_by.value,
            "length": _finite(self.length),
            "optimum": _finite(self.optimum),
            "gap": _finite(self.gap),
            "turns": path.turns if path else None,
            "clearance_m": _finite(path.clearance) if path else None,
            "seconds_run": self.seconds_run,
            "cpu_seconds": self.cpu_seconds,
            "seed": self.seed,
            "steps": self.steps,
            "path": path.cells.tolist() if path else None,
            "history": {
                "best": [_finite(value) for value in self.history.best.tolist()],
                "lost": self.history.lost.tolist(),
            },
            "notes": list(self.notes),
            "versions": self.versions,
        }


def plan(
    problem: Problem,
    rival: Rival,
    *,
    seed: int = 0,
    stop: Stop | None = None,
    cancel: threading.Event | None = None,
) -> RivalResult:
    """Plan a path without ants.

    Parameters
    ----------
    problem : Problem
    rival : Rival
        One of `RIVALS`, or a `Metaheuristic` or `PotentialField` of your own.
    seed : int
        0 <= seed < 2**64. The same seed gives the same result, with one version of NumPy and pygmo.
    stop : Stop, optional
        Looked at once a generation, or once a random walk.
    cancel : threading.Event, optional
        Set it from elsewhere, and the best so far comes back.

    Returns
    -------
    RivalResult
        With status "no_path" where the search found none: that is no error.

    Raises
    ------
    ParameterError
        A bad seed, or pygmo is needed and not installed.
    """
    seed = check_seed(seed)
    seconds_compile = _prepare(rival)
    optimum = exact.optimum(problem)
    begin, cpu = time.perf_counter(), time.thread_time()
    watch = Watch(stop, cancel)
    notes: tuple[str, ...] = ()
    status = RivalStatus.FOUND
    if not problem.connected:
        status = RivalStatus.UNREACHABLE
    elif problem.start_cell == problem.goal_cell:
        watch.found(0.0, np.array([problem.to_flat(problem.start_cell)]))
    else:
        failure = _search(problem, rival, seed, watch)
        if failure:
            status, notes = RivalStatus.NO_PATH, (failure,)
    seconds, cpu_seconds = time.perf_counter() - begin, time.thread_time() - cpu
    path = None
    if watch.cells is not None:
        flat = straightened(watch.cells.astype(np.int32), problem.terrain)  # as those of ants are
        path = Path(problem.from_flat(flat).astype(np.int32), problem.grid, problem.start, problem.goal)
    return RivalResult(
        status=status,
        stopped_by=watch.stopped_by,
        problem=problem,
        algorithm=rival,
        seed=seed,
        path=path,
        optimum=optimum.length,
        history=History(np.array(watch.history, np.float64)),
        steps=watch.steps,
        notes=notes,
        seconds_run=seconds,
        seconds_compile=seconds_compile,
        seconds_exact=optimum.seconds,
        cpu_seconds=cpu_seconds,
        versions=versions() | rival.versions(),
    )


def _search(problem: Problem, rival: Rival, seed: int, watch: Watch) -> str:
    try:
        return rival.search(problem, seed, watch)
    except Halted:
        return "" if watch.cells is not None else "ended before any path was found"


def _prepare(rival: Rival) -> float:
    """Import what the rival needs and compile its kernels, by two iterations on a tiny map; seconds that it took."""
    begin = time.perf_counter()
    grid = GridMap(np.array([[0, 0, 0], [0, 1, 0], [0, 0, 0]], np.uint8))
    _search(Problem.from_cells(grid, (2, 1), (0, 1)), rival, 0, Watch(Iterations(2)))
    return time.perf_counter() - begin


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _rivals() -> dict[str, Rival]:
    rivals: list[Rival] = [Metaheuristic(method=method, segments=join) for method in Method for join in Segments]
    return {rival.name: rival for rival in [*rivals, PotentialField()]}


#: Every rival with its defaults, by name.
RIVALS: Mapping[str, Rival] = MappingProxyType(_rivals())
