"""A colony: a task, its arrays, and a driver that lets it run until a criterion says stop."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.colony import own
from antnav.colony.heuristic import heuristic_weights, initial_pheromone
from antnav.colony.parameters import Settings
from antnav.colony.parts.memory import KnownPath
from antnav.colony.parts.part import Share
from antnav.errors import ParameterError, check_type, shown
from antnav.kernels import ant_kernels
from antnav.kernels.graph import Graph, PlacedGraph, slots_along
from antnav.planner.view import Fate, View
from antnav.run.stop import Clock, Progress, Stop
from antnav.values import check_seed, is_whole, read_only
from antnav.world.moves import SLOT_ANGLES
from antnav.world.path import Path
from antnav.world.problem import Problem, check_problem

#: Cells up to which each iteration passes over all edges, in vectorized loops; on larger maps it works on the rows of
#: tau that ants come to, with the same bytes.
PASSES = 4_000
#: Longest time in seconds that a colony runs between two looks at the clock, the observer and the cancel event.
POLL = 0.03


class Iteration(NamedTuple):
    """What one iteration brought; see `ant_kernels.History` for the units."""

    number: int  #: counted from 1
    best: float
    iteration_best: float
    mean: float
    arrived: int
    lost: int
    steps: int
    entropy: float


class Ant(NamedTuple):
    """What an ant of the last iteration did."""

    fate: Fate
    cells: NDArray[np.int64]  #: (row, col) of its walk, shape (k, 2), to where it arrived or died
    length: float  #: cost of its path, which is length without costs; inf where it did not arrive


class Task(msgspec.Struct, frozen=True, eq=False):
    """One colony's job. It holds all it needs, so it can be sent to another process and run again with the same result.

    Attributes
    ----------
    grid_graph : PlacedGraph
    start, goal : int
        Nodes.
    algorithm : Settings
        With the choices made that depend on the map, see `Algorithm.on`.
    iterations : int
        How many iterations there are to do.
    schedule : int or None
        T of this colony's schedule, by which eq. (4.1) and the deadlock strategy change; None: as many as there are to
        do. Stage one of PACO does the first T0 iterations of T.
    seed, colony : int
        The colony's number makes its random streams differ from its siblings' under one seed.
    stop : Stop or None
    iterations_used : int
        What the solver had done when it made the task; `stop` counts it in.
    began : Clock, optional
        Runs since the solver began, for `stop.Seconds`; default: since the task begins.
    part : bool
        Whether this is only a part of the way, so that its length says nothing about the whole.
    tau : ndarray of float64 (n, 8), optional
        Initial pheromone; default: tau0 everywhere.
    known : KnownPath, optional
        Counts as found before the first iteration; default: none.
    all_paths : bool
        Whether the outcome has the paths of all ants of the last iteration.
    """

    grid_graph: PlacedGraph
    start: int
    goal: int
    algorithm: Settings
    iterations: int
    seed: int
    colony: int = 0
    schedule: int | None = None
    stop: Stop | None = None
    iterations_used: int = 0
    began: Clock | None = None
    part: bool = False
    tau: NDArray[np.float64] | None = None
    known: KnownPath | None = None
    all_paths: bool = False


class Outcome(msgspec.Struct, frozen=True, eq=False):
    """What a task brought.

    Attributes
    ----------
    nodes : ndarray of int32 or None
        Best path; None where no ant arrived.
    length : float
        Its cost, which is length where the problem has no costs; inf without one.
    history : ant_kernels.History
        As long as the iterations that were done.
    visits : ndarray of int64 (n,)
        Arrived paths through each node, over all iterations.
    tau : ndarray of float64 (n, 8)
        Pheromone at the end.
    paths : list of ndarray of int32
        Of the ants that arrived in the last iteration, in ant order, after the best path; none where the task
        does not ask for them.
    seconds, cpu_seconds : float
        Of the thread that ran the task.
    stopped : bool
        Whether the task's criterion ended it.
    """

    nodes: NDArray[np.int32] | None
    length: float
    history: ant_kernels.History
    visits: NDArray[np.int64]
    tau: NDArray[np.float64]
    paths: list[NDArray[np.int32]]
    seconds: float
    cpu_seconds: float
    stopped: bool

    @property
    def iterations(self) -> int:
        """Iterations done."""
        return len(self.history.best)

    @property
    def steps(self) -> int:
        """Moves of all ants."""
        return int(self.history.steps.sum())


class Colony:
    """Ants that look for a path, one iteration at a time or many at once.

    Parameters
    ----------
    problem : Problem
        Its start and goal must differ and be connected.
    algorithm : Algorithm
        One that runs one colony on the whole map: without decomposition, `coarse`, `windows` and `colonies`. `Steps`
        steps through the others.
    seed : int
        0 <= seed < 2**64. The same seed gives the same ants on every machine.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> for iteration in an.Colony(problem, an.npaco(iterations=3), seed=7):
    ...     print(iteration.number, round(iteration.best, 2), iteration.lost)
    1 46.87 0
    2 38.38 28
    3 38.38 25
    """

    def __init__(self, problem: Problem, algorithm: Settings, seed: int = 0) -> None:
        check_problem(problem)
        check_type("algorithm", algorithm, Settings, "call a preset, as in an.npaco()")
        if algorithm.decomposition or algorithm.coarse or algorithm.windows or algorithm.colonies > 1:
            raise ParameterError(
                f"algorithm {algorithm.name}",
                "a colony is one, on the cells of the whole map; this algorithm runs several, or windows after them",
                "step through it with an.Steps, or give decomposition=None, coarse=0, windows=0 and colonies=1",
            )
        if problem.start_cell == problem.goal_cell or not problem.connected:
            raise ParameterError(
                f"{problem.start_cell} -> {problem.goal_cell}",
                "a colony needs a start and a goal that differ and are connected",
                "use solve(), which answers such problems without ants",
            )
        self._prepare(whole_task(problem, algorithm, seed))

    @classmethod
    def of(cls, task: Task) -> Colony:
        """The colony of a task."""
        colony = cls.__new__(cls)
        colony._prepare(task)
        return colony

    def _prepare(self, task: Task) -> None:
        self.task = task
        self.iteration = 0  #: iterations done
        algorithm, n, ants = task.algorithm, len(task.grid_graph), task.algorithm.ants
        graph = task.grid_graph.graph
        # Dask hands out read-only arrays, for which Numba would compile anew.
        self._graph = Graph._make(np.require(array, requirements=["C", "W"]) for array in graph)
        self._choices = _choices(task)
        self._state = ant_kernels.State(
            tau=initial_pheromone(algorithm, task.grid_graph, task.start, task.goal)
            if task.tau is None
            else task.tau.copy(),
            latest=np.zeros(n, np.int32),
            past=np.empty((task.iterations + 2, 4)),
            eta=heuristic_weights(algorithm, task.grid_graph, task.start, task.goal),
            weight=np.empty((n * self._choices.headings, 8)),
            exponent=np.ones(1),
            place=np.zeros(n, np.int32),
            merged_path=np.empty(n, np.int32),
            merged_slots=np.empty(n, np.uint8),
            bounds=np.array([algorithm.tau_min * algorithm.tau0, np.inf]),
            stagnant=np.zeros(2, np.int64),
            angles=SLOT_ANGLES,
            visited=np.zeros(n + 1, np.uint64),
            seen=np.empty(n * -(-ants // ant_kernels.BATCH) + 1, np.int32),
            count_seen=np.zeros(1, np.int64),
            path=np.empty((ants, n), np.int32),
            slots=np.empty((ants, n), np.uint8),
            steps_on_path=np.empty(ants, np.int64),
            status=np.empty(ants, np.uint8),
            met_dead_end=np.empty(ants, np.uint8),
            length=np.empty(ants),
            order=np.empty(ants, np.int64),
            depositor=np.empty(2 * ants + 1, np.int64),
            amount=np.empty(2 * ants + 1),
            dead_count=np.zeros(n, np.int32),
            dead_last=np.zeros(n, np.uint64),
            dead_pairs=np.zeros(n, np.uint64),
            dead_blocks=np.zeros(n // ant_kernels.BLOCK + 1, np.uint8),
            visits=np.zeros(n, np.int64),
            best_path=np.empty(n, np.int32),
            best_slots=np.empty(n, np.uint8),
            best_steps=np.full(1, -1, np.int64),
        )
        self._state.visited[n] = ~np.uint64(0)
        self._own = own.asked(algorithm, self._graph, self._choices, self._state)
        self._settled, self._watched = False, False
        self._history = ant_kernels.new_history(task.iterations)
        if task.known is not None:
            nodes = task.known.nodes
            steps = len(nodes) - 1
            self._state.best_steps[0] = steps
            self._state.best_path[: steps + 1] = nodes
            self._state.best_slots[:steps] = slots_along(graph, nodes)

    def step(self, count: int = 1) -> None:
        """Run `count` more iterations in one kernel call, or as many as the schedule still has."""
        if not is_whole(count) or count < 0:
            rule = "it is a whole number of iterations, 0 or more"
            raise ParameterError(f"count {shown(count)}", rule, "give one, such as 10")
        count = min(count, self.task.iterations - self.iteration)
        if count > 0:
            if self._own:
                self._own.check()  # what a rule left when it failed is nothing to walk on
            seed = np.uint64(self.task.seed)
            ant_kernels.advance(
                self._graph,
                self._choices,
                self._state,
                self._history,
                seed,
                self.task.colony,
                self.iteration + 1,
                count,
                True if self._own or self.task.algorithm.searches else None,
                self._own and self._own.plugs,
                self._own and self._own.walking,
            )
            if self._own:
                self._own.check()
            self.iteration += count
            self._settled = False
            if self._watched:
                self._settle()

    def __iter__(self) -> Iterator[Iteration]:
        while self.iteration < self.task.iterations:
            self.step()
            yield self.last

    @property
    def last(self) -> Iteration:
        """The latest iteration.

        Raises
        ------
        ParameterError
            There is none yet.
        """
        if not self.iteration:
            raise ParameterError("the last iteration", "none is done yet", "call step() first")
        return Iteration(self.iteration, *(array[self.iteration - 1].item() for array in self._history))

    @property
    def history(self) -> ant_kernels.History:
        """All iterations done so far."""
        return ant_kernels.History(*(array[: self.iteration].copy() for array in self._history))

    @property
    def tau(self) -> NDArray[np.float64]:
        """Pheromone of every edge, shape (n, 8); may be written to between steps: own rules need no kernel.

        Row i is node i: the cells that can be reached from the start, in map order. With
        `graph = colony.task.grid_graph`, `graph.cells[i]` is the node's (row, col), and `graph.node((row, col))` the
        node of a cell. Column k is the edge of move k: up left, up, up right, left, right, down left, down, down right.
        `graph.graph.neighbours[i, k]` is the node at its end, or n where no such move is legal; what tau holds there
        means nothing. The edge from there back is `tau[neighbours[i, k], 7 - k]`.
        """
        self._watched = True  # whoever has it may look at it after any step
        return self._settle()

    def _settle(self) -> NDArray[np.float64]:
        """Pheromone, after the kernel has brought all of it to the end of the last iteration."""
        state = self._state
        if not self._settled:
            ant_kernels.settle(state.tau, state.latest, state.past, state.bounds, self.iteration)
            self._settled = True
        return state.tau

    @property
    def best_length(self) -> float:
        """Cost of the best path so far, which is length without costs; inf before the first arrival."""
        return float(self._history.best[self.iteration - 1] if self.iteration else self._choices.known)

    @property
    def best_nodes(self) -> NDArray[np.int32] | None:
        """Nodes of the best path so far."""
        steps = int(self._state.best_steps[0])
        return None if steps < 0 else self._state.best_path[: steps + 1].copy()

    def view(self) -> View:
        """How it stands: arrays that are its own and cannot be written to."""
        state, best = self._state, self.best_nodes
        arrived = int(np.count_nonzero(state.status == ant_kernels.ARRIVED)) if self.iteration else 0
        self._settle()
        arrays = (state.tau, state.order[:arrived], state.length, state.status, state.steps_on_path, state.path)
        tau, order, lengths, fates, steps, paths = (read_only(array.view()) for array in arrays)
        return View(
            iteration=self.iteration,
            cells=self.task.grid_graph.cells,
            neighbours=self._graph.neighbours,
            tau=tau,
            order=order,
            lengths=lengths,
            fates=fates,
            steps=steps,
            paths=paths,
            best=np.empty(0, np.int32) if best is None else best,
            best_length=self.best_length,
        )

    def ants(self) -> list[Ant]:
        """All ants of the last iteration, lost ones too; none before the first."""
        view = self.view()
        return [
            Ant(
                fate := Fate(int(view.fates[ant])),
                view.cells[view.path(ant)],
                float(view.lengths[ant]) if fate is Fate.ARRIVED else math.inf,
            )
            for ant in range(len(view.fates) if self.iteration else 0)
        ]

    def ant_paths(self) -> list[NDArray[np.int32]]:
        """Nodes of the paths of the ants that arrived in the last iteration, in ant order."""
        state = self._state
        arrived = np.flatnonzero(state.status == ant_kernels.ARRIVED) if self.iteration else ()
        return [state.path[ant, : state.steps_on_path[ant] + 1].copy() for ant in arrived]

    def outcome(self, seconds: float, cpu_seconds: float, *, stopped: bool = False) -> Outcome:
        """What the colony has brought so far, in that time."""
        best = self.best_nodes
        if self._own and best is not None:
            self._own.check_path(best, self.task.start, self.task.goal, self._graph)
        paths = self.ant_paths() if self.task.all_paths else []
        return Outcome(
            best,
            self.best_length,
            self.history,
            self._state.visits,
            self._settle(),
            paths if best is None or not self.task.all_paths else [best, *paths],
            seconds,
            cpu_seconds,
            stopped,
        )

    def best_path(self, problem: Problem) -> Path | None:
        """Best path so far on the map of `problem`."""
        check_problem(problem)
        nodes = self.best_nodes
        return None if nodes is None else Path(self.task.grid_graph.cells[nodes].astype(np.int32), problem.grid)


def _choices(task: Task) -> ant_kernels.Choices:
    """The scalars of a task: the algorithm's own, and each part's share."""
    algorithm, graph = task.algorithm, task.grid_graph.graph
    schedule = task.schedule or task.iterations
    shares: Share = {}
    for part in algorithm.parts.values():
        shares |= part.share(schedule)
    return ant_kernels.Choices(
        start=task.start,
        goal=task.goal,
        known=math.inf if task.known is None else float(task.known.cost),
        ants=algorithm.ants,
        iterations=schedule,
        alpha=float(algorithm.alpha),
        rho=float(algorithm.rho),
        rho_last=float(algorithm.rho if algorithm.rho_last is None else algorithm.rho_last),
        beta_share=1.0 if algorithm.beta_last is None else float(algorithm.beta_last / algorithm.beta),
        spread=float(algorithm.spread),
        q=float(algorithm.q),
        tau0=float(algorithm.tau0),
        deposit=algorithm.deposit.code,
        graft=algorithm.graft,
        local_rate=float(algorithm.local_rate),
        dear=bool(task.grid_graph.dear),
        turning=float(task.grid_graph.turning),
        passes=len(task.grid_graph) <= PASSES or bool(own.rules_of(algorithm)),
        mean_choices=np.count_nonzero(graph.neighbours < len(task.grid_graph)) / len(task.grid_graph),
        **shares,  # type: ignore[arg-type]
    )


Observer = Callable[[Colony], None]


class Cancel(Protocol):
    """Something that can say stop, such as a threading.Event."""

    def is_set(self) -> bool:
        """Whether to stop."""


def whole_task(problem: Problem, algorithm: Settings, seed: int) -> Task:
    """The task of one colony on the undivided problem."""
    graph = problem.graph
    nodes = graph.node(problem.start_cell), graph.node(problem.goal_cell)
    return Task(graph, *nodes, algorithm.suited(problem), algorithm.iterations, check_seed(seed))


def run(job: Task | Colony, cancel: Cancel | None = None, observer: Observer | None = None) -> Outcome:
    """Run a task until its schedule ends, its criterion is reached or it is cancelled.

    Parameters
    ----------
    job : Task or Colony
        Of a colony, its task.
    cancel : object with is_set(), optional
        Such as a threading.Event set by another thread; the best so far comes back within `POLL` seconds or one
        iteration, whichever is longer.
    observer : callable, optional
        Called with the colony every `POLL` seconds or one iteration, whichever is longer, and after the last one.
    """
    begin, cpu = time.perf_counter(), time.thread_time()
    colony = Colony.of(job) if isinstance(job, Task) else job
    task = colony.task
    clock = task.began or Clock()
    chunk, improved, best, reached, told = 1, 0, math.inf, False, -math.inf
    while colony.iteration < task.iterations and not (cancel and cancel.is_set()):
        before = time.perf_counter()
        colony.step(1 if task.stop else chunk)
        pause = time.perf_counter() - before
        chunk = max(1, min(int(chunk * POLL / max(pause, 1e-9)), task.iterations))
        if observer and (before + pause - told >= POLL or colony.iteration == task.iterations):
            observer(colony)
            told = time.perf_counter()
        if task.stop:
            if colony.best_length < best:
                improved, best = colony.iteration, colony.best_length
            progress = Progress(
                task.iterations_used + colony.iteration,
                clock.seconds(),
                math.inf if task.part else best,
                colony.iteration - improved if math.isfinite(best) else 0,
            )
            if reached := task.stop.reached(progress):
                break
    return colony.outcome(time.perf_counter() - begin, time.thread_time() - cpu, stopped=reached)
