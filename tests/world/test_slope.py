"""Slopes: by hand on a small hill; the same everywhere, whoever asks; the way back costs other than the way."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

import antnav as an
from antnav import costs
from antnav.errors import ParameterError, PathError
from antnav.kernels import grid_kernels
from antnav.search import exact, windows
from antnav.world.cost import CostField, Slope
from antnav.world.grid_graph import GridGraph
from antnav.world.path import check_cost
from antnav.world.path_cost import PathCost
from tests.conftest import grid_of
from tests.kernels.test_ant_kernels import random_problem

HILL = np.array([[0.0, 2.0, 0.0], [0.0, 0.0, 0.0]])
ROOM = an.GridMap(np.zeros((2, 3), np.uint8), resolution=0.5)
OVER = np.array([(0, 0), (0, 1), (1, 2)], np.int32)


def hilly(seed: int, side: int = 14, *, down: float = 0.5, up: float = 4.0, **choices) -> an.Problem:
    """A random map of dear cells on hills, half a metre a cell."""
    plain = random_problem(seed, side=side)
    rng = np.random.default_rng(seed)
    grid = an.GridMap(plain.grid.cells, resolution=0.5)
    field = CostField(rng.gamma(0.5, 2.0, grid.shape)) + costs.slope(rng.normal(3.0, 0.4, grid.shape), up=up, down=down)
    return an.Problem.from_cells(grid, plain.start_cell, plain.goal_cell, cost=field, **choices)


def driven(problem: an.Problem) -> tuple[GridGraph, csr_matrix]:
    """The problem's graph, and its directed edges with costs from the formula."""
    graph, field, metres = problem.graph, problem.cost, problem.grid.resolution
    matrix = np.zeros((len(graph), len(graph)))
    for node, cell in enumerate(map(tuple, graph.cells)):
        for other in graph.graph.neighbours[node]:
            if other < len(graph):
                there = tuple(graph.cells[other])
                mean = 1 + (field.values[cell] + field.values[there]) / 2
                rise = (field.slope.elevation[there] - field.slope.elevation[cell]) / metres
                climb = field.slope.up * max(0, rise) + field.slope.down * max(0, -rise)
                matrix[node, other] = math.dist(cell, there) * mean + climb
    return graph, csr_matrix(matrix)


def test_a_climb_is_priced_by_hand_there_and_back() -> None:
    field = costs.slope(HILL, up=3.0, down=0.25)
    there = an.Problem.from_cells(ROOM, (0, 0), (1, 2), cost=field)
    length = 1 + math.sqrt(2)
    assert there.objective.of(OVER, ROOM) == pytest.approx(length + (3.0 * 2 + 0.25 * 2) / 0.5)  # cells of half a metre
    assert there.objective.of(OVER[:2], ROOM) == pytest.approx(1 + 12)
    assert there.objective.of(OVER[1::-1], ROOM) == pytest.approx(1 + 1)
    graph = there.graph
    assert graph.graph.lengths[graph.node((0, 0)), 4] == pytest.approx(1 + 12)
    assert graph.graph.lengths[graph.node((0, 1)), 3] == pytest.approx(1 + 1)
    assert graph.backwards.graph.lengths[graph.node((0, 0)), 4] == pytest.approx(1 + 1)
    around = an.solve(there, an.astar())
    assert around.cost == around.length == pytest.approx(length)  # over the level row
    path = an.Path(OVER, ROOM)
    check_cost(path, there, there.objective.of(OVER, ROOM))
    with pytest.raises(PathError, match="the moves add up to"):
        check_cost(path, there, path.length)


def test_up_costs_other_than_down() -> None:
    ramp = np.arange(8.0)[:, None] * np.ones(3) * 0.1
    grid = an.GridMap(np.zeros((8, 3), np.uint8))
    field = costs.slope(ramp, up=20.0, down=1.0)
    up, down = (an.Problem.from_cells(grid, *ends, cost=field) for ends in (((0, 1), (7, 1)), ((7, 1), (0, 1))))
    assert exact.optimum(up).cost == pytest.approx(7 + 20 * 0.7)
    assert exact.optimum(down).cost == pytest.approx(7 + 1 * 0.7)
    for problem in (up, down):
        result = an.solve(problem, an.paco_ls(ants=10, iterations=10), seed=1)
        assert result.gap == pytest.approx(0.0, abs=1e-9)


@settings(max_examples=60, derandomize=True)
@given(
    seed=st.integers(0, 10**6),
    rule=st.sampled_from(["forbid", "graze", "allow"]),
    up=st.sampled_from([0.0, 3.0, 40.0]),
    down=st.sampled_from([0.0, 1.0, 60.0]),
)
def test_exact_search_agrees_with_scipy_on_directed_graphs(seed: int, rule: str, up: float, down: float) -> None:
    if up == down == 0:
        return
    problem = hilly(seed, 11, up=up, down=down, corner_rule=rule)
    if not problem.connected:
        return
    graph, edges = driven(problem)
    start, goal = graph.node(problem.start_cell), graph.node(problem.goal_cell)
    there = dijkstra(edges, directed=True, indices=start)
    back = dijkstra(edges.T, directed=True, indices=goal)  # to the goal
    for method in ("astar", "dijkstra"):
        found = exact.shortest_path(problem, method)
        assert found.cost == pytest.approx(there[goal], rel=1e-9)
        assert an.check_path(found.path, problem) == pytest.approx(found.length)
        check_cost(found.path, problem, found.cost)
    np.testing.assert_allclose(graph.distances_to(goal), back, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(graph.backwards.distances_to(start), there, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(exact.distance_field(problem)[tuple(graph.cells.T)], back, rtol=1e-9, atol=1e-9)


@settings(max_examples=20, derandomize=True)
@given(seed=st.integers(0, 10**6))
def test_astar_expands_no_more_than_dijkstra(seed: int) -> None:
    problem = hilly(seed, 20)
    astar, every = (exact.shortest_path(problem, method) for method in ("astar", "dijkstra"))
    assert astar.cost == pytest.approx(every.cost, rel=1e-9)
    assert astar.expanded <= every.expanded


def test_turns_and_climbs_add() -> None:
    for seed in range(8):
        problem = hilly(seed, 10, corner_rule="allow", turning=0.7)
        found = exact.shortest_path(problem)
        if found.path is None:
            continue
        assert found.cost == pytest.approx(exact.shortest_path(problem, "dijkstra").cost)
        check_cost(found.path, problem, found.cost)


PLANNERS = [*an.PRESETS, "woa-exact", "sma-straight", "potential-field"]


@pytest.mark.parametrize("name", PLANNERS)
def test_what_a_planner_claims_is_the_cost_as_driven(name: str) -> None:
    for seed in range(3):
        problem = hilly(seed)
        choices = {"ants": 12, "iterations": 12} if name in an.PRESETS else {}
        result = an.solve(problem, an.algorithm(name, **choices), seed=seed)
        if result.path is None:
            continue
        an.check_path(result.path, problem)
        check_cost(result.path, problem, result.cost)
        assert result.gap >= -1e-9
        if result.estimated or result.notes:
            continue
        assert result.cost <= result.history.best[-1] * (1 + 1e-9)
        if result.algorithm.ants:
            assert result.history.best.min() >= result.optimum * (1 - 1e-9)  # of scouts from the goal, too


def test_scouts_from_the_goal_pay_for_the_way_from_the_start() -> None:
    """Down to the goal is cheap: what walks up from there must not say that it is dear."""
    ramp = np.linspace(2.0, 0.0, 12)[:, None] * np.ones(6)
    grid = an.GridMap(np.zeros((12, 6), np.uint8))
    problem = an.Problem.from_cells(grid, (0, 2), (11, 3), cost=costs.slope(ramp, up=50.0))
    result = an.solve(problem, an.paco(ants=10, iterations=10), seed=3)
    stage = next(stage for stage in result.stages if stage.name == "stage one")
    assert [colony.start for colony in stage.colonies] == [(0, 2), (11, 3)]
    for colony in stage.colonies:
        assert colony.length == pytest.approx(result.optimum, rel=0.3)
    assert result.optimum == pytest.approx(10 + math.sqrt(2))


def test_windows_make_a_hilly_path_no_dearer() -> None:
    for seed in range(8):
        problem = hilly(seed, 16)
        found = exact.shortest_path(an.Problem.from_cells(problem.grid, problem.start_cell, problem.goal_cell))
        if found.path is None:
            continue
        flat = np.array([problem.to_flat(cell) for cell in found.path.cells.tolist()], np.int32)
        better = windows.improved(flat, problem.terrain, 9)
        assert problem.cost_along(better) <= problem.cost_along(flat) + 1e-9
        assert problem.cost_along(windows.improved(flat, problem.terrain, 200)) == pytest.approx(
            exact.optimum(problem).cost
        )
        # What kernels add up differs by the same for all paths between two cells.
        prices, ends = problem.objective.prices, problem.cost.slope.elevation
        rest = (4.0 - 0.5) / 2 * (ends[problem.goal_cell] - ends[problem.start_cell]) / 0.5
        assert grid_kernels.cost_along(flat, problem.width, prices) + rest == pytest.approx(problem.cost_along(flat))


def test_level_ground_costs_nothing() -> None:
    plain = random_problem(3, side=14)
    ends = plain.start_cell, plain.goal_cell
    level = an.Problem.from_cells(plain.grid, *ends, cost=costs.slope(np.full(plain.grid.shape, 7.0)))
    assert exact.optimum(level).cost == pytest.approx(
        exact.optimum(an.Problem.from_cells(plain.grid, *ends)).cost, rel=1e-12
    )
    assert level.objective.backwards is not level.objective
    even = an.Problem.from_cells(plain.grid, *ends, cost=costs.slope(np.full(plain.grid.shape, 7.0), up=2, down=2))
    assert even.graph.backwards is even.graph


@pytest.mark.parametrize("name", ["paco", "paco_large", "astar"])
def test_results_on_slopes_go_into_files_and_come_back(name: str, tmp_path) -> None:
    problem = hilly(2)
    result = an.solve(problem, an.algorithm(name), seed=4)
    result.save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json")
    assert loaded.to_dict() == result.to_dict()
    assert (loaded.cost, loaded.gap) == (result.cost, result.gap)
    assert loaded.problem.cost.digest == problem.cost.digest
    text = (tmp_path / "plan.json").read_text()
    for damage in ((problem.cost.digest, "0" * 64), ('"up": 4.0', '"up": 5.0'), ('"elevation": "', '"elevation": "!')):
        (tmp_path / "plan.json").write_text(text.replace(*damage))
        with pytest.raises(an.errors.ResultFormatError, match=r"digest|decoded"):
            an.Result.load(tmp_path / "plan.json")
    for other in (copy.deepcopy(problem), pickle.loads(pickle.dumps(problem))):
        assert not other.cost.slope.elevation.flags.writeable
        assert an.solve(other, an.algorithm(name), seed=4).path.cells.tolist() == result.path.cells.tolist()


def test_slopes_of_one_elevation_add_and_of_two_do_not() -> None:
    one, other = costs.slope(HILL, up=1.0), costs.slope(HILL, up=2.0, down=3.0)
    both = one + CostField(np.ones((2, 3))) + other
    assert (both.slope.up, both.slope.down) == (3.0, 3.0)
    assert both.values.tolist() == np.ones((2, 3)).tolist()
    assert both.slope.elevation.tolist() == HILL.tolist()
    with pytest.raises(ParameterError, match="give one of them the sum"):
        _ = one + costs.slope(2 * HILL)
    with pytest.raises(ParameterError, match="shapes"):
        _ = one + costs.slope(HILL.T)
    plain = CostField(np.zeros((2, 3)))
    assert len({field.digest for field in (plain, one, other, costs.slope(HILL, up=2.0), costs.slope(2 * HILL))}) == 5
    assert repr(other) == "CostField('slope', 2 x 3 cells, 0..0, up 2, down 3)"
    with pytest.raises(ValueError, match="read-only"):
        one.slope.elevation[0, 0] = 1.0
    with pytest.raises(ParameterError, match="a height for each cell"):
        CostField(np.zeros((3, 2)), slope=one.slope)


@pytest.mark.parametrize(
    ("elevation", "choices", "said"),
    [
        ([[0.0, math.nan]], {}, "elevation nan"),
        ([[0.0, -math.inf]], {}, "elevation -inf"),
        ([[2e9]], {}, "elevation 2000000000"),
        ([[True]], {}, "of type bool"),
        ([1.0], {}, "rows and columns"),
        (HILL, {"up": -1.0}, "up -1"),
        (HILL, {"down": math.nan}, "down nan"),
        (HILL, {"up": "1"}, "up '1'"),
        (HILL, {"up": 0.0}, "one of them is above 0"),
    ],
)
def test_what_is_no_slope_is_refused(elevation: object, choices: dict, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        costs.slope(elevation, **choices)


def test_a_slope_is_one_object_on_a_map_whatever_asks() -> None:
    grid = grid_of("...", "...")
    field = costs.slope(HILL)
    one = an.Problem.from_cells(grid, (0, 0), (1, 2), cost=field)
    assert one.terrain.objective is an.Problem.from_cells(grid, (0, 1), (1, 2), cost=field).terrain.objective
    finer = an.GridMap(grid.cells, resolution=0.1)
    assert PathCost(field).on(finer).resolution == 0.1
    assert an.Terrain(finer, objective=PathCost(field)).objective.resolution == 0.1
    assert isinstance(field.slope, Slope)
