"""What a path costs: by hand, and the same everywhere, whoever asks."""

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
from antnav.errors import OccupiedError, ParameterError, PathError
from antnav.kernels import grid_kernels
from antnav.search import exact, windows
from antnav.world.cost import CostField
from antnav.world.path import check_cost
from antnav.world.path_cost import LENGTH, PathCost
from tests.conftest import grid_of
from tests.kernels.test_ant_kernels import random_problem

ROOM = grid_of("...", "...")
FIELD = CostField(np.array([[0.0, 1.0, 3.0], [0.5, 9.0, 0.0]]))


def priced(seed: int, side: int = 14, **choices) -> an.Problem:
    """A random map on which some cells are dear."""
    plain = random_problem(seed, side=side)
    values = np.random.default_rng(seed).gamma(0.5, 3.0, plain.grid.shape)
    return an.Problem.from_cells(plain.grid, plain.start_cell, plain.goal_cell, cost=CostField(values), **choices)


def test_a_move_costs_its_length_times_the_mean_price_of_its_cells() -> None:
    objective = PathCost(FIELD)
    cells = np.array([(0, 0), (0, 1), (1, 2)], np.int32)
    by_hand = 1 * (1 + 2) / 2 + math.sqrt(2) * (2 + 1) / 2
    assert objective.of(cells, ROOM) == pytest.approx(by_hand)
    assert LENGTH.of(cells, ROOM) == 1 + math.sqrt(2)
    assert objective.of(cells[:1], ROOM) == LENGTH.of(cells[:1], ROOM) == 0.0
    problem = an.Problem.from_cells(ROOM, (0, 0), (1, 2), cost=FIELD)
    graph = problem.graph
    assert graph.graph.lengths[graph.node((0, 1)), 4] == pytest.approx((2 + 4) / 2)
    assert graph.graph.lengths[graph.node((0, 2)), 3] == pytest.approx((2 + 4) / 2)
    result = an.solve(problem, an.astar())
    assert (result.cost, result.optimum, result.gap) == (pytest.approx(by_hand), result.cost, 0.0)
    assert result.length == pytest.approx(1 + math.sqrt(2))
    check_cost(result.path, problem, result.cost)
    with pytest.raises(PathError, match="the moves add up to"):
        check_cost(result.path, problem, result.length)


def test_without_a_field_nothing_is_another_object_or_number() -> None:
    problem = an.Problem.from_cells(ROOM, (0, 0), (1, 2))
    assert problem.objective is LENGTH
    assert problem.graph.graph.lengths[0, 4] == 1.0
    result = an.solve(problem, an.npaco(ants=5, iterations=3))
    assert result.cost == result.length
    assert "cost" not in dict(result.table)


@settings(max_examples=60, derandomize=True)
@given(seed=st.integers(0, 10**6), rule=st.sampled_from(["forbid", "graze", "allow"]))
def test_exact_search_agrees_with_scipy(seed: int, rule: str) -> None:
    problem = priced(seed, 12, corner_rule=rule)
    if not problem.connected:
        return
    graph = problem.graph
    node, slot = np.nonzero(graph.graph.neighbours < len(graph))
    edges = graph.graph.lengths[node, slot], (node, graph.graph.neighbours[node, slot])
    source = graph.node(problem.start_cell)
    distances = dijkstra(csr_matrix(edges, (len(graph), len(graph))), indices=source)
    for method in ("astar", "dijkstra"):
        found = exact.shortest_path(problem, method)
        assert found.cost == pytest.approx(distances[graph.node(problem.goal_cell)], rel=1e-9)
        assert an.check_path(found.path, problem) == pytest.approx(found.length)
        check_cost(found.path, problem, found.cost)
    np.testing.assert_allclose(graph.distances_to(source), distances, rtol=1e-9)
    field = exact.distance_field(problem, problem.start_cell)
    np.testing.assert_allclose(field[tuple(graph.cells.T)], distances, rtol=1e-9)


@pytest.mark.parametrize("name", an.PRESETS)
def test_no_preset_returns_a_dearer_path_than_its_ants_found(name: str) -> None:
    """Windows, joints, straightening and the choice among routes go by cost, not by length behind its back."""
    for seed in range(3):
        problem = priced(seed)
        result = an.solve(problem, an.preset(name, ants=12, iterations=12), seed=seed)
        if result.path is None:
            continue
        an.check_path(result.path, problem)
        check_cost(result.path, problem, result.cost)
        assert result.gap >= -1e-9
        if not result.estimated and not result.notes:
            assert result.cost <= result.history.best[-1] * (1 + 1e-9)


def test_windows_make_a_path_no_dearer_and_cheapest_within_one() -> None:
    for seed in range(12):
        problem = priced(seed, 16)
        found = exact.shortest_path(an.Problem.from_cells(problem.grid, problem.start_cell, problem.goal_cell))
        if found.path is None:
            continue
        flat = np.array([problem.to_flat(cell) for cell in found.path.cells.tolist()], np.int32)
        prices = problem.objective.prices
        before = grid_kernels.cost_along(flat, problem.width, prices)
        better = windows.improved(flat, problem.terrain, 9)
        assert grid_kernels.cost_along(better, problem.width, prices) <= before + 1e-9
        whole = windows.improved(flat, problem.terrain, 200)
        assert grid_kernels.cost_along(whole, problem.width, prices) == pytest.approx(exact.optimum(problem).cost)


def test_a_cheap_way_round_may_have_many_more_cells() -> None:
    """A window's path may outgrow the arrays that fit a shortest one."""
    cells = np.zeros((40, 41), np.uint8)
    for col in range(1, 41, 2):
        cells[slice(1, None) if col % 4 == 1 else slice(None, -1), col] = 0
    values = np.full(cells.shape, 0.0)
    values[:, 1::2] = 1000.0
    for col in range(1, 41, 4):
        values[-1, col] = 0.0
    for col in range(3, 41, 4):
        values[0, col] = 0.0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (0, 40), cost=CostField(values))
    straight = np.array([problem.to_flat((0, col)) for col in range(41)], np.int32)
    found = windows.improved(straight, problem.terrain, 160)
    assert len(found) > 600
    assert grid_kernels.cost_along(found, problem.width, problem.objective.prices) == pytest.approx(
        exact.optimum(problem).cost
    )


@pytest.mark.parametrize("name", ["woa-exact", "sma-straight", "potential-field"])
def test_rivals_go_by_cost(name: str) -> None:
    problem = priced(2, 10, corner_rule="allow")
    result = an.solve(problem, an.algorithm(name))
    if result.path is not None:
        check_cost(result.path, problem, result.cost)
        assert result.cost <= result.history.best[-1] * (1 + 1e-9)
        assert result.gap >= -1e-9


def test_blocked_cells_are_closed() -> None:
    blocked = np.zeros((3, 5), np.bool_)
    blocked[:2, 2] = True
    grid = an.GridMap(np.zeros((3, 5), np.uint8))
    field = CostField(np.zeros((3, 5)), blocked)
    problem = an.Problem.from_cells(grid, (0, 0), (0, 4), cost=field)
    assert problem.grid is an.Problem.from_cells(grid, (0, 0), (2, 4), cost=field).grid  # one map, with what it keeps
    assert (2, 2) in map(tuple, an.solve(problem).path.cells.tolist())
    assert an.solve(problem).path.clearance == math.inf  # no wall is there
    with pytest.raises(OccupiedError, match="kept out"):
        an.Problem.from_cells(grid, (0, 2), (0, 4), cost=field)
    everything = CostField(np.zeros((3, 5)), np.ones((3, 5), np.bool_))
    with pytest.raises(OccupiedError):
        an.Problem.from_cells(grid, (0, 0), (0, 4), cost=everything)


@pytest.mark.parametrize("name", ["paco", "paco_large", "astar"])
def test_results_with_costs_go_into_files_and_come_back(name: str, tmp_path) -> None:
    problem = priced(2)
    result = an.solve(problem, an.algorithm(name), seed=4)
    result.save(tmp_path / "plan.json")
    loaded = an.Result.load(tmp_path / "plan.json")
    assert loaded.to_dict() == result.to_dict()
    assert (loaded.cost, loaded.gap) == (result.cost, result.gap)
    assert loaded.problem.cost.digest == problem.cost.digest
    text = (tmp_path / "plan.json").read_text()
    (tmp_path / "plan.json").write_text(text.replace(problem.cost.digest, "0" * 64))
    with pytest.raises(an.errors.ResultFormatError, match="digest"):
        an.Result.load(tmp_path / "plan.json")
    for other in (copy.deepcopy(problem), pickle.loads(pickle.dumps(problem))):
        assert an.solve(other, an.algorithm(name), seed=4).path.cells.tolist() == result.path.cells.tolist()


def test_other_costs_are_another_terrain_of_the_same_moves() -> None:
    grid = an.GridMap(np.zeros((4, 4), np.uint8))
    one, other = (an.Terrain.of(grid, objective=PathCost(CostField(np.full((4, 4), cost)))) for cost in (1.0, 2.0))
    same = an.Terrain.of(grid, objective=PathCost(CostField(np.full((4, 4), 1.0))))
    assert one is same
    assert one is not other
    assert np.shares_memory(one.moves, other.moves)
    assert one.graph((0, 0)) is not other.graph((0, 0))
    with pytest.raises(ParameterError, match="the map has 4 x 4"):
        an.Terrain.of(grid, objective=PathCost(FIELD))
    with pytest.raises(ParameterError, match=r"antnav\.costs"):
        an.Problem.from_cells(grid, (0, 0), (1, 1), cost=np.zeros((4, 4)))


@pytest.mark.parametrize("values", [-1.0, math.nan, math.inf, 1e308, 1e9 * 1.01])
def test_costs_out_of_range_are_refused(values: float) -> None:
    with pytest.raises(ParameterError, match="a cell costs 0 to 1e"):
        CostField(np.full((2, 2), values))


@pytest.mark.parametrize("values", ["x", None, np.zeros(3), np.zeros((0, 2)), np.zeros((2, 2), complex), [[1], [1, 2]]])
def test_what_is_no_field_is_refused(values: object) -> None:
    with pytest.raises(ParameterError):
        CostField(values)


def test_fields_add_and_cannot_be_written_to() -> None:
    total = FIELD + CostField(np.ones((2, 3)), np.eye(2, 3, dtype=bool), "slow")
    assert total.values.tolist() == (FIELD.values + 1).tolist()
    assert total.blocked.tolist() == np.eye(2, 3, dtype=bool).tolist()
    assert total.name == "cost + slow"
    assert total.digest != FIELD.digest
    with pytest.raises(ValueError, match="read-only"):
        total.values[0, 0] = 3
    with pytest.raises(ParameterError, match="shapes"):
        _ = FIELD + CostField(np.zeros((3, 2)))
    with pytest.raises(ParameterError, match="a truth for each"):
        CostField(np.zeros((2, 2)), np.zeros((2, 2)))


def cheapest_turning(problem: an.Problem) -> float:
    """Cost of the cheapest path by SciPy's Dijkstra on states (node, move that led there), the start apart."""
    graph, turning = problem.graph, problem.turning
    n, neighbours, costs = len(graph), graph.graph.neighbours, graph.graph.lengths
    steps = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)]
    angle = {a: math.atan2(*a) for a in steps}
    rows, cols, values = [], [], []

    def edge(state: int, node: int, k: int, turn: float) -> None:
        rows.append(state)
        cols.append(1 + 8 * int(neighbours[node, k]) + k)
        values.append(costs[node, k] + turning * turn)

    source = graph.node(problem.start_cell)
    for k in range(8):
        if neighbours[source, k] < n:
            edge(0, source, k, 0.0)
    for node in range(n):
        for k in (k for k in range(8) if neighbours[node, k] < n):
            for by in range(8):
                turn = abs(math.remainder(angle[steps[k]] - angle[steps[by]], math.tau))
                edge(1 + 8 * node + by, node, k, turn)
    matrix = csr_matrix((values, (rows, cols)), (1 + 8 * n, 1 + 8 * n))
    goal = graph.node(problem.goal_cell)
    return float(dijkstra(matrix, indices=0)[1 + 8 * goal : 9 + 8 * goal].min())


@settings(max_examples=40, derandomize=True)
@given(seed=st.integers(0, 10**6), turning=st.sampled_from([0.01, 0.7, 5.0]), dear=st.booleans())
def test_exact_search_with_turns_agrees_with_scipy_on_headings(seed: int, turning: float, dear: bool) -> None:
    problem = priced(seed, 11, corner_rule="allow", turning=turning)
    if not dear:
        ends = problem.start_cell, problem.goal_cell
        problem = an.Problem.from_cells(problem.grid, *ends, corner_rule="allow", turning=turning)
    if problem.start_cell == problem.goal_cell or not problem.connected:
        return
    for method in ("astar", "dijkstra"):
        found = exact.shortest_path(problem, method)
        assert found.cost == pytest.approx(cheapest_turning(problem), rel=1e-9)
        an.check_path(found.path, problem)
        check_cost(found.path, problem, found.cost)


def test_turns_have_a_price_by_hand() -> None:
    objective = PathCost(turning=2.0)
    corner = np.array([(0, 0), (0, 1), (1, 1)], np.int32)
    assert objective.of(corner, ROOM) == pytest.approx(2 + 2.0 * math.pi / 2)
    assert objective.turns().shape == (9, 8)
    assert objective.turns()[0].tolist() == [0.0] * 8
    assert objective.turns()[1 + 4, 6] == pytest.approx(math.pi)  # right, then down: a quarter turn times 2
    assert LENGTH.turns() is None


@pytest.mark.parametrize("name", [name for name in an.PRESETS if name != "traditional"])
def test_ants_and_all_that_follows_them_pay_for_turns(name: str) -> None:
    for seed in range(2):
        problem = priced(seed + 2, corner_rule="allow", turning=0.8)
        result = an.solve(problem, an.preset(name, ants=12, iterations=12), seed=seed)
        if result.path is None:
            continue
        check_cost(result.path, problem, result.cost)
        assert result.gap >= -1e-9
        divided = any(stage.name == "stage two" for stage in result.stages)
        if not result.estimated and not divided and not result.notes:
            assert result.cost <= result.history.best[-1] * (1 + 1e-9)


def test_dear_turns_make_straighter_and_longer_paths() -> None:
    angles, lengths = [], []
    for seed in range(6):
        plain = random_problem(seed, side=16)
        if not plain.connected:
            continue
        ends = plain.start_cell, plain.goal_cell
        dear = an.Problem.from_cells(plain.grid, *ends, corner_rule=plain.corner_rule, turning=30.0)
        paths = [exact.shortest_path(problem).path for problem in (plain, dear)]
        angles.append([path.turning_angle for path in paths])
        lengths.append([path.length for path in paths])
    before, after = np.sum(angles, axis=0)
    assert after < 0.8 * before
    assert all(later <= first + 1e-9 for first, later in angles)
    assert all(later >= first - 1e-9 for first, later in lengths)


@pytest.mark.parametrize("turning", [-1, math.nan, 1e308, "1", None, True])
def test_no_price_of_turns_is_refused(turning: object) -> None:
    with pytest.raises(ParameterError, match="turning"):
        an.Problem.from_cells(ROOM, (0, 0), (1, 2), turning=turning)
