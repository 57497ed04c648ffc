"""One protocol for all planners: ants, exact search, rivals, and one's own."""

from __future__ import annotations

import copy
import pickle
import sys
from dataclasses import dataclass
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError, PathError
from antnav.plan.algorithms import names
from antnav.planner.plan import ColonyReport, Stage, history_of
from antnav.planner.planner import Recorded, identity
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.report import write_report
from antnav.study.runner import run_study
from antnav.study.store import Store
from antnav.study.toml import load_study
from tests.conftest import grid_of
from tests.kernels.test_ant_kernels import random_problem

GRID = grid_of("....", ".##.", "....")
PROBLEM = an.Problem.from_cells(GRID, (0, 0), (2, 3))


@dataclass(frozen=True)
class Staircase(an.Planner):
    """Down, then right: blind for walls."""

    name: str = "staircase"
    tread: float = 1

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        (row, col), (last_row, last_col) = problem.start_cell, problem.goal_cell
        down = [(at, col) for at in range(row, last_row + 1)]
        return an.Plan(cells=np.array([*down, *((last_row, at) for at in range(col + 1, last_col + 1))], np.int32))


@dataclass(frozen=True)
class Lazy(an.Planner):
    """Finds nothing."""

    name: str = "lazy"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.Plan(cells=None, notes=("too tired",))


def test_ones_own_planner_needs_a_name_and_plan() -> None:
    result = an.solve(PROBLEM, Staircase())
    assert (result.status, result.length, result.gap) == ("found", 5.0, pytest.approx(5 / result.optimum - 1))
    assert "staircase, seed 0" in result.summary()
    assert (result.steps, result.iterations, result.walks) == (0, 0, 0)
    tired = an.solve(PROBLEM, Lazy())
    assert (tired.status, tired.path, tired.notes) == ("no_path", None, ("too tired",))
    walled = an.solve(an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2)), Lazy())
    assert walled.status == "unreachable"
    assert an.solve(an.Problem.from_cells(GRID, (0, 0), (0, 0)), Lazy()).length == 0.0


@dataclass(frozen=True)
class Said(an.Planner):
    """Answers what it was given."""

    answer: Any
    name: str = "said"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        answer: an.Plan = self.answer
        return answer


def report(iterations: int) -> Stage:
    return Stage("search", 0.0, (ColonyReport((0, 0), (2, 3), iterations, 5.0, 0, 0.0, 0.0),))


ENDS = [(0, 0), (2, 3)]


@pytest.mark.parametrize(
    ("answer", "error", "words"),
    [
        (None, ParameterError, "plan of said None: its type is Plan"),
        (ENDS, ParameterError, "plan of said .*: its type is Plan"),
        (an.Plan(cells=None, status=an.Status.FOUND), ParameterError, "plan of said with status found"),
        (an.Plan(cells=None, status="none"), ParameterError, "plan of said with status 'none'"),
        (an.Plan(cells=ENDS, stopped_by=None), ParameterError, "plan of said with stopped_by None"),
        (an.Plan(cells=ENDS, notes="tired"), ParameterError, "plan of said with notes 'tired'"),
        (an.Plan(cells=ENDS, stages=("search",)), ParameterError, "plan of said with a stage 'search'"),
        (an.Plan(cells=ENDS, history=None), ParameterError, "plan of said with history None"),
        (an.Plan(cells=ENDS, history=history_of([5.0], [1])), ParameterError, r"history of \[1\]: .* the 0 iterations"),
        (an.Plan(cells=ENDS, stages=(report(2),)), ParameterError, r"history of \[0\]: .* the 2 iterations"),
        (an.Plan(cells=()), PathError, "plan of said without cells"),
        (an.Plan(cells=[0, 1, 2]), PathError, r"plan of said, cells of shape \(3,\)"),
        (an.Plan(cells=[(0.0, 0.0), (2.0, 3.0)]), PathError, "plan of said, cells of .* float64"),
        (an.Plan(cells=[(0, 1), (2, 3)]), PathError, r"plan of said with start \(0, 1\): the start is cell \(0, 0\)"),
        (an.Plan(cells=[(0, 0), (2, 2)]), PathError, r"plan of said with goal \(2, 2\): the goal is cell \(2, 3\)"),
    ],
)
def test_wrong_answers_name_the_planner(answer: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        an.solve(PROBLEM, Said(answer))


def test_an_account_that_fits_is_kept() -> None:
    cells = Staircase().plan(PROBLEM, an.Call()).cells
    result = an.solve(PROBLEM, Said(an.Plan(cells=cells, stages=(report(2),), history=history_of([5.0] * 2, [0, 0]))))
    assert (result.length, result.iterations) == (5.0, 2)


def test_a_planner_without_plan_is_told() -> None:
    with pytest.raises(ParameterError, match=r"planner 'own': its class has no method plan\(problem, call\)"):
        an.solve(PROBLEM, an.Planner())


def test_ones_own_planner_stands_in_a_study_and_its_report(tmp_path: Path) -> None:
    chosen = [an.npaco(ants=3, iterations=3), an.astar(), Staircase()]
    study = Study("t", [MapEntry("m", PROBLEM)], [AlgorithmEntry(one.name, one) for one in chosen], [0, 1])
    with Store(tmp_path / "runs.db") as store:
        records = run_study(study, store)
        assert len(store.keys()) == 6
    lengths = {record.algorithm: record.length for record in records}
    assert lengths["astar"] == records[0].optimum
    assert lengths["staircase"] == 5.0
    write_report(records, tmp_path / "report", title="t", paper=False, problems={"m": PROBLEM}, study=study)
    page = (tmp_path / "report" / "report.html").read_text()
    assert "staircase" in page
    assert "own planner" in page


@dataclass(frozen=True)
class Jump(an.Planner):
    name: str = "jump"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.Plan(cells=np.array([problem.start_cell, problem.goal_cell], np.int32))


def test_an_illegal_path_of_ones_own_planner_is_refused() -> None:
    with pytest.raises(PathError, match=r"plan of jump, move .*not neighbours; mend the planner"):
        an.solve(PROBLEM, Jump())


def test_identity_is_what_decides_the_outcome() -> None:
    assert identity(Staircase(), PROBLEM) == identity(Staircase("other name"), PROBLEM)
    assert identity(Staircase(tread=2), PROBLEM) != identity(Staircase(), PROBLEM)
    assert identity(an.astar(), PROBLEM) != identity(an.dijkstra(), PROBLEM)
    assert identity(an.npaco(), PROBLEM) == identity(an.npaco(name="x", certainty="y"), PROBLEM)

    class Opaque(an.Planner):
        name = "opaque"

    with pytest.raises(ParameterError, match="'opaque': its class is a dataclass"):
        identity(Opaque(), PROBLEM)


OWN = """
from dataclasses import dataclass
import antnav as an

@dataclass(frozen=True)
class Own(an.Planner):
    name: str = "own"

    def plan(self, problem, call):
        return an.Plan(cells=None, notes=("NOTE",))

class Derived(Own):
    pass
"""


def own_module(file: Path, code: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The module `own_planner`, with that code from now on."""
    file.write_text(code)
    spec = spec_from_file_location("own_planner", file)
    module = module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "own_planner", module)
    spec.loader.exec_module(module)
    return module


def test_other_code_under_the_same_name_is_another_planner(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    known, keys = [], []
    codes = [OWN, OWN + "# beside the class", OWN.replace("NOTE", "other")]
    for number, code in enumerate(codes):
        module = own_module(tmp_path / f"{number}.py", code, monkeypatch)
        assert module.Own().kind == "own_planner.Own"
        known.append([identity(planner(), PROBLEM) for planner in (module.Own, module.Derived)])
        study = Study("t", [MapEntry("m", PROBLEM)], [AlgorithmEntry("a", module.Own())], [0])
        keys.append(study.jobs()[0].key)
    assert known[0] == known[1]
    assert all(first != last for first, last in zip(known[0], known[2], strict=True))
    assert keys[0] == keys[1] != keys[2]
    assert "source" not in identity(an.npaco(), PROBLEM)
    assert "source" not in identity(an.astar(), PROBLEM)


def test_where_the_class_cannot_be_read_its_file_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = "\nHidden = dataclass(frozen=True)(type('Hidden', (an.Planner,), {'__module__': __name__}))\n"
    known = [
        identity(own_module(tmp_path / f"{number}.py", code, monkeypatch).Hidden(), PROBLEM)["source"]
        for number, code in enumerate([OWN + made, OWN + made + "# edited"])
    ]
    assert None not in [*known[0], *known[1]]
    assert known[0] != known[1]
    typed = dataclass(frozen=True)(type("Typed", (an.Planner,), {"__module__": "nowhere"}))
    alone = dataclass(frozen=True)(type("Typed", (an.Planner,), {"__module__": "nowhere", "plan": lambda *_: None}))
    assert identity(typed(), PROBLEM)["source"] != identity(alone(), PROBLEM)["source"], "then its bytecode does"


@pytest.mark.parametrize("method", ["astar", "dijkstra", "jps"])
@pytest.mark.parametrize("rule", ["forbid", "graze", "allow"])
def test_exact_planners_are_exact_and_counted(method: str, rule: str) -> None:
    for seed in range(4):
        problem = random_problem(seed, side=16)
        problem = an.Problem.from_cells(problem.grid, problem.start_cell, problem.goal_cell, corner_rule=rule)
        result = an.solve(problem, an.algorithm(method))
        if not problem.connected:
            assert result.status == "unreachable"
            continue
        assert an.check_path(result.path, problem) == pytest.approx(result.length)
        assert result.gap == 0.0
        assert result.length == pytest.approx(an.exact.distance_field(problem)[problem.start_cell])
        assert result.steps == result.stages[0].colonies[0].steps > 0
    with pytest.raises(ParameterError, match="exact methods are astar, dijkstra, jps"):
        type(an.astar())(method="a*")


@pytest.mark.parametrize("name", ["paco", "paco_large", "astar", "jps", "woa-exact", "potential-field"])
def test_results_of_all_planners_are_plain_data(name: str, tmp_path: Path) -> None:
    result = an.solve(PROBLEM, an.algorithm(name), seed=3)
    assert result.gap == 0.0  # searches the optimum, whose time goes along
    for other in (copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
        assert other.to_dict() == result.to_dict()
        if result.pheromone is None:
            assert other.pheromone is None
        else:
            np.testing.assert_array_equal(other.pheromone, result.pheromone)
    result.save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json")
    assert loaded.algorithm == result.algorithm
    assert an.solve(loaded.problem, loaded.algorithm, seed=3).path.cells.tolist() == result.path.cells.tolist()


def test_a_file_of_an_unknown_planner_can_be_read_but_not_run(tmp_path: Path) -> None:
    an.solve(PROBLEM, Staircase()).save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json")
    assert isinstance(loaded.algorithm, Recorded)
    assert (loaded.length, loaded.algorithm.name, loaded.algorithm.certainty) == (5.0, "staircase", "own planner")
    loaded.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "plan.json").read_bytes()
    assert repr(loaded.algorithm).startswith("<recorded planner 'staircase': nothing here makes a ")
    with pytest.raises(ParameterError, match="nothing here makes a"):
        an.solve(PROBLEM, loaded.algorithm)


@pytest.mark.parametrize("tread", [np.float64(2), np.float32(2), np.int64(2), np.longdouble(2)])
def test_numpys_numbers_are_numbers(tread: float, tmp_path: Path) -> None:
    assert identity(Staircase(tread=tread), PROBLEM) == identity(Staircase(tread=2), PROBLEM)
    result = an.solve(PROBLEM, Staircase(np.str_("stairs"), tread))
    result.save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json").algorithm
    assert (loaded.name, loaded.document()["tread"]) == ("stairs", 2)


@pytest.mark.parametrize("tread", [np.ones(3), object(), 1j])
def test_what_no_file_can_hold_is_refused(tread: Any, tmp_path: Path) -> None:
    result = an.solve(PROBLEM, Staircase(tread=tread))
    for refused in (result.to_dict, lambda: result.save(tmp_path / "plan.json")):
        with pytest.raises(ParameterError, match="planner 'staircase': its class is a dataclass of numbers"):
            refused()
    assert not list(tmp_path.iterdir())


def test_every_planner_has_a_name_and_a_typo_a_remedy() -> None:
    assert [an.algorithm(name).name for name in names()] == list(names())
    with pytest.raises(ParameterError, match="choose astar"):
        an.algorithm("a_star")
    with pytest.raises(ParameterError, match="parameter 'ants': astar has no parameters"):
        an.algorithm("astar", ants=3)
    assert an.algorithm("potential-field", escapes=7).escapes == 7


def test_exact_planners_and_rivals_stand_in_a_study_file(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(
        'title = "t"\nseeds = 1\n[[maps]]\nbuiltin = "equiv20"\ncorner_rule = "allow"\n'
        '[[algorithms]]\npreset = "astar"\n[[algorithms]]\npreset = "potential-field"\nescapes = 9\n'
    )
    study = load_study(tmp_path / "study.toml")
    assert [entry.algorithm for entry in study.algorithms] == [an.astar(), an.algorithm("potential-field", escapes=9)]
