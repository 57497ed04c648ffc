"""solve: a problem and an algorithm in, a result out. Reads as section 4.4 of the paper."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav import decompose, exact, spmd
from antnav.colony import colony
from antnav.colony.colony import Iteration, Outcome, Task
from antnav.colony.kernels import COUNTS, History, new_history
from antnav.colony.parameters import Algorithm, Decomposition, paco
from antnav.colony.parts import Join, Search
from antnav.errors import ParameterError
from antnav.path import Path
from antnav.problem import GridGraph, Problem
from antnav.result import ColonyReport, Result, Stage, Status, StoppedBy, versions
from antnav.stop import Progress, Stop
from antnav.warmup import warmup


class Snapshot(NamedTuple):
    """What an observer of `solve` sees."""

    stage: str
    fraction: float  #: of the schedule, in [0, 1]
    best: float  #: length in cells of the best path from start to goal so far; inf before the first


def solve(
    problem: Problem,
    algorithm: Algorithm | None = None,
    *,
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
    observer: Callable[[Snapshot], None] | None = None,
) -> Result:
    """Plan a path.

    Parameters
    ----------
    problem : Problem
    algorithm : Algorithm, optional
        A preset such as `paco()` (default), `npaco()` or `traditional()`.
    seed : int
        0 <= seed < 2**64. The same seed gives the same result whatever the executor and the number of workers.
    stop : Stop, optional
        Ends the run before its schedule does, for instance ``Seconds(0.5) | TargetLength(30)``.
    executor : concurrent.futures.Executor, optional
        Where the colonies of a stage run side by side; default: threads.
    cancel : threading.Event, optional
        Set it from elsewhere, and the best so far comes back. Not seen by executors in other processes.
    observer : callable, optional
        Gets a `Snapshot` now and then, from worker threads; not called by executors in other processes.

    Returns
    -------
    Result
        With status "unreachable" where no path exists and "no_ant_arrived" where no ant found one: neither is an error.

    Raises
    ------
    ParameterError
        A parameter is out of range.
    WorkerLostError
        A worker of the executor died again and again.
    """
    algorithm = algorithm or paco()
    if not isinstance(algorithm, Algorithm):
        raise ParameterError(f"algorithm {algorithm!r}", "an algorithm is made by a preset", "call it, as in an.paco()")
    colony.check_seed(seed)
    seconds_compile = warmup()
    optimum = exact.optimum(problem)
    solver = _Solver(problem, algorithm.on(problem.grid), seed, stop, executor, cancel or threading.Event(), observer)
    try:
        found = solver.run()
    except BaseException:
        solver.cancel.set()  # colonies in other threads end at their next look
        raise
    return solver.result(found, optimum, seconds_compile)


@dataclass
class _Found:
    """What the colonies found: a path over the nodes of the problem's graph, and the pheromone on their way."""

    nodes: NDArray[np.int32] | None
    history: History
    tau: NDArray[np.float64] | None = None
    auxiliary: int | None = None


@dataclass
class _Solver:
    """One call of `solve`: what was asked, and the accounts that grow on the way."""

    problem: Problem
    algorithm: Algorithm
    seed: int
    stop: Stop | None
    executor: Executor | None
    cancel: threading.Event
    observer: Callable[[Snapshot], None] | None
    begin: float = field(default_factory=time.perf_counter)
    stages: list[Stage] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    cpu_seconds: float = 0.0
    stopped: bool = False
    seconds: float = 0.0

    def run(self) -> _Found:
        if self.problem.start_cell == self.problem.goal_cell:
            found = _Found(np.zeros(1, np.int32), new_history(0))
        elif not self.problem.connected:
            found = _Found(None, new_history(0))
        elif self.algorithm.decomposition is None:
            found = self.undivided()
        else:
            found = self.divided(self.algorithm.decomposition)
        self.seconds = time.perf_counter() - self.begin
        return found

    def undivided(self) -> _Found:
        """One colony on the whole map."""
        (outcome,) = self.side_by_side("whole map", [self.task(0, *self.ends, self.algorithm.iterations)])
        return _Found(outcome.nodes, outcome.history, outcome.tau)

    def divided(self, split: Decomposition) -> _Found:
        """PACO, step by step as in section 4.4 of the paper."""
        graph = self.problem.graph
        start, goal = self.ends
        line = decompose.boundary(self.problem.start_cell, self.problem.goal_cell, split.axis)

        # Steps 1 and 2: two colonies, one from either end, side by side.
        first = self.stage_one(split)
        if first is None:
            return self.undivided()
        forward, backward = first
        scout = min(first, key=lambda outcome: outcome.length)
        scouted = scout.nodes if scout is forward or scout.nodes is None else scout.nodes[::-1]
        early = _Found(scouted, _merge_histories(np.minimum, forward, backward), forward.tau)
        if self.ended(forward.iterations, early):
            return early

        # Step 3: the cell of the dividing line that most paths pass through.
        auxiliary = decompose.auxiliary_node(graph, forward.visits + backward.visits, line, (start, goal))
        if auxiliary is None:
            self.notes.append("no cell divides start and goal; solved undivided")
            return self.undivided()

        # Step 4: start -> auxiliary cell and auxiliary cell -> goal, side by side.
        rest = self.algorithm.iterations - forward.iterations
        inherited = forward.tau if split.inherit else None
        halves = [(2, start, auxiliary, start), (3, auxiliary, goal, goal)]
        tasks, maps = [], []
        for number, here, there, end in halves:
            part = decompose.half(graph, line, auxiliary, end) if split.search is Search.HALF else None
            task = self.task(number, here, there, rest, forward.iterations, inherited, part)
            tasks.append(task)
            maps.append(part[1] if part else np.arange(len(graph), dtype=np.int32))
        left, right = self.side_by_side("stage two", tasks)
        history = _append(early.history, _merge_histories(np.add, left, right))

        # Step 5: the sub-paths joined.
        tau = np.zeros((len(graph), 8))
        for outcome, nodes in zip((left, right), maps, strict=True):
            tau[nodes] += outcome.tau
        if left.nodes is None or right.nodes is None:
            self.notes.append("a half found no path; the path is that of stage one")
            return _Found(early.nodes, history, tau, auxiliary)
        joined = np.concatenate([maps[0][left.nodes], maps[1][right.nodes][1:]])
        return _Found(self.repaired(joined, early, split.join), history, tau, auxiliary)

    def stage_one(self, split: Decomposition) -> tuple[Outcome, Outcome] | None:
        """Two colonies from either end for T0 iterations; longer where no ant arrives; None where that is in vain."""
        start, goal = self.ends
        iterations, attempt = split.stage_one, 0
        while iterations < self.algorithm.iterations:
            tasks = [
                self.task(4 * attempt, start, goal, iterations),
                self.task(4 * attempt + 1, goal, start, iterations),
            ]
            forward, backward = self.side_by_side("stage one", tasks)
            if math.isfinite(min(forward.length, backward.length)) or self.stopped or self.cancel.is_set():
                return forward, backward
            iterations, attempt = 2 * iterations, attempt + 1
            self.notes.append(f"no ant arrived in {iterations // 2} iterations of stage one")
        self.notes.append("solved undivided")
        return None

    def ended(self, iterations: int, found: _Found) -> bool:
        """Whether the run ends after stage one."""
        if self.stop and not self.stopped:
            best = found.history.best[-1]
            self.stopped = self.stop.reached(Progress(iterations, time.perf_counter() - self.begin, best, 0))
        return self.stopped or self.cancel.is_set()

    def repaired(self, joined: NDArray[np.int32], early: _Found, join: Join) -> NDArray[np.int32]:
        """The joined path, as it is or without its loops, or stage one's where that is shorter."""
        whole = decompose.without_loops(joined)
        if join is Join.PAPER:
            if len(whole) < len(joined):
                self.notes.append("the sub-paths cross; the joined path has a loop")
            return joined
        if early.nodes is not None and self.path(early.nodes).length < self.path(whole).length:
            self.notes.append("stage one's path is shorter than the joined one, and was kept")
            return early.nodes
        return whole

    @property
    def ends(self) -> tuple[int, int]:
        graph = self.problem.graph
        return graph.node(self.problem.start_cell), graph.node(self.problem.goal_cell)

    def task(
        self,
        number: int,
        start: int,
        goal: int,
        iterations: int,
        used: int = 0,
        tau: NDArray[np.float64] | None = None,
        part: tuple[GridGraph, NDArray[np.int32]] | None = None,
    ) -> Task:
        """Task of colony `number`; start and goal are nodes of the whole graph, `part` the half to keep to."""
        graph = self.problem.graph
        if part:
            graph, nodes = part
            start, goal = (int(np.searchsorted(nodes, node)) for node in (start, goal))
            tau = None if tau is None else tau[nodes]
        return Task(
            graph,
            start,
            goal,
            self.algorithm,
            iterations,
            self.seed,
            number,
            self.stop,
            used,
            time.perf_counter() - self.begin,
            used > 0,
            tau,
        )

    def side_by_side(self, name: str, tasks: list[Task]) -> list[Outcome]:
        """Run the colonies of a stage on the executor, and keep account of it."""
        begin = time.perf_counter()
        if spmd.shares_memory(self.executor):
            watch = self.watch(name) if self.observer else None
            outcomes = spmd.run_jobs(colony.run, tasks, self.executor, self.cancel, watch)
        else:
            outcomes = spmd.run_jobs(colony.run, tasks, self.executor)
        seconds = time.perf_counter() - begin
        reports = [self.report(task, outcome) for task, outcome in zip(tasks, outcomes, strict=True)]
        self.stages.append(Stage(name, seconds, tuple(reports)))
        self.cpu_seconds += sum(outcome.cpu_seconds for outcome in outcomes)
        self.stopped |= any(outcome.stopped for outcome in outcomes)
        return outcomes

    def report(self, task: Task, outcome: Outcome) -> ColonyReport:
        start, goal = ((int(row), int(col)) for row, col in task.grid_graph.cells[[task.start, task.goal]])
        length = outcome.length if math.isfinite(outcome.length) else None
        return ColonyReport(
            start, goal, outcome.iterations, length, outcome.steps, outcome.seconds, outcome.cpu_seconds
        )

    def watch(self, stage: str) -> colony.Observer:
        """An observer of colonies that turns what it sees into snapshots of the whole run."""
        bests: dict[int, float] = {}

        def see(task: Task, iteration: Iteration) -> None:
            bests[task.colony] = iteration.best
            known = list(bests.values())
            best = (sum(known) if len(known) == 2 else math.inf) if task.part else min(known)
            done = (task.iterations_used + iteration.number) / self.algorithm.iterations
            assert self.observer is not None
            self.observer(Snapshot(stage, min(1.0, done), best))

        return see

    def path(self, nodes: NDArray[np.int32]) -> Path:
        cells = self.problem.graph.cells[nodes].astype(np.int32)
        return Path(cells, self.problem.grid, self.problem.start, self.problem.goal)

    def result(self, found: _Found, optimum: exact.Optimum, seconds_compile: float) -> Result:
        problem = self.problem
        status = Status.FOUND if found.nodes is not None else Status.NO_ANT_ARRIVED
        if not problem.connected:
            status = Status.UNREACHABLE
        ending = StoppedBy.CRITERION if self.stopped else StoppedBy.SCHEDULE
        auxiliary = None if found.auxiliary is None else problem.graph.cells[found.auxiliary]
        return Result(
            status=status,
            stopped_by=StoppedBy.CANCELLED if self.cancel.is_set() else ending,
            problem=problem,
            algorithm=self.algorithm,
            seed=int(self.seed),
            path=None if found.nodes is None else self.path(found.nodes),
            optimum=optimum.length,
            auxiliary_cell=None if auxiliary is None else (int(auxiliary[0]), int(auxiliary[1])),
            stages=tuple(self.stages),
            history=found.history,
            pheromone=self.heat(found.tau),
            notes=tuple(self.notes),
            seconds_run=self.seconds,
            seconds_compile=seconds_compile,
            seconds_exact=optimum.seconds,
            cpu_seconds=self.cpu_seconds,
            versions=versions(),
        )

    def heat(self, tau: NDArray[np.float64] | None) -> NDArray[np.float32]:
        """Mean pheromone of each cell's edges."""
        field = np.full(self.problem.grid.shape, np.nan, np.float32)
        if tau is not None:
            graph = self.problem.graph
            edges = graph.graph.neighbours < len(graph)
            field[tuple(graph.cells.T)] = np.where(edges, tau, 0).sum(axis=1) / np.maximum(edges.sum(axis=1), 1)
        return field


def _merge_histories(combine: np.ufunc, one: Outcome, other: Outcome) -> History:
    """The histories of two colonies side by side as one; lengths are combined, numbers of ants added up."""
    length = max(one.iterations, other.iterations)
    first, second = _padded(one.history, length), _padded(other.history, length)
    return History(
        best=combine(first.best, second.best),
        iteration_best=combine(first.iteration_best, second.iteration_best),
        mean=combine(first.mean, second.mean) if combine is np.add else (first.mean + second.mean) / 2,
        arrived=first.arrived + second.arrived,
        lost=first.lost + second.lost,
        steps=first.steps + second.steps,
        entropy=(first.entropy + second.entropy) / 2,
    )


def _padded(history: History, length: int) -> History:
    """The history with its last values held where a sibling went on, and nobody walking any more."""
    more = length - len(history.best)
    columns = zip(History._fields, history, strict=True)
    held = [np.append(array, np.repeat(array[-1:] * (name not in COUNTS), more)) for name, array in columns]
    return History(*held)


def _append(first: History, second: History) -> History:
    """One stage after the other."""
    return History(*(np.append(*pair) for pair in zip(first, second, strict=True)))
