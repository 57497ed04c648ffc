"""solve: a problem and an algorithm in, a result out. Reads as section 4.4 of the paper."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav import decompose, grid_kernels, spmd, windows
from antnav.abstraction import Abstraction, prepare
from antnav.accounts import Run, heat, joined_history
from antnav.colony import colony
from antnav.colony.colony import Iteration, Task
from antnav.colony.parameters import Algorithm, Decomposition
from antnav.colony.parts import Cuts, Join, Search
from antnav.colony.presets import paco
from antnav.errors import ParameterError
from antnav.path import Path
from antnav.problem import GridGraph, Problem
from antnav.result import Result, Status, StoppedBy, versions
from antnav.stop import Progress, Stop
from antnav.warmup import warmup


class Snapshot(NamedTuple):
    """What an observer of `solve` sees."""

    stage: str
    fraction: float  #: of the schedule, in [0, 1]
    best: float  #: length in cells of the path from start to goal that this stage has so far; inf before the first


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
    algorithm = paco() if algorithm is None else algorithm
    if not isinstance(algorithm, Algorithm):
        raise ParameterError(f"algorithm {algorithm!r}", "an algorithm is made by a preset", "call it, as in an.paco()")
    if not isinstance(problem, Problem):
        raise ParameterError(f"problem {problem!r}", "it is a Problem", "make one from a map, a start and a goal")
    if not (stop is None or isinstance(stop, Stop)):
        raise ParameterError(f"stop {stop!r}", "it is a criterion of antnav.stop", "give one, such as Seconds(0.5)")
    colony.check_seed(seed)
    seconds_compile = warmup(algorithm)
    solver = _Solver(problem, algorithm.on(problem.grid), seed, stop, executor, _Cancel(cancel), observer)
    try:
        found = solver.run()
    except BaseException:
        solver.cancel.failed = True  # colonies in other threads end at their next look
        raise
    return solver.result(found, seconds_compile)


class _Cancel:
    """The caller's event, or a failure here: that must end the other colonies, but not set the caller's event."""

    def __init__(self, event: threading.Event | None) -> None:
        self.event, self.failed = event, False

    def is_set(self) -> bool:
        return self.failed or (self.event is not None and self.event.is_set())


@dataclass(frozen=True, eq=False)
class _Found:
    """What the colonies found: a path over flat cells of the padded map, and the node at which PACO divided."""

    flat: NDArray[np.int32] | None
    auxiliary: int | None = None
    reachable: bool = True


@dataclass
class _Solver:
    """One call of `solve`: what was asked, and the accounts that grow on the way."""

    problem: Problem
    algorithm: Algorithm
    seed: int
    stop: Stop | None
    executor: Executor | None
    cancel: _Cancel
    observer: Callable[[Snapshot], None] | None
    began: float = field(default_factory=time.time)
    begin: float = field(default_factory=time.perf_counter)
    runs: list[Run] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    stopped: bool = False
    seconds: float = 0.0

    def run(self) -> _Found:
        if self.problem.start_cell == self.problem.goal_cell:
            found = _Found(np.array([self.problem.to_flat(self.problem.start_cell)], np.int32))
        elif self.algorithm.coarse:
            found = self.coarse()
        elif not self.problem.connected:
            found = _Found(None, reachable=False)
        elif self.algorithm.decomposition is None:
            found = self.undivided()
        else:
            found = self.divided(self.algorithm.decomposition)
        found = self.straightened(self.improved(found))
        self.seconds = time.perf_counter() - self.begin
        return found

    def undivided(self, number: int = 0) -> _Found:
        """One colony on the whole map; after a stage one in vain under a number that no colony had."""
        run = self.side_by_side("whole map", [self.task(number, *self.ends, self.algorithm.iterations)])
        return self.found(run.outcomes[0].nodes)

    def found(self, nodes: NDArray[Any] | None, auxiliary: int | None = None) -> _Found:
        """A path over nodes of the problem's graph."""
        return _Found(None if nodes is None else self.problem.graph.flat[nodes], auxiliary)

    def coarse(self) -> _Found:
        """Ants on the graph of regions, from either end; their best routes laid out on cells, side by side.

        The abstraction of a new map is worked out first; that cannot be interrupted.
        """
        problem = self.problem
        begin = time.perf_counter()
        abstraction = self.abstraction
        self.account("abstraction", begin)
        ends = problem.to_flat(problem.start_cell), problem.to_flat(problem.goal_cell)
        graph = abstraction.between(*ends)
        if graph is None:
            return _Found(None, reachable=False)
        if graph.start == graph.goal:
            self.notes.append("start and goal lie in one region; no ant walked")
            return _Found(windows.laid_out(np.array(ends, np.int32), abstraction))
        tasks = [
            Task(
                graph,
                one,
                other,
                self.algorithm,
                self.algorithm.iterations,
                self.seed,
                number,
                self.stop,
                began=self.began,
                part=True,
            )
            for number, (one, other) in enumerate(((graph.start, graph.goal), (graph.goal, graph.start)))
        ]
        forward, backward = self.side_by_side("regions", tasks).outcomes
        arrived = [*forward.paths, *(path[::-1] for path in backward.paths)]
        routes = decompose.different_routes(arrived, graph, self.algorithm.routes)
        if not routes:
            return _Found(None)
        begin = time.perf_counter()
        stops = [abstraction.stops(route, *ends) for route in routes]
        paths = spmd.run_jobs(windows.laid_out, stops, self.local, abstraction)
        paths = [decompose.without_loops(path) for path in paths]
        lengths = [grid_kernels.length_along(path, problem.width) for path in paths]
        self.account("routes", begin)
        return _Found(paths[int(np.argmin(lengths))])

    def improved(self, found: _Found) -> _Found:
        """The path after the algorithm's windows."""
        if not self.algorithm.windows or found.flat is None:
            return found
        begin = time.perf_counter()
        moves, width = self.problem.moves.ravel(), self.problem.width
        flat = windows.improved(found.flat, moves, width, self.algorithm.windows, self.local, self.ended_with)
        self.account("windows", begin)
        return replace(found, flat=decompose.without_loops(flat))

    def straightened(self, found: _Found) -> _Found:
        """The path with fewer turns at the same length, where the algorithm wants that."""
        if not self.algorithm.straighten or found.flat is None or len(found.flat) < 3:
            return found
        moves, width = self.problem.moves.ravel(), self.problem.width
        return replace(found, flat=windows.straightened(found.flat, moves, width))

    def account(self, name: str, begin: float) -> None:
        """Keep account of a stage without ants."""
        self.runs.append(Run(name, False, time.perf_counter() - begin, (), ()))

    @cached_property
    def abstraction(self) -> Abstraction:
        """The map in short; kept with the map."""
        problem, block = self.problem, self.algorithm.coarse
        return prepare(problem.grid, problem.corner_rule, allow_unknown=problem.allow_unknown, block=block)

    @property
    def local(self) -> Executor | None:
        """The executor for jobs that need the whole map: not in other processes, which would get a copy each."""
        return self.executor if spmd.shares_memory(self.executor) else None

    def ended_with(self, path: NDArray[np.int32]) -> bool:
        """Whether the run ends with this path: by time, length or `cancel`; iterations count for ants only."""
        length = grid_kernels.length_along(path, self.problem.width)
        if self.observer:
            self.observer(Snapshot("windows", 1.0, length))
        if not self.stops_at(0, length):
            return False
        self.notes.append("the run ended before its windows did")
        return True

    def stops_at(self, iterations: int, best: float) -> bool:
        """Whether the criterion, or somebody, ends the run now."""
        if self.stop and self.stop.reached(Progress(iterations, time.perf_counter() - self.begin, best, 0)):
            self.stopped = True
            return True
        return self.cancel.is_set()

    def divided(self, split: Decomposition) -> _Found:
        """PACO, step by step as in section 4.4 of the paper."""
        graph = self.problem.graph
        start, goal = self.ends
        line = decompose.boundary(self.problem.start_cell, self.problem.goal_cell, split.axis)

        # Steps 1 and 2: two colonies, one from either end, side by side.
        first = self.stage_one(split)
        if first is None:
            return self.undivided(2)
        forward, backward = first.outcomes
        scouted = forward.nodes
        if backward.nodes is not None and backward.length < forward.length:
            scouted = backward.nodes[::-1]
        if self.ended(forward.iterations, min(forward.length, backward.length)):
            return self.found(scouted)

        # Step 3: the cell of the dividing line that most paths pass through, or one cell on each level.
        visits = forward.visits + backward.visits
        if split.cuts is Cuts.LEVELS:
            distance = graph.distances_to(start)
            crossings = decompose.level_crossings(graph, visits, distance, goal, split.pieces)
        else:
            auxiliary = decompose.auxiliary_node(graph, visits, line, (start, goal))
            crossings = [] if auxiliary is None else [auxiliary]
        if not crossings:
            self.notes.append("no cell divides start and goal; solved undivided")
            return self.undivided(2)

        # Step 4: start -> auxiliary cell and auxiliary cell -> goal, side by side.
        pairs = list(pairwise([start, *crossings, goal]))
        parts: list[GridGraph | None] = [graph] * len(pairs)
        if split.search is Search.HALF and split.cuts is Cuts.LEVELS:
            parts = spmd.run_jobs(decompose.band, pairs, self.local, graph, distance)
        elif split.search is Search.HALF:
            parts = [decompose.half(graph, line, crossings[0], end) for end in (start, goal)]
        if None in parts:
            self.notes.append("a part is not connected by itself; its colony walked on the whole map")
        graphs = [part or graph for part in parts]
        rest = self.algorithm.iterations - forward.iterations
        inherited = forward.tau if split.inherit else None
        tasks = [
            self.task(number, *pair, rest, used=forward.iterations, tau=inherited, graph=part)
            for number, pair, part in zip((2, 3, *range(1000, 1062)), pairs, graphs, strict=False)
        ]
        second = self.side_by_side("stage two", tasks, parts=True)

        # Step 5: the sub-paths joined.
        crossing = crossings[0] if len(crossings) == 1 else None
        pieces = [
            part.flat[outcome.nodes]
            for part, outcome in zip(graphs, second.outcomes, strict=True)
            if outcome.nodes is not None
        ]
        if len(pieces) < len(pairs):
            self.notes.append("a part found no path; the path is that of stage one")
            return self.found(scouted, crossing)
        joined = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
        return self.found(self.repaired(np.searchsorted(graph.flat, joined), scouted, split.join), crossing)

    def stage_one(self, split: Decomposition) -> Run | None:
        """Two colonies from either end for T0 iterations; longer where no ant arrives; None where that is in vain."""
        start, goal = self.ends
        iterations, attempt = split.stage_one, 0
        while iterations < self.algorithm.iterations:
            tasks = [
                self.task(4 * attempt, start, goal, iterations),
                self.task(4 * attempt + 1, goal, start, iterations),
            ]
            run = self.side_by_side("stage one", tasks)
            arrived = any(outcome.nodes is not None for outcome in run.outcomes)
            if arrived or self.stopped or self.cancel.is_set():
                return run
            self.notes.append(f"no ant arrived in {iterations} iterations of stage one")
            iterations, attempt = 2 * iterations, attempt + 1
        self.notes.append("solved undivided")
        return None

    def ended(self, iterations: int, best: float) -> bool:
        """Whether the run ends after stage one."""
        return self.stopped or self.stops_at(iterations, best)

    def repaired(self, joined: NDArray[np.intp], scouted: NDArray[np.int32] | None, join: Join) -> NDArray[Any]:
        """The joined path, as it is or without its loops, or stage one's where that is shorter.

        A run that was ended early keeps the shorter one too: more time must not make a path longer.
        """
        early = self.stopped or self.cancel.is_set()
        path = decompose.without_loops(joined) if join is Join.REPAIR else joined
        keeps_shorter = early or join is Join.REPAIR
        if keeps_shorter and scouted is not None and self.path(scouted).length < self.path(path).length:
            self.notes.append("stage one's path is shorter than the joined one, and was kept")
            return scouted
        if len(set(path.tolist())) < len(path):
            self.notes.append("the sub-paths cross; the joined path has a loop")
        return path

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
        *,
        used: int = 0,
        tau: NDArray[np.float64] | None = None,
        graph: GridGraph | None = None,
    ) -> Task:
        """Task of colony `number` between two nodes of the problem's graph, which may walk on a part of it.

        With iterations already used it is a part of the way.
        """
        whole = self.problem.graph
        if graph is not None and graph is not whole:
            start, goal = (int(np.searchsorted(graph.flat, whole.flat[node])) for node in (start, goal))
            tau = None if tau is None else tau[np.searchsorted(whole.flat, graph.flat)]
        return Task(
            grid_graph=whole if graph is None else graph,
            start=start,
            goal=goal,
            algorithm=self.algorithm,
            iterations=iterations,
            seed=self.seed,
            colony=number,
            stop=self.stop,
            iterations_used=used,
            began=self.began,
            part=used > 0,
            tau=tau,
        )

    def side_by_side(self, name: str, tasks: list[Task], *, parts: bool = False) -> Run:
        """Run the colonies of a stage on the executor, and keep account of it."""
        begin = time.perf_counter()
        if spmd.shares_memory(self.executor):
            watch = self.watch(name, len(tasks) if parts else 0) if self.observer else None
            outcomes = spmd.run_jobs(colony.run, tasks, self.executor, self.cancel, watch)
        else:
            outcomes = spmd.run_jobs(colony.run, tasks, self.executor)
        run = Run(name, parts, time.perf_counter() - begin, tasks, outcomes)
        self.runs.append(run)
        self.stopped |= any(outcome.stopped for outcome in outcomes)
        return run

    def watch(self, stage: str, parts: int) -> colony.Observer:
        """An observer of colonies, each with one of so many parts of the way, that makes snapshots of the whole run."""
        bests: dict[int, float] = {}

        def see(task: Task, iteration: Iteration) -> None:
            bests[task.colony] = iteration.best
            best = min(bests.values())
            if task.part:  # lengths on a graph of regions do not count
                best = sum(bests.values()) if len(bests) == parts else math.inf
            done = (task.iterations_used + iteration.number) / self.algorithm.iterations
            assert self.observer is not None
            self.observer(Snapshot(stage, min(1.0, done), best))

        return see

    def path(self, nodes: NDArray[Any]) -> Path:
        return self.on_map(self.problem.graph.flat[nodes])

    def on_map(self, flat: NDArray[np.int32]) -> Path:
        cells = self.problem.from_flat(flat).astype(np.int32)
        return Path(cells, self.problem.grid, self.problem.start, self.problem.goal)

    def result(self, found: _Found, seconds_compile: float) -> Result:
        problem = self.problem
        self.notes.extend(problem.moved_ends)
        status = Status.FOUND if found.flat is not None else Status.NO_ANT_ARRIVED
        if not found.reachable:
            status = Status.UNREACHABLE
        ending = StoppedBy.CRITERION if self.stopped else StoppedBy.SCHEDULE
        auxiliary = None if found.auxiliary is None else problem.graph.cells[found.auxiliary]
        return Result(
            status=status,
            stopped_by=StoppedBy.CANCELLED if self.cancel.is_set() else ending,
            problem=problem,
            algorithm=self.algorithm,
            seed=int(self.seed),
            path=None if found.flat is None else self.on_map(found.flat),
            auxiliary_cell=None if auxiliary is None else (int(auxiliary[0]), int(auxiliary[1])),
            stages=tuple(run.stage() for run in self.runs),
            history=joined_history(self.runs),
            heat=heat(problem, self.runs, self.abstraction.on_map if self.algorithm.coarse else None),
            stop=None if self.stop is None else repr(self.stop),
            notes=tuple(self.notes),
            seconds_run=self.seconds,
            seconds_compile=seconds_compile,
            cpu_seconds=sum(outcome.cpu_seconds for run in self.runs for outcome in run.outcomes),
            versions=versions(),
        )
