"""Chunks: sizes, what travels once, what is handed back, and workers that die over one of many jobs."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from antnav.errors import ParameterError, WorkerLostError
from antnav.run import chunks
from antnav.run.spmd import ATTEMPTS, Processes, Serial, width


@dataclass(frozen=True, eq=False)
class Map:
    """What jobs share."""

    name: str
    cells: bytes = b""


@dataclass(frozen=True)
class Look:
    """A job."""

    number: int
    at: Map = field(default_factory=lambda: Map("own"))


class Elsewhere(Executor):
    """A worker that does what it is given at once, by copies, and notes it."""

    def __init__(self, forgets: int = -1) -> None:
        self.given: list[chunks.Chunk] = []
        self.done: list[chunks.Done] = []
        self._forgets = forgets

    def submit(self, function, /, *arguments):
        (chunk,) = arguments
        self.given.append(chunk)
        if len(self.given) == self._forgets:
            chunks._SHELF._kept.clear()
        future: Future[chunks.Done] = Future()
        try:
            self.done.append(pickle.loads(pickle.dumps(function(pickle.loads(pickle.dumps(chunk))))))
            future.set_result(self.done[-1])
        except ZeroDivisionError as error:
            future.set_exception(error)
        return future


@pytest.fixture
def one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chunks, "CHUNK_SECONDS", 0.0)
    monkeypatch.setattr(chunks, "_SHELF", chunks._Shelf())


def names(jobs: Iterator[Look]) -> list[tuple[int, str, int]]:
    """Of each job its number, its map's name, and which map that is here."""
    return [(job.number, job.at.name, id(job.at)) for job in jobs]


def found(jobs: list[Look], executor: Executor, **more) -> list[tuple[Look, tuple[int, str, int]]]:
    stream = chunks.stream_chunks(names, jobs, executor, 1, shared=lambda job: (job.at,), **more)
    return [pair for done, results in stream for pair in zip(done, results, strict=True)]


def test_what_jobs_share_travels_until_it_has_arrived_and_again_where_it_is_lacking(one_by_one: None) -> None:
    place, worker = Map("yard"), Elsewhere(forgets=5)
    pairs = found([Look(number, place) for number in range(12)], worker)
    assert [(job.number, name) for job, (_, name, _) in pairs] == [(number, "yard") for number in range(12)]
    assert [chunk.shared[0].content is not None for chunk in worker.given] == [
        *[True] * 3,
        *[False] * 3,
        *[True] * 2,
    ] + [False] * 6
    assert [done.lacking for done in worker.done] == [*[False] * 4, True, True, *[False] * 8]
    assert len({address for _, (_, _, address) in pairs}) == 2, "one for all, but for the one that was forgotten"


def test_workers_and_senders_keep_what_is_latest(one_by_one: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chunks, "KEPT_BYTES", 2500)
    maps = [Map(str(number), bytes(1000)) for number in range(4)]
    worker = Elsewhere()
    pairs = found([Look(number, maps[number % 4]) for number in range(12)], worker)
    assert [name for _, (_, name, _) in pairs] == [str(number % 4) for number in range(12)]
    assert len(chunks._SHELF._kept) == 2


def test_chunks_grow_and_become_smaller_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    worker = Elsewhere()
    known = found([Look(number) for number in range(1000)], worker, count=1000)
    assert [job.number for job, _ in known] == list(range(1000))
    sizes = [done.begun for done in worker.done]
    assert sizes[0] == 1
    assert max(sizes) > 60
    assert sizes[-1] == 1
    monkeypatch.setattr(chunks, "LARGEST_CHUNK", 10)
    worker = Elsewhere()
    assert len(found([Look(number) for number in range(1000)], worker)) == 1000
    assert max(done.begun for done in worker.done) == 10


def slow(jobs: Iterator[Look]) -> list[int]:
    done = []
    for job in jobs:
        time.sleep(0.0 if job.number < 20 else 0.03)
        done.append(job.number)
    return done


@pytest.mark.parametrize("ordered", [True, False])
def test_what_takes_too_long_is_handed_back(monkeypatch: pytest.MonkeyPatch, ordered: bool) -> None:
    monkeypatch.setattr(chunks, "CHUNK_SECONDS", 0.02)
    worker, looks = Elsewhere(), [Look(number) for number in range(40)]
    stream = chunks.stream_chunks(slow, looks, worker, 1, shared=lambda _: (), ordered=ordered)
    pairs = [(jobs, numbers) for jobs, numbers in stream]
    assert all([job.number for job in jobs] == numbers for jobs, numbers in pairs)
    numbers = [number for _, numbers in pairs for number in numbers]
    assert (numbers if ordered else sorted(numbers)) == list(range(40))


def deadly(jobs: Iterator[Look]) -> list[int]:
    """Job 13 kills its worker, whoever that is."""
    done = []
    for job in jobs:
        if job.number == 13:
            os.kill(os.getpid(), signal.SIGKILL)
        done.append(job.number)
    return done


@pytest.mark.parametrize("ordered", [True, False])
def test_a_job_that_kills_its_workers_takes_no_other_along(ordered: bool) -> None:
    lost: list[Look] = []
    looks = [Look(number) for number in range(60)]
    with Processes(2) as pool:
        stream = chunks.stream_chunks(deadly, looks, pool, 2, shared=lambda _: (), ordered=ordered, lost=lost.append)
        numbers = [number for _, numbers in stream for number in numbers]
        assert (numbers if ordered else sorted(numbers)) == [number for number in range(60) if number != 13]
        assert [job.number for job in lost] == [13]
        with pytest.raises(WorkerLostError, match=f"{ATTEMPTS} times"):
            list(chunks.stream_chunks(deadly, looks, pool, 2, shared=lambda _: (), ordered=ordered))


def die_once(jobs: Iterator[Path]) -> list[str]:
    done = []
    for marker in jobs:
        if not marker.exists():
            marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        done.append(marker.name)
    return done


def test_a_worker_that_dies_once_costs_a_retry(tmp_path: Path) -> None:
    with Processes(2) as pool:
        stream = chunks.stream_chunks(die_once, [tmp_path / name for name in "ab"], pool, 2, shared=lambda _: ())
        assert [name for _, names in stream for name in names] == ["a", "b"]


def unlucky(jobs: Iterator[Look]) -> list[int]:
    return [1 // (job.number - 3) for job in jobs]


def test_what_has_ended_comes_before_an_error(one_by_one: None) -> None:
    stream = chunks.stream_chunks(
        unlucky, [Look(n) for n in (3, 4, 5)], Elsewhere(), 1, shared=lambda _: (), ordered=False
    )
    assert [job.number for jobs, _ in (next(stream), next(stream)) for job in jobs] == [4, 5]
    with pytest.raises(ZeroDivisionError):
        next(stream)


@pytest.mark.parametrize(
    ("make", "count"), [(Serial, 1), (lambda: ThreadPoolExecutor(3), 3), (lambda: Processes(4), 4)]
)
def test_width(make: Callable[[], Executor], count: int) -> None:
    assert width(make()) == count


def test_what_cannot_be_sent_is_refused() -> None:
    with pytest.raises(ParameterError, match="cannot be sent"):
        list(chunks.stream_chunks(names, [Look(1)], Elsewhere(), 1, shared=lambda _: (threading.Lock(),)))
