"""Problem: what is refused before any ant walks, and the graph that ants get."""

from __future__ import annotations

import math
import pickle
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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
        {"corner_rule": None},
        {"corner_rule": ["forbid"]},
        {"allow_unknown": "no"},
        {"start": None},
        {"start": "12"},
        {"start": (True, False)},
        {"start": (1.25, "3.25")},
        {"start": (10**400, 0)},
        {"start": 5},
        {"goal": np.zeros((2, 2))},
        {"goal": {"x": 1, "y": 2}},
        {"goal_tolerance": "1"},
        {"goal_tolerance": None},
        {"start_tolerance": True},
        {"start_tolerance": math.nan},
        {"start_tolerance": [1.0]},
        {"grid": np.zeros((3, 3), np.uint8)},
        {"grid": None},
        {"grid": "warehouse"},
    ],
)
def test_bad_numbers(arguments: dict) -> None:
    with pytest.raises(ParameterError):
        an.Problem(**({"grid": GRID, "start": (1.25, 3.25), "goal": (1.25, 3.25)} | arguments))


@pytest.mark.parametrize(
    "cell",
    [None, 3, "12", (0,), (0, 1, 2), (math.nan, 0), (math.inf, 0), (True, False), ("0", "1"), {}, [[0], [1]], 1j],
)
def test_bad_cells(cell: object) -> None:
    for ends in ((cell, (0, 1)), ((0, 1), cell)):
        with pytest.raises(ParameterError, match="two whole numbers"):
            an.Problem.from_cells(GRID, *ends)
    with pytest.raises(ParameterError, match="GridMap"):
        an.Problem.from_cells(np.zeros((3, 3), np.uint8), (0, 0), (0, 1))


def test_numpy_scalars_and_any_pairs_are_numbers() -> None:
    problem = an.Problem(
        GRID,
        np.array([1.25, 3.25], np.float32),
        (np.float64(1.75), np.int64(3)),
        allow_unknown=np.True_,
        goal_tolerance=np.float32(0.5),
        start_tolerance=np.int8(1),
    )
    assert (problem.start, problem.goal, problem.goal_tolerance) == ((1.25, 3.25), (1.75, 3.0), 0.5)
    assert {type(part) for part in (*problem.start, *problem.goal, problem.goal_tolerance)} == {float}
    assert problem.allow_unknown is True
    for cell in (np.array([2, 1]), (np.int8(2), 1.0), (part for part in (2, 1)), range(2, 0, -1)):
        assert an.Problem.from_cells(GRID, (0, 0), cell).goal_cell == (2, 1)


def test_cells_must_be_pairs_of_whole_numbers_inside() -> None:
    with pytest.raises(ParameterError):
        an.Problem.from_cells(GRID, (0.5, 0), (0, 1))
    with pytest.raises(OutsideMapError, match=r"rows are 0\.\.2"):
        an.Problem.from_cells(GRID, (0, 0), (3, 0))


def test_outside_tells_the_border_as_it_is() -> None:
    with pytest.raises(OutsideMapError, match=r"\(3\.0, 2\.5\) m.*1 <= x < 3 m, 2 <= y < 3\.5 m"):
        an.Problem(GRID, (1.25, 3.25), (3.0, 2.5))
    beside = math.nextafter(1.0, 0)
    with pytest.raises(OutsideMapError, match=r"start \(0\.9999999999999999, 2\.5\) m"):
        an.Problem(GRID, (beside, 2.5), (1.25, 3.25))
    for point in ((1e300, -1e300), (1.7e308, 1.7e308)):
        with pytest.raises(OutsideMapError):
            an.Problem(GRID, point, (1.25, 3.25))


def test_outside_a_turned_map_tells_its_corners() -> None:
    grid = an.GridMap(np.zeros((2, 2), np.uint8), 1.0, (0.0, 0.0, math.pi / 4))
    with pytest.raises(OutsideMapError) as caught:  # inside the bounding box of the map
        an.Problem(grid, (1.3, 0.2), (0.0, 1.0))
    message = str(caught.value)
    assert "turned by 45 degrees" in message
    assert "<=" not in message
    for corner in ("(1.41421356237, 1.41421356237)", "2.82842712475)", "(-1.41421356237, 1.41421356237)"):
        assert corner in message


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


def test_start_tolerance_moves_a_start_that_is_not_free() -> None:
    grid = grid_of(".....", "....#", ".....").inflated(1.0)  # (0, 4), (1, 3), (2, 4) are within the radius
    with pytest.raises(OccupiedError, match="or give a start tolerance"):
        an.Problem.from_cells(grid, (1, 3), (0, 0))
    problem = an.Problem(grid, (3.4, 1.6), (0.5, 2.5), start_tolerance=2.0)
    assert problem.start_cell == (0, 3)  # (0, 3) is 0.9 m away, (1, 2) is as far; rows first
    assert (problem.start, problem.requested_start) == ((3.5, 2.5), (3.4, 1.6))
    assert problem.connected
    with pytest.raises(OccupiedError, match="larger start tolerance"):
        an.Problem(grid, (3.4, 1.6), (0.5, 2.5), start_tolerance=0.5)
    free = an.Problem.from_cells(grid, (0, 0), (2, 0), start_tolerance=2.0)
    assert (free.start_cell, free.requested_start) == ((0, 0), None)


def test_start_tolerance_prefers_what_leads_to_the_goal_and_passes_no_wall() -> None:
    cells = np.array([[0, 1, 0, 3, 3, 0, 0]])
    beside = an.Problem.from_cells(an.GridMap(cells), (0, 3), (0, 6), start_tolerance=5.0)
    assert beside.start_cell == (0, 5)  # (0, 2) is nearer, but leads nowhere
    behind = an.Problem.from_cells(an.GridMap(cells), (0, 3), (0, 0), start_tolerance=5.0)
    assert behind.start_cell == (0, 2)  # (0, 0) leads to the goal, but lies behind a wall
    assert not behind.connected
    both = an.Problem.from_cells(
        an.GridMap([[0, 3, 3, 0, 0, 1]]), (0, 1), (0, 5), start_tolerance=5.0, goal_tolerance=2.0
    )
    assert (both.start_cell, both.goal_cell) == ((0, 3), (0, 4))  # (0, 0) is nearer, but leads nowhere near the goal
    at_goal = an.Problem.from_cells(an.GridMap([[3, 0, 1]]), (0, 0), (0, 1), start_tolerance=1.0)
    assert at_goal.start_cell == at_goal.goal_cell == (0, 1)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), tolerance=st.floats(0.1, 6), yaw=st.floats(-3, 3))
def test_ends_move_to_the_nearest_cells_that_do(seed: int, tolerance: float, yaw: float) -> None:
    """Against a search of the whole map, cell by cell."""
    rng = np.random.default_rng(seed)
    cells = rng.choice([0, 0, 0, 1, 3], (9, 11)).astype(np.uint8)
    grid = an.GridMap(cells, 0.5, (3.0, 1.0, yaw))
    start, goal = (tuple(map(int, cell)) for cell in rng.integers(0, (9, 11), (2, 2)))
    cells[start] = 0
    grid = an.GridMap(cells, 0.5, (3.0, 1.0, yaw))
    reached = an.Problem.from_cells(grid, start, start).reachable
    point = grid.cell_to_world(goal)
    offers = [(math.dist(point, grid.cell_to_world(cell)), *map(int, cell)) for cell in np.argwhere(reached)]
    nearest = min((offer for offer in offers if offer[0] <= tolerance), default=None)
    if nearest is None and cells[goal]:
        with pytest.raises(OccupiedError):
            an.Problem.from_cells(grid, start, goal, goal_tolerance=tolerance)
    else:
        problem = an.Problem.from_cells(grid, start, goal, goal_tolerance=tolerance)
        away = math.dist(point, grid.cell_to_world(problem.goal_cell))
        assert away == pytest.approx(nearest[0] if nearest else 0.0)


def test_two_cells_are_looked_at_and_nothing_else() -> None:
    """Whole-map arrays come when a planner needs them, and belong to the map."""
    grid = an.GridMap(np.zeros((2000, 2000), np.uint8))
    tracemalloc.start()
    problems = [an.Problem.from_cells(grid, (0, 0), (1999, col), start_tolerance=5.0) for col in range(1000)]
    used = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert used < 2e6
    assert [name for name, kept in vars(grid.kept).items() if len(kept)] == ["terrains"]
    one, other = problems[:2]
    assert one.passable is other.passable
    assert np.shares_memory(one.moves, other.moves)
    assert one.graph is other.graph
    assert not one.passable.flags.writeable
    assert len(pickle.dumps(one)) < 2 * len(pickle.dumps(grid))


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
