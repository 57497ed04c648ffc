"""The shortest line at any angle against every pair of corners that see one another, and by hand."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import antnav as an
from antnav.kernels import any_angle_kernels
from tests.conftest import grid_of
from tests.search.naive_any_angle import shortest


def length_of(line: np.ndarray) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum()) if len(line) else math.inf


@st.composite
def questions(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """A map with one closed cell all round, and two points in open cells, off their corners."""
    rows, cols = draw(st.integers(1, 6)), draw(st.integers(2, 7))
    cells = draw(st.lists(st.sampled_from((0, 0, 0, 1)), min_size=rows * cols, max_size=rows * cols))
    closed = np.pad(np.array(cells, np.uint8).reshape(rows, cols), 1, constant_values=1)
    free = np.argwhere(closed == 0)
    if len(free) == 0:
        closed[1, 1], free = 0, np.array([(1, 1)])
    ends = [free[draw(st.integers(0, len(free) - 1))][::-1] for _ in range(2)]
    within = [draw(st.sampled_from(((0.5, 0.5), (0.0, 0.5), (0.5, 0.0), (0.25, 0.7), (0.3141, 0.0)))) for _ in range(2)]
    return closed, np.array(ends) + within


@given(questions(), st.booleans())
def test_it_is_as_long_as_the_naive_one_and_the_same_both_ways(
    question: tuple[np.ndarray, np.ndarray], squeeze: bool
) -> None:
    closed, ends = question
    line, _ = any_angle_kernels.shortest_line(closed, squeeze, ends)
    start, goal = map(tuple, ends.tolist())
    assert length_of(line) == pytest.approx(shortest(closed, start, goal, squeeze=squeeze), rel=1e-12)
    back, _ = any_angle_kernels.shortest_line(closed, squeeze, ends[::-1].copy())
    assert length_of(back) == pytest.approx(length_of(line), rel=1e-12)


def test_around_a_corner_and_between_two_cells_that_touch() -> None:
    grid = grid_of("....", ".#..", "..#.", "....")
    lengths = {}
    for rule in an.CornerRule:
        lengths[rule] = an.exact.any_angle(an.Problem.from_cells(grid, (2, 1), (1, 2), corner_rule=rule)).length
    around = 2 * math.hypot(0.5, 0.5) + 2  # from (1.5, 2.5) over (1, 2), (1, 1), (2, 1) to (2.5, 1.5)
    assert lengths == pytest.approx({"forbid": around, "graze": around, "allow": math.sqrt(2)})


def test_exact_ends_in_metres() -> None:
    grid = an.GridMap(np.zeros((20, 30), np.uint8), 0.1, (3.0, -1.0, 0.7))
    start, goal = (3.0 + 0.1, -1.0 + 0.5), (3.0 + 0.4, -1.0 + 1.7)
    problem = an.Problem(grid, start, goal)
    found = an.exact.any_angle(problem)
    assert found.points.tolist() == [list(start), list(goal)]
    assert found.length == pytest.approx(math.dist(start, goal) / 0.1)
    assert an.exact.any_angle_bound(problem) == pytest.approx(math.dist(problem.start_cell, problem.goal_cell))


def test_bounds_of_results() -> None:
    grid = grid_of(".#.", ".#.", "...")
    problem = an.Problem.from_cells(grid, (0, 0), (0, 2))
    result = an.solve(problem, an.astar())
    assert result.any_angle_bound == pytest.approx(1 + 2 * math.hypot(0.5, 1.5))
    assert result.optimum == pytest.approx(6.0)
    path = an.exact.any_angle(problem).path
    assert path is not None
    assert path.cells.tolist() == [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2]]
    closed = an.solve(an.Problem.from_cells(grid_of(".#."), (0, 0), (0, 2)), an.astar())
    assert closed.any_angle_bound == math.inf
    nothing = an.exact.any_angle(closed.problem)
    assert (nothing.points.shape, nothing.path) == ((0, 2), None)
    priced = an.solve(an.Problem.from_cells(grid, (0, 0), (0, 2), turning=1.0), an.astar())
    assert priced.any_angle_bound is None


@pytest.mark.parametrize("rule", an.CornerRule)
@pytest.mark.parametrize("seed", range(8))
def test_no_path_is_shorter_and_the_line_is_clear(seed: int, rule: an.CornerRule) -> None:
    draw = np.random.default_rng(seed)
    grid = an.GridMap((draw.random((60, 70)) < 0.05 * (1 + seed % 6)).astype(np.uint8))
    free = np.argwhere(grid.cells == 0)
    for one, other in free[draw.integers(len(free), size=(12, 2))].tolist():
        problem = an.Problem.from_cells(grid, tuple(one), tuple(other), corner_rule=rule)
        found, path = an.exact.any_angle(problem), an.exact.shortest_path(problem)
        assert (found.length == math.inf) == (path.path is None)
        if path.path is not None:
            assert math.dist(one, other) * (1 - 1e-12) <= found.length <= path.length * (1 + 1e-12)
            assert found.path is not None
            an.check_path(found.path, problem)
            assert found.path.length >= found.length * (1 - 1e-12)
            assert found.length == pytest.approx(an.exact.any_angle_bound(problem), rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_cells_along_lines_between_any_points(seed: int) -> None:
    draw = np.random.default_rng(seed)
    grid = an.GridMap((draw.random((25, 30)) < 0.2).astype(np.uint8), 0.1, (1.0, 2.0, 0.5))
    free = np.argwhere(grid.cells == 0)
    for pair in free[draw.integers(len(free), size=(20, 2))]:
        within = draw.choice((0.0, -0.5, 0.25, 0.4999), (2, 2)) if seed % 2 else draw.uniform(-0.5, 0.5, (2, 2))
        start, goal = map(tuple, grid.cell_to_world(pair + within).tolist())
        cells = [grid.cell_at(point) for point in (start, goal)]
        if not all(grid.contains(cell) and grid.cells[cell] == 0 for cell in cells):
            continue
        problem = an.Problem(grid, start, goal, "allow" if seed % 3 else "forbid")
        path = an.exact.any_angle(problem).path
        assert (path is not None) == problem.connected
        if path is not None:
            an.check_path(path, problem)


@pytest.mark.filterwarnings("ignore::antnav.maps.MapWarning")
def test_pulled_paths_of_a_real_map_are_no_shorter(data: Path) -> None:
    grid = an.load_map(data / "ros" / "nav2_bringup" / "depot.yaml").inflated(0.2, strict=True)
    free = np.argwhere(grid.cells == 0)
    draw = np.random.default_rng(3)
    for one, other in free[draw.integers(len(free), size=(10, 2))].tolist():
        problem = an.Problem.from_cells(grid, tuple(one), tuple(other))
        if problem.connected:
            result = an.solve(problem, an.astar())
            assert result.any_angle_bound is not None
            # without a radius the curve keeps to open cells, so the bound holds for it, too
            assert result.any_angle_bound * grid.resolution <= result.trajectory(spacing=0.01).length * (1 + 1e-9)
