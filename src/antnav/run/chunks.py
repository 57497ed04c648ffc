"""Chunks: many short jobs at a time for one worker, with what they share once a worker and not once a job."""

from __future__ import annotations

import hashlib
import io
import pickle
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any, Generic, NamedTuple, TypeVar

from antnav.errors import ParameterError, shown
from antnav.run.channel import Asked
from antnav.run.spmd import stream_pairs

Job = TypeVar("Job")
Result = TypeVar("Result")

#: Seconds that a chunk should take: handing it out costs milliseconds, and what is lost with a worker is little. A
#: worker hands back what it has not begun after twice as long.
CHUNK_SECONDS = 0.4
#: Most jobs of a chunk.
LARGEST_CHUNK = 1024
#: Chunks under way for each worker: one in work, others in its queue or waiting for their turn.
AHEAD = 3
#: Bytes, as they travel, of what jobs share that are kept on either side; what workers work out from a map takes up
#: to a hundred times as much as the map.
KEPT_BYTES = 8 << 20


class Sent(NamedTuple):
    """What jobs share, on its way."""

    key: str
    content: bytes | None  #: None: the worker should have it


@dataclass(frozen=True)
class Chunk:
    """Jobs that follow each other; in `jobs` stand numbers for what is in `shared`.

    No tuple, and its jobs packed, as are their results: Dask looks into each part of those, for 0.1 ms a run.
    """

    number: int
    function: Callable[[Iterator[Any]], Any]
    shared: tuple[Sent, ...]
    jobs: bytes
    seconds: float


@dataclass(frozen=True)
class Done:
    """What came of a chunk."""

    result: bytes
    begun: int = 0  #: jobs, from the first on
    seconds: float = 0.0
    lacking: bool = False  #: nothing: the worker has not all that they share


class _Shelf:
    """What this worker keeps: the latest that jobs shared, as long as it fits."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, tuple[object, int]] = OrderedDict()
        self._lock = threading.Lock()

    def taken(self, shared: Sequence[Sent]) -> list[object] | None:
        """All of these, in their order; None where one is lacking."""
        with self._lock:
            found = [self._kept.get(key) for key, _ in shared]
        for place, (known, (_, content)) in enumerate(zip(found, shared, strict=True)):
            if known is None and content is None:
                return None
            if known is None and content is not None:
                found[place] = pickle.loads(content), len(content)
        with self._lock:
            for (key, _), item in zip(shared, found, strict=True):
                assert item is not None
                self._kept[key] = item
                self._kept.move_to_end(key)
            while len(self._kept) > len(shared) and sum(size for _, size in self._kept.values()) > KEPT_BYTES:
                self._kept.popitem(last=False)
        return [item[0] for item in found if item is not None]


_SHELF = _Shelf()


class _InTime(Iterator[Any]):
    """Jobs, until the time is over."""

    def __init__(self, jobs: Sequence[Any], seconds: float) -> None:
        self._jobs, self._end = jobs, time.perf_counter() + 2 * seconds
        self.begun = 0

    def __next__(self) -> Any:
        if self.begun == len(self._jobs) or (self.begun and time.perf_counter() > self._end):
            raise StopIteration
        self.begun += 1
        return self._jobs[self.begun - 1]


def do(chunk: Chunk) -> Done:
    """Do a chunk, in a worker."""
    begin = time.perf_counter()
    shared = _SHELF.taken(chunk.shared)
    if shared is None:
        return Done(b"", lacking=True)
    jobs = _InTime(_Unpickler(chunk.jobs, shared).load(), chunk.seconds)
    result = pickle.dumps(chunk.function(jobs), pickle.HIGHEST_PROTOCOL)
    return Done(result, jobs.begun, time.perf_counter() - begin)


class _Pickler(pickle.Pickler):
    def __init__(self, stream: io.BytesIO, places: dict[int, int]) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL)
        self._places = places

    def persistent_id(self, given: Any) -> int | None:
        return self._places.get(id(given))


class _Unpickler(pickle.Unpickler):
    def __init__(self, content: bytes, shared: Sequence[object]) -> None:
        super().__init__(io.BytesIO(content))
        self._shared = shared

    def persistent_load(self, place: int) -> object:
        return self._shared[place]


def stream_chunks(
    function: Callable[[Iterator[Job]], Result],
    jobs: Iterable[Job],
    executor: Executor,
    workers: int,
    *,
    shared: Callable[[Job], Sequence[object]],
    count: int | None = None,
    ordered: bool = True,
    lost: Callable[[Job], object] | None = None,
    cancel: Asked | None = None,
) -> Iterator[tuple[Sequence[Job], Result]]:
    """Do jobs in other processes or on other machines, in chunks.

    Chunks grow until one takes `CHUNK_SECONDS`, and are smaller where so few jobs are left that workers would wait. A
    chunk whose worker dies again and again is halved, so that one job does not take others along.

    Parameters
    ----------
    function : callable
        Importable in workers: does the jobs of an iterator, which may end before all are done.
    jobs : iterable
        Read as they are needed.
    executor, ordered, cancel
        As for `stream_pairs`.
    workers : int
        Jobs that the executor does at a time.
    shared : callable
        The objects in a job that other jobs hold too, the same ones: they travel once to each worker.
    count : int, optional
        How many jobs there are, where that is known: the last chunks are smaller then.
    lost : callable, optional
        Called with a job that is left out because it has killed its worker again and again. Default: a
        `WorkerLostError`.

    Yields
    ------
    jobs, result
        Of each chunk.

    Raises
    ------
    ParameterError
        Something cannot be sent.
    WorkerLostError
        See `lost`.
    """
    chunks = _Chunks(function, jobs, workers, shared, count)
    pairs = stream_pairs(
        do,
        chunks,
        executor,
        AHEAD * workers,
        again=chunks.with_all,
        rest=chunks.rest,
        halves=chunks.halves,
        lost=None if lost is None else lambda chunk: lost(chunks.taken(chunk)[0]),
        ordered=ordered,
        cancel=cancel,
    )
    for chunk, done in pairs:
        yield chunks.taken(chunk)[: done.begun], pickle.loads(done.result)


class _Known:
    """Something that jobs share, which must live as long as its address says which it is."""

    def __init__(self, given: object) -> None:
        self.given, self.arrived = given, False
        try:
            content = pickle.dumps(given, pickle.HIGHEST_PROTOCOL)
        except Exception as error:  # whatever its own way to be pickled raises
            remedy = "define its class in a module that workers can import, or use threads"
            raise ParameterError(shown(given), f"it cannot be sent: {error}", remedy) from error
        self.sent = Sent(hashlib.sha256(content).hexdigest(), content)


class _Chunks(Generic[Job]):
    """A stream of chunks, and what is known of those under way."""

    def __init__(
        self,
        function: Callable[[Iterator[Job]], Any],
        jobs: Iterable[Job],
        workers: int,
        shared: Callable[[Job], Sequence[object]],
        count: int | None,
    ) -> None:
        self._function, self._jobs, self._workers, self._shared = function, jobs, workers, shared
        self._left, self._number, self._size = count, 0, 1
        self._known: OrderedDict[int, _Known] = OrderedDict()
        self._bytes = 0
        self._under_way: dict[int, tuple[Sequence[Job], Sequence[_Known]]] = {}

    def __iter__(self) -> Iterator[Chunk]:
        waiting: list[Job] = []
        for job in self._jobs:
            waiting.append(job)
            if len(waiting) >= self._size:
                yield self._chunk(waiting)
                waiting = []
        if waiting:
            yield self._chunk(waiting)

    def _chunk(self, jobs: Sequence[Job], *, counted: bool = True) -> Chunk:
        known = {id(given): self._of(given) for job in jobs for given in self._shared(job)}
        stream = io.BytesIO()
        _Pickler(stream, {address: place for place, address in enumerate(known)}).dump(jobs)
        self._number += 1
        self._under_way[self._number] = jobs, list(known.values())
        if self._left is not None and counted:
            self._left -= len(jobs)
        shared = tuple(Sent(each.sent.key, None) if each.arrived else each.sent for each in known.values())
        return Chunk(self._number, self._function, shared, stream.getvalue(), CHUNK_SECONDS)

    def _of(self, given: object) -> _Known:
        known = self._known.pop(id(given), None)
        if known is None:
            known = _Known(given)
            self._bytes += _size(known)
        self._known[id(given)] = known
        while self._bytes > KEPT_BYTES and len(self._known) > 1:
            self._bytes -= _size(self._known.popitem(last=False)[1])
        return known

    def with_all(self, chunk: Chunk, done: Done) -> Chunk | None:
        """The chunk with all that is shared, where a worker lacked some."""
        if not done.lacking:
            return None
        return replace(chunk, shared=tuple(each.sent for each in self._under_way[chunk.number][1]))

    def rest(self, chunk: Chunk, done: Done) -> Chunk | None:
        """What a worker has not begun; takes note of what came of the others."""
        jobs, known = self._under_way[chunk.number]
        for each in known:
            each.arrived = True
        wanted = round(CHUNK_SECONDS * done.begun / max(done.seconds, 1e-6))
        share = LARGEST_CHUNK if self._left is None else self._left // (2 * self._workers)
        self._size = max(1, min(wanted, 2 * self._size, share, LARGEST_CHUNK))
        left = jobs[done.begun :]
        return self._chunk(left, counted=False) if left else None

    def halves(self, chunk: Chunk) -> list[Chunk]:
        """Two chunks instead of one, none where it is one job."""
        jobs = self._under_way[chunk.number][0]
        middle = len(jobs) // 2
        if not middle:
            return []
        del self._under_way[chunk.number]
        return [self._chunk(part, counted=False) for part in (jobs[:middle], jobs[middle:])]

    def taken(self, chunk: Chunk) -> Sequence[Job]:
        """The jobs of a chunk that is no longer under way."""
        return self._under_way.pop(chunk.number)[0]


def _size(known: _Known) -> int:
    return len(known.sent.content or b"")
