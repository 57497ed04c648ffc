"""How colonies make a path: each strategy asks for stages, gets what their colonies brought, and returns a path.

A strategy is a generator, so that one text serves both ways of running it: `solve` lets the colonies of a stage run
side by side to their end, `Steps` one iteration at a time.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Generator, Iterable, Sequence
from concurrent.futures import Executor
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.ants import decompose, streams
from antnav.ants.accounts import Run
from antnav.colony.colony import Outcome, Task
from antnav.colony.parameters import Decomposition, Settings
from antnav.colony.parts import Cuts, CutsPart, Join, Search
from antnav.colony.parts.ground import Ground
from antnav.colony.parts.memory import KnownPath, Warm
from antnav.planner.call import Call
from antnav.planner.events import Improved
from antnav.planner.memory import turned
from antnav.planner.phases import Phase
from antnav.planner.plan import StoppedBy
from antnav.run import spmd
from antnav.search import windows
from antnav.search.abstraction import Abstraction
from antnav.world.grid_graph import GridGraph
from antnav.world.problem import Problem

#: Regions near the route up to which a thread of its own for each colony and route costs more than it saves.
BRIEF = 2000


class Order(NamedTuple):
    """Colonies that are to run side by side; `Run` is what comes of them."""

    phase: Phase
    tasks: Sequence[Task]
    parts: bool = False  #: whether their paths are parts of one
    brief: bool = False  #: whether they are over before threads would have begun; other processes get them all the same

    def best(self, lengths: Iterable[float]) -> float:
        """Length of the path from start to goal that colonies with these best lengths have; inf while there is none.

        The lengths may be fewer than the colonies: those that have not begun are missing.
        """
        known = list(lengths)
        if not self.parts:  # lengths on a graph of regions do not count
            return math.inf if any(task.part for task in self.tasks) else min(known, default=math.inf)
        return sum(known) if len(known) == len(self.tasks) else math.inf


class Found(msgspec.Struct, frozen=True, eq=False):
    """What the colonies found: a path over flat cells of the padded map, and the node at which PACO divided."""

    flat: NDArray[np.int32] | None
    auxiliary: int | None = None
    reachable: bool = True


#: Yields an `Order`, is sent the `Run` that comes of it, and so on; returns what was found.
Strategy = Generator[Order, Any, Found]


class Context(msgspec.Struct, eq=False, dict=True):
    """One run: what was asked, and the accounts that grow on the way."""

    problem: Problem
    algorithm: Settings  #: with the choices made that depend on the map, see `Settings.on`
    call: Call
    runs: list[Run] = msgspec.field(default_factory=list)
    notes: list[str] = msgspec.field(default_factory=list)
    stopped: bool = False
    telling: threading.Lock = msgspec.field(default_factory=threading.Lock)  #: held while somebody is told something

    @cached_property
    def ends(self) -> tuple[int, int]:
        """Nodes of start and goal."""
        start, goal = np.searchsorted(self.problem.graph.flat, self.problem.flat_ends)
        return int(start), int(goal)

    @cached_property
    def abstraction(self) -> Abstraction:
        """The map in short; kept with the map."""
        return Abstraction.of(self.problem.terrain, self.algorithm.coarse)

    @property
    def iterations(self) -> int:
        """Iterations done one after the other, those of attempts that were in vain among them."""
        return sum(run.iterations for run in self.runs)

    @property
    def local(self) -> Executor | None:
        """The executor for jobs that need the whole map: not in other processes, which would get a copy each."""
        executor = self.call.executor
        return executor if spmd.shares_memory(executor) else None

    def keep(self, order: Order, outcomes: Sequence[Outcome], seconds: float) -> Run:
        """Keep account of a stage with ants."""
        self.runs.append(Run(order.phase, order.parts, seconds, order.tasks, outcomes))
        return self.runs[-1]

    def account(self, phase: Phase, begin: float) -> None:
        """Keep account of a stage without ants."""
        self.runs.append(Run(phase, False, time.perf_counter() - begin, (), ()))

    def stops_at(self, iterations: int, best: float) -> bool:
        """Whether the criterion, or somebody, ends the run now."""
        ending = self.call.ending(iterations, best)
        self.stopped |= ending is StoppedBy.CRITERION
        return ending is not None

    def found(self, nodes: NDArray[Any] | None, auxiliary: int | None = None) -> Found:
        """A path over nodes of the problem's graph."""
        return Found(None if nodes is None else self.problem.graph.flat[nodes], auxiliary)

    @cached_property
    def warm(self) -> Warm:
        """What colonies on the whole map begin with."""
        memory, algorithm = self.call.warm, self.algorithm
        return algorithm.memory.warm(memory, self.problem, algorithm, self.call.seed) if memory else Warm()

    @cached_property
    def warm_from_goal(self) -> Warm:
        """The same for ants from the goal to the start."""
        tau, known = self.warm
        return Warm(
            None if tau is None else turned(tau, self.problem.graph.graph),
            known and KnownPath(known.nodes[::-1].copy(), known.cost),
        )

    def task(
        self,
        number: int,
        start: int,
        goal: int,
        iterations: int,
        *,
        schedule: int | None = None,
        part: bool = False,
        warm: Warm | None = None,
        graph: GridGraph | None = None,
        all_paths: bool = False,
    ) -> Task:
        """Task of colony `number` between two nodes of the problem's graph, which may walk on a part of it."""
        whole, (tau, known) = self.problem.graph, warm or Warm()
        if graph is not None and graph is not whole:
            start, goal = (int(np.searchsorted(graph.flat, whole.flat[node])) for node in (start, goal))
            tau = None if tau is None else tau[np.searchsorted(whole.flat, graph.flat)]
        return Task(
            grid_graph=whole if graph is None else graph,
            start=start,
            goal=goal,
            algorithm=self.algorithm,
            iterations=iterations,
            seed=self.call.seed,
            colony=number,
            schedule=schedule,
            stop=self.call.stop,
            iterations_used=self.iterations,
            began=self.call.began,
            part=part,
            tau=tau,
            known=known,
            all_paths=all_paths or (self.call.remember and not part),
        )


def strategy_of(run: Context) -> Strategy:
    """The strategy that the run's problem, of two different cells, and algorithm ask for."""
    algorithm = run.algorithm
    if algorithm.coarse:
        return regions(run)
    if not run.problem.connected:
        return _unreachable()
    if algorithm.decomposition is None:
        return undivided(run)
    return divided(run, algorithm.decomposition)


def _unreachable() -> Strategy:
    yield from ()  # a generator, as its siblings are
    return Found(None, reachable=False)


def undivided(run: Context, number: int = streams.WHOLE_MAP) -> Strategy:
    """Colonies on the whole map, by turns from the start and from the goal; the best path wins, the first of equals."""
    iterations, graph = run.algorithm.iterations, run.problem.graph
    tasks = [
        run.task(number + index, *run.ends[::-1], iterations, warm=run.warm_from_goal, graph=graph.backwards)
        if index % 2
        else run.task(number + index, *run.ends, iterations, warm=run.warm)
        for index in range(run.algorithm.colonies)
    ]
    done: Run = yield Order(Phase.WHOLE_MAP, tasks)
    lengths = [outcome.length for outcome in done.outcomes]
    winner = int(np.argmin(lengths))
    nodes = done.outcomes[winner].nodes
    return run.found(nodes[::-1] if winner % 2 and nodes is not None else nodes)


def divided(run: Context, split: Decomposition) -> Strategy:
    """PACO, step by step as in section 4.4 of the paper."""
    graph = run.problem.graph
    start, goal = run.ends
    line = decompose.boundary(run.problem.start_cell, run.problem.goal_cell, split.axis)

    # Steps 1 and 2: two colonies, one from either end, side by side.
    first = yield from _stage_one(run, split)
    if first is None:
        return (yield from undivided(run, streams.TAKES_OVER))
    forward, backward = first.outcomes
    scouted = forward.nodes
    if backward.nodes is not None and backward.length < forward.length:
        scouted = backward.nodes[::-1]
    if run.stopped or run.stops_at(run.iterations, min(forward.length, backward.length)):
        return run.found(scouted)

    # Step 3: the cell of the dividing line that most paths pass through, or one cell on each level.
    visits = forward.visits + backward.visits
    if isinstance(split.cuts, CutsPart):
        ground = Ground(graph, start, goal, run.algorithm.tau0)
        paths = [*forward.paths, *(path[::-1] for path in backward.paths)]
        crossings = split.cuts.crossings(ground, paths, split.pieces)
    elif split.cuts is Cuts.LEVELS:
        distance = graph.backwards.distances_to(start)
        crossings = decompose.level_crossings(graph, visits, distance, goal, split.pieces)
    else:
        auxiliary = decompose.auxiliary_node(graph, visits, line, (start, goal))
        crossings = [] if auxiliary is None else [auxiliary]
    if not crossings:
        run.notes.append("no cell divides start and goal; solved undivided")
        return (yield from undivided(run, streams.TAKES_OVER))

    # Step 4: start -> auxiliary cell and auxiliary cell -> goal, side by side.
    pairs = list(pairwise([start, *crossings, goal]))
    parts: list[GridGraph | None] = [graph] * len(pairs)
    if split.search is Search.HALF and split.cuts is Cuts.LEVELS:
        parts = spmd.run_jobs(decompose.band, pairs, run.local, graph, distance)
    elif split.search is Search.HALF:
        parts = [decompose.half(graph, line, crossings[0], end) for end in (start, goal)]
    if None in parts:
        run.notes.append("a part is not connected by itself; its colony walked on the whole map")
    graphs = [part or graph for part in parts]
    rest = run.algorithm.iterations - forward.iterations
    inherited = Warm(forward.tau) if split.inherit else None
    tasks = [
        run.task(streams.piece(index), *pair, rest, part=True, warm=inherited, graph=part)
        for index, (pair, part) in enumerate(zip(pairs, graphs, strict=True))
    ]
    second: Run = yield Order(Phase.STAGE_TWO, tasks, parts=True)

    # Step 5: the sub-paths joined.
    crossing = crossings[0] if len(crossings) == 1 else None
    pieces = [
        part.flat[outcome.nodes]
        for part, outcome in zip(graphs, second.outcomes, strict=True)
        if outcome.nodes is not None
    ]
    if len(pieces) < len(pairs):
        run.notes.append("a part found no path; the path is that of stage one")
        return run.found(scouted, crossing)
    joined = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
    return run.found(_repaired(run, np.searchsorted(graph.flat, joined), scouted, split.join), crossing)


def _stage_one(run: Context, split: Decomposition) -> Generator[Order, Any, Run | None]:
    """Two colonies from either end for "the first T0 iterations of the algorithm", that is of its schedule over T.

    Longer where no ant arrives; None where that is in vain.
    """
    ends, whole, forward = run.ends, run.algorithm.iterations, run.problem.graph
    iterations, attempt = split.stage_one, 0
    while iterations < whole:
        tasks = [
            run.task(
                streams.scout(attempt, side),
                *pair,
                iterations,
                schedule=whole,
                warm=run.warm_from_goal if side else run.warm,
                graph=graph,
                all_paths=isinstance(split.cuts, CutsPart),
            )
            for side, (pair, graph) in enumerate(((ends, forward), (ends[::-1], forward.backwards)))
        ]
        first: Run = yield Order(Phase.STAGE_ONE, tasks)
        arrived = any(outcome.nodes is not None for outcome in first.outcomes)
        if arrived or run.stopped or run.call.cancel.is_set():
            return first
        run.notes.append(f"no ant arrived in {iterations} iterations of stage one")
        iterations, attempt = 2 * iterations, attempt + 1
    run.notes.append("solved undivided")
    return None


def _repaired(run: Context, joined: NDArray[np.intp], scouted: NDArray[np.int32] | None, join: Join) -> NDArray[Any]:
    """The joined path, as it is or without its loops, or stage one's where that is shorter.

    A run that was ended early keeps the shorter one too: more time must not make a path longer.
    """
    flat = run.problem.graph.flat
    early = run.stopped or run.call.cancel.is_set()
    path = windows.without_loops(joined) if join is Join.REPAIR else joined
    keeps_shorter = early or join is Join.REPAIR
    if (
        keeps_shorter
        and scouted is not None
        and run.problem.cost_along(flat[scouted]) < run.problem.cost_along(flat[path])
    ):
        run.notes.append("stage one's path is shorter than the joined one, and was kept")
        return scouted
    if len(set(path.tolist())) < len(path):
        run.notes.append("the sub-paths cross; the joined path has a loop")
    return path


def regions(run: Context) -> Strategy:
    """Ants on the graph of regions, from either end; their best routes laid out on cells, side by side.

    The abstraction of a new map is worked out first; that cannot be interrupted.
    """
    problem, algorithm = run.problem, run.algorithm
    begin = time.perf_counter()
    abstraction = run.abstraction
    run.account(Phase.ABSTRACTION, begin)
    ends = problem.flat_ends
    graph = abstraction.between(*ends)
    if graph is None:
        return Found(None, reachable=False)
    if graph.start == graph.goal:
        run.notes.append("start and goal lie in one region; no ant walked")
        return Found(windows.laid_out(np.array(ends, np.int32), abstraction))
    tasks = [
        Task(
            grid_graph=graph,
            start=one,
            goal=other,
            algorithm=algorithm,
            iterations=algorithm.iterations,
            seed=run.call.seed,
            colony=streams.router(side),
            stop=run.call.stop,
            began=run.call.began,
            part=True,
            all_paths=True,
        )
        for side, (one, other) in enumerate(((graph.start, graph.goal), (graph.goal, graph.start)))
    ]
    both: Run = yield Order(Phase.REGIONS, tasks, brief=len(graph) <= BRIEF)
    forward, backward = both.outcomes
    arrived = [*forward.paths, *(path[::-1] for path in backward.paths)]
    routes = decompose.different_routes(arrived, graph, algorithm.routes)
    if not routes:
        return Found(None)
    begin = time.perf_counter()
    stops = [abstraction.stops(route, graph, *ends) for route in routes]
    if len(graph) <= BRIEF:
        paths = [windows.laid_out(each, abstraction) for each in stops]
    else:
        paths = spmd.run_jobs(windows.laid_out, stops, run.local, abstraction)
    paths = [windows.without_loops(path) for path in paths]
    lengths = [run.problem.cost_along(path) for path in paths]
    run.account(Phase.ROUTES, begin)
    return Found(paths[int(np.argmin(lengths))])


def improved(run: Context, found: Found) -> Found:
    """The path after the algorithm's windows, with as few turns as its moves allow."""
    flat = _after_windows(run, found.flat) if run.algorithm.windows and found.flat is not None else found.flat
    if run.algorithm.straighten and flat is not None and len(flat) > 2:
        flat = windows.straightened(flat, run.problem.terrain)
    return Found(flat, found.auxiliary, found.reachable)


def _after_windows(run: Context, path: NDArray[np.int32]) -> NDArray[np.int32]:
    begin, best = time.perf_counter(), math.inf
    terrain = run.problem.terrain

    def ended_with(path: NDArray[np.int32]) -> bool:
        """Whether the run ends with this path: by time, length or `cancel`; iterations count for ants only."""
        nonlocal best
        length = run.problem.cost_along(path)
        if length < best:
            best = length
            run.call.tell(Improved(Phase.WINDOWS, length))
        if not run.stops_at(0, length):
            return False
        run.notes.append("the run ended before its windows did")
        return True

    flat = windows.improved(path, terrain, run.algorithm.windows, run.local, ended_with)
    run.account(Phase.WINDOWS, begin)
    return windows.without_loops(flat)
