"""run_study: does the runs of a study that its store does not have yet."""

from __future__ import annotations

import os
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing
from dataclasses import replace
from itertools import islice
from typing import Any, TypeVar

from antnav.errors import ParameterError
from antnav.run.spmd import Serial
from antnav.study.budget import Budget
from antnav.study.model import AnyJob, AnyStudy
from antnav.study.record import Kept, Mark, Record
from antnav.study.store import Store

__all__ = ["Progress", "run_study", "without_times"]

R = TypeVar("R", bound=Kept)

#: Called with runs done, runs in all, and seconds left (None before the first run has ended).
Progress = Callable[[int, int, float | None], None]


def run_study(
    study: AnyStudy[R],
    store: Store[R],
    *,
    workers: int | None = None,
    cancel: threading.Event | None = None,
    progress: Progress | None = None,
) -> list[R]:
    """Do the missing runs of a study, each stored as it ends.

    Parameters
    ----------
    study : Study
    store : Store
        Of what the study keeps. What it has is not run again, so a study that was interrupted, in whatever way, goes on
        where it stopped.
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
    for job in missing:
        job.prepare()
    _run([job for job in missing if not job.reference], store, workers or 1, cancel, reporter)
    _run(_allowed(missing, store), store, workers or 1, cancel, reporter)
    records = {record.key: record for record in store.records()}
    return [job.labelled(records[job.key]) for job in jobs if job.key in records]


def without_times(record: Record) -> Record:
    """The part of a record that is the same for all runs of one key."""
    marks = tuple(mark for mark in record.marks if mark not in {Mark.LOADED, Mark.BUSY})
    return replace(record, seconds=0.0, cpu_seconds=0.0, marks=marks, environment={})


def _run(
    jobs: Sequence[AnyJob[R]], store: Store[R], workers: int, cancel: threading.Event, reporter: _Reporter
) -> None:
    outcomes = _one_by_one(jobs, cancel) if workers == 1 else _side_by_side(jobs, workers, cancel)
    with closing(outcomes):
        for job, record, seconds in outcomes:
            company = (Mark.LOADED,) if workers > 1 else (Mark.BUSY,) if _busy() else ()
            store.add(replace(record, marks=record.marks + company))
            reporter.done(job, seconds)


def _allowed(jobs: Sequence[AnyJob[R]], store: Store[R]) -> list[AnyJob[R]]:
    """The jobs with a budget, each with what its reference used; those whose reference was given up are left out."""
    limited = [job for job in jobs if job.reference]
    spent = {record.key: record for record in store.records()} if limited else {}
    return [
        replace(job, allowed=float(getattr(spent[job.reference], str(job.budget))))
        for job in limited
        if job.reference in spent
    ]


def _busy() -> bool:
    """Whether more processes want to run than there are cores; False where the system does not tell."""
    return hasattr(os, "getloadavg") and os.getloadavg()[0] > (os.cpu_count() or 1)


_Outcome = tuple[AnyJob[R], R, float]


def _one_by_one(jobs: Sequence[AnyJob[R]], cancel: threading.Event) -> Generator[_Outcome[R], None, None]:
    for job in jobs:
        outcome = _done(job, None, cancel)
        if outcome is None:
            return
        yield outcome


def _side_by_side(
    jobs: Sequence[AnyJob[R]], workers: int, cancel: threading.Event
) -> Generator[_Outcome[R], None, None]:
    """Records in the order in which the runs end.

    A run starts when one ends, not before, so that no more than a few records wait for the store.
    """
    pool = ThreadPoolExecutor(workers, thread_name_prefix="antnav-study")
    waiting = iter(jobs)

    def start(count: int) -> set[Future[_Outcome[R] | None]]:
        return {pool.submit(_done, job, Serial(), cancel) for job in islice(waiting, count)}

    try:
        running = start(workers)
        while running:
            ended, running = wait(running, return_when=FIRST_COMPLETED)
            running |= start(len(ended))
            for future in ended:
                outcome = future.result()
                if outcome is not None:
                    yield outcome
    except BaseException:  # GeneratorExit too: the one who reads the records failed
        cancel.set()
        raise
    finally:
        pool.shutdown()


def _done(job: AnyJob[R], executor: Executor | None, cancel: threading.Event) -> _Outcome[R] | None:
    """The job's record and the seconds that it took with all that belongs to it; None once cancelled."""
    if cancel.is_set():
        return None
    begin = time.perf_counter()
    record = job.run(executor, cancel)
    return None if record is None else (job, record, time.perf_counter() - begin)


class _Reporter:
    """Counts runs, and guesses the time left: a run takes as long as those of its algorithm on its map so far.

    Until one of them has run, as long as all runs so far, on average.
    """

    def __init__(self, total: int, missing: Sequence[AnyJob[Any]], workers: int, progress: Progress | None) -> None:
        self._total, self._workers, self._progress = total, workers, progress
        self._left = Counter(_kind(job) for job in missing)
        self._runs: Counter[tuple[str, str]] = Counter()
        self._seconds: defaultdict[tuple[str, str], float] = defaultdict(float)
        self._report()

    def done(self, job: AnyJob[Any], seconds: float) -> None:
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


def _kind(job: AnyJob[Any]) -> tuple[str, str]:
    return job.map_label, job.algorithm_label
