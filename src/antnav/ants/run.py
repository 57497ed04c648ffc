"""Run: a strategy carried out, the colonies of each stage side by side."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, NamedTuple

from antnav.ants.accounts import Run
from antnav.ants.strategies import Context, Found, Order, strategy_of
from antnav.colony import colony
from antnav.colony.colony import Colony, Task
from antnav.planner.call import CancelOrFailure
from antnav.planner.events import Improved, Iterated, StageBegan
from antnav.planner.view import View
from antnav.run import spmd

if TYPE_CHECKING:
    from antnav.run.channel import Sender

#: Bytes of a view that is sent from another process at most: 30 of them a second are little then.
MOST_SENT = 4_000_000
#: Cells up to which colonies are made before their threads begin: 50 us each there, but 450 where two threads that make
#: one contend for the interpreter's lock. On larger maps the arrays matter more, and are filled side by side.
PREPARED = 20_000


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
    begin, call = time.perf_counter(), run.call
    call.tell(StageBegan(order.phase, len(order.tasks)))
    watch = _Watch(run, order)
    if spmd.shares_memory(call.executor):
        jobs = [Colony.of(task) if len(task.grid_graph) <= PREPARED else task for task in order.tasks]
        common = call.cancel, watch.colony if call.events else None
        if order.brief:
            outcomes = [_ran(job, *common) for job in jobs]
        else:
            outcomes = spmd.run_jobs(_ran, jobs, call.executor, *common)
    elif call.events or call.cancel.event:
        from antnav.run.channel import Channel

        with Channel(watch.hear, call.cancel) as sender:
            outcomes = spmd.run_jobs(_ran_elsewhere, order.tasks, call.executor, sender, call.events is not None)
    else:
        outcomes = spmd.run_jobs(colony.run, order.tasks, call.executor)
    run.stopped |= any(outcome.stopped for outcome in outcomes)
    return run.keep(order, outcomes, time.perf_counter() - begin)


def _ran(job: Task | Colony, cancel: CancelOrFailure, observer: colony.Observer | None) -> colony.Outcome:
    """`colony.run`; where it fails, the other colonies end at their next look, and nobody waits for their schedules."""
    try:
        return colony.run(job, cancel, observer)
    except BaseException:
        cancel.failed = True
        raise


def _ran_elsewhere(task: Task, sender: Sender, watched: bool) -> colony.Outcome:
    """`colony.run` in another process."""
    with sender:
        return colony.run(task, sender, (lambda seen: sender.send(_Told.of(seen).to_send())) if watched else None)


class _Told(NamedTuple):
    """What a colony tells of itself."""

    colony: int
    number: int
    best: float
    view: View | None

    @classmethod
    def of(cls, seen: Colony) -> _Told:
        """All of it."""
        return cls(seen.task.colony, seen.iteration, seen.best_length, seen.view())

    def to_send(self) -> _Told:
        """The same without a view that is too large to be sent often."""
        view = self.view
        large = view is not None and view.tau.nbytes + view.paths.nbytes > MOST_SENT
        return self._replace(view=None) if large else self


class _Watch:
    """Turns what colonies of a stage tell into events of the whole run, one at a time."""

    def __init__(self, run: Context, order: Order) -> None:
        self._run, self._order = run, order
        self._place = {task.colony: place for place, task in enumerate(order.tasks)}
        self._bests: dict[int, float] = {}
        self._best = math.inf

    def colony(self, seen: Colony) -> None:
        """A colony in this process."""
        self.hear(_Told.of(seen))

    def hear(self, told: _Told) -> None:
        """A colony has told something, from any thread."""
        order, call = self._order, self._run.call
        with self._run.telling:
            self._bests[told.colony] = told.best
            best = order.best(self._bests.values())
            place = self._place[told.colony]
            done = (order.tasks[place].iterations_used + told.number) / self._run.algorithm.iterations
            call.tell(Iterated(order.phase, place, told.number, min(1.0, done), best, told.view))
            if best < self._best:
                self._best = best
                call.tell(Improved(order.phase, best))
