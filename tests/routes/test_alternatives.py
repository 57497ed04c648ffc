"""Routes are legal, cheap and truly different, and what is said of them is so."""

from __future__ import annotations

import math
import threading
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import costs
from antnav.errors import ParameterError
from antnav.planner.plan import Status
from antnav.run import spmd
from antnav.world.path import check_cost
from tests.conftest import grid_of
from tests.routes.naive import enclosed, shared_share

BLOCK = grid_of(
    "...............",
    "...............",
    "......###......",
    "......###......",
    "......###......",
    "......###......",
    "...............",
)
TWO_BLOCKS = grid_of(
    "....................",
    "....................",
    "....###......###....",
    "....###......###....",
    "....###......###....",
    "....................",
    "....................",
)
HALL = an.GridMap(np.zeros((30, 40), np.uint8))


def problem_on(grid: an.GridMap, row: int, **choices) -> an.Problem:
    return an.Problem.from_cells(grid, (row, 0), (row, grid.cols - 1), **choices)


def rows_passed(route: an.Route, col: int) -> set[int]:
    return {row for row, at in route.path.cells.tolist() if at == col}


def assert_honest(found: an.Alternatives) -> None:
    """Everything that is said of the routes, worked out by other code."""
    problem = found.problem
    reach = found.tolerance / problem.grid.resolution
    assert len(found) <= found.k
    for number, route in enumerate(found):
        an.check_path(route.path, problem)
        check_cost(route.path, problem, route.cost)
        cells = list(map(tuple, route.path.cells.tolist()))
        assert len(set(cells)) == len(cells)
        assert route.cost <= found.longest * found.optimum * (1 + 1e-9)
        better = [other.path.cells for other in found.routes[:number]]
        share = max((shared_share(route.path.cells, other, problem, reach) for other in better), default=0.0)
        assert route.difference == pytest.approx(1 - share)
        assert number == 0 or route.difference >= found.least_difference - 1e-9
        assert route.obstacles == enclosed(route.path.cells, found[0].path.cells, problem)
    priced = [route.cost for route in found]
    assert all(one <= other + 1e-8 for one, other in pairwise(priced))


def test_round_one_block_lead_two_routes() -> None:
    found = an.alternatives(problem_on(BLOCK, 3), 5)
    assert_honest(found)
    assert [round(route.cost - found.optimum, 6) for route in found] == [0, pytest.approx(2 * (math.sqrt(2) - 1))]
    assert [rows_passed(route, 7) for route in found] == [{1}, {6}]
    assert [route.obstacles for route in found] == [0, 1]
    assert found.status is Status.FOUND
    assert found.notes == ("2 of 5 routes: no other side has one that is cheap enough and different enough",)


def test_round_two_blocks_lead_four() -> None:
    found = an.alternatives(problem_on(TWO_BLOCKS, 3), 9, least_difference=0.2)
    assert_honest(found)
    sides = {(min(rows_passed(route, 5)) < 3, min(rows_passed(route, 14)) < 3) for route in found}
    assert len(found) == len(sides) == 4
    assert sorted(route.obstacles for route in found) == [0, 1, 1, 2]


def test_what_differs_too_little_is_no_route() -> None:
    problem = problem_on(TWO_BLOCKS, 3)
    assert len(an.alternatives(problem, 4, least_difference=0.0)) == 4
    few = an.alternatives(problem, 4, least_difference=0.6)
    assert_honest(few)
    assert len(few) == 2
    assert few[1].obstacles == 2


@pytest.mark.parametrize("side", [(3, 2), (20, 35)])
def test_an_empty_hall_has_one_route(side: tuple[int, int]) -> None:
    """Though its grid is full of detours that are cheapest paths for most of their length."""
    found = an.alternatives(an.Problem.from_cells(HALL, (2, 3), side), longest=3.0)
    assert len(found) == 1
    assert found[0].cost == found.optimum


def test_a_dearer_route_than_allowed_is_none() -> None:
    problem = problem_on(BLOCK, 3)
    dearest = an.alternatives(problem, 2)[1].cost / an.exact.optimum(problem).cost
    assert len(an.alternatives(problem, 2, longest=dearest - 1e-6)) == 1
    assert len(an.alternatives(problem, 2, longest=dearest + 1e-6)) == 2


def test_a_thin_wall_parts_routes_that_lie_two_cells_apart() -> None:
    grid = grid_of("....................", ".##################.", "....................")
    problem = an.Problem.from_cells(grid, (1, 0), (1, 19))
    found = an.alternatives(problem, 2)
    assert_honest(found)
    assert [route.cost for route in found] == [found.optimum] * 2
    assert found[1].difference > 0.7


def test_a_wide_tolerance_takes_routes_together() -> None:
    problem = problem_on(BLOCK, 3)
    assert len(an.alternatives(problem, 2, tolerance=0.0)) == 2
    assert len(an.alternatives(problem, 2, tolerance=20.0)) == 1


def test_tolerance_is_in_metres_and_two_cells_or_more() -> None:
    fine = replace(BLOCK, resolution=0.05)
    problem = problem_on(fine, 3)
    assert an.alternatives(problem).tolerance == pytest.approx(0.1)
    assert an.alternatives(problem, tolerance=0.15).tolerance == pytest.approx(0.15)
    long = an.Problem.from_cells(an.GridMap(np.zeros((3, 400), np.uint8), 0.5), (1, 0), (1, 399))
    assert an.alternatives(long).tolerance == pytest.approx(0.02 * 399 * 0.5)


def test_round_a_dear_place_lead_two_routes() -> None:
    """No obstacle far and wide."""
    values = np.zeros(HALL.shape)
    rows, cols = np.indices(HALL.shape)
    values[np.hypot(rows - 15, cols - 20) < 9] = 20.0
    problem = an.Problem.from_cells(HALL, (15, 1), (15, 38), cost=costs.array(values))
    found = an.alternatives(problem, 5)
    assert_honest(found)
    assert len(found) == 2
    assert {min(rows_passed(route, 20)) < 15 for route in found} == {True, False}
    assert [route.obstacles for route in found] == [0, 0]


def test_the_way_over_a_dear_place_and_both_ways_round_it() -> None:
    values = np.zeros(HALL.shape)
    values[9:13, 12:28] = values[18:22, 12:28] = 20.0
    problem = an.Problem.from_cells(HALL, (15, 1), (15, 38), cost=costs.array(values))
    found = an.alternatives(problem, 5)
    assert_honest(found)
    assert len(found) == 3
    assert rows_passed(found[0], 20) == {15}


def test_turns_have_their_price() -> None:
    problem = problem_on(TWO_BLOCKS, 3, turning=0.7)
    found = an.alternatives(problem, 4, least_difference=0.2)
    assert_honest(found)
    assert found[0].cost == pytest.approx(an.exact.optimum(problem).cost)
    assert len(found) == 4


@pytest.mark.parametrize("seed", range(4))
def test_slopes_have_their_price_up_and_down(seed: int) -> None:
    field = costs.slope(3 * np.random.default_rng(seed).random(TWO_BLOCKS.shape), up=3.0, down=0.5)
    problem = problem_on(TWO_BLOCKS, 3, cost=field)
    found = an.alternatives(problem, 3, least_difference=0.2)
    assert_honest(found)
    assert found[0].cost == pytest.approx(an.exact.shortest_path(problem, "dijkstra").cost)


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    rule=st.sampled_from(list(an.CornerRule)),
    share=st.floats(0, 1),
    priced=st.booleans(),
    turning=st.sampled_from([0.0, 0.4]),
)
def test_all_that_is_said_is_so(seed: int, rule: an.CornerRule, share: float, priced: bool, turning: float) -> None:
    rng = np.random.default_rng(seed)
    cells = (rng.random((12, 14)) < 0.25).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    field = costs.array(rng.gamma(1.0, 1.0, cells.shape)) if priced else None
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (11, 13), corner_rule=rule, cost=field, turning=turning)
    found = an.alternatives(problem, 4, least_difference=share)
    assert_honest(found)
    assert bool(found.routes) == problem.connected
    if found.routes:
        assert found[0].cost == pytest.approx(found.optimum)
        assert found.optimum == pytest.approx(an.exact.shortest_path(problem, "dijkstra").cost)


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), algorithm=st.sampled_from([an.astar(), an.npaco(ants=8, iterations=8)]))
def test_what_is_said_of_a_planners_routes_is_so(seed: int, algorithm: an.Planner) -> None:
    cells = (np.random.default_rng(seed).random((12, 14)) < 0.2).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (11, 13))
    found = an.alternatives(problem, 3, algorithm=algorithm, seed=seed)
    assert_honest(found)
    assert all(route.obstacles > 0 for route in found.routes[1:])


def test_a_planner_finds_both_ways_too() -> None:
    for planner in (an.astar(), an.npaco(ants=20, iterations=15), an.paco_ls(ants=20, iterations=15)):
        found = an.alternatives(problem_on(BLOCK, 3), 2, algorithm=planner, seed=1)
        assert_honest(found)
        assert [rows_passed(route, 7) for route in found] == [{1}, {6}]
        assert planner.name in found.method
    assert len(found) == 2


def test_a_planner_that_is_pushed_aside_in_the_open_has_found_nothing() -> None:
    found = an.alternatives(an.Problem.from_cells(HALL, (15, 1), (15, 38)), 2, algorithm=an.astar())
    assert len(found) == 1
    assert found.notes == ("astar found no further route in 8 runs: others may exist",)


def test_same_seed_same_bytes_whatever_the_workers() -> None:
    problem = problem_on(TWO_BLOCKS, 3)
    for planner in (None, an.paco(ants=10, iterations=10)):
        runs = [
            an.alternatives(problem, 3, algorithm=planner, seed=5, executor=executor)
            for executor in (None, spmd.Serial(), spmd.Serial())
        ]
        told = [[route.path.cells.tobytes() for route in run] for run in runs]
        assert told[0] == told[1] == told[2]


def test_who_cancels_gets_what_there_is() -> None:
    cancel = threading.Event()
    cancel.set()
    found = an.alternatives(problem_on(BLOCK, 3), 3, algorithm=an.npaco(), cancel=cancel)
    assert len(found) <= 1


def test_no_way() -> None:
    found = an.alternatives(an.Problem.from_cells(grid_of("..#..", "..#.."), (0, 0), (0, 4)))
    assert (len(found), found.status, found.optimum, found.notes) == (0, Status.UNREACHABLE, math.inf, ())
    assert found.summary().startswith("status         unreachable, 0 of 3 routes\n")


def test_start_is_goal() -> None:
    found = an.alternatives(an.Problem.from_cells(BLOCK, (0, 0), (0, 0)))
    assert [route.path.cells.tolist() for route in found] == [[[0, 0]]]
    assert found.notes == ("start and goal lie in one cell: there is one route",)


def test_neighbouring_ends() -> None:
    assert_honest(an.alternatives(an.Problem.from_cells(BLOCK, (0, 0), (0, 1))))


@pytest.mark.parametrize(
    "wrong",
    [
        {"k": 0},
        {"k": 101},
        {"k": 2.5},
        {"least_difference": -0.1},
        {"least_difference": 1.1},
        {"longest": 0.9},
        {"longest": math.inf},
        {"tolerance": -1},
        {"algorithm": "paco"},
        {"seed": -1},
    ],
)
def test_what_is_out_of_range_is_named(wrong: dict) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        an.alternatives(problem_on(BLOCK, 3), **wrong)


def test_the_summary_has_a_line_for_each_route() -> None:
    found = an.alternatives(problem_on(BLOCK, 3), 2)
    lines = found.summary().splitlines()
    assert lines[0] == "status         found, 2 of 2 routes"
    assert lines[1].startswith(f"route 1        {found[0].path.length_m:.3f} m, 0.00 % above the optimum; clearance")
    assert "% different; 1 obstacle lies between it and route 1" in lines[2]
    assert repr(found).startswith("Alternatives(2 of 2 routes on 'a map', [Route(")


def test_depot_has_many_routes(data: Path) -> None:
    with pytest.warns(an.maps.MapWarning):
        grid = an.load_map(data / "ros/nav2_bringup/depot.yaml").inflated(0.2)
    found = an.alternatives(an.Problem(grid, (2, 2), (28, 13)), 5, tolerance=1.0)
    assert len(found) == 5
    assert found[4].cost < 1.1 * found.optimum
