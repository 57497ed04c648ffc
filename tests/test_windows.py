"""Windows: never longer, legal, exact where they see enough, the same for any number of workers."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import exact, grid_kernels, spmd, windows
from antnav.moves import STEPS, CornerRule
from antnav.path import length_of
from tests.conftest import grid_of


def blind_path(problem: an.Problem, seed: int) -> np.ndarray:
    """A path from start to goal by depth-first search in random order, as flat cells."""
    rng = np.random.default_rng(seed)
    moves, width = problem.moves.ravel(), problem.width
    path, seen = [problem.to_flat(problem.start_cell)], set()
    goal = problem.to_flat(problem.goal_cell)
    while path[-1] != goal:
        seen.add(path[-1])
        ways = [path[-1] + r * width + c for k, (r, c) in enumerate(STEPS) if moves[path[-1]] >> k & 1]
        ways = [cell for cell in ways if cell not in seen]
        if ways:
            path.append(int(rng.choice(ways)))
        else:
            path.pop()
    return np.array(path, np.int32)


def random_problem(rows: int, cols: int, density: float, seed: int, rule: CornerRule) -> an.Problem:
    cells = (np.random.default_rng(seed).random((rows, cols)) < density).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    return an.Problem.from_cells(an.GridMap(cells), (0, 0), (rows - 1, cols - 1), corner_rule=rule)


@settings(max_examples=120, deadline=None, derandomize=True)
@given(
    rows=st.integers(2, 16),
    cols=st.integers(2, 16),
    density=st.floats(0, 0.5),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
    window=st.integers(3, 30),
)
def test_paths_get_no_longer_and_stay_legal(
    rows: int, cols: int, density: float, seed: int, rule: CornerRule, window: int
) -> None:
    problem = random_problem(rows, cols, density, seed, rule)
    if not problem.connected:
        return
    before = blind_path(problem, seed)
    moves, width = problem.moves.ravel(), problem.width
    after = windows.improved(before, moves, width, window)
    length = an.check_path(problem.from_flat(after), problem)
    assert length <= an.check_path(problem.from_flat(before), problem) + 1e-9
    assert grid_kernels.length_along(after, width) == pytest.approx(length)
    again = windows.improved(before, moves, width, window, spmd.Serial())
    with ThreadPoolExecutor(8) as eight:
        assert after.tolist() == again.tolist() == windows.improved(before, moves, width, window, eight).tolist()
    whole = windows.improved(before, moves, width, 4 * max(rows, cols, len(before)))
    assert length_of(problem.from_flat(whole)) == pytest.approx(exact.shortest_path(problem).length)


def test_a_window_sees_a_quarter_of_its_length_around() -> None:
    """The way round a wall is 9 rows deep; the door in the wall is 3 cells off the path's box."""
    rows = ["." * 9 for _ in range(10)]
    rows[:9] = ["....#...."] * 9
    rows[6] = "........."
    problem = an.Problem.from_cells(grid_of(*rows), (9, 0), (9, 8), corner_rule="allow")
    straight = np.array([problem.to_flat((9, col)) for col in range(9)], np.int32)
    assert windows.improved(straight, problem.moves.ravel(), problem.width, 16).tolist() == straight.tolist()
    round_the_end = [(row, 0) for row in range(0, 10)] + [(9, col) for col in range(1, 9)]
    round_the_end += [(row, 8) for row in range(8, -1, -1)]
    problem = an.Problem.from_cells(grid_of(*rows), (0, 0), (0, 8), corner_rule="allow")
    path = np.array([problem.to_flat(cell) for cell in round_the_end], np.int32)
    found = windows.improved(path, problem.moves.ravel(), problem.width, 30)
    assert length_of(problem.from_flat(found)) == pytest.approx(exact.shortest_path(problem).length)
    assert (6, 4) in [tuple(cell) for cell in problem.from_flat(found).tolist()]


def test_a_piece_without_a_detour_is_left_alone() -> None:
    """Two paths of one length: the one there is stays, cell by cell."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((5, 9), np.uint8)), (0, 0), (4, 8))
    cells = [(0, 0), (0, 1), (1, 2), (1, 3), (2, 4), (2, 5), (3, 6), (3, 7), (4, 8)]
    path = np.array([problem.to_flat(cell) for cell in cells], np.int32)
    assert windows.improved(path, problem.moves.ravel(), problem.width, 6).tolist() == path.tolist()


def test_stops_between_passes() -> None:
    problem = random_problem(16, 16, 0.3, 4, CornerRule.ALLOW)
    path = blind_path(problem, 1)
    looks = iter([False, True])
    once = windows.improved(path, problem.moves.ravel(), problem.width, 9, ended=lambda: next(looks))
    expected = grid_kernels.reoptimise(problem.moves.ravel(), problem.width, path, 3, 0)
    assert once.tolist() == expected.tolist() != path.tolist()


def test_a_longer_way_is_replaced() -> None:
    problem = an.Problem.from_cells(grid_of("......", ".#..#.", "..##.."), (0, 0), (0, 5), corner_rule="allow")
    down = np.array(
        [problem.to_flat(cell) for cell in [(0, 0), (1, 0), (2, 1), (1, 2), (1, 3), (2, 4), (1, 5), (0, 5)]]
    )
    found = windows.improved(down.astype(np.int32), problem.moves.ravel(), problem.width, 9)
    assert problem.from_flat(found).tolist() == [[0, col] for col in range(6)]
