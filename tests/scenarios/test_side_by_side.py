"""replays: the same wherever they are made."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.run.spmd import Processes
from antnav.scenarios import Scenario, named
from antnav.scenarios.side_by_side import replays

NAMES = ["regions", "astar", "dstar_lite"]


@pytest.fixture(scope="module")
def hall() -> tuple[an.Problem, Scenario]:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((12, 20), np.uint8)), (6, 0), (6, 19))
    return problem, named("people:4+obstacles:3:1", problem, seed=2)


def told(found: list[an.Replay], folder: Path) -> list[bytes]:
    """The files of replays without times."""
    files = []
    for number, one in enumerate(found):
        one.save(folder / f"{number}.csv")
        lines = (folder / f"{number}.csv").read_text().splitlines()
        files.append("\n".join(line.rsplit(",", 2)[0] for line in lines).encode())
    return files


def test_the_same_wherever_they_are_made(hall: tuple[an.Problem, Scenario], tmp_path: Path) -> None:
    alone = [an.replay(*hall, name) for name in NAMES]
    with Processes(2) as processes, ThreadPoolExecutor(2) as threads:
        for choices in ({}, {"workers": 2}, {"executor": processes}, {"executor": threads, "workers": 2}):
            count: list[int] = []
            found = replays(*hall, NAMES, progress=lambda done, _total, count=count: count.append(done), **choices)
            assert told(found, tmp_path) == told(alone, tmp_path)
            assert all(one.problem is hall[0] and one.scenario is hall[1] for one in found)
            assert [one.algorithm for one in found] == NAMES
            assert count == sorted(count)
            assert count[-1] in (3, 3 * hall[1].ticks) or not choices


def test_cancelled(hall: tuple[an.Problem, Scenario]) -> None:
    cancel = threading.Event()
    cancel.set()
    assert replays(*hall, NAMES, cancel=cancel) == []
    assert replays(*hall, NAMES, cancel=cancel, workers=2) == []


@pytest.mark.parametrize("given", [{"algorithms": "astar"}, {"algorithms": 3}, {"workers": 0}, {"executor": "threads"}])
def test_what_is_no_comparison(hall: tuple[an.Problem, Scenario], given: dict[str, object]) -> None:
    with pytest.raises(ParameterError):
        replays(*hall, **{"algorithms": NAMES, **given})
