"""replays: one scenario with several replanners, one after the other or side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from threading import Event as Flag
from typing import NamedTuple

from antnav.errors import ParameterError, shown
from antnav.live.replanner import Replanner
from antnav.run.chunks import AHEAD, stream_chunks
from antnav.run.spmd import Processes, checked_workers, shares_memory, stream_jobs, width
from antnav.scenarios.model import Replay
from antnav.scenarios.replay import prepare, replay
from antnav.scenarios.scenario import Scenario
from antnav.world.grid import GridMap
from antnav.world.problem import Problem


def replays(
    given: GridMap | Problem | None,
    scenario: Scenario,
    algorithms: Sequence[str | Replanner],
    *,
    improve: int = 1,
    verify: bool = False,
    executor: Executor | None = None,
    workers: int | None = None,
    cancel: Flag | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Replay]:
    """Drive a robot through a scenario with each of several replanners, as `replay` does.

    Parameters
    ----------
    given, scenario, improve, verify
        As of `replay`.
    algorithms : sequence of str or Replanner
        In other processes replanners are copies: what they remember stays there.
    executor : concurrent.futures.Executor, optional
        Where replays run side by side, as of `solve_many`; it is left open. Replanning is measured in CPU seconds,
        which others on the machine lengthen by what they take of its caches.
    workers : int, optional
        Without an executor: processes, started for this call; 1, the default: none. With one: how many replays it does
        at a time.
    cancel : threading.Event, optional
        Set it from elsewhere to end early. Side by side, what is not over is left out then.
    progress : callable, optional
        Called with what is done and with all: ticks one after the other, replays side by side.

    Returns
    -------
    list of Replay
        One each, in order; the same, but for seconds, wherever they were made.

    Raises
    ------
    ParameterError, EndpointError
        As of `replay`; no sequence of replanners, fewer than one worker, something cannot be sent.
    WorkerLostError
        A worker died again and again.
    """
    if isinstance(algorithms, str) or not isinstance(algorithms, Sequence):
        raise ParameterError(f"algorithms {shown(algorithms)}", "there are several", "give a list of replanners")
    if workers is not None:
        checked_workers(workers)
    problem, count = scenario.problem(given), len(algorithms)
    jobs = [_Job(_Scene(problem, scenario, improve, verify), algorithm) for algorithm in algorithms]
    if executor is None and (workers or 1) == 1:
        return _in_turn(jobs, cancel, progress)
    found: list[Replay] = []
    pool = Processes(min(workers or 1, count or 1)) if executor is None else None
    where = pool or executor
    assert where is not None
    try:
        for one in _side_by_side(jobs, where, workers or width(where), cancel):
            found.append(replace(one, problem=problem, scenario=scenario))
            if progress is not None:
                progress(len(found), count)
    finally:
        if pool is not None:
            pool.kill()
    return found


@dataclass(frozen=True, eq=False)
class _Scene:
    """What replays share."""

    problem: Problem
    scenario: Scenario
    improve: int
    verify: bool


class _Job(NamedTuple):
    scene: _Scene
    algorithm: str | Replanner

    def done(self, cancel: Flag | None = None, progress: Callable[[int, int], None] | None = None) -> Replay:
        """The replay."""
        scene = self.scene
        return replay(
            scene.problem,
            scene.scenario,
            self.algorithm,
            improve=scene.improve,
            verify=scene.verify,
            cancel=cancel,
            progress=progress,
        )


def _in_turn(jobs: Sequence[_Job], cancel: Flag | None, progress: Callable[[int, int], None] | None) -> list[Replay]:
    found: list[Replay] = []
    for number, job in enumerate(jobs):
        if cancel is not None and cancel.is_set():
            break

        def count(ticks: int, total: int, before: int = number) -> None:
            if progress is not None:
                progress(before * total + ticks, len(jobs) * total)

        found.append(job.done(cancel, count))
    return found


def _side_by_side(jobs: Sequence[_Job], executor: Executor, workers: int, cancel: Flag | None) -> Iterator[Replay]:
    if shares_memory(executor):
        for job in jobs:
            prepare(job.algorithm)
        yield from stream_jobs(lambda job: job.done(cancel), jobs, executor, AHEAD * workers, cancel=cancel)
        return
    for _, found in stream_chunks(
        _work, jobs, executor, workers, shared=lambda job: (job.scene,), count=len(jobs), cancel=cancel
    ):
        yield from found


def _work(jobs: Iterator[_Job]) -> list[Replay]:
    """Replays in a worker."""
    return [job.done() for job in jobs]
