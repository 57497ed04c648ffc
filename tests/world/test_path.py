"""Path: measures by hand, and a check that finds every kind of fault."""

from __future__ import annotations

import math
import pickle
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.errors import PathError
from antnav.world.path import Path
from tests.conftest import grid_of

GRID = an.GridMap(grid_of("....", ".#..", "....").cells, resolution=0.5)
CELLS = [(0, 0), (1, 0), (2, 1), (2, 2), (1, 3)]


def test_measures_by_hand() -> None:
    path = Path(CELLS, GRID)
    assert path.length == 2 + 2 * math.sqrt(2)
    assert path.length_m == pytest.approx(path.length / 2)
    assert path.turns == 3
    assert path.turning_angle == pytest.approx(3 * math.pi / 4)
    assert path.clearance == pytest.approx(0.5)  # (1, 0) is one cell from the obstacle
    np.testing.assert_allclose(path.points[0], (0.25, 1.25))
    np.testing.assert_allclose(path.headings, [-math.pi / 2, -math.pi / 4, 0, math.pi / 4, math.pi / 4])


def test_ends_are_exactly_start_and_goal() -> None:
    path = Path(CELLS, GRID, start=(0.3, 1.3), goal=(1.6, 0.8))
    assert tuple(path.points[0]) == (0.3, 1.3)
    assert tuple(path.points[-1]) == (1.6, 0.8)


def test_metres_are_those_of_the_polyline() -> None:
    path = Path(CELLS, GRID, start=(0.3, 1.3), goal=(1.6, 0.8))
    assert path.length_m == pytest.approx(sum(math.dist(*pair) for pair in pairwise(path.points.tolist())))
    assert path.length == Path(CELLS, GRID).length
    assert path.length_m != pytest.approx(path.length * 0.5, rel=1e-3)


def test_start_and_goal_in_one_cell_are_two_points() -> None:
    problem = an.Problem(GRID, (0.05, 1.05), (0.45, 1.45))
    path = an.solve(problem, an.paco(), seed=1).path
    assert path.points.tolist() == [[0.05, 1.05], [0.45, 1.45]]
    np.testing.assert_allclose(path.headings, [math.pi / 4, math.pi / 4])
    assert (path.length, path.length_m) == (0, pytest.approx(0.4 * math.sqrt(2)))
    assert an.check_path(path, problem) == 0


def test_a_path_of_one_cell() -> None:
    path = Path([(0, 0)], GRID)
    assert (path.length, path.turns, path.turning_angle, len(path.headings)) == (0, 0, 0, 1)


def test_clearance_without_obstacles_is_infinite() -> None:
    assert Path([(0, 0), (0, 1)], grid_of("..")).clearance == math.inf


def sampled(path: Path) -> float:
    """Least distance from points along the polyline to the squares of occupied cells, in metres, one by one."""
    grid, least = path.grid, math.inf
    yaw = grid.origin[2]
    for (x0, y0), (x1, y1) in pairwise([*path.points.tolist(), path.points[-1].tolist()]):
        for share in np.linspace(0, 1, 41):
            x, y = x0 + share * (x1 - x0) - grid.origin[0], y0 + share * (y1 - y0) - grid.origin[1]
            x, y = math.cos(yaw) * x + math.sin(yaw) * y, math.cos(yaw) * y - math.sin(yaw) * x
            for row, col in np.argwhere(grid.cells == an.Cell.OCCUPIED):
                left, below = col * grid.resolution, (grid.rows - 1 - row) * grid.resolution
                dx = max(left - x, 0, x - left - grid.resolution)
                dy = max(below - y, 0, y - below - grid.resolution)
                least = min(least, math.hypot(dx, dy))
    return least


@settings(max_examples=80, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), density=st.floats(0.01, 0.3), exact_ends=st.booleans())
def test_distances_to_walls_equal_brute_force(seed: int, density: float, exact_ends: bool) -> None:
    rng = np.random.default_rng(seed)
    cells = (rng.random((7, 8)) < density).astype(np.uint8)
    grid = an.GridMap(cells, 0.5, (1.0, -2.0, float(rng.uniform(-3, 3))))
    row, col = rng.integers(0, 7), rng.integers(0, 8)
    walk = [(row, col)]
    for step in rng.integers(-1, 2, (5, 2)):
        row, col = np.clip((row + step[0], col + step[1]), 0, (6, 7))
        walk += [(row, col)] if (row, col) != walk[-1] else []
    ends = grid.cell_to_world(np.array([walk[0], walk[-1]]) + rng.uniform(-0.5, 0.5, (2, 2)) * exact_ends)
    path = Path(walk, grid, *map(tuple, ends.tolist()))
    walls = np.argwhere(cells)
    if not len(walls):
        assert path.wall_distance == path.clearance == math.inf
        return
    assert path.clearance == pytest.approx(0.5 * min(math.dist(cell, wall) for cell in walk for wall in walls))
    step = 0.5 * math.sqrt(2) * 1.5 / 40
    assert sampled(path) - step - 1e-9 <= path.wall_distance <= sampled(path) + 1e-9


def test_a_diagonal_move_is_nearest_in_its_middle() -> None:
    grid = grid_of("...#", "....", "....", "#...")
    path = Path([(1, 1), (2, 2)], grid)
    assert path.wall_distance == pytest.approx(math.sqrt(2))
    assert path.clearance == pytest.approx(math.sqrt(5))


def test_a_good_path_passes_and_its_length_is_added_up_anew() -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule="graze")
    assert an.check_path(CELLS, problem) == pytest.approx(2 + 2 * math.sqrt(2))


@pytest.mark.parametrize(
    ("cells", "rule", "message"),
    [
        ([], "allow", "must lead from"),
        (CELLS[1:], "allow", "must lead from"),
        (CELLS[:-1], "allow", "must lead from"),
        ([(0, 0), (1, 1), (1, 2), (1, 3)], "allow", "not free"),
        ([(0, 0), (-1, 1), (0, 2), (1, 3)], "allow", "outside"),
        ([(0, 0), (0, 2), (1, 3)], "allow", "not neighbours"),
        ([(0, 0), (0, 0), (0, 1), (0, 2), (1, 3)], "allow", "not neighbours"),
        (CELLS, "forbid", "cuts a corner"),
    ],
)
def test_every_fault_is_found(cells: list, rule: str, message: str) -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule=rule)
    with pytest.raises(PathError, match=message):
        an.check_path(cells, problem)


def test_squeezing_between_two_obstacles_needs_allow() -> None:
    grid = grid_of(".#", "#.")
    an.check_path([(0, 0), (1, 1)], an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule="allow"))
    with pytest.raises(PathError, match="corner"):
        an.check_path([(0, 0), (1, 1)], an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule="graze"))


def test_a_false_length_is_found() -> None:
    problem = an.Problem.from_cells(GRID, (0, 0), (1, 3), corner_rule="graze")
    path = Path(CELLS, GRID)
    path.__dict__["length"] = 3.0
    with pytest.raises(PathError, match="add up to"):
        an.check_path(path, problem)


def test_a_path_from_another_process_is_read_only_too() -> None:
    path = pickle.loads(pickle.dumps(an.Path([(0, 0), (0, 1)], grid_of(".."))))
    assert not path.cells.flags.writeable
