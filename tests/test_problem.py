"""Problem: what is refused before any ant walks, and the graph that ants get."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.errors import OccupiedError, OutsideMapError, ParameterError
from tests.conftest import grid_of

GRID = an.GridMap(grid_of("..#.", ".##.", "?.#.").cells, resolution=0.5, origin=(1.0, 2.0, 0.0))


def test_metres_and_cells_name_the_same_problem() -> None:
    in_metres = an.Problem(GRID, start=(1.25, 3.25), goal=(1.8, 2.2))
    in_cells = an.Problem.from_cells(GRID, (0, 0), (2, 1))
    assert (in_metres.start_cell, in_metres.goal_cell) == (in_cells.start_cell, in_cells.goal_cell) == ((0, 0), (2, 1))
    assert in_cells.goal == (1.75, 2.25)
    assert in_metres.goal == (1.8, 2.2)  # the exact goal is kept: the path ends there


@pytest.mark.parametrize(
    ("start", "goal", "error", "code"),
    [
        ((0.9, 3.0), (1.25, 3.25), OutsideMapError, 203),
        ((1.25, 3.25), (1.25, 9.0), OutsideMapError, 204),
        ((2.25, 3.25), (1.25, 3.25), OccupiedError, 205),
        ((1.25, 3.25), (1.25, 2.25), OccupiedError, 206),  # unknown
    ],
)
def test_ends_outside_or_not_free_have_their_own_errors(start: tuple, goal: tuple, error: type, code: int) -> None:
    with pytest.raises(error) as caught:
        an.Problem(GRID, start, goal)
    assert caught.value.nav2_code == code
    assert caught.value.end == ("start" if code in {203, 205} else "goal")
    assert f"{start[0] if code in {203, 205} else goal[0]:g}" in str(caught.value)


def test_inflated_and_unknown_ends_say_so() -> None:
    with pytest.raises(OccupiedError, match="robot's radius"):
        an.Problem.from_cells(grid_of("..#").inflated(1.0), (0, 0), (0, 1))
    with pytest.raises(OccupiedError, match="allow unknown"):
        an.Problem.from_cells(grid_of("..?"), (0, 0), (0, 2))
    assert an.Problem.from_cells(grid_of("..?"), (0, 0), (0, 2), allow_unknown=True).connected


@pytest.mark.parametrize(
    "arguments",
    [
        {"start": (math.nan, 0)},
        {"goal": "here"},
        {"start": (1.0,)},
        {"goal_tolerance": -1.0},
        {"goal_tolerance": math.inf},
        {"corner_rule": "rarely"},
    ],
)
def test_bad_numbers(arguments: dict) -> None:
    with pytest.raises(ParameterError):
        an.Problem(GRID, **({"start": (1.25, 3.25), "goal": (1.25, 3.25)} | arguments))


def test_cells_must_be_pairs_of_whole_numbers_inside() -> None:
    with pytest.raises(ParameterError):
        an.Problem.from_cells(GRID, (0.5, 0), (0, 1))
    with pytest.raises(OutsideMapError, match=r"rows are 0\.\.2"):
        an.Problem.from_cells(GRID, (0, 0), (3, 0))


@pytest.mark.parametrize(("rule", "connected"), [("allow", True), ("graze", False), ("forbid", False)])
def test_connected_depends_on_the_corner_rule(rule: str, connected: bool) -> None:
    assert an.Problem.from_cells(grid_of(".#", "#."), (0, 0), (1, 1), corner_rule=rule).connected is connected


def test_goal_tolerance_moves_the_goal_to_the_nearest_reachable_cell() -> None:
    grid = grid_of("....#.")
    problem = an.Problem.from_cells(grid, (0, 0), (0, 4), goal_tolerance=1.0)
    assert problem.goal_cell == (0, 3)
    assert problem.goal == (3.5, 0.5)
    beyond = an.Problem.from_cells(grid, (0, 0), (0, 5), goal_tolerance=1.0)
    assert beyond.goal_cell == (0, 5)  # free, but nothing reachable within 1 m: the answer is "unreachable"
    assert not beyond.connected
    with pytest.raises(OccupiedError, match="larger goal tolerance"):
        an.Problem.from_cells(grid, (0, 0), (0, 4), goal_tolerance=0.5)


def test_graph_holds_the_reachable_cells_and_their_moves() -> None:
    problem = an.Problem.from_cells(grid_of("..#.", "..#."), (0, 0), (1, 1))
    graph = problem.graph
    assert graph.cells.tolist() == [[0, 0], [0, 1], [1, 0], [1, 1]]
    assert [sorted(row[row < 4].tolist()) for row in graph.graph.neighbours] == [
        [1, 2, 3],
        [0, 2, 3],
        [0, 1, 3],
        [0, 1, 2],
    ]
    for i in range(4):
        assert graph.node(tuple(graph.cells[i])) == i
        for k, j in enumerate(graph.graph.neighbours[i]):
            if j < 4:
                assert graph.graph.neighbours[j, graph.graph.reverse[i, k]] == i
                assert graph.graph.lengths[i, k] == pytest.approx(math.dist(graph.cells[i], graph.cells[j]))
    assert np.array_equal(problem.reachable, [[True, True, False, False]] * 2)
