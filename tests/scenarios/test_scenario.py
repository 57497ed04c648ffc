"""Scenarios and their files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import OutputError, ParameterError, ResultFormatError
from antnav.scenarios import Event

GRID = an.GridMap(np.zeros((5, 6), np.uint8), 0.5, (1.0, 2.0, 0.0), "small")
PROBLEM = an.Problem.from_cells(GRID, (0, 0), (4, 5))
EVENTS = (Event(0, blocked=[(2, 2), (2, 3)]), Event(3, [(1, 1)], [(2, 2)], [(0, 3)], [1.5]))


def scenario(**choices) -> an.Scenario:
    return an.Scenario.of(PROBLEM, EVENTS, **{"ticks": 9, "radius": 0.1, "sensor": 4, **choices})


@pytest.mark.parametrize("map_cells", [True, False])
def test_a_file_holds_everything(map_cells: bool, tmp_path: Path) -> None:
    made = scenario()
    made.save(tmp_path / "one.json", map_cells=map_cells)
    read = an.Scenario.load(tmp_path / "one.json")
    assert read.to_dict() == made.to_dict(map_cells=map_cells)
    assert read.events[1].prices.tolist() == [1.5]
    assert read.events[1].freed.tolist() == [[2, 2]]
    read.save(tmp_path / "two.json", map_cells=map_cells)
    assert (tmp_path / "one.json").read_bytes() == (tmp_path / "two.json").read_bytes()
    assert read.problem(GRID).grid == GRID
    assert read.problem(PROBLEM) is PROBLEM
    if map_cells:
        assert read.problem().goal_cell == (4, 5)
    else:
        with pytest.raises(ParameterError, match="does not hold its map"):
            read.problem()


def test_another_map_or_query_is_refused_and_another_name_is_not() -> None:
    made = scenario()
    other = an.GridMap(np.eye(5, 6, dtype=bool), 0.5, (1.0, 2.0, 0.0), "other")
    for given in (
        other,
        an.Problem.from_cells(GRID, (0, 0), (4, 4)),
        an.Problem.from_cells(GRID, (0, 0), (4, 5), corner_rule="allow"),
    ):
        with pytest.raises(ParameterError, match="the scenario is of map 'small'"):
            made.problem(given)
    assert made.problem(an.GridMap(GRID.cells, 0.5, (1.0, 2.0, 0.0), "renamed")).start_cell == (0, 0)


def test_costs_go_along_or_have_to_be_given(tmp_path: Path) -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (4, 5), cost=an.costs.array(np.ones((5, 6))))
    made = an.Scenario.of(problem, ticks=3)
    assert made.problem().cost.values.max() == made.problem(GRID).cost.values.max() == 1.0
    made.save(tmp_path / "bare.json", map_cells=False)
    bare = an.Scenario.load(tmp_path / "bare.json")
    with pytest.raises(ParameterError, match="costs"):
        bare.problem(GRID)
    assert bare.problem(problem) is problem


@pytest.mark.parametrize(
    ("choices", "told"),
    [
        ({"ticks": 0}, "ticks"),
        ({"ticks": 3}, "tick 3"),
        ({"speed": 0}, "speed"),
        ({"seconds": 0.0}, "seconds"),
        ({"radius": -1.0}, "radius"),
        ({"sensor": 0}, "sensor 0"),
        ({"sensor": 3, "speed": 3}, "sensor 3"),
        ({"seed": -1}, "seed"),
        ({"name": 3}, "name"),
    ],
)
def test_values_out_of_range(choices: dict, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        scenario(**choices)


@pytest.mark.parametrize(
    ("events", "told"),
    [
        ([EVENTS[1], EVENTS[0]], "tick 0 after 3"),
        ([EVENTS[0], EVENTS[0]], "tick 0 after 0"),
        ([Event(0, blocked=[(5, 0)])], r"cell \(5, 0\)"),
        ([Event(0, priced=[(0, -1)], prices=[1.0])], r"cell \(0, -1\)"),
        ([3], "event 3"),
    ],
)
def test_events_that_do_not_fit(events: list, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        an.Scenario.of(PROBLEM, events, ticks=9)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"blocked": [(1, 1), (2, 3)], "freed": [(2, 3)]}, r"cell \(2, 3\)"),
        ({"blocked": [1, 2]}, "blocked"),
        ({"freed": [(0.5, 1)]}, "freed"),
        ({"priced": [(1, 1)]}, "prices"),
        ({"priced": [(1, 1)], "prices": [-1.0]}, "prices"),
        ({"priced": [(1, 1)], "prices": [np.nan]}, "prices"),
        ({"blocked": [(2**40, 1)]}, "blocked"),
    ],
)
def test_what_is_no_event(given: dict, told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        Event(0, **given)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda file: file.update(schema="antnav/result"), "antnav/scenario"),
        (lambda file: file.update(version=2), "version 2"),
        (lambda file: file.update(ticks=2), "tick 3"),
        (lambda file: file.update(seed=-1), "seed"),
        (lambda file: file.update(seconds=None), "seconds"),
        (lambda file: file.update(sensor=0), "sensor"),
        (lambda file: file["events"].reverse(), "ascend"),
        (lambda file: file["events"][0]["blocked"].append([9, 9]), "cell"),
        (lambda file: file["events"][0].update(tick="one"), "tick"),
        (lambda file: file["events"][1]["prices"].pop(), "prices"),
        (lambda file: file.pop("query"), "query"),
    ],
)
def test_what_cannot_be_true_is_refused(change, told: str, tmp_path: Path) -> None:
    file = scenario().to_dict()
    change(file)
    (tmp_path / "s.json").write_text(json.dumps(file))
    with pytest.raises(ResultFormatError, match=told):
        an.Scenario.load(tmp_path / "s.json")


def test_a_map_that_is_not_the_one_of_its_digest_is_refused(tmp_path: Path) -> None:
    file = scenario().to_dict()
    file["query"]["map"]["resolution"] = 0.25
    (tmp_path / "s.json").write_text(json.dumps(file))
    with pytest.raises(ResultFormatError, match="digest"):
        an.Scenario.load(tmp_path / "s.json").problem()


def test_no_file_and_no_place(tmp_path: Path) -> None:
    with pytest.raises(ResultFormatError, match="No such file"):
        an.Scenario.load(tmp_path / "none.json")
    with pytest.raises(ParameterError, match=r"\.json"):
        scenario().save(tmp_path / "s.csv")
    with pytest.raises(OutputError):
        scenario().save(tmp_path / "none" / "s.json")


def test_it_says_what_it_is() -> None:
    assert repr(scenario()) == "Scenario('own', seed 0, 'small': 2 events, 5 changes of cells, 9 ticks)"
    assert repr(EVENTS[1]) == "Event(tick 3: 1 blocked, 1 freed, 1 priced)"
