"""solve: a problem and an algorithm in, a result out."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor

from antnav.ants.accounts import Run, heat, joined_history
from antnav.ants.presets import paco
from antnav.ants.strategies import Cancel, Context, Found, Order, Snapshot, improved, strategy_of
from antnav.colony import colony
from antnav.colony.colony import Iteration, Task
from antnav.colony.parameters import Algorithm
from antnav.errors import ParameterError, check_type, shown
from antnav.plan.warmup import warmup
from antnav.planner.result import Result, Status, StoppedBy, versions
from antnav.run import spmd
from antnav.run.stop import Stop
from antnav.world.problem import Problem, check_problem


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
    algorithm = checked(problem, algorithm, seed)
    check_type("stop", stop, Stop | None, "give a criterion of antnav.run.stop, such as Seconds(0.5)")
    spmd.shares_memory(executor)  # checks it
    if not (cancel is None or callable(getattr(cancel, "is_set", None))):
        raise ParameterError(f"cancel {shown(cancel)}", "it has is_set()", "give a threading.Event")
    if not (observer is None or callable(observer)):
        raise ParameterError(f"observer {shown(observer)}", "it is called with a Snapshot", "give a function")
    seconds_compile = warmup(algorithm)
    run = Context(problem, algorithm.on(problem.grid), seed, stop, executor, Cancel(cancel), observer)
    try:
        found = improved(run, _carried_out(run))
    except BaseException:
        run.cancel.failed = True  # colonies in other threads end at their next look
        raise
    return concluded(run, found, run.began.seconds(), seconds_compile)


def checked(problem: Problem, algorithm: Algorithm | None, seed: int) -> Algorithm:
    """The algorithm, `paco` by default, if all three are what they should be.

    Raises
    ------
    ParameterError
        One is not.
    """
    algorithm = paco() if algorithm is None else algorithm
    check_type("algorithm", algorithm, Algorithm, "call a preset, as in an.paco()")
    check_problem(problem)
    colony.check_seed(seed)
    return algorithm


def _carried_out(run: Context) -> Found:
    """The algorithm's strategy, the colonies of each stage side by side on the executor."""
    strategy, done = strategy_of(run), None
    while True:
        try:
            order = strategy.send(done)
        except StopIteration as end:
            found: Found = end.value
            return found
        done = _side_by_side(run, order)


def _side_by_side(run: Context, order: Order) -> Run:
    """Run the colonies of a stage, and keep account of it."""
    begin = time.perf_counter()
    if spmd.shares_memory(run.executor):
        watch = _watch(run, order) if run.observer else None
        outcomes = spmd.run_jobs(_ran, order.tasks, run.executor, run.cancel, watch)
    else:
        outcomes = spmd.run_jobs(colony.run, order.tasks, run.executor)
    run.stopped |= any(outcome.stopped for outcome in outcomes)
    return run.keep(order, outcomes, time.perf_counter() - begin)


def _ran(task: Task, cancel: Cancel, observer: colony.Observer | None) -> colony.Outcome:
    """`colony.run`; where it fails, the other colonies end at their next look, and nobody waits for their schedules."""
    try:
        return colony.run(task, cancel, observer)
    except BaseException:
        cancel.failed = True
        raise


def _watch(run: Context, order: Order) -> colony.Observer:
    """An observer of a stage's colonies that makes snapshots of the whole run."""
    bests: dict[int, float] = {}

    def see(task: Task, iteration: Iteration) -> None:
        bests[task.colony] = iteration.best
        done = (task.iterations_used + iteration.number) / run.algorithm.iterations
        assert run.observer is not None
        run.observer(Snapshot(order.phase, min(1.0, done), order.best(bests.values())))

    return see


def concluded(run: Context, found: Found, seconds: float, seconds_compile: float = 0.0) -> Result:
    """What is told about a run that is over."""
    problem = run.problem
    status = Status.FOUND if found.flat is not None else Status.NO_ANT_ARRIVED
    if not found.reachable:
        status = Status.UNREACHABLE
    ending = StoppedBy.CRITERION if run.stopped else StoppedBy.SCHEDULE
    auxiliary = None if found.auxiliary is None else problem.graph.cells[found.auxiliary]
    return Result(
        status=status,
        stopped_by=StoppedBy.CANCELLED if run.cancel.is_set() else ending,
        problem=problem,
        algorithm=run.algorithm,
        seed=int(run.seed),
        path=None if found.flat is None else run.on_map(found.flat),
        auxiliary_cell=None if auxiliary is None else (int(auxiliary[0]), int(auxiliary[1])),
        stages=tuple(stage.stage() for stage in run.runs),
        history=joined_history(run.runs),
        heat=heat(problem, run.runs, run.abstraction.on_map if run.algorithm.coarse else None),
        stop=None if run.stop is None else repr(run.stop),
        notes=(*run.notes, *problem.moved_ends),
        seconds_run=seconds,
        seconds_compile=seconds_compile,
        cpu_seconds=sum(outcome.cpu_seconds for stage in run.runs for outcome in stage.outcomes),
        versions=versions(),
    )
