"""Equal budgets: what a schedule costs, how it is made to cost something else, and what the runs then spend."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.rivals import RIVALS, Metaheuristic
from antnav.study import comparison, results
from antnav.study.budget import Budget, with_walks
from antnav.study.groups import grouped
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.record import Mark, Record
from antnav.study.report import write_report
from antnav.study.runner import run_study, without_times
from antnav.study.store import Store
from tests.study.made_up import OPTIMUM, made_up, problems

WOA = Metaheuristic(method="woa", population=10, evaluations=300)


def small(*chosen, **fields) -> Study:
    entries = [AlgorithmEntry(f"{i} {one.name}", one) for i, one in enumerate(chosen)]
    return Study("t", [MapEntry("equiv20", problems(("equiv20",))["equiv20"])], entries, [0, 1], **fields)


def done(study: Study, path: Path) -> dict[str, list[Record]]:
    with Store(path) as store:
        (group,) = grouped(run_study(study, store)).values()
        return group


@pytest.mark.parametrize(
    "chosen",
    [an.npaco(ants=7, iterations=9), an.paco(ants=8, iterations=9), an.paco_levels(ants=6, iterations=8), WOA],
)
def test_walks_are_those_of_the_runs(chosen, tmp_path: Path) -> None:
    (runs,) = done(small(chosen), tmp_path / "runs.db").values()
    assert {run.walks for run in runs} == {chosen.walks}


def test_large_maps_walk_from_both_ends(tmp_path: Path) -> None:
    chosen = an.paco_large(ants=4, iterations=5)
    result = an.solve(problems(("equiv40",))["equiv40"], chosen)
    assert Record.of(result, key="", map_label="", algorithm_label="").walks == chosen.walks == 40


@pytest.mark.parametrize(
    "chosen", [an.paco(), an.acs(), an.paco_levels(), an.paco_large(), RIVALS["woa-exact"], RIVALS["potential-field"]]
)
@pytest.mark.parametrize("wanted", [2500, 4321])
def test_schedules_are_replaced_up_to_one_iteration(chosen, wanted: int) -> None:
    made = with_walks(chosen, wanted)
    side_by_side = 4 if chosen.name == "paco_levels" else 2
    assert abs(made.walks - wanted) <= side_by_side * getattr(chosen, "ants", 1) / 2
    assert with_walks(chosen, chosen.walks) is chosen


class Own(an.Planner):
    name = "own"


def test_walks_of_somebodys_own_planner_are_not_known() -> None:
    with pytest.raises(ParameterError, match=r"'0 own' with equal_budget walks: .*; give its class a property walks"):
        small(Own(), an.npaco(), equal_budget="walks")
    with pytest.raises(
        ParameterError, match=r"own with 2500 walks: it does not say .*; give its class a property walks"
    ):
        small(an.npaco(), Own(), equal_budget="walks")


def test_equal_walks_follow_the_baseline_or_the_first(tmp_path: Path) -> None:
    chosen = (an.npaco(ants=10, iterations=30), an.acs(ants=5), WOA)
    study = small(*chosen, equal_budget="walks")
    assert [entry.algorithm.walks for entry in study.algorithms] == [300] * 3
    assert replace(study, title="u").algorithms == study.algorithms
    assert {run.walks for runs in done(study, tmp_path / "runs.db").values() for run in runs} == {300}
    other = small(*chosen, equal_budget="walks", baseline="1 acs")
    assert [entry.algorithm.walks for entry in other.algorithms] == [250] * 3


def test_equal_steps_end_before_they_exceed_the_baselines(tmp_path: Path) -> None:
    study = small(an.acs(ants=5, iterations=20), an.paco(ants=10, axis="row"), an.acs(ants=2), equal_budget="steps")
    first, second, third = done(study, tmp_path / "runs.db").values()
    for reference, run, least in zip(first, second, third, strict=True):
        assert Mark.SPENT not in reference.marks
        assert run.steps <= reference.steps
        assert Mark.SPENT in run.marks
        more = an.solve(problems(("equiv20",))["equiv20"], an.paco(ants=10, axis="row"), seed=run.seed)
        assert more.history.steps[: run.iterations + 1].sum() > reference.steps
        assert least.steps <= reference.steps
    again = done(study, tmp_path / "again.db")
    assert [without_times(run) for run in again["1 paco"]] == [without_times(run) for run in second]


def test_equal_steps_hold_where_stage_one_is_repeated(tmp_path: Path) -> None:
    again = an.paco(ants=1, deadlock="death", iterations=20, heuristic="edge")
    problem = problems(("equiv40",))["equiv40"]
    entries = [
        AlgorithmEntry("first", an.npaco(ants=1, iterations=40, deadlock="death")),
        AlgorithmEntry("again", again),
    ]
    study = Study("t", [MapEntry("equiv40", problem)], entries, range(6), equal_budget="steps")
    first, second = done(study, tmp_path / "runs.db").values()
    assert all(run.iterations > 3 for run in second), "into the second attempt"
    for reference, run in zip(first, second, strict=True):
        assert run.steps <= reference.steps
        assert Mark.SPENT in run.marks


def test_a_first_iteration_that_exceeds_the_budget_is_told(tmp_path: Path) -> None:
    study = small(an.npaco(ants=1, iterations=1), an.npaco(ants=20), equal_budget="steps")
    first, second = done(study, tmp_path / "runs.db").values()
    for reference, run in zip(first, second, strict=True):
        assert run.steps > reference.steps
        assert run.iterations == 1
        assert Mark.EXCEEDED in run.marks


def test_equal_seconds_need_one_worker_and_end_runs(tmp_path: Path) -> None:
    study = small(an.npaco(ants=5, iterations=5), an.npaco(iterations=100_000), equal_budget="seconds")
    with Store(tmp_path / "no.db") as store, pytest.raises(ParameterError, match="2 workers with equal_budget seconds"):
        run_study(study, store, workers=2)
    first, second = done(study, tmp_path / "runs.db").values()
    for reference, run in zip(first, second, strict=True):
        assert Mark.SPENT in run.marks
        assert Mark.SPENT not in reference.marks
        assert run.iterations < 1000


def test_a_study_with_a_budget_goes_on_where_it_stopped(tmp_path: Path) -> None:
    study = small(an.acs(ants=5, iterations=20), an.npaco(ants=10), equal_budget="steps")
    path = tmp_path / "runs.db"
    done(replace(study, seeds=[1]), path)
    with Store(path) as store:
        kept = {record.key: record for record in store.records()}
        records = run_study(study, store, workers=2)
    assert [record.key for record in records] == [job.key for job in study.jobs()]
    assert sum(record == kept.get(record.key) for record in records) == 2


def test_tables_print_what_runs_spent_and_the_report_warns_where_it_differs(tmp_path: Path) -> None:
    records = [made_up(name, seed, OPTIMUM, walks=count) for name, count in (("a", 100), ("b", 250)) for seed in (0, 1)]
    table = results.outcomes("m", grouped(records)["equiv20"], paper=False, name="t", title="T")
    spent = [column.head for column in table.columns].index("ant walks or path evaluations")
    assert [row[spent] for row in table.rows] == [100, 250]
    write_report(records, tmp_path, title="t", paper=False, problems={})
    text = (tmp_path / "report.md").read_text()
    assert "equiv20: budgets differ, from 100 walks of a to 250 of b (medians)" in text
    assert "key equal_budget gives all algorithms the same" in text
    alike = [made_up(name, seed, OPTIMUM, steps=1000 if name == "a" else 1101) for name in "ab" for seed in (0, 1)]
    assert comparison.unequal_budgets(grouped(alike), Budget.WALKS) == []
    assert len(comparison.unequal_budgets(grouped(alike), Budget.STEPS)) == 1
    study = small(an.npaco(), an.acs(), equal_budget="steps")
    write_report(alike, tmp_path, title="t", paper=False, problems={}, study=study)
    text = (tmp_path / "report.md").read_text()
    assert "All algorithms got the steps of 0 npaco, each run ending" in text
    assert "from 1000 steps of a to 1101 of b" in text
