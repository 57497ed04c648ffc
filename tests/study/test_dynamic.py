"""Studies of maps that change: the changes, the measures by hand, from the file to the report, kept and continued."""

from __future__ import annotations

import csv
import json
import math
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import maps
from antnav.errors import ParameterError
from antnav.planner.facts import Certainty
from antnav.search import exact
from antnav.study import tracking
from antnav.study.changes import Changes
from antnav.study.dynamic_model import DynamicStudy
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.dynamic_report import write_dynamic_report
from antnav.study.model import AlgorithmEntry, MapEntry
from antnav.study.runner import run_study
from antnav.study.store import Store
from antnav.study.toml import StudyFormatError, load_study
from antnav.study.tracking import Tracking
from tests.conftest import grid_of

PROBLEM = an.Problem.from_cells(maps.builtin("equiv20"), *maps.builtin_query("equiv20"), corner_rule="allow")
CHANGES = Changes(count=2, every=4, share=0.1)
FILE = """
title = "Walls that move"
seeds = 3
changes = { count = 2, every = 5, share = 0.1, seed = 4 }

[[maps]]
builtin = "equiv20"
corner_rule = "allow"

[[algorithms]]
preset = "npaco"
label = "forgetful"
memory = "restart"

[[sweep]]
preset = "npaco"
memory = ["keep", "repair"]
"""


def study_of(*memories: str, changes: Changes = CHANGES, **more: Any) -> DynamicStudy:
    entries = [AlgorithmEntry(name, an.npaco(memory=name, ants=8)) for name in memories]
    return DynamicStudy("", [MapEntry("hall", PROBLEM)], entries, [0, 1], changes=changes, **more)


def done(study: DynamicStudy, path: Path) -> tuple[list[DynamicRecord], int]:
    """Records, and how many runs were made for them."""
    counts: list[int] = []
    with Store(path, DynamicRecord) as store:
        records = run_study(study, store, progress=lambda count, *_: counts.append(count))
    return records, len(counts) - 1


def made_up(best: list[list[float | None]], optima: list[float], **fields: Any) -> DynamicRecord:
    given: dict[str, Any] = {
        "key": "k",
        "map": "m",
        "algorithm": "a",
        "seed": 0,
        "optima": tuple(optima),
        "best": tuple(map(tuple, best)),
        "steps": 1,
        "seconds": 0.5,
        "certainty": Certainty.of("own"),
        "notes": (),
        "environment": {"machine": "one"},
    }
    return DynamicRecord(**given | fields)


def test_changes_move_a_share_of_the_walls_and_leave_a_way() -> None:
    before, *after = Changes(count=6, share=0.1, seed=2).problems(PROBLEM, 3)
    assert before is PROBLEM
    assert len(after) == 6
    occupied = np.count_nonzero(PROBLEM.grid.cells == an.Cell.OCCUPIED)
    for problem in after:
        moved = problem.grid.cells != before.grid.cells
        assert moved.sum() == 2 * round(0.1 * occupied)
        assert np.count_nonzero(problem.grid.cells == an.Cell.OCCUPIED) == occupied
        assert problem.connected
        assert (problem.start_cell, problem.goal_cell) == (PROBLEM.start_cell, PROBLEM.goal_cell)
        assert (problem.corner_rule, problem.grid.resolution) == (PROBLEM.corner_rule, PROBLEM.grid.resolution)
        before = problem


def test_changes_are_drawn_by_both_seeds() -> None:
    def drawn(seed: int, run: int) -> list[str]:
        return [problem.grid.digest for problem in Changes(count=2, seed=seed).problems(PROBLEM, run)]

    assert drawn(1, 2) == drawn(1, 2)
    assert len({tuple(drawn(*seeds)) for seeds in ((1, 2), (2, 1), (0, 2), (1, 0))}) == 4


def test_a_map_that_no_change_leaves_open_is_refused() -> None:
    corridor = an.Problem.from_cells(grid_of("#####", ".....", "#####"), (1, 0), (1, 4))
    with pytest.raises(ParameterError, match="no change left a way"):
        list(Changes(count=1, share=1.0).problems(corridor, 0))


@pytest.mark.parametrize(
    "wrong",
    [{"count": 0}, {"count": 1.5}, {"every": 0}, {"share": 0}, {"share": 1.1}, {"share": "much"}, {"seed": -1}],
)
def test_changes_out_of_range_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        Changes(**wrong)


def test_measures_by_hand() -> None:
    best = [[12.0, 11.0], [None, 22.0], [10.0, 10.0], [13.0, 10.05]]
    run = Tracking(made_up(best, [10.0, 20.0, 10.0, 10.0]))
    inf = math.inf
    np.testing.assert_allclose(run.gaps, [[inf, 0.1], [0, 0], [0.3, 0.005]])
    assert run.offline == inf
    assert run.accuracy == pytest.approx((0 + 1 / 1.1 + 1 + 1 + 1 / 1.3 + 1 / 1.005) / 6)
    assert run.stability == pytest.approx((1 / 1.1 + 0 + (1 - 1 / 1.3)) / 3)  # the second change makes it better
    assert run.recovery.tolist() == [2, 1, 2]  # 0.005 is more than before, but near
    assert run.at(2) == pytest.approx((0.1 + 0 + 0.005) / 3)
    late = Tracking(made_up([[10.0], [12.0]], [10.0, 10.0]))
    assert late.recovery.tolist() == [inf]
    assert tracking.offline_gaps([late.run]) == [pytest.approx(0.2)]


def test_a_run_follows_its_changes_with_what_it_remembers(tmp_path: Path) -> None:
    study = study_of("restart", "repair")
    records, _ = done(study, tmp_path / "runs.sqlite")
    assert [(run.algorithm, run.seed) for run in records] == [
        ("restart", 0),
        ("repair", 0),
        ("restart", 1),
        ("repair", 1),
    ]
    for run in records:
        problems = list(CHANGES.problems(PROBLEM, run.seed))
        assert run.optima == tuple(exact.optimum(problem).cost for problem in problems)
        assert [len(row) for row in run.best] == [4, 4, 4]
    first = an.solve(PROBLEM, an.npaco(memory="repair", ants=8), seed=1, stop=an.stop.Iterations(4), remember=True)
    assert records[3].best[0] == tuple(first.history.best.tolist())
    seed = (1 + 0x9E3779B97F4A7C15) % 2**64
    second = an.solve(
        list(CHANGES.problems(PROBLEM, 1))[1], first.algorithm, seed=seed, stop=an.stop.Iterations(4), warm=first
    )
    assert records[3].best[1] == tuple(second.history.best.tolist())
    assert records[1].best[0] == records[0].best[0], "until the first change all strategies do the same"
    assert records[1].best[1:] != records[0].best[1:]


def test_what_is_there_is_not_run_again(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    first, made = done(study_of("restart"), path)
    assert made == 2
    again, made = done(study_of("restart", "keep"), path)
    assert made == 2
    assert again[::2] == first
    other = study_of("restart", changes=replace(CHANGES, seed=9))
    assert done(other, path)[1] == 2
    assert done(study_of("restart"), path)[1] == 0


def test_a_run_that_is_cancelled_leaves_nothing() -> None:
    cancel = threading.Event()
    cancel.set()
    assert study_of("keep").jobs()[0].run(None, cancel) is None


def test_a_schedule_that_is_shorter_is_held(tmp_path: Path) -> None:
    study = replace(study_of("keep"), algorithms=[AlgorithmEntry("short", an.npaco(iterations=2, ants=8))])
    records, _ = done(study, tmp_path / "runs.sqlite")
    assert all(row[1] == row[2] == row[3] for run in records for row in run.best)


def test_pacos_stages_are_one_curve(tmp_path: Path) -> None:
    study = replace(study_of("keep"), algorithms=[AlgorithmEntry("paco", an.paco(ants=8))])
    records, _ = done(study, tmp_path / "runs.sqlite")
    for row in (row for run in records for row in run.best):
        assert len(row) == 4
        known = [cost for cost in row if cost is not None]
        assert known == sorted(known, reverse=True)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(FILE)
    return path


def test_from_the_file_to_the_report(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    study = load_study(file)
    assert isinstance(study, DynamicStudy)
    assert study.changes == Changes(count=2, every=5, share=0.1, seed=4)
    records, _ = done(study, tmp_path / "runs.sqlite")
    page = write_dynamic_report(records, tmp_path / "out", study).read_text()
    assert "<svg" in page or "data:image/svg" in page
    told = (tmp_path / "out" / "report.md").read_text()
    assert "Each run meets 2 changes, one every 5 iterations; each moves 10 % of the occupied cells" in told
    with (tmp_path / "out" / "tables" / "changes_1_equiv20.csv").open() as stream:
        rows = {row["algorithm"]: row for row in csv.DictReader(stream)}
    assert list(rows) == ["forgetful", "npaco memory=keep", "npaco memory=repair"]
    runs = [Tracking(run) for run in records if run.algorithm == "npaco memory=repair"]
    row = rows["npaco memory=repair"]
    assert float(row["offline gap (%)"]) == pytest.approx(100 * np.mean([run.offline for run in runs]))
    assert float(row["gap after 2 (%)"]) == pytest.approx(100 * np.mean([run.at(2) for run in runs]))
    assert "gap after 5 (%)" in row
    assert "gap after 10 (%)" not in row, "there are five iterations"
    assert float(row["recovered within 5 (%)"]) == 100 * np.mean([run.recovery <= 5 for run in runs])
    assert {"changes_1_equiv20", "critical_difference"} <= {
        path.stem for path in (tmp_path / "out" / "figures").iterdir()
    }
    document = json.loads((tmp_path / "out" / "parameters.json").read_text())
    assert document["changes"] == {"count": 2, "every": 5, "share": 0.1, "seed": 4}
    assert document["algorithms"]["forgetful"]["changed"][0] == "memory"
    assert (tmp_path / "out" / "as_run.toml").read_text() == FILE
    with (tmp_path / "out" / "runs.csv").open() as stream:
        assert len(list(csv.DictReader(stream))) == 9


def test_a_report_of_one_run_says_what_it_cannot_show(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    study = replace(study_of("keep"), seeds=[0])
    run = made_up([[None, None], [None, None]], [1.0, 1.0], map="hall", algorithm="keep")
    page = write_dynamic_report([run], tmp_path, study)
    told = (page.parent / "report.md").read_text()
    assert "Paired comparisons need two algorithms" in told
    assert "no path" in told
    with pytest.raises(ParameterError, match="no runs to report"):
        write_dynamic_report([], tmp_path, study)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("count = 2", "counts = 2", "counts"),
        ("count = 2", "count = 2.5", "whole number"),
        ("share = 0.1", "share = 2", "above 0"),
        ("seeds = 3", "seeds = 3\nseconds = 1", "seconds"),
        ('corner_rule = "allow"', "robot_radius = 0.5", "robot_radius"),
        ('memory = "restart"', 'memory = "restarts"', "memory .restarts"),
        ('preset = "npaco"\nlabel', 'preset = "paco_large"\nlabel', "memory|regions"),
        ('preset = "npaco"\nlabel = "forgetful"\nmemory = "restart"', 'preset = "astar"', "remembers no pheromone"),
    ],
)
def test_what_a_study_of_changes_refuses(file: Path, old: str, new: str, words: str) -> None:
    text = FILE.replace(old, new, 1)
    assert text != FILE
    file.write_text(text)
    with pytest.raises(ParameterError, match=words):
        load_study(file)


def test_changes_are_a_table(file: Path) -> None:
    file.write_text(FILE.replace("{ count = 2, every = 5, share = 0.1, seed = 4 }", "3"))
    with pytest.raises(StudyFormatError, match="changes"):
        load_study(file)


def test_what_cannot_be_studied_is_refused() -> None:
    walled = an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2))
    with pytest.raises(ParameterError, match="differ and are connected"):
        replace(study_of("keep"), maps=[MapEntry("walled", walled)])
    for limit in ({"seconds": 1.0}, {"equal_budget": "walks"}):
        with pytest.raises(ParameterError, match="leave them out"):
            study_of("keep", **limit)
