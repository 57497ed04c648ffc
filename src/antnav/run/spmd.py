"""One program on many data: the same function for every job, on any executor, results in job order."""

from __future__ import annotations

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    thread,
    wait,
)
from contextlib import contextmanager
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING, Any, Generic, ParamSpec, TypeVar

from antnav.errors import ParameterError, WorkerLostError, shown

if TYPE_CHECKING:
    from concurrent.futures import ProcessPoolExecutor

    from antnav.run.channel import Asked

Job = TypeVar("Job")
Result = TypeVar("Result")
P = ParamSpec("P")

#: Threads of the default executor.
CORES = max(2, os.cpu_count() or 1)
#: How often a job is tried before its loss is reported.
ATTEMPTS = 3
#: Seconds between two looks at whether a stream of jobs should end, and whether there still is anybody to do them.
LOOK, PATIENCE = 0.05, 1.0


class Serial(Executor):
    """Runs each job at once in the calling thread."""

    def submit(self, fn: Callable[P, Result], /, *args: P.args, **kwargs: P.kwargs) -> Future[Result]:
        """Run the job now."""
        future: Future[Result] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class Processes(Executor):
    """A pool of processes that is built anew when a worker dies, where the standard one stays broken for good.

    Parameters
    ----------
    workers : int, optional
        Default: one for each core.

    Notes
    -----
    Workers are spawned: forking a process with threads can hang. They end when this process does, however that ends,
    and leave Ctrl-C, which a terminal sends them too, to it.
    """

    def __init__(self, workers: int | None = None) -> None:
        self._workers = os.cpu_count() or 1 if workers is None else checked_workers(workers)
        self._lock = threading.Lock()
        self._pool: ProcessPoolExecutor | None = None

    def submit(self, fn: Callable[P, Result], /, *args: P.args, **kwargs: P.kwargs) -> Future[Result]:
        """Hand a job to the pool."""
        with self._lock:
            for _ in range(2):
                if self._pool is None:
                    self._pool = _spawning(self._workers)
                try:
                    with _interrupts_kept_off():  # new workers inherit it
                        return self._pool.submit(fn, *args, **kwargs)
                except BrokenExecutor:
                    self._pool = None
        raise WorkerLostError("the process pool", "it broke twice in a row", "look for what kills its workers")

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait, cancel_futures=cancel_futures)

    def kill(self) -> None:
        """End the workers at once, whatever they do."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            for worker in list((pool._processes or {}).values()):
                worker.kill()
            pool.shutdown(cancel_futures=True)


def _spawning(workers: int) -> ProcessPoolExecutor:
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _end_with_parent)


def _end_with_parent() -> None:
    """End this worker when the process that started it has gone: nobody else would tell it."""
    from multiprocessing import connection, parent_process

    def watch() -> None:
        if parent := parent_process():
            connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=watch, name="antnav-parent", daemon=True).start()


@contextmanager
def _interrupts_kept_off() -> Iterator[None]:
    """Keep Ctrl-C from this thread, and from processes that it starts, for whose whole life it then waits."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # started later, it would undo this
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def shares_memory(executor: Any) -> bool:
    """Whether jobs see the caller's events and may call its functions.

    Raises
    ------
    ParameterError
        It is no executor.
    """
    if not (executor is None or isinstance(executor, Executor)):
        rule = "it is an Executor of concurrent.futures, or made like one"
        raise ParameterError(f"executor {shown(executor)}", rule, "give one, such as ThreadPoolExecutor(4), or None")
    return executor is None or isinstance(executor, Serial | ThreadPoolExecutor)


def executor_for(workers: int | None) -> Executor | None:
    """The executor for a number of workers: in turn for 1, else threads.

    Raises
    ------
    ParameterError
        Fewer than 1.
    """
    if workers is None:
        return None
    return Serial() if checked_workers(workers) == 1 else ThreadPoolExecutor(workers, thread_name_prefix="antnav")


def width(executor: Executor) -> int:
    """How many jobs an executor does at a time, as far as it says so."""
    if isinstance(executor, Serial):
        return 1
    client = getattr(executor, "_client", None)
    if client is not None:
        return sum(client.nthreads().values()) or CORES
    named = (getattr(executor, name, None) for name in ("_max_workers", "_workers", "num_workers"))
    return next((count for count in named if isinstance(count, int) and count > 0), CORES)


def gone(executor: Executor) -> bool:
    """Whether Dask's client has lost its scheduler for good: it leaves jobs undone then, for ever."""
    return getattr(getattr(executor, "_client", None), "status", "") in ("closing", "closed")


def checked_workers(workers: Any) -> int:
    """A number of workers, or a `ParameterError`."""
    if not isinstance(workers, int) or workers < 1:
        raise ParameterError(f"workers {shown(workers)}", "at least 1 worker is needed", "give 1 or more")
    return int(workers)


@cache
def _own_threads() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(CORES, thread_name_prefix="antnav")


if hasattr(os, "register_at_fork"):  # a child inherits the pool, but not its threads
    os.register_at_fork(after_in_child=_own_threads.cache_clear)


def run_jobs(
    function: Callable[..., Result], jobs: Any, executor: Executor | None = None, *common: Any
) -> list[Result]:
    """Call `function(job, *common)` for every job.

    Parameters
    ----------
    function : callable
        For executors in other processes it must be importable there, and jobs must be picklable.
    jobs : sequence
        Complete in themselves: a job may run again where its worker died.
    executor : concurrent.futures.Executor, optional
        Default: threads, the calling one among them, since kernels let go of the interpreter lock. Called from a thread
        of any pool, that thread works too: all threads of this executor may be waiting for jobs of their own, or of it.
    *common
        Further arguments, the same for all jobs.

    Returns
    -------
    list
        One result a job, in the order of the jobs whatever the order in which they ended.

    Raises
    ------
    ParameterError
        The function cannot be called, the jobs are no sequence, or the executor is none.
    WorkerLostError
        A job's worker died `ATTEMPTS` times. Errors that the function itself raises pass unchanged.
    """
    if not callable(function) or not isinstance(jobs, Sequence):
        rule = "a function is called for each job of a sequence"
        raise ParameterError(f"run_jobs({shown(function)}, {shown(jobs)})", rule, "give both")
    shares_memory(executor)  # checks it
    if executor is None:
        return _in_threads(_own_threads(), function, jobs, *common)
    if isinstance(executor, ThreadPoolExecutor) and _in_a_pool():
        return _in_threads(executor, function, jobs, *common)
    results: dict[int, Result] = {}
    for _ in range(ATTEMPTS):
        missing = [index for index in range(len(jobs)) if index not in results]
        pending = {index: _submit(executor, function, jobs[index], *common) for index in missing}
        for index, future in pending.items():
            try:
                results[index] = future.result()
            except Exception as error:
                if not _worker_died(error):
                    raise
        if len(results) == len(jobs):
            return [results[index] for index in range(len(jobs))]
    lost = sorted(set(range(len(jobs))) - set(results))
    raise _lost(f"jobs {lost} of {len(jobs)}")


def _lost(what: str) -> WorkerLostError:
    remedy = "look for what kills the workers (memory? a script without `if __name__ == '__main__':`?), or use threads"
    return WorkerLostError(what, f"workers died {ATTEMPTS} times over it", remedy)


def stream_jobs(
    function: Callable[[Job], Result],
    jobs: Iterable[Job],
    executor: Executor,
    ahead: int,
    *,
    again: Callable[[Job, Result], Job | None] | None = None,
    cancel: Asked | None = None,
) -> Iterator[Result]:
    """Call `function(job)` for each job of a stream, which is read no further than needed.

    Parameters
    ----------
    function, jobs, executor
        As for `run_jobs`.
    ahead : int
        So many jobs at most are handed out, or done and not yet taken.
    again : callable, optional
        Called with a job and what came of it; a job that it returns is done instead, such as one with what its worker
        lacked.
    cancel : object with is_set(), optional
        Ends the stream; jobs under way are left alone.

    Yields
    ------
    object
        One result a job, in the order of the jobs.

    Raises
    ------
    WorkerLostError
        A job's worker died `ATTEMPTS` times. Errors that the function itself raises pass unchanged.
    """
    for _, result in stream_pairs(function, jobs, executor, ahead, again=again, cancel=cancel):
        yield result


def stream_pairs(
    function: Callable[[Job], Result],
    jobs: Iterable[Job],
    executor: Executor,
    ahead: int,
    *,
    again: Callable[[Job, Result], Job | None] | None = None,
    rest: Callable[[Job, Result], Job | None] | None = None,
    halves: Callable[[Job], Sequence[Job]] | None = None,
    lost: Callable[[Job], object] | None = None,
    ordered: bool = True,
    cancel: Asked | None = None,
) -> Iterator[tuple[Job, Result]]:
    """Call `function(job)` for each job of a stream, and say which job each result is of.

    A job whose worker died is handed out again at once; with others that shared a broken pool it may be innocent. The
    second time it is a suspect: it runs while nothing else does, so that the guilty one is known.

    Parameters
    ----------
    function, jobs, executor, ahead, again, cancel
        As for `stream_jobs`.
    rest : callable, optional
        Called with a job and what came of it; a job that it returns comes next in order.
    halves : callable, optional
        Called with a suspect: smaller jobs instead of it, or none.
    lost : callable, optional
        Called with a job whose worker died `ATTEMPTS` times, which is left out then. Default: a `WorkerLostError`.
    ordered : bool
        Whether results come in the order of the jobs, or as they end.
    """
    source, handed = iter(jobs), deque[_Handed[Job, Result]]()
    try:
        while cancel is None or not cancel.is_set():
            suspect = next((each for each in handed if each.suspect), None)
            if suspect is None:
                for job in islice(source, ahead - len(handed)):
                    handed.append(_Handed(function, job, executor))
                    handed[-1].hand_out()
            if not handed:
                return
            running = [each.future for each in handed if each.future is not None and not each.done]
            if suspect and not running:
                running = [suspect.hand_out()]
            if not wait(running, LOOK if cancel else PATIENCE, FIRST_COMPLETED).done and gone(executor):
                raise _left_alone()
            handed = deque(now for each in handed for now in each.now(again, rest, halves, lost))
            if ordered:
                while handed and handed[0].done:
                    yield handed.popleft().pair
            else:
                ended = sorted((each for each in handed if each.done), key=lambda each: each.failed)
                handed = deque(each for each in handed if not each.done)
                for each in ended:
                    yield each.pair
    finally:
        for each in handed:
            if each.future is not None and not gone(executor):
                each.future.cancel()


class _Handed(Generic[Job, Result]):
    """A job that somebody was given, or who is next, where it is a suspect."""

    def __init__(self, function: Callable[[Job], Result], job: Job, executor: Executor, deaths: int = 0) -> None:
        self._function, self._job, self._executor, self._deaths = function, job, executor, deaths
        self.future: Future[Result] | None = None
        self.done = False

    @property
    def suspect(self) -> bool:
        """Whether it waits to run alone."""
        return self.future is None

    @property
    def failed(self) -> bool:
        """Whether it ended with an error."""
        return self.future is not None and self.future.exception() is not None

    @property
    def pair(self) -> tuple[Job, Result]:
        """The job and what came of it, or its error."""
        assert self.future is not None
        return self._job, self.future.result()

    def hand_out(self) -> Future[Result]:
        """Give it to a worker."""
        self.future = _submit(self._executor, self._function, self._job)
        return self.future

    def now(
        self,
        again: Callable[[Job, Result], Job | None] | None,
        rest: Callable[[Job, Result], Job | None] | None,
        halves: Callable[[Job], Sequence[Job]] | None,
        lost: Callable[[Job], object] | None,
    ) -> list[_Handed[Job, Result]]:
        """Take note of what came of it; what stands in its place."""
        if self.done or self.future is None or not self.future.done():
            return [self]
        error = CancelledError() if self.future.cancelled() else self.future.exception()
        if isinstance(error, Exception) and _worker_died(error):
            return self._after_a_death(error, halves, lost)
        if error is None and again and (instead := again(self._job, self.future.result())) is not None:
            self._job = instead
            self.hand_out()
            return [self]
        self.done = True
        if error is None and rest and (left := rest(self._job, self.future.result())) is not None:
            behind = self._of(left)
            behind.hand_out()
            return [self, behind]
        return [self]

    def _after_a_death(
        self, error: Exception, halves: Callable[[Job], Sequence[Job]] | None, lost: Callable[[Job], object] | None
    ) -> list[_Handed[Job, Result]]:
        self._deaths += 1
        if self._deaths < ATTEMPTS - 1:
            self.hand_out()
            return [self]
        if halves and (smaller := halves(self._job)):
            return [self._of(job, ATTEMPTS - 1) for job in smaller]
        if self._deaths < ATTEMPTS:
            self.future = None
            return [self]
        if lost is None:
            raise _lost("a job of a stream") from error
        lost(self._job)
        return []

    def _of(self, job: Job, deaths: int = 0) -> _Handed[Job, Result]:
        return _Handed(self._function, job, self._executor, deaths)


def _in_a_pool() -> bool:
    """Whether the calling thread is one of some pool's: pools list theirs under this lock, after they have started."""
    with thread._global_shutdown_lock:
        return threading.current_thread() in thread._threads_queues


def _in_threads(
    pool: ThreadPoolExecutor, function: Callable[..., Result], jobs: Sequence[Any], *common: Any
) -> list[Result]:
    """Run jobs in as many threads as there are cores, the calling one and the pool's: each takes the next job in turn.

    A thread that the pool has no room for is not waited for, so jobs that call `run_jobs` themselves cannot hang.
    """
    waiting = deque(range(len(jobs)))
    results: dict[int, Result] = {}

    def work() -> None:
        try:
            while waiting:
                try:
                    index = waiting.popleft()
                except IndexError:  # another thread was faster
                    return
                results[index] = function(jobs[index], *common)
        except BaseException:
            waiting.clear()  # nobody begins anything more
            raise

    others = [pool.submit(work) for _ in range(min(CORES, len(jobs)) - 1)]
    try:
        work()
    finally:
        for other in others:
            if not other.cancel():
                other.exception()
    for other in others:
        if not other.cancelled():
            other.result()
    return [results[index] for index in range(len(jobs))]


def _submit(executor: Executor, function: Callable[..., Result], *arguments: Any) -> Future[Result]:
    try:
        return executor.submit(function, *arguments)
    except BrokenExecutor as error:
        failed: Future[Result] = Future()
        failed.set_exception(error)
        return failed
    except Exception as error:
        if gone(executor):  # in this very moment
            raise _left_alone() from error
        raise


def _left_alone() -> WorkerLostError:
    return WorkerLostError("the executor", "its scheduler is gone", "start one, and then this again")


def _worker_died(error: Exception) -> bool:
    """Whether an error means that the worker is gone; Dask's own class is known by name, to spare the import."""
    by_name = {"KilledWorker", "CancelledError", "CommClosedError"}
    return isinstance(error, BrokenExecutor) or type(error).__name__ in by_name
