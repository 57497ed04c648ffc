"""SPMD: job order, lost workers, errors of the job itself."""

from __future__ import annotations

import math
import os
import signal
import threading
import time
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

from antnav.errors import ParameterError, WorkerLostError
from antnav.run import spmd


def slow_square(number: int) -> int:
    time.sleep(0.02 * (3 - number))
    return number * number


def die_once(marker: str) -> str:
    """Kill the own process the first time, answer the second."""
    path = Path(marker)
    if not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


def die(_: int) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def fail(number: int) -> int:
    raise ZeroDivisionError(number)


@pytest.mark.parametrize("executor", [None, spmd.Serial(), ThreadPoolExecutor(2)])
def test_results_come_in_job_order(executor) -> None:
    assert spmd.run_jobs(slow_square, [0, 1, 2, 3], executor) == [0, 1, 4, 9]


def test_processes_in_job_order_and_with_a_worker_killed(tmp_path: Path) -> None:
    with spmd.Processes(2) as executor:
        assert spmd.run_jobs(slow_square, [0, 1, 2], executor) == [0, 1, 4]
        markers = [str(tmp_path / "a"), str(tmp_path / "b")]
        assert spmd.run_jobs(die_once, markers, executor) == ["done", "done"]
        assert spmd.run_jobs(slow_square, [3], executor) == [9]


def test_a_worker_that_always_dies_is_reported() -> None:
    with spmd.Processes(1) as executor, pytest.raises(WorkerLostError, match=r"jobs \[0\] of 1"):
        spmd.run_jobs(die, [0], executor)


def test_a_standard_pool_that_broke_is_reported_not_hung() -> None:
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as executor,
        pytest.raises(WorkerLostError),
    ):
        spmd.run_jobs(die, [0], executor)


@pytest.mark.parametrize("executor", [None, spmd.Serial()])
def test_errors_of_the_job_pass_unchanged(executor) -> None:
    with pytest.raises(ZeroDivisionError):
        spmd.run_jobs(fail, [1], executor)


def test_executor_for_a_number_of_workers() -> None:
    assert isinstance(spmd.executor_for(1), spmd.Serial)
    assert isinstance(spmd.executor_for(2), ThreadPoolExecutor)
    assert spmd.executor_for(None) is None
    with pytest.raises(ParameterError):
        spmd.executor_for(0)
    assert spmd.shares_memory(None)
    assert not spmd.shares_memory(spmd.Processes(1))


@pytest.mark.slow
def test_a_dask_worker_that_is_killed_is_replaced(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        executor = client.get_executor()
        assert spmd.run_jobs(die_once, [str(tmp_path / "a"), str(tmp_path / "b")], executor) == ["done", "done"]
        with pytest.raises(WorkerLostError, match=r"jobs \[0\] of 1"):
            spmd.run_jobs(die, [0], executor)


def test_a_jobs_own_index_error_is_raised() -> None:
    def job(number: int) -> int:
        return [1, 2][number]

    assert spmd.run_jobs(job, [0, 1]) == [1, 2]
    with pytest.raises(IndexError):
        spmd.run_jobs(job, [0, 1, 2, 3])


def test_jobs_run_side_by_side_on_as_many_threads_as_cores() -> None:
    both = threading.Barrier(2)
    names = set()

    def job(number: int) -> int:
        names.add(threading.get_ident())
        if number < 2:
            both.wait(timeout=60)  # neither ends before the other has begun
        return number

    assert spmd.run_jobs(job, range(50)) == list(range(50))
    assert 2 <= len(names) <= spmd.CORES


@pytest.mark.parametrize("failing", ["caller", "pool"])
def test_after_an_error_no_job_begins(failing: str) -> None:
    """Whichever thread fails, the other one finishes its job and takes no more."""
    both, failed = threading.Barrier(2), threading.Event()
    caller, begun = threading.get_ident(), []

    def job(number: int) -> None:
        begun.append(number)
        if number < 2:
            both.wait(timeout=60)
            if (threading.get_ident() == caller) == (failing == "caller"):
                failed.set()
                raise ValueError(number)
            failed.wait(timeout=60)
        else:
            time.sleep(0.001)

    with pytest.raises(ValueError, match=r"0|1"):
        spmd.run_jobs(job, range(10_000))
    assert len(begun) < 10_000


@pytest.mark.parametrize("size", [1, 2])
def test_jobs_of_a_pool_may_hand_it_jobs(size: int) -> None:
    """All its threads are busy with jobs that wait for theirs: they do them themselves."""

    def outer(number: int) -> list[int]:
        return spmd.run_jobs(slow_square, [number, number + 1], pool)

    with ThreadPoolExecutor(size) as pool:
        futures = [pool.submit(outer, number) for number in range(3)]
        assert [future.result(timeout=60) for future in futures] == [[0, 1], [1, 4], [4, 9]]


@pytest.mark.parametrize("middle", [None, ThreadPoolExecutor(1), ThreadPoolExecutor(1, thread_name_prefix="antnav")])
def test_jobs_that_a_pool_waits_for_may_hand_it_jobs(middle: ThreadPoolExecutor | None) -> None:
    """Its only thread waits for another pool's jobs, which would wait for it."""
    both = threading.Barrier(2)  # of the calling thread, and of one that does not belong to the pool

    def inner(number: int) -> list[int]:
        if middle is None:
            both.wait(timeout=60)
        return spmd.run_jobs(abs, [number, -number], pool)

    def outer() -> list[list[int]]:
        return spmd.run_jobs(inner, [1, 2], middle)

    pool = ThreadPoolExecutor(1)
    try:
        assert pool.submit(outer).result(timeout=60) == [[1, 1], [2, 2]]
    finally:
        pool.shutdown(wait=False)


def test_two_pools_may_hand_each_other_jobs() -> None:
    both = threading.Barrier(2)
    one, other = ThreadPoolExecutor(1), ThreadPoolExecutor(1)

    def outer(pool: ThreadPoolExecutor) -> list[int]:
        both.wait(timeout=60)
        return spmd.run_jobs(abs, [1, -2], pool)

    try:
        futures = [one.submit(outer, other), other.submit(outer, one)]
        assert [future.result(timeout=60) for future in futures] == [[1, 2], [1, 2]]
    finally:
        one.shutdown(wait=False)
        other.shutdown(wait=False)


@pytest.mark.parametrize("workers", [0, -1, 1.5, "2", math.nan, [1]])
def test_numbers_of_workers_are_counts(workers: object) -> None:
    for make in (spmd.Processes, spmd.executor_for):
        with pytest.raises(ParameterError, match="at least 1 worker"):
            make(workers)


@pytest.mark.parametrize("executor", ["threads", 4, ThreadPoolExecutor, object()])
def test_executors_are_executors(executor: object) -> None:
    with pytest.raises(ParameterError, match="executor"):
        spmd.run_jobs(slow_square, [1], executor)


def test_a_scheduler_that_closes_while_a_job_is_handed_out_is_told_as_gone() -> None:
    class Client:
        status = "running"

    class Closing(Executor):
        _client = Client()

        def submit(self, function, /, *arguments, **more):  # type: ignore[no-untyped-def]
            self._client.status = "closed"
            raise RuntimeError("Client is closed. Can't send update-graph message.")

    with pytest.raises(WorkerLostError, match="its scheduler is gone"):
        spmd.run_jobs(abs, [1, 2], Closing())
