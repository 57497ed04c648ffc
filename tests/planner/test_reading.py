"""Files of other days, other planners and other costs, read again."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ResultFormatError
from tests.kernels.test_ant_kernels import random_problem
from tests.world.test_path_cost import priced


@pytest.mark.parametrize("name", ["paco", "paco_ls", "paco_levels", "paco_extended"])
def test_turns_where_parts_meet_are_in_no_part(name: str, tmp_path: Path) -> None:
    """The history may lie below the optimum by a turn for each joint, and the file is read all the same."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((5, 3), np.uint8)), (0, 0), (4, 2), turning=3.0)
    for seed in range(10):
        result = an.solve(problem, an.preset(name, iterations=12), seed=seed)
        result.save(tmp_path / "plan.json")
        assert an.Result.load(tmp_path / "plan.json").cost == result.cost


def test_files_without_the_word_estimated_are_read(tmp_path: Path) -> None:
    problem = random_problem(3, side=30)
    for algorithm in (an.paco_large(iterations=9), an.npaco(iterations=5, ants=5)):
        document = json.loads(json.dumps(an.solve(problem, algorithm, seed=1).to_dict()))
        del document["estimated"]
        (tmp_path / "plan.json").write_text(json.dumps(document))
        assert an.Result.load(tmp_path / "plan.json").estimated == (algorithm.coarse > 0)
        document["estimated"] = algorithm.coarse == 0
        (tmp_path / "plan.json").write_text(json.dumps(document))
        with pytest.raises(ResultFormatError, match="estimated"):
            an.Result.load(tmp_path / "plan.json")


def test_a_rivals_file_is_read_by_a_process_that_never_heard_of_rivals(tmp_path: Path) -> None:
    result = an.solve(random_problem(3, side=12), an.algorithm("woa-exact", evaluations=300), seed=2)
    result.save(tmp_path / "plan.json")
    script = (
        "import sys, antnav as an; r = an.Result.load(sys.argv[1]);"
        "print(an.solve(r.problem, r.algorithm, seed=2).length)"
    )
    run = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path / "plan.json")], check=True, capture_output=True, text=True
    )
    assert float(run.stdout) == result.length


def test_a_result_on_regions_carries_no_abstraction() -> None:
    problem = random_problem(3, side=120)
    result = an.solve(problem, an.paco_large(iterations=5), seed=1)
    size = len(pickle.dumps(result))
    assert size < len(pickle.dumps(problem)) + 60_000
    again = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(again.pheromone, result.pheromone)


def test_the_next_query_with_costs_finds_what_the_first_worked_out() -> None:
    first = priced(2)
    second = an.Problem.from_cells(first.grid, first.goal_cell, first.start_cell, cost=first.cost)
    assert second.objective is first.objective
    assert second.terrain is first.terrain
    turning = an.Problem.from_cells(first.grid, first.goal_cell, first.start_cell, cost=first.cost, turning=1.0)
    assert turning.objective is not first.objective
    short = an.prepare(first.grid, cost=first.cost, block=8)
    assert short is an.prepare(first.grid, cost=first.cost, block=8)
    assert short is not an.prepare(first.grid, block=8)
    again = pickle.loads(pickle.dumps(turning))
    assert (again.objective.turning, again.objective.key) == (1.0, turning.objective.key)


def test_windows_tell_of_better_paths_only() -> None:
    told: list[float] = []

    def hear(event: an.events.Event) -> None:
        if isinstance(event, an.events.Improved) and event.stage == "windows":
            told.append(event.best)

    an.solve(random_problem(5, side=40), an.paco_ls(iterations=9, ants=5), events=hear)
    assert told == sorted(set(told), reverse=True)
