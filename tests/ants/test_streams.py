"""No two colonies of one run share their random numbers."""

from __future__ import annotations

from itertools import count, takewhile

import antnav as an
from antnav.ants import streams
from antnav.run import spmd
from tests.conftest import grid_of


def test_numbers_of_a_run_differ() -> None:
    longest = 10**9  # iterations that an algorithm may have: stage one doubles until it has as many
    attempts = list(takewhile(lambda attempt: 2**attempt < longest, count()))
    scouts = [streams.scout(attempt, side) for attempt in attempts for side in (0, 1)]
    pieces = [streams.piece(index) for index in range(64)]
    assert len({*scouts, *pieces}) == len(scouts) + len(pieces)
    assert len({*scouts, streams.TAKES_OVER}) == len(scouts) + 1
    assert streams.router(0) != streams.router(1)


def test_colonies_of_a_run_have_these_numbers(monkeypatch) -> None:
    seen: list[int] = []
    run_jobs = spmd.run_jobs

    def watched(function, jobs, *arguments):
        tasks = [getattr(job, "task", job) for job in jobs]  # colonies are made before they are handed over
        seen.extend(task.colony for task in tasks if hasattr(task, "colony"))
        return run_jobs(function, jobs, *arguments)

    monkeypatch.setattr(spmd, "run_jobs", watched)
    problem = an.Problem.from_cells(grid_of(*["." * 12] * 12), (0, 0), (11, 11))
    an.solve(problem, an.paco_levels(ants=3, iterations=9, pieces=5))
    assert seen == [streams.scout(0, 0), streams.scout(0, 1), *(streams.piece(index) for index in range(5))]
    assert len(set(seen)) == len(seen)
