"""Rules of users: a function becomes a part that works wherever a name does."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.colony.heuristic import heuristic_weights, initial_pheromone
from antnav.errors import ParameterError, RuleError
from antnav.planner.facts import Basis, Knows
from antnav.planner.planner import Recorded

PROBLEM = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
FILE = '''
import antnav as an

NEAR = 0.1


@an.register.heuristic(version="1.2")
def homing(ground, reach=an.parameter(2.0, least=0, most=9)):
    """1 / (reach + the straight distance to the goal)."""
    rows, cols = (ground.cells - ground.cells[ground.goal]).T
    return 1 / (reach + (rows**2 + cols**2) ** 0.5 + NEAR)
'''


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    file = tmp_path / "mine.py"
    file.write_text(FILE)
    return file


def test_one_rule_by_four_names(mine: Path) -> None:
    algorithm = an.npaco(heuristic=f"{mine}:homing", reach=1.5)
    homing = type(algorithm.heuristic)
    assert algorithm.heuristic.reach == 1.5
    assert algorithm == an.npaco(heuristic="homing", reach=1.5)
    assert algorithm == an.npaco(heuristic=homing, reach=1.5)
    assert algorithm == an.npaco(heuristic=homing(reach=1.5))
    assert an.npaco(heuristic=homing) == an.npaco(heuristic=homing(reach=2.0))
    assert str(algorithm.certainty).endswith("modified: heuristic homing, reach 1.5; own rule homing (mine.py, 1.2)")
    assert Basis.OWN in algorithm.certainty.bases
    assert algorithm.heuristic.__doc__.startswith("1 / (reach")


def test_it_is_the_formula_that_ants_follow(mine: Path) -> None:
    algorithm = an.npaco(heuristic=f"{mine}:homing", reach=0.0, beta=2)
    graph = PROBLEM.graph
    weights = heuristic_weights(algorithm, graph, 0, len(graph) - 1)
    node = graph.node((19, 17))
    right = graph.neighbours if hasattr(graph, "neighbours") else graph.graph.neighbours
    slot = int(np.flatnonzero(right[node] == graph.node((19, 18)))[0])
    assert weights[node, slot] == pytest.approx(1 / 1.1**2)
    assert an.solve(PROBLEM, algorithm, seed=1).length == an.solve(PROBLEM, algorithm, seed=1).length


def test_steps_colony_and_many_queries_take_it(mine: Path) -> None:
    algorithm = an.npaco(heuristic=f"{mine}:homing", iterations=3)
    result = an.solve(PROBLEM, algorithm, seed=4)
    steps = an.Steps(PROBLEM, algorithm, seed=4)
    assert [step.best for step in steps][-1] == result.history.best[-1]
    colony = an.Colony(PROBLEM, algorithm, seed=4)
    assert [one.best for one in colony][-1] == result.history.best[-1]
    (many,) = an.solve_many([PROBLEM], algorithm, seed=4)
    assert (many.path.cells == result.path.cells).all()


def test_what_asks_for_distances_knows_them() -> None:
    @an.register.heuristic
    def exact(ground):
        """By exact distance."""
        return 1 / (1 + ground.distances_to(ground.goal))

    algorithm = an.npaco(heuristic=exact)
    assert algorithm.knows == Knows.TO_GOAL
    assert "heuristic exact own: it knows the exact distances" in str(algorithm.certainty)


@pytest.mark.parametrize(
    "returned",
    [
        lambda ground: 2.5,
        lambda ground: np.full(len(ground), 2.5),
        lambda ground: np.full((len(ground), 8), 2.5),
    ],
)
def test_initial_pheromone_by_edge_by_node_or_one_for_all(returned: object) -> None:
    flat = an.register.initial(returned, name="flat")
    algorithm = an.npaco(initial=flat)
    tau = initial_pheromone(algorithm, PROBLEM.graph, 0, 1)
    there = PROBLEM.graph.graph.neighbours < len(PROBLEM.graph)
    assert tau.shape == there.shape
    assert tau.flags.c_contiguous
    assert tau.flags.writeable
    assert (tau[there] == 2.5).all()
    assert an.solve(PROBLEM, algorithm).path


def test_ground_tells_what_the_algorithm_begins_with() -> None:
    seen = []

    @an.register.initial
    def noted(ground):
        seen.append(ground)
        return ground.tau0

    initial_pheromone(an.npaco(initial=noted, tau0=3.0), PROBLEM.graph, 5, 7)
    (ground,) = seen
    assert (ground.start, ground.goal, ground.tau0) == (5, 7, 3.0)
    assert ground.cells.shape == (len(ground), 2)
    assert ground.neighbours.shape == ground.lengths.shape == (len(ground), 8)
    with pytest.raises(ValueError, match="read-only"):
        ground.neighbours[0, 0] = 1


@pytest.mark.parametrize(
    ("returned", "words"),
    [
        (lambda ground: np.ones(3), r"shape \(3,\): .* of shape \(400, 8\) or \(400,\)"),
        (lambda ground: 1.0, r"shape \(\)"),
        (lambda ground: "much", "what it returned: 'much'"),
        (lambda ground: None, "what it returned: None"),
        (lambda ground: np.full(len(ground), 1j), "what it returned: array"),
        (lambda ground: np.arange(len(ground)) - 1.0, r"-1.0 at node 0, cell \(0, 0\)"),
        (lambda ground: 1 / (np.arange(len(ground)) * 0.0), "inf at node"),
        (lambda ground: np.where(np.arange(len(ground)) == 2, np.nan, 1), "nan at node 2"),
        (lambda ground: ground.nothing, "it raised AttributeError: 'Ground' object has no attribute 'nothing'"),
        (lambda ground: 1 / 0, "it raised ZeroDivisionError: division by zero"),
    ],
)
def test_what_a_rule_returns_is_checked(returned: object, words: str) -> None:
    grid = an.GridMap(np.zeros((20, 20), np.uint8))
    an.register.heuristic(returned, name="bad")
    with np.errstate(divide="ignore"), pytest.raises(RuleError, match=words) as caught:
        an.solve(an.Problem.from_cells(grid, (0, 0), (19, 19)), an.npaco(heuristic="bad"))
    assert "own rule bad (test_parts.py)" in str(caught.value)


def none() -> None: ...
def several(ground, *more): ...
def further(ground, **more): ...
def text(ground, how="fast"): ...
def open_(ground, top): ...
def taken(ground, rho=0.1): ...
def of_others(ground, elite=3): ...
def of_parts(ground, family=3): ...
def of_every_part(ground, function=3): ...
def nameless(*, ground): ...


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (none, r"it is called as none\(ground, ...\)"),
        (nameless, "called as nameless"),
        (several, "more of own rule several .*: each parameter has a name and a default"),
        (further, "each parameter has a name and a default"),
        (text, "default 'fast': the default of a parameter is a number"),
        (open_, "default none"),
        (taken, "rho belongs to every algorithm; call it another, such as taken_rho"),
        (of_others, "elite belongs to pheromone rank_based"),
        (of_parts, "family belongs to every part"),
        (of_every_part, "function belongs to every part; call it another, such as of_every_part_function"),
        (7, "an own heuristic is defined by a function or a class"),
        (partial(open_, top=3), "an own heuristic is defined by a function or a class"),
    ],
)
def test_what_cannot_be_a_rule_is_refused(function: object, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        an.register.heuristic(function)


def test_words_of_the_decorator_are_checked() -> None:
    for given, words in (
        ({"name": "a b"}, "a name is a word"),
        ({"name": "a:b"}, "a name is a word"),
        ({"name": "a" * 101}, "of up to 100 letters"),
        ({"name": "target"}, "antnav has one of that name; give another, as in @an.register.heuristic"),
        ({"version": 1.2}, "version of <lambda>|a name is a word"),
        ({"jit": True, "name": "ok"}, "compiling it saves nothing"),
    ):
        with pytest.raises(ParameterError, match=words):
            an.register.heuristic(**given)(lambda ground: 1)


def test_a_name_belongs_to_one_file_and_the_same_code_may_come_again(mine: Path, tmp_path: Path) -> None:
    first = an.npaco(heuristic=f"{mine}:homing")
    copy = tmp_path / "copy.py"
    copy.write_text(FILE)
    an.npaco(heuristic=f"{copy}:homing")  # the same code elsewhere
    other = tmp_path / "other.py"
    other.write_text(FILE.replace("0.1", "0.2"))
    with pytest.raises(
        ParameterError, match=r"other.py, line 7, heuristic homing .*registered another one of that name"
    ):
        an.npaco(heuristic=f"{other}:homing")
    mine.write_text(FILE)
    an.register.heuristic(lambda ground: 1, name="cell")
    an.register.heuristic(lambda ground: 2, name="cell")  # a cell of a notebook run again after a change
    assert first == an.npaco(heuristic=type(first.heuristic))


def test_an_edited_file_takes_its_own_place(mine: Path) -> None:
    before = an.npaco(heuristic=f"{mine}:homing")
    mine.write_text(FILE.replace("NEAR = 0.1", "NEAR = 0.3"))
    after = an.npaco(heuristic=f"{mine}:homing")
    assert before != after
    assert before.document()["own"] != after.document()["own"]
    assert an.npaco(heuristic="homing") == after


def test_files_hold_the_rule_and_its_digest(mine: Path, tmp_path: Path) -> None:
    result = an.solve(PROBLEM, an.npaco(heuristic=f"{mine}:homing", reach=1.0))
    result.save(tmp_path / "result.json")
    document = result.algorithm.document()
    told = document["own"]["heuristic"]
    assert (document["heuristic"], document["reach"]) == ("homing", 1.0)
    assert (told["name"], told["version"], told["file"], len(told["source"])) == ("homing", "1.2", "mine.py", 64)
    again = an.Result.load(tmp_path / "result.json")
    assert again.algorithm == result.algorithm
    assert again.notes == result.notes
    assert an.solve(PROBLEM, again.algorithm).length == result.length
    assert "own" not in an.npaco().document()

    mine.write_text(FILE.replace("1.2", "1.3"))
    an.npaco(heuristic=f"{mine}:homing")
    edited = an.Result.load(tmp_path / "result.json")
    then = f"homing (mine.py, 1.2), sha256 {told['source'][:16]}"
    assert f"own rule homing (mine.py, 1.3) has other code here than in the run: {then}" in edited.notes
    assert str(edited.algorithm.certainty).endswith("reach 1.0; own rule homing (mine.py, 1.3)")

    type(an.npaco().heuristic).registered.clear()
    unknown = an.Result.load(tmp_path / "result.json")
    assert isinstance(unknown.algorithm, Recorded)
    assert unknown.algorithm.document() == document
    missing = "its rule homing (mine.py, 1.2) is not registered here"
    assert repr(unknown.algorithm) == f"<recorded planner 'npaco': {missing}>"
    assert [str(one.source) for one in unknown.algorithm.own] == ["homing (mine.py, 1.2)"]
    with pytest.raises(ParameterError, match=re.escape(f"planner 'npaco': {missing}; import or load its file")):
        an.solve(PROBLEM, unknown.algorithm)


def test_a_rule_that_is_not_there_is_told_what_is(mine: Path) -> None:
    told = r"mine\.py registers nothing of that name and kind, but homing \(heuristic\); did you mean homing\?"
    with pytest.raises(ParameterError, match=told):
        an.npaco(heuristic=f"{mine}:homin")
    with pytest.raises(ParameterError, match=r"but homing \(heuristic\); register homing there"):
        an.npaco(pheromone=f"{mine}:homing")
    with pytest.raises(ParameterError, match=r"^heuristic 'homin': it is one of .*; choose homing, or load"):
        an.npaco(heuristic="homin")
    with pytest.raises(ParameterError, match=r"^initial 'unifrm': .*; choose uniform, or load"):
        an.npaco(initial="unifrm")


def test_a_document_executes_no_file(mine: Path) -> None:
    document = an.npaco().document() | {"heuristic": f"{mine}:homing"}
    with pytest.raises(ParameterError, match="reading one executes no file"):
        an.Algorithm.of(document)


def test_a_rule_travels_as_code(mine: Path, tmp_path: Path) -> None:
    algorithm = an.npaco(heuristic=f"{mine}:homing", reach=1.5)
    packed = pickle.dumps(algorithm)
    assert pickle.loads(packed) == algorithm
    length = an.solve(PROBLEM, algorithm, seed=3).length
    (tmp_path / "packed").write_bytes(packed)
    mine.unlink()
    code = (
        "import pickle, antnav as an; algorithm = pickle.load(open('packed', 'rb'));"
        "problem = an.Problem.from_cells(an.maps.builtin('equiv20'), (0, 0), (19, 19));"
        "print(an.solve(problem, algorithm, seed=3).length, pickle.loads(pickle.dumps(algorithm)) == algorithm)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [str(length), "True"]


def test_an_own_deadlock_rule_punishes_as_the_paper_does_unless_told_otherwise() -> None:
    @an.register.deadlock
    def late(stuck: an.register.Stuck, until: float = 0.6) -> bool:
        """It dies late in the run, as the paper's."""
        return stuck.t > until * stuck.iterations

    usual = an.npaco(ants=20, iterations=20, switch=0.6)
    where = an.Problem.from_cells(an.maps.builtin("equiv20"), *an.maps.builtin_query("equiv20"))
    tau = {}
    for name, algorithm in {
        "paper": usual,
        "own": an.npaco(ants=20, iterations=20, deadlock="late"),
        "own, kind": an.npaco(ants=20, iterations=20, deadlock=late(punish=0)),
    }.items():
        colony = an.Colony(where, algorithm, seed=1)
        colony.step(20)
        tau[name] = colony.tau.tobytes()
    assert tau["own"] == tau["paper"] != tau["own, kind"]
