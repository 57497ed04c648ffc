"""run_study: does the runs of a study that its store does not have yet."""

from __future__ import annotations

import math
import os
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing
from dataclasses import replace
from itertools import islice

from antnav.errors import ParameterError
from antnav.plan.solve import solve
from antnav.planner.facts import Certainty
from antnav.planner.plan import StoppedBy
from antnav.planner.result import Result
from antnav.run.spmd import Serial
from antnav.run.stop import Iterations, Seconds, Stop
from antnav.search import exact
from antnav.study.budget import Budget
from antnav.study.model import Job, Study
from antnav.study.record import Mark, Record
from antnav.study.store import Store
from antnav.world.path import check_cost, check_path

__all__ = ["Progress", "run_study", "without_times"]

#: Called with runs done, runs in all, and seconds left (None before the first run has ended).
Progress = Callable[[int, int, float | None], None]


def run_study(
    study: Study,
    store: Store,
    *,
    workers: int | None = None,
    cancel: threading.Event | None = None,
    progress: Progress | None = None,
) -> list[Record]:
    """Do the missing runs of a study, each stored as it ends.

    Parameters
    ----------
    study : Study
    store : Store
        What it has is not run again, so a study that was interrupted, in whatever way, goes on where it stopped.
    workers : int, optional
        Runs side by side, >= 1; see the notes. Default 1.
    cancel : threading.Event, optional
        Set it from elsewhere to end early: runs under way are given up. May be set here where the study fails.
    progress : callable, optional
        Called in this thread, at the start and after each run.

    Returns
    -------
    list of Record
        In the order of `study.jobs()`; after cancelling, those that are there.

    Raises
    ------
    ParameterError
        Fewer than one worker; more than one where seconds are the budget.
    OutputError
        The store cannot be written, such as on a full disk. What was stored before is untouched.
    PathError
        A planner broke the rules of the map: a bug.

    Notes
    -----
    Times are measured with one worker: runs follow each other, nothing else of the study runs meanwhile, and the two
    colonies of a divided problem have a thread each. With more workers, each run has one thread for all its colonies
    and shares caches and memory with others; its figures are the same, its CPU seconds nearly, but its wall seconds
    say little, and its record has the mark `loaded`.
    """
    if workers is not None and workers < 1:
        raise ParameterError(f"workers {workers}", "at least 1 worker is needed", "give 1 or more")
    if study.equal_budget is Budget.SECONDS and (workers or 1) > 1:
        rule = "the seconds of runs that share the machine are no measure"
        raise ParameterError(f"{workers} workers with equal_budget seconds", rule, "use 1 worker")
    cancel = cancel or threading.Event()
    jobs = study.jobs()
    stored = store.keys()
    distinct = {job.key: job for job in jobs}
    missing = [job for job in distinct.values() if job.key not in stored]
    reporter = _Reporter(len(distinct), missing, workers or 1, progress)
    _prepare(missing)
    _run([job for job in missing if not job.reference], store, workers or 1, cancel, reporter)
    _run(_allowed(missing, store), store, workers or 1, cancel, reporter)
    records = {record.key: record for record in store.records()}
    return [_labelled(records[job.key], job) for job in jobs if job.key in records]


def without_times(record: Record) -> Record:
    """The part of a record that is the same for all runs of one key."""
    marks = tuple(mark for mark in record.marks if mark not in {Mark.LOADED, Mark.BUSY})
    return replace(record, seconds=0.0, cpu_seconds=0.0, marks=marks, environment={})


def _prepare(jobs: Sequence[Job]) -> None:
    """Do beforehand what runs on one map share, so that the first one's time does not hold it."""
    for job in jobs:
        exact.optimum(job.problem)
        job.algorithm.prepare(job.problem)


def _run(jobs: Sequence[Job], store: Store, workers: int, cancel: threading.Event, reporter: _Reporter) -> None:
    outcomes = _one_by_one(jobs, cancel) if workers == 1 else _side_by_side(jobs, workers, cancel)
    with closing(outcomes):
        for job, result, seconds in outcomes:
            if result.path is not None:
                check_path(result.path, job.problem)
                check_cost(result.path, job.problem, result.cost)
            record = Record.of(result, key=job.key, map_label=job.map_label, algorithm_label=job.algorithm_label)
            limited = (_ending(job, result),) if result.stopped_by is StoppedBy.CRITERION else ()
            company = (Mark.LOADED,) if workers > 1 else (Mark.BUSY,) if _busy() else ()
            store.add(replace(record, marks=limited + company))
            reporter.done(job, seconds)


def _allowed(jobs: Sequence[Job], store: Store) -> list[Job]:
    """The jobs with a budget, each with what its reference used; those whose reference was given up are left out."""
    limited = [job for job in jobs if job.reference]
    spent = {record.key: record for record in store.records()} if limited else {}
    return [
        replace(job, allowed=float(getattr(spent[job.reference], str(job.budget))))
        for job in limited
        if job.reference in spent
    ]


def _ending(job: Job, result: Result) -> Mark:
    """Which limit ended a run."""
    if job.budget is Budget.STEPS and result.steps > job.allowed:
        return Mark.EXCEEDED
    in_time = job.seconds is None or result.seconds_run < job.seconds
    return Mark.SPENT if job.budget is not None and in_time else Mark.LIMITED


def _busy() -> bool:
    """Whether more processes want to run than there are cores; False where the system does not tell."""
    return hasattr(os, "getloadavg") and os.getloadavg()[0] > (os.cpu_count() or 1)


_Outcome = tuple[Job, Result, float]


def _one_by_one(jobs: Sequence[Job], cancel: threading.Event) -> Generator[_Outcome, None, None]:
    for job in jobs:
        outcome = _solved(job, None, cancel)
        if outcome is None:
            return
        yield outcome


def _side_by_side(jobs: Sequence[Job], workers: int, cancel: threading.Event) -> Generator[_Outcome, None, None]:
    """Results in the order in which the runs end.

    A run starts when one ends, not before, so that no more than a few results wait for the store.
    """
    pool = ThreadPoolExecutor(workers, thread_name_prefix="antnav-study")
    waiting = iter(jobs)

    def start(count: int) -> set[Future[_Outcome | None]]:
        return {pool.submit(_solved, job, Serial(), cancel) for job in islice(waiting, count)}

    try:
        running = start(workers)
        while running:
            ended, running = wait(running, return_when=FIRST_COMPLETED)
            running |= start(len(ended))
            for future in ended:
                outcome = future.result()
                if outcome is not None:
                    yield outcome
    except BaseException:  # GeneratorExit too: the one who reads the results failed
        cancel.set()
        raise
    finally:
        pool.shutdown()


def _solved(job: Job, executor: Executor | None, cancel: threading.Event) -> _Outcome | None:
    """The job's result and the seconds that it took with all that belongs to it; None once cancelled."""
    if cancel.is_set():
        return None
    begin = time.perf_counter()
    limits = [job.seconds, job.allowed if job.budget is Budget.SECONDS else None]
    seconds = min((limit for limit in limits if limit is not None), default=None)
    stop: Stop | None = None if seconds is None else Seconds(seconds)
    result = solve(job.problem, job.algorithm, seed=job.seed, stop=stop, executor=executor, cancel=cancel)
    within = int((result.history.steps.cumsum() <= job.allowed).sum()) if job.budget is Budget.STEPS else math.inf
    if within < result.iterations:  # again, up to there: the same seed makes the same steps
        ends = Iterations(max(1, int(within)))
        stop = ends if stop is None else stop | ends
        result = solve(job.problem, job.algorithm, seed=job.seed, stop=stop, executor=executor, cancel=cancel)
    if result.stopped_by is StoppedBy.CANCELLED:
        return None
    return job, result, time.perf_counter() - begin


def _labelled(record: Record, job: Job) -> Record:
    """A record under the labels of a job: it may stem from another study, or from a job of another name."""
    certainty = Certainty.of(job.algorithm.on(job.problem.grid).certainty)
    return replace(record, map=job.map_label, algorithm=job.algorithm_label, certainty=certainty)


class _Reporter:
    """Counts runs, and guesses the time left: a run takes as long as those of its algorithm on its map so far.

    Until one of them has run, as long as all runs so far, on average.
    """

    def __init__(self, total: int, missing: Sequence[Job], workers: int, progress: Progress | None) -> None:
        self._total, self._workers, self._progress = total, workers, progress
        self._left = Counter(_kind(job) for job in missing)
        self._runs: Counter[tuple[str, str]] = Counter()
        self._seconds: defaultdict[tuple[str, str], float] = defaultdict(float)
        self._report()

    def done(self, job: Job, seconds: float) -> None:
        """Count a run that took so many seconds."""
        self._left[_kind(job)] -= 1
        self._runs[_kind(job)] += 1
        self._seconds[_kind(job)] += seconds
        self._report()

    def _report(self) -> None:
        if self._progress:
            self._progress(self._total - self._left.total(), self._total, self._seconds_left())

    def _seconds_left(self) -> float | None:
        if not self._left.total():
            return 0.0
        if not self._runs:
            return None
        means = {kind: seconds / self._runs[kind] for kind, seconds in self._seconds.items()}
        typical = sum(self._seconds.values()) / self._runs.total()
        return sum(count * means.get(kind, typical) for kind, count in self._left.items()) / self._workers


def _kind(job: Job) -> tuple[str, str]:
    return job.map_label, job.algorithm_label
