"""`--plugin mine.py`: what a file registers, at the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import antnav as an
from antnav.cli import divided

from .conftest import Run

MINE = '''
from dataclasses import dataclass
import antnav as an

@an.register.heuristic(version="1.2")
def homing(ground, reach=an.parameter(2.0, least=0, most=9)):
    """1 / (reach + the straight distance to the goal)."""
    rows, cols = (ground.cells - ground.cells[ground.goal]).T
    return 1 / (reach + (rows**2 + cols**2) ** 0.5)

@an.register.pheromone
def share(ants, top=3):
    """The best few deposit."""
    best = ants.order[: min(top, ants.arrived)]
    ants.amounts[: best.size] = ants.q / ants.costs[best]

@an.register.algorithm
def drawn(pull=1.0, **choices):
    """npaco drawn home."""
    return an.npaco(**({"heuristic": homing(reach=pull), "ants": 9} | choices))

@an.register.planner
@dataclass(frozen=True)
class Stair(an.Planner):
    """As A*."""
    name: str = "stair"
    wait: float = 0.5
    def plan(self, problem, call):
        return an.Plan(cells=an.exact.shortest_path(problem).path.cells)

@an.register.objective
class Middle(an.objectives.Objective):
    """Keep to the middle columns."""
    name = "middle"
    def edges(self, terrain, graph):
        columns = graph.cells[:, 1]
        return abs(columns - columns.max() / 2)[:, None] + 0.0 * graph.graph.lengths
'''


@pytest.fixture(autouse=True)
def _in_a_folder_with_a_plugin(cli: Run) -> None:
    Path("mine.py").write_text(MINE)


def test_where_the_option_may_stand() -> None:
    assert divided(["plan", "--plugin", "a.py", "map", "--plugin=b.py"]) == (["plan", "map"], ["a.py", "b.py"])
    assert divided(["plan", "--", "--plugin"]) == (["plan", "--", "--plugin"], [])
    assert divided(["plan", "--plugin"]) == (["plan"], [""])


def test_a_rule_an_algorithm_and_a_planner_plan(cli: Run) -> None:
    for words in (
        ("--plugin", "mine.py", "plan", "equiv20", "--heuristic", "homing"),
        ("plan", "equiv20", "--heuristic", "mine.py:homing"),
        ("plan", "equiv20", "--algorithm", "drawn", "--plugin=mine.py"),
        ("plan", "equiv20", "--algorithm", "mine.py:drawn"),
    ):
        code, out, err = cli(*words)
        assert (code, err) == (0, "")
        assert "own rule homing (mine.py, 1.2)" in out
    code, out, _ = cli("plan", "equiv20", "--algorithm", "stair", "--json")
    assert json.loads(out)["algorithm"]["own"]["planner"]["file"] == "mine.py"
    assert cli("batch", "equiv20", "--plugin", "mine.py", "--help")[0] == 0


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("plan", "equiv20", "--plugin"), "--plugin: a file follows it; give one, as in --plugin mine.py"),
        (("plan", "equiv20", "--plugin", "no.py"), "plugin no.py: No such file or directory"),
        (("plan", "equiv20", "--plugin", "bad.py"), "plugin bad.py, line 1: it raised ZeroDivisionError"),
        (("plan", "equiv20", "--heuristic", "mine.py:away"), "'mine.py:away': mine.py registers nothing of that name"),
        (("plan", "equiv20", "--heuristic", "away"), "--heuristic 'away': it is one of auto, "),
        (("plan", "equiv20", "--algorithm", "away"), "the planners are traditional, "),
        (
            ("plan", "equiv20", "--algorithm", "homing", "--plugin", "mine.py"),
            "'homing': it is a heuristic rule; give heuristic=\"homing\" to a preset such as npaco, "
            "on the command line --set heuristic=homing",
        ),
        (("plan", "equiv20", "--algorithm", "mine.py:homing"), "on the command line --set heuristic=mine.py:homing"),
    ],
)
def test_what_cannot_be_loaded_is_bad_input(cli: Run, words: tuple[str, ...], told: str) -> None:
    Path("bad.py").write_text("1 / 0\n")
    code, out, err = cli(*words)
    assert (code, out) == (2, "")
    assert err.startswith("antnav: error: ")
    assert told in err
    assert err.count("\n") == 1


def test_own_ones_are_listed_and_marked(cli: Run) -> None:
    listed = cli("algorithms")[1]
    assert "your rules" not in listed
    code, out, err = cli("algorithms", "--plugin", "mine.py")
    assert (code, err) == (0, "")
    words = " ".join(out.split())
    assert "own algorithm drawn (mine.py)" in words
    assert "own planner stair (mine.py)" in words
    assert "your rules" in words
    assert "mine.py, 1.2" in words
    out = cli("algorithms", "homing")[1]
    assert "your own heuristic rule: homing (mine.py, 1.2)" in out
    assert "0 to 9" in out
    assert cli("algorithms", "mine.py:drawn")[1].startswith("npaco drawn home.")
    document = json.loads(cli("algorithms", "--json")[1])
    assert document["share"]["parameters"] == {
        "top": {"default": 3, "range": document["share"]["parameters"]["top"]["range"]}
    }
    assert document["drawn"]["own"]["heuristic"]["name"] == "homing"


def test_replay_and_fronts_take_them(cli: Run) -> None:
    code, _, err = cli(
        "replay", "equiv20", "--scenario", "people:1", "--algorithm", "mine.py:drawn", "--ticks", 90, "-q"
    )
    assert (code, err) == (0, "")
    code, out, err = cli("pareto", "equiv20", "--objective", "length", "--objective", "mine.py:middle", "--json", "-q")
    assert (code, err) == (0, "")
    assert "middle" in out


def test_the_view_shows_registered_ones_and_executes_no_file(cli: Run) -> None:
    from antnav.errors import ParameterError
    from antnav.view.menu import menu, planners
    from antnav.view.messages import Panel

    an.algorithm("mine.py:drawn")
    shown = {one["name"]: one for one in menu()["algorithms"]}
    assert shown["drawn"]["about"] == "npaco drawn home."
    assert shown["stair"]["parameters"] == []
    (heuristic,) = [one for one in shown["npaco"]["parameters"] if one["name"] == "heuristic"]
    assert "homing" in heuristic["choices"]
    assert planners([Panel("drawn")])[0].name == "drawn"
    Path("evil.py").write_text("raise SystemExit('executed')\n")
    for panel in (Panel("evil.py:x"), Panel("npaco", {"heuristic": "evil.py:x"})):
        with pytest.raises(ParameterError, match="the view takes what is registered"):
            planners([panel])
