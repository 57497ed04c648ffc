"""solve(): the paper's results on the stand-ins, the cases it leaves out, and the same bytes everywhere."""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.ants import run as running
from antnav.colony.colony import Task
from antnav.errors import ParameterError
from antnav.planner import nav2
from antnav.planner.call import CancelOrFailure
from antnav.run import spmd, stop
from tests.conftest import grid_of

SEEDS = range(30)
#: Means measured by a prototype, of paper_equivalent/README.md: npaco, paco.
MEANS = {20: (29.2132, 29.2132), 30: (37.3848, 37.3848), 40: (51.3470, 51.7456)}


def fingerprint(result: an.Result) -> bytes:
    """Everything of a result that must not depend on the machine or the executor."""
    cells = b"" if result.path is None else result.path.cells.tobytes()
    return cells + b"".join(column.tobytes() for column in result.history) + str(result.auxiliary_cell).encode()


@pytest.mark.parametrize("place", [0, 1])
def test_paper_quality_over_30_seeds(equivalent: an.Problem, place: int) -> None:
    algorithm = (an.npaco(), an.paco(axis="row"))[place]
    results = [an.solve(equivalent, algorithm, seed=seed) for seed in SEEDS]
    for result in results:
        an.check_path(result.path, equivalent)
    lengths = np.array([result.length for result in results])
    assert lengths.min() == results[0].optimum
    assert lengths.mean() <= 1.005 * MEANS[equivalent.grid.rows][place]


def test_traditional_fails_as_the_paper_says(equivalent: an.Problem) -> None:
    results = [an.solve(equivalent, an.traditional(), seed=seed) for seed in range(10)]
    found = [result for result in results if result.path]
    if equivalent.grid.rows == 40:
        assert not found
        assert {result.status for result in results} == {an.Status.NO_ANT_ARRIVED}
    else:
        assert min(result.gap for result in found) > 0.2


def test_paco_finds_the_printed_auxiliary_cell(equivalent: an.Problem) -> None:
    printed = {20: (9, 8), 30: (11, 20), 40: (19, 11)}[equivalent.grid.rows]
    cells = [an.solve(equivalent, an.paco(axis="row"), seed=seed).auxiliary_cell for seed in SEEDS]
    assert cells.count(printed) >= 15


def test_stage_one_is_the_first_iterations_of_the_whole_schedule(equivalent: an.Problem) -> None:
    """Section 4.3: "the first T0 iterations of the algorithm", so the first three of a schedule over 50: c = 1 in eq.
    (4.1), and nobody is killed before 60 to 80 % of 50.
    """
    result = an.solve(equivalent, an.paco(axis="row"), seed=0)
    alone = an.Colony(equivalent, an.npaco(), seed=0)
    alone.step(3)
    forward = result.stages[0].colonies[0]
    assert (forward.iterations, forward.steps, forward.length) == (3, alone.history.steps.sum(), alone.best_length)
    assert result.history.lost[:3].tolist() == [0, 0, 0]
    assert result.stages[1].colonies[0].iterations == 47


def test_stages_are_accounted_for(equivalent: an.Problem) -> None:
    result = an.solve(equivalent, an.paco(axis="row"), seed=1)
    one, two = result.stages
    assert [colony.iterations for colony in one.colonies] == [3, 3]
    assert [colony.iterations for colony in two.colonies] == [47, 47]
    assert one.colonies[0].start == one.colonies[1].goal == equivalent.start_cell
    assert two.colonies[0].goal == two.colonies[1].start == result.auxiliary_cell
    assert result.length == pytest.approx(sum(colony.length for colony in two.colonies))
    assert result.iterations == 50
    assert result.history.best[-1] == pytest.approx(result.length)
    assert result.steps == result.history.steps.sum()
    assert result.critical_steps == sum(max(colony.steps for colony in stage.colonies) for stage in result.stages)


def test_same_bytes_on_every_executor(equivalent: an.Problem) -> None:
    algorithm = an.paco()
    expected = fingerprint(an.solve(equivalent, algorithm, seed=5))
    with ThreadPoolExecutor(8) as eight:
        for executor in (spmd.Serial(), spmd.executor_for(2), eight):
            assert fingerprint(an.solve(equivalent, algorithm, seed=5, executor=executor)) == expected
    assert fingerprint(an.solve(equivalent, algorithm, seed=6)) != expected


def test_same_bytes_in_other_processes(equivalent: an.Problem) -> None:
    expected = fingerprint(an.solve(equivalent, an.paco(), seed=5))
    with spmd.Processes(2) as processes:
        assert fingerprint(an.solve(equivalent, an.paco(), seed=5, executor=processes)) == expected
    name = f"equiv{equivalent.grid.rows}"
    script = (
        "import antnav as an, hashlib; from antnav import maps; from tests.plan.test_solve import fingerprint\n"
        f"p = an.Problem.from_cells(maps.builtin({name!r}), *maps.builtin_query({name!r}), corner_rule='allow')\n"
        "print(fingerprint(an.solve(p, an.paco(), seed=5)).hex())"
    )
    output = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout
    assert bytes.fromhex(output) == expected


def test_same_bytes_on_a_real_dask_cluster(equivalent: an.Problem) -> None:
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    expected = fingerprint(an.solve(equivalent, an.paco(), seed=5))
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        executor = client.get_executor()
        assert fingerprint(an.solve(equivalent, an.paco(), seed=5, executor=executor)) == expected


def test_unreachable_is_a_status_and_no_ant_walks() -> None:
    problem = an.Problem.from_cells(grid_of(".#.", ".#.", ".#."), (0, 0), (0, 2))
    for algorithm in (an.paco(), an.npaco()):
        result = an.solve(problem, algorithm)
        assert (result.status, result.path, result.steps) == (an.Status.UNREACHABLE, None, 0)
        assert result.optimum == result.length == float("inf")
        assert nav2.code_of(result) == 208


def test_start_equals_goal() -> None:
    problem = an.Problem.from_cells(grid_of("..."), (0, 1), (0, 1))
    result = an.solve(problem)
    assert (result.status, result.length, result.gap) == (an.Status.FOUND, 0.0, 0.0)
    assert an.check_path(result.path, problem) == 0


@pytest.mark.parametrize("axis", ["auto", "row", "column"])
def test_adjacent_ends_and_ends_on_one_line(axis: str) -> None:
    grid = grid_of(".....", ".....", ".....")
    for goal in ((1, 1), (1, 2), (1, 4), (2, 1)):
        problem = an.Problem.from_cells(grid, (1, 0), goal)
        result = an.solve(problem, an.paco(axis=axis), seed=3)
        assert result.length == result.optimum
        an.check_path(result.path, problem)


def test_corridor_without_a_dividing_cell_is_solved_undivided() -> None:
    result = an.solve(an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1)), an.paco())
    assert result.length == 1.0
    assert result.auxiliary_cell is None
    assert any("undivided" in note for note in result.notes)


def test_stage_one_is_extended_and_then_given_up() -> None:
    # One ant that dies at its first dead end, on a map full of them: most runs see no arrival for long.
    problem = an.Problem.from_cells(maps.builtin("equiv40"), *maps.builtin_query("equiv40"), corner_rule="allow")
    algorithm = an.paco(ants=1, deadlock="death", iterations=20, heuristic="edge")
    result = an.solve(problem, algorithm, seed=0)
    names = [stage.name for stage in result.stages]
    assert names == ["stage one", "stage one", "stage one", "whole map"]
    assert [stage.colonies[0].iterations for stage in result.stages] == [3, 6, 12, 20]
    assert result.notes[-1] == "solved undivided"


def test_repair_cuts_loops_and_never_loses_to_stage_one(equivalent: an.Problem) -> None:
    for seed in range(10):
        plain = an.solve(equivalent, an.paco(axis="row"), seed=seed)
        repaired = an.solve(equivalent, an.paco(axis="row", join="repair"), seed=seed)
        assert repaired.length <= plain.length
        assert len({tuple(cell) for cell in repaired.path.cells}) == len(repaired.path)


@pytest.mark.parametrize("algorithm", [an.paco(search="half"), an.paco(inherit=True), an.paco_extended()])
def test_our_additions_give_valid_paths(equivalent: an.Problem, algorithm: an.Algorithm) -> None:
    for seed in range(5):
        result = an.solve(equivalent, algorithm, seed=seed)
        an.check_path(result.path, equivalent)
        assert result.gap < 0.1


def test_stopping_by_iterations_and_target(equivalent: an.Problem) -> None:
    short = an.solve(equivalent, an.npaco(), seed=1, stop=stop.Iterations(7))
    assert (short.iterations, short.stopped_by) == (7, "criterion")
    full = an.solve(equivalent, an.npaco(), seed=1)
    assert np.array_equal(short.history.best, full.history.best[:7])
    divided = an.solve(equivalent, an.paco(), seed=1, stop=stop.Iterations(10))
    assert divided.iterations == 10
    easy = an.solve(equivalent, an.paco(), seed=1, stop=stop.TargetLength(1000))
    assert easy.iterations == 1
    assert easy.status == "found"


def test_a_target_is_not_mistaken_in_a_half(equivalent: an.Problem) -> None:
    # Each half is shorter than the whole optimum; that must not end the run.
    result = an.solve(equivalent, an.paco(), seed=2, stop=stop.TargetLength(equivalent_optimum(equivalent) * 0.9))
    assert (result.iterations, result.stopped_by) == (50, "schedule")


def equivalent_optimum(problem: an.Problem) -> float:
    return an.exact.optimum(problem).length


def test_stagnation_and_seconds(equivalent: an.Problem) -> None:
    result = an.solve(equivalent, an.npaco(iterations=1000), seed=1, stop=stop.Stagnation(20))
    best = result.history.best
    assert result.iterations < 1000
    assert best[-1] == best[-20]
    timed = an.solve(equivalent, an.npaco(iterations=10**6), seed=1, stop=stop.Seconds(0.1))
    assert timed.stopped_by == "criterion"
    assert timed.path is not None


@pytest.mark.parametrize("algorithm", [an.npaco(iterations=10**7), an.paco(iterations=10**7)])
def test_cancelled_runs_give_the_best_so_far(equivalent: an.Problem, algorithm: an.Algorithm) -> None:
    cancel = threading.Event()
    threading.Timer(0.3, cancel.set).start()
    began = time.monotonic()
    result = an.solve(equivalent, algorithm, cancel=cancel)
    assert time.monotonic() - began < 30
    assert (result.status, result.stopped_by) == ("found", "cancelled")
    an.check_path(result.path, equivalent)


@pytest.mark.parametrize(
    "arguments", [{"seed": -1}, {"seed": 1.5}, {"seed": 2**64}, {"algorithm": "paco"}, {"stop": 5}, {"problem": None}]
)
def test_bad_arguments(arguments: dict) -> None:
    problem = an.Problem.from_cells(grid_of(".."), (0, 0), (0, 1))
    with pytest.raises(ParameterError):
        an.solve(**({"problem": problem} | arguments))


def test_seeds_may_be_as_large_as_64_bits() -> None:
    problem = an.Problem.from_cells(grid_of("...", "..."), (0, 0), (1, 2))
    assert an.solve(problem, seed=2**64 - 1).length == an.solve(problem, seed=2**63).optimum


@pytest.mark.parametrize("rule", ["allow", "graze", "forbid"])
def test_paths_keep_the_corner_rule(rule: str) -> None:
    grid = maps.generate("random", 25, 30, seed=4)
    cells = np.argwhere(grid.passable())
    problem = an.Problem.from_cells(grid, tuple(cells[0]), tuple(cells[-1]), corner_rule=rule)
    for seed in range(5):
        result = an.solve(problem, an.paco(), seed=seed)
        assert result.path is not None
        an.check_path(result.path, problem)


def test_detour_guides_where_target_gets_lost() -> None:
    grid = maps.generate("caves", 120, 160, seed=1)
    cells = np.argwhere(grid.passable())
    problem = an.Problem.from_cells(grid, tuple(cells[0]), tuple(cells[-1]))
    guided, lost = (an.solve(problem, an.paco(heuristic=name), seed=0) for name in ("auto", "target"))
    assert str(guided.algorithm.heuristic) == "detour"
    assert guided.gap < 0.01
    assert not lost.gap < 0.2


def test_a_colony_that_never_started_is_accounted_for(equivalent: an.Problem) -> None:
    """Cancelled in the first colony, with one worker: the second does no iteration at all."""
    cancel = threading.Event()
    result = an.solve(
        equivalent,
        an.paco(),
        executor=spmd.Serial(),
        cancel=cancel,
        events=lambda event: isinstance(event, an.events.Iterated) and cancel.set(),
    )
    assert [colony.iterations for colony in result.stages[0].colonies] == [1, 0]
    assert result.stopped_by == "cancelled"
    assert result.path is not None
    assert result.history.best[0] == pytest.approx(result.length)


def test_more_iterations_never_make_a_stopped_path_longer(equivalent: an.Problem) -> None:
    for seed in range(10):
        lengths = [an.solve(equivalent, an.paco(), seed=seed, stop=stop.Iterations(n)).length for n in (3, 4, 6)]
        assert lengths[1] <= lengths[0]
        assert lengths[2] <= lengths[0]


def test_jobs_that_solve_in_turn_do_not_wait_for_each_other(equivalent: an.Problem) -> None:
    lengths = spmd.run_jobs(lambda seed: an.solve(equivalent, an.paco(), seed=seed).length, range(6))
    assert lengths == [an.solve(equivalent, an.paco(), seed=seed).length for seed in range(6)]
    with spmd.executor_for(2) as pool:
        assert [f.result() for f in [pool.submit(lambda: an.solve(equivalent).length) for _ in range(4)]]
    assert an.solve(equivalent).path is not None


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_solving_after_a_fork(equivalent: an.Problem) -> None:
    an.solve(equivalent)
    script = (
        "import os, antnav as an; from antnav import maps\n"
        "p = an.Problem.from_cells(maps.builtin('equiv20'), (0, 0), (19, 19), corner_rule='allow')\n"
        "an.solve(p)\n"
        "child = os.fork()\n"
        "if child == 0:\n    an.solve(p); os._exit(0)\n"
        "print(os.waitpid(child, 0)[1])"
    )
    command = [sys.executable, "-W", "ignore", "-c", script]
    run = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert run.stdout.strip() == "0", run.stderr


def test_a_time_limit_holds_for_colonies_in_turn(equivalent: an.Problem) -> None:
    began = time.monotonic()
    an.solve(equivalent, an.paco(iterations=10**6), stop=stop.Seconds(1.0), executor=spmd.Serial())
    assert time.monotonic() - began < 1.9


@pytest.mark.parametrize("hours", [-1, 1])
def test_a_time_limit_is_deaf_to_the_wall_clock(equivalent: an.Problem, hours: int, monkeypatch) -> None:
    """Somebody sets it back or forward between any two looks at it."""
    jumping = itertools.count(time.time(), 3600 * hours)
    monkeypatch.setattr(time, "time", lambda: next(jumping))
    began = time.monotonic()
    result = an.solve(equivalent, an.npaco(iterations=10**5), stop=stop.Seconds(0.3))
    assert result.stopped_by == "criterion"
    assert 0.3 <= time.monotonic() - began < 10


def test_a_failing_listener_does_not_set_the_callers_event(equivalent: an.Problem) -> None:
    cancel = threading.Event()
    with pytest.raises(ZeroDivisionError):
        an.solve(equivalent, cancel=cancel, events=lambda event: 1 / 0)
    assert not cancel.is_set()


def test_a_colony_that_fails_ends_the_others_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before the error arrives: whoever hands out the jobs waits for all of them."""

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(running.colony, "run", fail)
    cancel = CancelOrFailure(None)
    with pytest.raises(ZeroDivisionError):
        running._ran(None, cancel, None)
    assert cancel.is_set()


def test_a_moved_goal_is_said(tmp_path) -> None:
    problem = an.Problem.from_cells(grid_of("...#"), (0, 0), (0, 3), goal_tolerance=2.0)
    result = an.solve(problem)
    assert problem.requested_goal == (3.5, 0.5)
    assert any("moved by 1 m" in note for note in result.notes)
    result.save(tmp_path / "plan.json")
    assert an.Result.load(tmp_path / "plan.json").problem.requested_goal == (3.5, 0.5)


def optimal_runs(problem: an.Problem, **choices: Any) -> int:
    return sum(an.solve(problem, an.paco_ls(**choices), seed=seed).gap < 1e-9 for seed in range(30))


def test_local_search_reaches_the_optimum(equivalent: an.Problem) -> None:
    assert optimal_runs(equivalent) >= 29
    assert optimal_runs(equivalent, ants=5) >= 27


def test_local_search_on_published_grids(data: Path) -> None:
    files = sorted((data / "aco_grids").glob("*.json"))
    assert len(files) == 6
    for file in files:
        about = json.loads(file.read_text())
        ends = tuple(about["start_row_col"]), tuple(about["goal_row_col"])
        problem = an.Problem.from_cells(an.load_map(file.with_suffix(".txt")), *ends, corner_rule="allow")
        assert optimal_runs(problem) >= 29
        assert optimal_runs(problem, ants=5) >= 27


class Watched(spmd.Serial):
    """Runs jobs in turn, and notes the seed and number of each colony among them."""

    def __init__(self) -> None:
        self.streams: list[tuple[int, int]] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Any:
        tasks = [arg.task if isinstance(arg, an.Colony) else arg for arg in args]
        self.streams += [(task.seed, task.colony) for task in tasks if isinstance(task, Task)]
        return super().submit(fn, *args, **kwargs)


def test_iterations_of_a_stage_one_that_is_repeated_count() -> None:
    problem = an.Problem.from_cells(maps.builtin("equiv40"), *maps.builtin_query("equiv40"), corner_rule="allow")
    algorithm = an.paco(ants=1, deadlock="death", iterations=20, heuristic="edge")
    whole = an.solve(problem, algorithm)
    assert [stage.name for stage in whole.stages] == ["stage one"] * 3 + ["whole map"]
    for count in range(1, whole.iterations):
        result = an.solve(problem, algorithm, stop=stop.Iterations(count))
        assert (result.iterations, result.stopped_by) == (count, "criterion")
        assert result.history.steps.tolist() == whole.history.steps[:count].tolist()


@pytest.mark.parametrize(
    ("algorithm", "stages"),
    [
        (an.paco(axis="row"), ["stage one", "stage two"]),
        (an.paco(cuts="levels", pieces=5), ["stage one", "stage two"]),
        (
            an.paco(ants=1, deadlock="death", iterations=20, heuristic="edge"),
            ["stage one", "stage one", "stage one", "whole map"],
        ),
    ],
)
def test_no_two_colonies_of_a_run_draw_the_same_numbers(algorithm: an.Algorithm, stages: list[str]) -> None:
    """An ant's stream is that of its seed, colony, iteration and place: a second stage would walk as the first did."""
    watched = Watched()
    problem = an.Problem.from_cells(maps.builtin("equiv40"), *maps.builtin_query("equiv40"), corner_rule="allow")
    result = an.solve(problem, algorithm, seed=0, executor=watched)
    assert [stage.name for stage in result.stages] == stages
    assert len(watched.streams) == sum(len(stage.colonies) for stage in result.stages)
    assert len(set(watched.streams)) == len(watched.streams)


def test_what_a_planner_of_ones_own_raises_is_its_error() -> None:
    @dataclass(frozen=True)
    class Faulty(an.Planner):
        name: str = "faulty"

        def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
            raise ZeroDivisionError("by nothing")

    with pytest.raises(
        an.errors.RuleError, match=r"planner faulty: it raised ZeroDivisionError: by nothing \(line"
    ) as caught:
        an.solve(an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19)), Faulty())
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
