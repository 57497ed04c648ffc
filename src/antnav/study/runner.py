"""run_study: does the runs of a study that its store does not have yet."""

from __future__ import annotations

import os
import platform
import threading
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import Any, NamedTuple, TypeVar

from antnav.errors import AntnavError, ParameterError, PathError, WorkerLostError
from antnav.planner.facts import Certainty
from antnav.plugins.loading import said
from antnav.run.chunks import KEPT_BYTES, stream_chunks
from antnav.run.spmd import ATTEMPTS, Serial, checked_workers, shares_memory, width
from antnav.study.budget import Budget
from antnav.study.model import AnyJob, AnyStudy
from antnav.study.record import Kept, Mark, without_times
from antnav.study.shard import Shard, jobs_of
from antnav.study.sources import sources
from antnav.study.store import Store

__all__ = ["Progress", "run_study", "without_times"]

R = TypeVar("R", bound=Kept)
T = TypeVar("T")

#: Runs that may fail, or kill their workers, before the study is given up.
MOST_LOST = 10


class RunFailedError(AntnavError, RuntimeError):
    """Runs of a study raised errors, by their names; all others are stored."""


class _Failure(NamedTuple):
    """What a run raised, as text: not every error can be sent."""

    said: str
    trace: str


_Outcome = tuple[AnyJob[R], R | _Failure, float]

#: Called with runs done, runs in all, and seconds left (None before the first run has ended).
Progress = Callable[[int, int, float | None], None]


def run_study(
    study: AnyStudy[R],
    store: Store[R],
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    shard: Shard | None = None,
    cancel: threading.Event | None = None,
    progress: Progress | None = None,
) -> list[R]:
    """Do the missing runs of a study, each stored as it ends.

    Parameters
    ----------
    study : Study
    store : Store
        Of what the study keeps. What it has is not run again, so a study that was interrupted, in whatever way, goes on
        where it stopped, on whatever executor.
    executor : concurrent.futures.Executor, optional
        Where runs are done side by side: threads, `an.spmd.Processes`, Dask's ``client.get_executor()``, an
        ``MPIPoolExecutor``; it is left open. Default: threads of this process.
    workers : int, optional
        Runs side by side, >= 1; see the notes. Default: as many as the executor says it does at a time, without one 1.
    shard : Shard, optional
        Do only this part of the runs, such as ``Shard(3, 10)`` in a job array; `merged` joins the stores.
    cancel : threading.Event, optional
        Set it from elsewhere to end early: runs under way are given up. May be set here where the study fails.
    progress : callable, optional
        Called in this thread, at the start and after each run.

    Returns
    -------
    list of Record
        In the order of `study.jobs()`, of a shard its own; after cancelling, those that are there. Apart from times,
        environment and marks they are the same whatever the executor.

    Raises
    ------
    ParameterError
        Fewer than one worker; more than one where seconds are the budget; something cannot be sent to workers, or
        theirs is other code of antnav.
    OutputError
        The store cannot be written, such as on a full disk. What was stored before is untouched.
    RunFailedError
        Runs that raised errors, by their names; all others are stored.
    WorkerLostError
        Runs that killed their workers again and again, by their names; all others are stored. Or an executor that died.
    PathError
        A planner of antnav broke the rules of the map: a bug.

    Notes
    -----
    Times are measured with one worker: runs follow each other, nothing else of the study runs meanwhile, and the two
    colonies of a divided problem have a thread each. With more workers, each run has one thread for all its colonies
    and shares caches and memory with others; its figures are the same, its CPU seconds nearly, but its wall seconds
    say little, and its record has the mark `loaded`.

    To other processes and machines runs go in chunks of some tenths of a second, maps and planners once to each worker.
    A chunk is stored when it has come back, in one transaction.
    """
    if workers is not None:
        checked_workers(workers)
    side_by_side = workers or (1 if executor is None else width(executor))
    if study.equal_budget is Budget.SECONDS and side_by_side > 1:
        rule = "the seconds of runs that share the machine are no measure"
        raise ParameterError(f"{side_by_side} workers with equal_budget seconds", rule, "use 1 worker")
    local = shares_memory(executor)
    cancel = cancel or threading.Event()
    jobs = jobs_of(study, shard)
    stored = store.keys()
    distinct = {job.key: job for job in jobs}
    missing = [job for job in distinct.values() if job.key not in stored]
    reporter = _Reporter(len(distinct), missing, side_by_side, progress)
    lost: list[AnyJob[R]] = []
    failures = _Failures()

    def run(some: Sequence[AnyJob[R]]) -> None:
        if not local and executor is not None:
            outcomes = _elsewhere(some, executor, side_by_side, cancel, lost)
        elif side_by_side == 1:
            outcomes = _one_by_one(some, cancel)
        else:
            outcomes = _side_by_side(some, executor, side_by_side, cancel)
        _store(outcomes, store, reporter, failures, loaded=side_by_side > 1)

    if local:
        missing = [job for job in missing if failures.passed(job, _tried(job, job.prepare))]
    run([job for job in missing if not job.reference])
    run(_allowed(missing, store))
    if failures and not cancel.is_set():
        raise failures.error() from (_lost(lost) if lost else None)
    if lost:
        raise _lost(lost)
    return _labelled(jobs, {record.key: record for record in store.records()})


def _labelled(jobs: Sequence[AnyJob[R]], records: Mapping[str, R]) -> list[R]:
    """The records of jobs under their labels, where there are any."""
    certain: dict[tuple[int, int], Certainty] = {}
    found = []
    for job in jobs:
        pair = id(job.problem), id(job.algorithm)
        if pair not in certain:
            certain[pair] = job.certainty
        if job.key in records:
            found.append(job.labelled(records[job.key], certain[pair]))
    return found


def _store(
    outcomes: Generator[Sequence[_Outcome[R]], None, None],
    store: Store[R],
    reporter: _Reporter,
    failures: _Failures,
    *,
    loaded: bool,
) -> None:
    """Store the records of runs as they come, each group in one transaction, and note those that failed."""
    with closing(outcomes):
        for group in outcomes:
            company = (Mark.LOADED,) if loaded else (Mark.BUSY,) if _busy() else ()
            records = [record for _, record, _ in group if not isinstance(record, _Failure)]
            store.add_all(replace(record, marks=record.marks + company) for record in records)
            for job, outcome, seconds in group:
                if failures.passed(job, outcome):
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


def _one_by_one(jobs: Sequence[AnyJob[R]], cancel: threading.Event) -> Generator[Sequence[_Outcome[R]], None, None]:
    for job in jobs:
        outcome = _done(job, None, cancel)
        if outcome is None:
            return
        yield [outcome]


def _side_by_side(
    jobs: Sequence[AnyJob[R]], executor: Executor | None, workers: int, cancel: threading.Event
) -> Generator[Sequence[_Outcome[R]], None, None]:
    """Records in the order in which the runs end.

    A run starts when one ends, not before, so that no more than a few records wait for the store.
    """
    pool = executor or ThreadPoolExecutor(workers, thread_name_prefix="antnav-study")
    waiting = iter(jobs)

    def start(count: int) -> set[Future[_Outcome[R] | None]]:
        return {pool.submit(_done, job, Serial(), cancel) for job in islice(waiting, count)}

    running = set[Future[_Outcome[R] | None]]()
    try:
        running = start(workers)
        while running:
            ended, running = wait(running, return_when=FIRST_COMPLETED)
            running |= start(len(ended))
            for future in ended:
                outcome = future.result()
                if outcome is not None:
                    yield [outcome]
    except BaseException:  # GeneratorExit too: the one who reads the records failed
        cancel.set()
        raise
    finally:
        if executor is None:
            pool.shutdown()
        else:
            wait(running)


def _done(job: AnyJob[R], executor: Executor | None, cancel: threading.Event) -> _Outcome[R] | None:
    """What came of the job, and the seconds that it took with all that belongs to it; None once cancelled."""
    if cancel.is_set():
        return None
    begin = time.perf_counter()
    record = _tried(job, partial(job.run, executor, cancel))
    return None if record is None else (job, record, time.perf_counter() - begin)


def _tried(job: AnyJob[Any], act: Callable[[], T]) -> T | _Failure:
    """What a step of the job returns, or what it raises; bugs of antnav pass."""
    try:
        return act()
    except Exception as error:
        planner = job.algorithm
        if isinstance(error, PathError) and type(planner).__module__.startswith("antnav.") and not planner.own:
            raise
        told = f"{error.given}: {error.rule}" if isinstance(error, AntnavError) else said(error)
        return _Failure(told, traceback.format_exc())


def _elsewhere(
    jobs: Sequence[AnyJob[R]], executor: Executor, workers: int, cancel: threading.Event, lost: list[AnyJob[R]]
) -> Generator[Sequence[_Outcome[R]], None, None]:
    """Records of chunks of runs, as they come back from other processes."""

    def note(job: AnyJob[R]) -> None:
        lost.append(job)
        if len(lost) == MOST_LOST:
            raise _lost(lost)

    for done, found in stream_chunks(
        partial(_work, sources()),
        _in_blocks(jobs),
        executor,
        workers,
        shared=lambda job: job.shared,
        count=len(jobs),
        ordered=False,
        lost=note,
        cancel=cancel,
    ):
        yield [(job, *outcome) for job, outcome in zip(done, found, strict=True)]


def _work(code: str, jobs: Iterator[AnyJob[R]]) -> list[tuple[R | _Failure, float]]:
    """Do runs in a worker: what came of them, and seconds that each took."""
    if code != sources():
        rule, remedy = "it has other code of antnav than this process", "install the same version there"
        raise ParameterError(f"a worker on {platform.node()}", rule, remedy)
    never, found = threading.Event(), []
    for job in jobs:
        failure = _tried(job, job.prepare)
        outcome = (job, failure, 0.0) if failure else _done(job, Serial(), never)
        assert outcome is not None
        found.append(outcome[1:])
    return found


def _in_blocks(jobs: Sequence[AnyJob[R]]) -> list[AnyJob[R]]:
    """The jobs in their order, but only so many maps at a time as workers can keep."""
    places, block, size = dict[int, int](), 0, 0
    for job in jobs:
        if id(job.problem) not in places:
            size += job.problem.grid.cells.nbytes
            if size > KEPT_BYTES // 2:
                block, size = block + 1, job.problem.grid.cells.nbytes
            places[id(job.problem)] = block
    return sorted(jobs, key=lambda job: places[id(job.problem)])


class _Failures:
    """The runs that raised errors."""

    def __init__(self) -> None:
        self._found: list[tuple[AnyJob[Any], _Failure]] = []

    def __bool__(self) -> bool:
        return bool(self._found)

    def passed(self, job: AnyJob[Any], outcome: object) -> bool:
        """Whether it did not fail; too many failures end the study."""
        if not isinstance(outcome, _Failure):
            return True
        self._found.append((job, outcome))
        if len(self._found) == MOST_LOST:
            raise self.error()
        return False

    def error(self) -> RunFailedError:
        """All of them, with the trace of the first."""
        found = sorted(self._found, key=lambda pair: (*_kind(pair[0]), pair[0].seed))  # not as they ended
        reasons = dict.fromkeys(failure.said for _, failure in found)
        rule = f"{'they' if len(found) > 1 else 'it'} failed: {'; '.join(reasons)}"
        remedy = "mend that, and start again: what came back is stored"
        error = RunFailedError(_named([job for job, _ in found]), rule, remedy)
        error.add_note(found[0][1].trace)
        return error


def _named(jobs: Sequence[AnyJob[Any]]) -> str:
    names = ", ".join(f"{job.algorithm_label} on {job.map_label} under seed {job.seed}" for job in jobs)
    return f"{len(jobs)} run{'s' * (len(jobs) > 1)}: {names}"


def _lost(jobs: Sequence[AnyJob[R]]) -> WorkerLostError:
    rule = f"workers died {ATTEMPTS} times over each; what came back is stored"
    remedy = "look for what kills them (memory? a script without `if __name__ == '__main__':`?), and start again"
    return WorkerLostError(_named(jobs), rule, remedy)


class _Reporter:
    """Counts runs, and guesses the time left: a run takes as long as those of its algorithm on its map so far.

    Until one of them has run, as long as all runs so far, on average. Sums are kept, since kinds may be many.
    """

    def __init__(self, total: int, missing: Sequence[AnyJob[Any]], workers: int, progress: Progress | None) -> None:
        self._total, self._workers, self._progress = total, workers, progress
        self._kinds = Counter(_kind(job) for job in missing)
        self._unknown = self._left = len(missing)  # those of kinds of which none has run; all
        self._runs: Counter[tuple[str, str]] = Counter()
        self._seconds: defaultdict[tuple[str, str], float] = defaultdict(float)
        self._all_seconds, self._expected, self._done = 0.0, 0.0, 0
        self._report()

    def done(self, job: AnyJob[Any], seconds: float) -> None:
        """Count a run that took so many seconds."""
        kind = _kind(job)
        if self._runs[kind]:
            self._expected -= self._kinds[kind] * self._seconds[kind] / self._runs[kind]
        else:
            self._unknown -= self._kinds[kind]
        self._kinds[kind] -= 1
        self._runs[kind] += 1
        self._seconds[kind] += seconds
        self._expected += self._kinds[kind] * self._seconds[kind] / self._runs[kind]
        self._left -= 1
        self._done += 1
        self._all_seconds += seconds
        self._report()

    def _report(self) -> None:
        if self._progress:
            self._progress(self._total - self._left, self._total, self._seconds_left())

    def _seconds_left(self) -> float | None:
        if not self._left:
            return 0.0
        if not self._done:
            return None
        return (self._expected + self._unknown * self._all_seconds / self._done) / self._workers


def _kind(job: AnyJob[Any]) -> tuple[str, str]:
    return job.map_label, job.algorithm_label
