"""Whole algorithms and planners of users by name: in Python, files, other processes."""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

import antnav as an
from antnav.errors import ParameterError, PathError
from antnav.planner.facts import Basis
from antnav.planner.planner import KINDS, Recorded, identity

PROBLEM = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
FILE = '''
from dataclasses import dataclass

import antnav as an


@an.register.algorithm(version="3")
def cautious(pull=1.0, **choices):
    """npaco with a weak pull."""
    return an.npaco(beta=pull, **choices)


@an.register.planner(version="2")
@dataclass(frozen=True)
class Stair(an.Planner):
    """As A*, after a while."""

    name: str = "stair"
    wait: float = 0.5

    def plan(self, problem, call):
        return an.Plan(cells=an.exact.shortest_path(problem).path.cells)
'''


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    file = tmp_path / "mine.py"
    file.write_text(FILE)
    return file


def test_a_preset_of_ones_own(mine: Path, tmp_path: Path) -> None:
    algorithm = an.algorithm(f"{mine}:cautious", ants=9)
    assert (algorithm.name, algorithm.beta, algorithm.ants) == ("cautious", 1.0, 9)
    assert algorithm == an.algorithm("cautious", ants=9)
    assert an.algorithm("cautious", pull=2.0).beta == 2.0
    assert str(algorithm.certainty).startswith("own algorithm cautious (mine.py, 3); paper (Si & Bao 2024")
    assert Basis.OWN in algorithm.certainty.bases
    assert "cautious" in an.plan.algorithms.names()
    assert an.algorithm("cautious", name="mine").name == "mine"
    an.solve(PROBLEM, algorithm).save(tmp_path / "result.json")
    again = an.Result.load(tmp_path / "result.json").algorithm
    assert again == algorithm.suited(PROBLEM)
    assert an.solve(PROBLEM, again).path


@pytest.mark.parametrize(
    ("function", "given", "words"),
    [
        (lambda: 7, {}, "own algorithm odd .*it returns a planner, not 7"),
        (lambda: 1 / 0, {}, "it raised ZeroDivisionError"),
        (an.npaco, {"rho": 3}, "rho 3: rho lies in 0..1"),
        (an.npaco, {"top": 3}, "parameter 'top'"),
        (lambda rho=0.1: an.npaco(rho=rho), {"ants": 3}, "it raised TypeError: .* unexpected keyword argument 'ants'"),
    ],
)
def test_what_an_algorithm_makes_is_checked(function: object, given: dict[str, object], words: str) -> None:
    an.register.algorithm(function, name="odd")
    with pytest.raises(ParameterError, match=words):
        an.algorithm("odd", **given)


def test_an_algorithm_may_make_any_planner() -> None:
    an.register.algorithm(an.astar, name="shortest")
    assert an.solve(PROBLEM, an.algorithm("shortest")).gap == 0.0


def test_names_that_are_taken() -> None:
    for name in ("paco", "astar", "pso-straight"):
        with pytest.raises(ParameterError, match=f"algorithm {name}.*: antnav has one of that name"):
            an.register.algorithm(an.astar, name=name)
    with pytest.raises(ParameterError, match="a name is a word"):
        an.register.algorithm(lambda: an.npaco(rho=0.2))


def test_an_unknown_algorithm_is_told_what_there_is(mine: Path) -> None:
    an.algorithm(f"{mine}:cautious")
    with pytest.raises(ParameterError, match=r"your own cautious, stair; choose cautious, or load the file .*--plugin"):
        an.algorithm("cautios")
    with pytest.raises(
        ParameterError, match=r"mine\.py registers nothing of that name and kind, but .*cautious \(algorithm"
    ):
        an.algorithm(f"{mine}:careless")
    with pytest.raises(ParameterError, match=r"did you mean cautious\?"):
        an.algorithm(f"{mine}:cautios")


def test_a_planner_of_ones_own_runs_again_from_its_file(mine: Path, tmp_path: Path) -> None:
    planner = an.algorithm(f"{mine}:stair", wait=0.25)
    assert (planner.kind, planner.wait) == ("mine.Stair", 0.25)
    assert planner.certainty == "own planner stair (mine.py, 2)"
    result = an.solve(PROBLEM, planner)
    assert result.gap == 0.0
    result.save(tmp_path / "result.json")
    document = planner.document()
    assert document["own"]["planner"]["file"] == "mine.py"
    again = an.Result.load(tmp_path / "result.json")
    assert again.algorithm == planner
    assert an.solve(PROBLEM, again.algorithm).length == result.length
    with pytest.raises(ParameterError, match="stair has name, wait; leave it out"):
        an.algorithm("stair", speed=1)

    before = identity(planner, PROBLEM)
    mine.write_text(FILE + "# edited\n")
    assert identity(an.algorithm(f"{mine}:stair", wait=0.25), PROBLEM) != before
    (note,) = an.Result.load(tmp_path / "result.json").notes
    assert note.startswith("own rule stair (mine.py, 2) has other code here than in the run: stair (mine.py")

    del KINDS["mine.Stair"]
    assert isinstance(an.Result.load(tmp_path / "result.json").algorithm, Recorded)


def test_paths_of_registered_planners_are_checked() -> None:
    @an.register.planner
    @dataclass(frozen=True)
    class Through(an.Planner):
        name: str = "through"

        def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
            return an.Plan(cells=[problem.start_cell, problem.goal_cell])

    with pytest.raises(PathError, match="mend the planner"):
        an.solve(PROBLEM, an.algorithm("through"))


def test_what_is_no_planner_is_refused() -> None:
    class Plain(an.Planner):
        name = "plain"

    @dataclass(frozen=True)
    class Open(an.Planner):
        wait: float
        name: str = "open"

    @dataclass(frozen=True)
    class Listed(an.Planner):
        name: str = "listed"
        stops: tuple[int, ...] = (1, 2)

    @dataclass(frozen=True)
    class Kind(an.Planner):
        name: str = "kind"
        label: str = "x"

    for kind, words in (
        (Plain, "its class is a frozen dataclass"),
        (Open, "field wait: .* give it one, as in wait: float = 1.0"),
        (Listed, "field stops: its fields are numbers, texts or truths"),
        (Kind, "field label: files use that name"),
        (int, "it is a class that derives from an.Planner"),
        (3, "it is a class that derives from an.Planner"),
    ):
        with pytest.raises(ParameterError, match=words):
            an.register.planner(kind)


def test_files_tell_classes_of_one_name_apart(mine: Path, tmp_path: Path) -> None:
    an.algorithm(f"{mine}:stair")
    (tmp_path / "other").mkdir()
    other = tmp_path / "other" / "mine.py"
    other.write_text(FILE.replace('"stair"', '"steps"').replace("cautious", "careful"))
    with pytest.raises(ParameterError, match=r"planner steps .*: files would take it for stair .*rename the class"):
        an.algorithm(f"{other}:steps")


def test_a_planner_travels_as_code(mine: Path, tmp_path: Path) -> None:
    planner = an.algorithm(f"{mine}:stair", wait=2.0)
    packed = pickle.dumps(planner)
    assert pickle.loads(packed) == planner
    (tmp_path / "packed").write_bytes(packed)
    mine.unlink()
    code = (
        "import pickle, antnav as an; planner = pickle.load(open('packed', 'rb'));"
        "problem = an.Problem.from_cells(an.maps.builtin('equiv20'), (0, 0), (19, 19));"
        "result = an.solve(problem, planner); print(result.gap, planner.kind, planner.wait);"
        "assert pickle.loads(pickle.dumps(planner)) == planner"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["0.0", "mine.Stair", "2.0"]


def test_missions_drive_by_them(mine: Path) -> None:
    mission = an.Mission(PROBLEM, f"{mine}:cautious")
    assert "cautious" in repr(mission)
    assert mission.gap >= 0.0
    assert an.Mission(PROBLEM, "stair").gap == 0.0
