"""Sides by sums of marks are the sides by angles."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import antnav as an
from antnav.routes.difference import Zone, default_reach, flat_cells
from antnav.routes.sides import marks_below, obstacles_between, polished, side
from tests.conftest import grid_of
from tests.routes.naive import enclosed, near_cells, shared_share

GRID = grid_of(
    ".......",
    ".##.#..",
    ".##....",
    ".......",
)
TERRAIN = an.Problem.from_cells(GRID, (3, 0), (0, 6)).terrain


def path_of(*cells: tuple[int, int]) -> np.ndarray:
    return flat_cells(an.Path(cells, GRID), TERRAIN)


OVER = path_of((3, 0), (2, 0), (1, 0), (0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (0, 5), (0, 6))
BETWEEN = path_of((3, 0), (3, 1), (3, 2), (2, 3), (1, 3), (0, 4), (0, 5), (0, 6))
UNDER = path_of((3, 0), (3, 1), (3, 2), (3, 3), (2, 4), (2, 5), (1, 6), (0, 6))
BACK = path_of((3, 0), (3, 1), (3, 2), (3, 3), (3, 2), (3, 3), (2, 4), (2, 5), (1, 6), (0, 6))


def test_by_hand() -> None:
    paths = (OVER, BETWEEN, UNDER, BACK)
    counts = [[obstacles_between(one, other, TERRAIN) for other in paths] for one in paths]
    assert counts == [[0, 1, 2, 2], [1, 0, 1, 1], [2, 1, 0, 0], [2, 1, 0, 0]]
    below = marks_below(~np.pad(GRID.passable(), 1).ravel(), TERRAIN.width)
    over, between, under, back = (side(path, below, TERRAIN.width) for path in paths)
    assert under == back
    assert len({over, between, under}) == 3


def test_marks_are_summed_from_below() -> None:
    mask = np.zeros((4, 3), np.bool_)
    mask[1, 1] = mask[2, 1] = True
    below = marks_below(mask.ravel(), 3).reshape(4, 3)
    assert (below[:, [0, 2]] == 0).all()
    assert below[2:, 1].tolist() == [0, 0]
    assert below[0, 1] != below[1, 1] != 0
    np.testing.assert_array_equal(below, marks_below(mask.ravel(), 3).reshape(4, 3))


def random_walk(problem: an.Problem, rng: np.random.Generator) -> np.ndarray:
    """From the start over three drawn cells to the goal."""
    cells = np.argwhere(problem.reachable)
    stops = [problem.start_cell, *map(tuple, cells[rng.integers(len(cells), size=3)].tolist()), problem.goal_cell]
    walked = [np.array([problem.start_cell])]
    for one, other in pairwise(stops):
        leg = an.Problem.from_cells(problem.grid, one, other, corner_rule=problem.corner_rule)
        path = an.exact.shortest_path(leg).path
        assert path is not None
        walked.append(path.cells[1:])
    return np.concatenate(walked)


@given(seed=st.integers(0, 10**6), rule=st.sampled_from(list(an.CornerRule)))
def test_all_ways_to_tell_sides_agree(seed: int, rule: an.CornerRule) -> None:
    rng = np.random.default_rng(seed)
    cells = (rng.random((9, 10)) < 0.3).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (8, 9), corner_rule=rule)
    if not problem.connected:
        return
    one, other = random_walk(problem, rng), random_walk(problem, rng)
    width, terrain = problem.width, problem.terrain
    flat = [flat_cells(an.Path(path, problem.grid), terrain) for path in (one, other)]
    count = obstacles_between(*flat, terrain)
    assert count == enclosed(one, other, problem)
    below = marks_below(~np.pad(problem.passable, 1).ravel(), width)
    assert (side(flat[0], below, width) == side(flat[1], below, width)) == (count == 0)


@given(seed=st.integers(0, 10**6), reach=st.integers(0, 50).map(lambda tenths: tenths / 10))
def test_zones_are_what_scipy_reaches(seed: int, reach: float) -> None:
    rng = np.random.default_rng(seed)
    cells = (rng.random((9, 10)) < 0.3).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (8, 9))
    if not problem.connected:
        return
    one, other = random_walk(problem, rng), random_walk(problem, rng)
    flat = [flat_cells(an.Path(path, problem.grid), problem.terrain) for path in (one, other)]
    zone = Zone.of(flat[0], problem.terrain, reach)
    found = {tuple(cell) for cell in problem.from_flat(np.flatnonzero(zone.near)).tolist()}
    assert found == near_cells(one, problem, reach)
    assert abs(zone.share(flat[1]) - shared_share(other, one, problem, reach)) < 1e-12


def test_a_path_of_one_cell_is_shared() -> None:
    one = flat_cells(an.Path([(0, 0)], GRID), TERRAIN)
    assert Zone.of(one, TERRAIN, 2.0).share(one) == 1.0


def test_default_reach() -> None:
    assert (default_reach(28.0), default_reach(1000.0)) == (2.0, 20.0)


def test_polished_paths_keep_their_side() -> None:
    bent = path_of((3, 0), (3, 1), (3, 2), (3, 3), (2, 3), (3, 4), (2, 5), (3, 6), (2, 6), (1, 6), (0, 6))
    better = polished(bent, TERRAIN, 2.0)
    assert TERRAIN.cost_along(better) < TERRAIN.cost_along(bent)
    assert obstacles_between(bent, better, TERRAIN) == 0
    assert TERRAIN.cost_along(polished(OVER, TERRAIN, 9.0)) == TERRAIN.cost_along(OVER)
