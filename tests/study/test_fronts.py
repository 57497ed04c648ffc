"""Studies of fronts: from the file to the report, kept and continued, what is refused."""

from __future__ import annotations

import csv
import hashlib
import inspect
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import costs, fronts, objectives
from antnav.errors import ParameterError
from antnav.planner.facts import Certainty
from antnav.study import comparison, front_sections
from antnav.study.front_model import FrontPlanner, FrontStudy
from antnav.study.front_record import FrontRecord
from antnav.study.front_report import write_front_report
from antnav.study.groups import grouped
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.runner import run_study
from antnav.study.standing import Standing, missing_hypervolume, standings
from antnav.study.store import Store
from antnav.study.toml import StudyFormatError, load_study
from tests.conftest import grid_of

pytest.importorskip("moocore")

HALL = grid_of("........", "...##...", "...##...", "........", "........")
PROBLEM = an.Problem.from_cells(HALL, (0, 0), (0, 7))
WALLED = an.Problem.from_cells(grid_of(".#.", ".#.", ".#."), (0, 0), (0, 2))
FILE = """
title = "Ways through a hall"
seeds = 3
objectives = ["length", "risk:clearance:3", "turns"]

[[maps]]
label = "hall"
file = "hall.txt"
start_cell = [0, 0]
goal_cell = [0, 7]

[[maps]]
generate = { kind = "caves", rows = 16, cols = 16, seed = 3 }

[[algorithms]]
method = "exact"

[[algorithms]]
method = "sweep"
label = "few sums"
searches = 5
"""
NSGA2 = """
[[algorithms]]
method = "nsga2"
population = 12
generations = 5
"""


class Drawing(fronts.Sweep):
    """A method that the seed decides: it ends after so many sums as the seed says."""

    draws = True

    @property
    def name(self) -> str:
        return "drawing"

    def find(self, instance: Any, call: Any) -> Any:
        return fronts.Sweep(1 + call.seed).find(instance, call)


def entry(method: fronts.Method, label: str = "") -> AlgorithmEntry:
    return AlgorithmEntry(label or method.name, FrontPlanner(method))


def study_of(
    *methods: fronts.Method, seeds: Sequence[int] = (0, 1, 2), problem: an.Problem = PROBLEM, **more: Any
) -> FrontStudy:
    asked = [objectives.Length(), objectives.Risk(costs.clearance(problem.grid, 2.0, 3.0))]
    given = {"objectives": {"hall": asked}} | more
    return FrontStudy("", [MapEntry("hall", problem)], [entry(method) for method in methods], seeds, **given)


def done(study: FrontStudy, path: Path) -> tuple[list[FrontRecord], int]:
    """Records, and how many runs were made for them."""
    counts: list[int] = []
    with Store(path, FrontRecord) as store:
        records = run_study(study, store, progress=lambda count, *_: counts.append(count))
    return records, len(counts) - 1


@pytest.fixture
def file(tmp_path: Path) -> Path:
    an.maps.save_map(HALL, tmp_path / "hall.txt")
    path = tmp_path / "study.toml"
    path.write_text(FILE)
    return path


def test_from_the_file_to_the_report(file: Path, tmp_path: Path) -> None:
    pytest.importorskip("pygmo")
    pytest.importorskip("matplotlib")
    file.write_text(FILE + NSGA2)
    study = load_study(file)
    assert isinstance(study, FrontStudy)
    records, _ = done(study, tmp_path / "runs.sqlite")
    assert len(records) == 2 * 3 * 3
    text = write_front_report(records, tmp_path / "out", study).read_text()
    assert (tmp_path / "out" / "as_run.toml").read_text() == FILE + NSGA2
    told = (tmp_path / "out" / "report.md").read_text()
    exact = next(run for run in records if run.map == "hall" and run.algorithm == "exact")
    assert f"which exact proved: {len(exact.values)} paths" in told
    truth = np.array(exact.values)
    point = truth.min(axis=0) + 1.1 * np.ptp(truth, axis=0)
    reference = ", ".join(f"{name} {value:.6g}" for name, value in zip(exact.objectives, point, strict=True))
    assert f"Reference point: {reference}." in told
    with (tmp_path / "out" / "tables" / "fronts_1_hall.csv").open() as stream:
        rows = {row["method"]: row for row in csv.DictReader(stream)}
    assert list(rows) == ["exact", "few sums", "nsga2"]
    assert float(rows["exact"]["hypervolume (%)"]) == 100
    assert float(rows["exact"]["epsilon"]) == float(rows["exact"]["IGD+"]) == 0
    assert 0 < float(rows["few sums"]["hypervolume (%)"]) < 100
    assert (rows["exact"]["runs"], rows["nsga2"]["runs"]) == ("1", "3")
    assert float(rows["nsga2"]["hypervolume, lower quartile (%)"]) <= float(rows["nsga2"]["hypervolume (%)"])
    assert rows["nsga2"]["work"] == "73 evaluations"
    assert {"fronts_1_hall", "critical_difference"} <= {path.stem for path in (tmp_path / "out" / "figures").iterdir()}
    assert "<svg" in text or "data:image/svg" in text
    document = json.loads((tmp_path / "out" / "parameters.json").read_text())
    assert document["objectives"]["hall"] == ["length [m]", "risk clearance:3 [m]", "turns"]
    assert document["algorithms"]["nsga2"]["method"] == "nsga2"
    assert document["algorithms"]["nsga2"]["changed"] == ["population", "generations"]


def test_it_goes_on_where_it_stopped_and_one_run_stands_for_all_seeds(tmp_path: Path) -> None:
    path = tmp_path / "runs.sqlite"
    first, made = done(study_of(fronts.Exact(), Drawing()), path)
    assert (len(first), made) == (6, 1 + 3)
    assert [run.seed for run in first if run.algorithm == "exact"] == [0, 1, 2]
    again, made = done(study_of(fronts.Exact(), Drawing()), path)
    assert (again, made) == (first, 0)
    more, made = done(study_of(fronts.Exact(), Drawing(), fronts.Sweep(3), seeds=(2, 3)), path)
    assert made == 2  # a seed, and a method
    assert [run.values for run in more if run.seed == 2][:2] == [run.values for run in first if run.seed == 2]


def test_what_decides_outcomes_is_in_the_keys() -> None:
    def key(study: FrontStudy) -> str:
        return study.jobs()[0].key

    usual = key(study_of(fronts.Exact()))
    other = {"hall": [objectives.Length(), objectives.Risk(costs.clearance(HALL, 2.0, 4.0))]}
    assert usual == key(study_of(fronts.Exact(), fronts.Sweep(), seeds=(7,)))
    changed = [
        study_of(fronts.Exact(limit=9)),
        study_of(fronts.Sweep()),
        study_of(fronts.Exact(), objectives=other),
        study_of(fronts.Exact(), objectives={"hall": [objectives.Length(), objectives.Turns()]}),
        study_of(fronts.Exact(), seconds=1.0),
        study_of(fronts.Exact(), problem=an.Problem.from_cells(HALL, (0, 0), (0, 7), corner_rule="allow")),
    ]
    assert len({usual, *map(key, changed)}) == 1 + len(changed)
    assert key(study_of(Drawing(), seeds=(1,))) != key(study_of(Drawing(), seeds=(2,)))
    assert FrontPlanner(fronts.Exact()).versions() == {}
    assert FrontPlanner(Drawing()).versions() == {
        "code 0": hashlib.sha256(inspect.getsource(Drawing).encode()).hexdigest()
    }


def test_a_store_holds_paths_and_fronts(tmp_path: Path) -> None:
    paths = Study("", [MapEntry("hall", PROBLEM)], [AlgorithmEntry("astar", an.astar())], [0])
    with Store(tmp_path / "runs.sqlite") as store:
        lengths = run_study(paths, store)
    records, _ = done(study_of(fronts.Exact()), tmp_path / "runs.sqlite")
    with Store(tmp_path / "runs.sqlite") as store:
        assert run_study(paths, store) == lengths
        assert len(store.keys()) == 1
    assert records[0].values[0][0] == pytest.approx(lengths[0].length)


def test_workers_change_no_front(tmp_path: Path) -> None:
    study = study_of(fronts.Exact(), Drawing())
    alone, _ = done(study, tmp_path / "one.sqlite")
    with Store(tmp_path / "two.sqlite", FrontRecord) as store:
        together = run_study(study, store, workers=2)
    assert [run.values for run in alone] == [run.values for run in together]
    assert all("loaded" in run.marks for run in together)


def test_a_time_limit_and_a_budget_of_seconds_are_noted(tmp_path: Path) -> None:
    short, _ = done(study_of(fronts.Sweep(100_000), seeds=(0,), seconds=0.01), tmp_path / "a.sqlite")
    assert "limited" in short[0].marks
    study = study_of(fronts.Exact(), fronts.Sweep(100_000), seeds=(0,), equal_budget="seconds")
    records, _ = done(study, tmp_path / "b.sqlite")
    assert "spent" in records[1].marks
    assert records[1].work["searches"] < 100_000


def record(name: str, seed: int, values: Sequence[tuple[float, ...]], **more: Any) -> FrontRecord:
    given: dict[str, Any] = {
        "key": f"{name} {seed}",
        "map": "hall",
        "algorithm": name,
        "seed": seed,
        "status": "found",
        "complete": False,
        "objectives": ("length [m]", "risk clearance:3 [m]"),
        "counted": (0.001, 0.001),
        "values": tuple(values),
        "work": {"walks": 3},
        "seconds": 0.5,
        "certainty": Certainty.of("ours"),
        "notes": (),
        "environment": {},
    }
    return FrontRecord(**given | more)


def test_the_union_is_the_yardstick_where_none_is_complete() -> None:
    one, other = record("one", 0, [(0.0, 10.0), (6.0, 4.0)]), record("other", 0, [(10.0, 0.0), (4.0, 12.0)])
    standing = standings(grouped([one, other]))["hall"]
    assert standing.truth.tolist() == [[0.0, 10.0], [6.0, 4.0], [10.0, 0.0]]
    assert "union" in standing.yardstick
    assert standing.reference == (11.0, 11.0)
    whole = 11 * 1 + 5 * 6 + 1 * 4  # area below the union, up to (11, 11)
    qualities = standing.qualities
    assert qualities["one 0"].hypervolume == pytest.approx((11 + 5 * 6) / whole)
    assert qualities["other 0"].hypervolume == pytest.approx(11 / whole)
    assert qualities["one 0"].epsilon == pytest.approx(0.4)  # from (6, 4) to (10, 0), in ranges of 10
    assert qualities["one 0"].igd_plus == pytest.approx(0.4 / 3)


def test_a_complete_front_is_the_yardstick() -> None:
    whole = record("exact", 0, [(0.0, 2.0), (2.0, 0.0)], complete=True)
    standing = Standing.of({"exact": [whole], "other": [record("other", 0, [(0.0, 1.9)])]})
    assert standing is not None
    assert standing.proved == "exact"
    assert standing.truth.tolist() == [[0.0, 2.0], [2.0, 0.0]]
    assert Standing.of({"exact": [replace(whole, values=())]}) is None


def test_the_typical_run_is_the_median() -> None:
    runs = [record("one", seed, [(0.0, high)]) for seed, high in enumerate((3.0, 1.0, 2.0))]
    standing = Standing.of({"one": runs, "exact": [record("exact", 0, [(0.0, 1.0), (1.0, 0.0)], complete=True)]})
    assert standing is not None
    assert standing.typical(runs[1:]).seed == 2


def test_methods_are_compared_by_what_they_lack() -> None:
    exact = [record("exact", seed, [(0.0, 1.0), (1.0, 0.0)], key="exact", complete=True) for seed in range(6)]
    sums = [record("sums", seed, [(0.0, 1.0)], key="sums") for seed in range(6)]
    drawn = [record("drawn", seed, [(0.1 * seed, 1.0 + 0.01 * seed)]) for seed in range(6)]
    groups = grouped([*exact, *sums, *drawn])
    table = comparison.comparisons(groups, None, missing_hypervolume(standings(groups)))
    assert table is not None
    pairs = {(row[1], row[2]): row for row in table.rows}
    assert set(pairs) == {("exact", "drawn"), ("sums", "drawn")}  # no test of exact with sums: neither draws
    assert pairs["exact", "drawn"][4:7] == (6, 0, 0)
    assert "Missing hypervolumes of runs of the same seed" in table.note


def test_who_took_longer_than_the_limit_is_named() -> None:
    study = study_of(fronts.Exact(), fronts.Sweep(), seeds=(0,), seconds=1.0)
    runs = [record("exact", 0, [(0.0, 1.0)], seconds=1.05), record("sweep", 0, [(0.0, 1.0)], seconds=2.5)]
    told = " ".join(front_sections.warnings(runs, grouped(runs), study))
    assert "hall: longer than that took sweep 2.5 s (medians)" in told
    assert "exact 1.05" not in told
    assert "Each run had 1 s at most; this ended 0 of 2 runs" in told


def test_a_map_without_a_way_has_dashes(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    study = study_of(fronts.Exact(), fronts.Sweep(), problem=WALLED, seeds=(0,))
    records, _ = done(study, tmp_path / "runs.sqlite")
    assert [run.status for run in records] == ["unreachable"] * 2
    write_front_report(records, tmp_path / "out", study)
    assert "hall: no path leads from the start to the goal." in (tmp_path / "out" / "report.md").read_text()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"turns"]', '"speed"]', "objective 'speed'"),
        ('["length", "risk:clearance:3", "turns"]', '["length"]', "1 objective"),
        ('"turns"]', '"length"]', "different names"),
        ('"turns"]', "3]", "objectives = 3"),
        ('method = "exact"', 'method = "best"', "the methods are"),
        ('method = "exact"', 'preset = "paco"', "key 'preset'|method is missing"),
        ("searches = 5", "searches = 0", "searches 0"),
        ("searches = 5", 'searches = "5"', "searches = '5'"),
        ("searches = 5", "points = 5", "key 'points'"),
        ("seeds = 3", 'seeds = 3\nequal_budget = "walks"', "equal_budget walks"),
        ("seeds = 3", 'seeds = 3\nequal_budget = "steps"', "equal_budget steps"),
        ("seeds = 3", 'seeds = 3\nbaseline = "ants"', "baseline 'ants'"),
        ('label = "hall"', 'label = "hall"\nturning = 1.0', "key 'turning'"),
        ('label = "hall"', 'label = "hall"\ncost = ["clearance:1"]', "key 'cost'"),
        ("[[algorithms]]", "[sweep]\nsearches = [1, 2]\n[[algorithms]]", "key 'sweep'"),
    ],
)
def test_what_a_file_cannot_say_is_refused(file: Path, old: str, new: str, message: str) -> None:
    file.write_text(FILE.replace(old, new, 1))
    with pytest.raises(ParameterError, match=message):
        load_study(file)


def test_a_mask_is_looked_for_beside_the_file(file: Path) -> None:
    file.write_text(FILE.replace('"turns"]', '"time:absent.yaml"]'))
    with pytest.raises(an.AntnavError, match=str(file.parent / "absent.yaml")):
        load_study(file)


def test_what_is_no_study_of_fronts_is_refused() -> None:
    with pytest.raises(ParameterError, match="compares methods of fronts"):
        FrontStudy("", [MapEntry("hall", PROBLEM)], [AlgorithmEntry("paco", an.paco())], [0])
    with pytest.raises(ParameterError, match="objectives"):
        study_of(fronts.Exact(), objectives={})
    with pytest.raises(ParameterError, match="a problem with costs"):
        study_of(fronts.Exact(), problem=an.Problem.from_cells(HALL, (0, 0), (0, 7), turning=1.0))
    with pytest.raises(ParameterError, match="no runs to report"):
        write_front_report([], "out", study_of(fronts.Exact()))
    with pytest.raises(StudyFormatError):
        load_study("absent.toml")
