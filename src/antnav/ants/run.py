"""Run: a strategy carried out, the colonies of each stage side by side."""

from __future__ import annotations

import time

from antnav.ants.accounts import Run
from antnav.ants.strategies import Context, Found, Order, Snapshot, strategy_of
from antnav.colony import colony
from antnav.colony.colony import Iteration, Task
from antnav.planner.call import CancelOrFailure
from antnav.run import spmd


def carried_out(run: Context) -> Found:
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
    if spmd.shares_memory(run.call.executor):
        watch = _watch(run, order) if run.call.observer else None
        outcomes = spmd.run_jobs(_ran, order.tasks, run.call.executor, run.call.cancel, watch)
    else:
        outcomes = spmd.run_jobs(colony.run, order.tasks, run.call.executor)
    run.stopped |= any(outcome.stopped for outcome in outcomes)
    return run.keep(order, outcomes, time.perf_counter() - begin)


def _ran(task: Task, cancel: CancelOrFailure, observer: colony.Observer | None) -> colony.Outcome:
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
        assert run.call.observer is not None
        run.call.observer(Snapshot(order.phase, min(1.0, done), order.best(bests.values())))

    return see
