"""Results as they were recorded, to the last bit: the file notices what no other test does.

Where results change on purpose, write it anew and say in the changelog what changed and why::

    python -m tests.plan.test_recorded
"""

from __future__ import annotations

import hashlib
import json
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import pytest

import antnav as an
from antnav import maps
from antnav.colony.parts import PheromoneRule
from antnav.run import spmd

FILE = Path(__file__).with_name("recorded.json")


def same_everywhere(algorithm: an.Algorithm) -> bool:
    """Whether it needs no power but by multiplications: others differ between machines in the last bit."""
    whole = all(power % 1 == 0 for power in (algorithm.alpha, algorithm.beta, algorithm.openness))
    return whole and algorithm.beta_last is None and algorithm.pheromone.name is not PheromoneRule.MAX_MIN


CASES = [
    (grid, name, seed)
    for grid in ("equiv20", "equiv30", "equiv40")
    for name, make in an.PRESETS.items()
    if same_everywhere(make())
    for seed in (0, 1)
]


def label(grid: str, name: str, seed: int) -> str:
    return f"{grid} {name} {seed}"


def measured(grid: str, name: str, seed: int, executor: Executor | None = None) -> dict[str, Any]:
    problem = an.Problem.from_cells(maps.builtin(grid), *maps.builtin_query(grid), corner_rule="allow")
    result = an.solve(problem, an.preset(name), seed=seed, executor=executor)
    found = hashlib.sha256()
    if result.path:
        found.update(result.path.cells.tobytes())
    for column in (result.history.best, result.history.lost):
        found.update(column.tobytes())
    return {
        "length": result.length if result.path else None,
        "steps": result.steps,
        "cells, best and lost": found.hexdigest()[:16],
    }


@pytest.fixture(scope="module")
def recorded() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(FILE.read_text())
    return found


@pytest.mark.parametrize("case", CASES, ids=lambda case: label(*case))
def test_results_are_those_that_were_recorded(case: tuple[str, str, int], recorded: dict[str, Any]) -> None:
    assert measured(*case) == measured(*case, spmd.Serial()) == recorded[label(*case)]


def test_what_is_recorded_is_what_is_tested(recorded: dict[str, Any]) -> None:
    assert list(recorded) == [label(*case) for case in CASES]
    assert len(recorded) > 60


if __name__ == "__main__":
    lines = [f" {json.dumps(label(*case))}: {json.dumps(measured(*case))}" for case in CASES]
    FILE.write_text("{\n" + ",\n".join(lines) + "\n}\n")
