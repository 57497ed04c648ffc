"""Windows: never longer, legal, exact where they see enough, the same for any number of workers."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav import costs
from antnav.kernels import grid_kernels, jump_kernels
from antnav.run import spmd
from antnav.search import exact, windows
from antnav.world.moves import STEPS, CornerRule
from antnav.world.path import length_of
from antnav.world.path_cost import FREE
from tests.conftest import grid_of


def blind_path(problem: an.Problem, seed: int) -> np.ndarray:
    """A path from start to goal by depth-first search in random order, as flat cells."""
    rng = np.random.default_rng(seed)
    moves, width = problem.flat_moves, problem.width
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
    after = windows.improved(before, problem.terrain, window)
    length = an.check_path(problem.from_flat(after), problem)
    assert length <= an.check_path(problem.from_flat(before), problem) + 1e-9
    assert grid_kernels.length_along(after, problem.width) == pytest.approx(length)
    again = windows.improved(before, problem.terrain, window, spmd.Serial())
    with ThreadPoolExecutor(8) as eight:
        assert after.tolist() == again.tolist() == windows.improved(before, problem.terrain, window, eight).tolist()
    whole = windows.improved(before, problem.terrain, 4 * max(rows, cols, len(before)))
    assert length_of(problem.from_flat(whole)) == pytest.approx(exact.shortest_path(problem).length)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    rows=st.integers(2, 16),
    cols=st.integers(2, 16),
    density=st.floats(0, 0.5),
    seed=st.integers(0, 2**32 - 1),
    kind=st.sampled_from(["none", "gamma", "slope"]),
    turning=st.sampled_from([0.0, 0.3, 3.0]),
    window=st.integers(3, 30),
)
def test_windows_know_costs_slopes_and_turns(
    rows: int, cols: int, density: float, seed: int, kind: str, turning: float, window: int
) -> None:
    plain = random_problem(rows, cols, density, seed, CornerRule.ALLOW)
    if not plain.connected:
        return
    rng = np.random.default_rng(seed)
    fields = {
        "none": None,
        "gamma": costs.array(rng.gamma(1.0, 2.0, (rows, cols))),
        "slope": costs.slope(rng.normal(size=(rows, cols)), up=5.0, down=1.0),
    }
    ends = (0, 0), (rows - 1, cols - 1)
    problem = an.Problem.from_cells(plain.grid, *ends, corner_rule="allow", cost=fields[kind], turning=turning)
    before = blind_path(problem, seed)
    after = windows.improved(before, problem.terrain, window)
    an.check_path(problem.from_flat(after), problem)
    assert problem.cost_along(after) <= problem.cost_along(before) * (1 + 1e-12)
    whole = windows.improved(before, problem.terrain, 4 * max(rows, cols, len(before)))
    assert problem.cost_along(whole) == pytest.approx(exact.shortest_path(problem).cost)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    rows=st.integers(2, 16),
    cols=st.integers(2, 16),
    density=st.floats(0, 0.5),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
    window=st.integers(3, 30),
)
def test_windows_searched_by_jumps_are_as_short(
    rows: int, cols: int, density: float, seed: int, rule: CornerRule, window: int
) -> None:
    problem = random_problem(rows, cols, density, seed, rule)
    if not problem.connected:
        return
    path, graph = blind_path(problem, seed), (problem.flat_moves, problem.width)
    for offset in (0, window // 2):
        by_star = grid_kernels.reoptimise(*graph, path, window, offset, FREE)
        by_jumps = jump_kernels.reoptimise(*graph, problem.terrain.jumps, path, window, offset)
        length = an.check_path(problem.from_flat(by_jumps), problem)
        assert length == pytest.approx(an.check_path(problem.from_flat(by_star), problem), abs=1e-9)
        path = by_jumps


@pytest.mark.parametrize(("choice", "most"), [({}, 3000), ({"turning": 0.1}, windows.MOST_WITH_COSTS)])
def test_windows_are_shorter_where_a_star_searches_them(
    choice: dict, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((3, 5), np.uint8)), (0, 0), (2, 4), **choice)
    way = [(0, 0), (0, 1), (1, 1), (1, 2)] * 1000  # longer than a window
    path, lengths = np.array([problem.to_flat(cell) for cell in way], np.int32), []
    monkeypatch.setattr(windows, "_one_pass", lambda path, terrain, length, *rest: (lengths.append(length), path)[1])
    windows.improved(path, problem.terrain, 3000)
    assert lengths == ([most, most] if problem.objective.plain else [most // 3, most // 3, most, most])


@pytest.mark.parametrize(("window", "wanted"), [(3, [1, 1, 3]), (60, [20, 20, 60]), (64, [64]), (1000, [1000])])
def test_a_path_in_one_window_is_searched_once(window: int, wanted: list, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((3, 5), np.uint8)), (0, 0), (2, 4))
    path = np.array([problem.to_flat(cell) for cell in [(0, 0), (0, 1), (1, 1), (1, 2)]], np.int32)
    lengths = []
    monkeypatch.setattr(windows, "_one_pass", lambda path, terrain, length, *rest: (lengths.append(length), path)[1])
    windows.improved(path, problem.terrain, window)
    assert lengths == wanted


def test_a_window_sees_a_quarter_of_its_length_around() -> None:
    """The way round a wall is 9 rows deep; the door in the wall is 3 cells off the path's box."""
    rows = ["." * 9 for _ in range(10)]
    rows[:9] = ["....#...."] * 9
    rows[6] = "........."
    problem = an.Problem.from_cells(grid_of(*rows), (9, 0), (9, 8), corner_rule="allow")
    straight = np.array([problem.to_flat((9, col)) for col in range(9)], np.int32)
    assert windows.improved(straight, problem.terrain, 16).tolist() == straight.tolist()
    round_the_end = [(row, 0) for row in range(0, 10)] + [(9, col) for col in range(1, 9)]
    round_the_end += [(row, 8) for row in range(8, -1, -1)]
    problem = an.Problem.from_cells(grid_of(*rows), (0, 0), (0, 8), corner_rule="allow")
    path = np.array([problem.to_flat(cell) for cell in round_the_end], np.int32)
    found = windows.improved(path, problem.terrain, 30)
    assert length_of(problem.from_flat(found)) == pytest.approx(exact.shortest_path(problem).length)
    assert (6, 4) in [tuple(cell) for cell in problem.from_flat(found).tolist()]


@pytest.mark.parametrize(("depth", "seen"), [(4, True), (5, False)])
def test_the_quarter_is_one_quarter_to_the_cell(depth: int, seen: bool) -> None:
    """A window of 16 moves over the top of a wall; below, a V of diagonals that is shorter goes `depth` rows down."""
    top, span = 8 - depth, 2 * depth
    rows = np.ones((top + 1 + depth, span + 1), np.uint8)
    over = [(row, 0) for row in range(top, -1, -1)] + [(0, col) for col in range(1, span)]
    over += [(row, span) for row in range(top + 1)]
    below = [(top + depth - abs(depth - col), col) for col in range(span + 1)]
    rows[tuple(np.array(over + below).T)] = 0
    problem = an.Problem.from_cells(an.GridMap(rows), over[0], over[-1], corner_rule="allow")
    path = np.array([problem.to_flat(cell) for cell in over], np.int32)
    found = grid_kernels.reoptimise(problem.flat_moves, problem.width, path, 16, 0, FREE)
    assert ([top + depth, depth] in problem.from_flat(found).tolist()) == seen


def test_a_piece_without_a_detour_is_left_alone() -> None:
    """Two paths of one length: the one there is stays, cell by cell."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((5, 9), np.uint8)), (0, 0), (4, 8))
    cells = [(0, 0), (0, 1), (1, 2), (1, 3), (2, 4), (2, 5), (3, 6), (3, 7), (4, 8)]
    path = np.array([problem.to_flat(cell) for cell in cells], np.int32)
    assert windows.improved(path, problem.terrain, 6).tolist() == path.tolist()


def test_stops_between_passes() -> None:
    problem = random_problem(16, 16, 0.3, 4, CornerRule.ALLOW)
    path = blind_path(problem, 1)
    moves, width, seen = problem.flat_moves, problem.width, []
    windows.improved(path, problem.terrain, 9, ended=seen.append)
    assert len(seen) == 4
    expected = path
    for window, offset, before in zip((3, 3, 9, 9), (0, 1, 0, 4), seen, strict=True):
        assert before.tolist() == expected.tolist()
        expected = grid_kernels.reoptimise(moves, width, expected, window, offset, FREE)
    assert expected.tolist() == windows.improved(path, problem.terrain, 9).tolist() != path.tolist()
    once = windows.improved(path, problem.terrain, 9, ended=lambda path: len(path) < len(seen[0]))
    assert once.tolist() == seen[1].tolist()


def test_long_paths_are_cut_the_same_for_any_workers() -> None:
    """More than a thousand moves: many jobs a pass, none of which may change what another does."""
    cells = np.zeros((60, 1200), np.uint8)
    cells[np.random.default_rng(3).random(cells.shape) < 0.25] = 1
    cells[:3, :3] = cells[-3:, -3:] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (59, 1199), corner_rule="allow")
    path = blind_path(problem, 2)
    graph = problem.flat_moves, problem.width
    assert len(path) > 1200
    for window in (9, 30, 240, 600):
        alone = path
        for length in (window // 3, window) if window < windows.ONCE_FROM else (window,):
            for offset in (0, length // 2):
                by_star = grid_kernels.reoptimise(*graph, alone, length, offset, FREE)
                by_jumps = jump_kernels.reoptimise(*graph, problem.terrain.jumps, alone, length, offset)
                assert length_of(problem.from_flat(by_star)) == length_of(problem.from_flat(by_jumps))
                alone = by_star if length < windows.JUMPS_FROM else by_jumps
        with ThreadPoolExecutor(3) as three:
            for executor in (None, spmd.Serial(), three):
                assert windows.improved(path, problem.terrain, window, executor).tolist() == alone.tolist()


def test_paths_of_any_length_are_cut_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Jobs of one window each, whose last one may hold all of it, a part, or nothing."""
    monkeypatch.setattr(windows, "CHUNK_MOVES", 1)
    problem = random_problem(9, 9, 0.2, 6, CornerRule.ALLOW)
    path = blind_path(problem, 2)
    assert len(path) > 30
    for cells in range(1, 30):
        alone = path[:cells]
        for length in (2, 6):
            for offset in (0, length // 2):
                alone = grid_kernels.reoptimise(problem.flat_moves, problem.width, alone, length, offset, FREE)
        assert windows.improved(path[:cells], problem.terrain, 6, spmd.Serial()).tolist() == alone.tolist()


@pytest.mark.parametrize("turned", [False, True])
def test_a_small_detour_far_from_the_diagonal_is_seen(turned: bool) -> None:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((12, 12), np.uint8)), (0, 0), (11, 11))
    detour = [(0, 8), (0, 9), (1, 9), (2, 9), (3, 9), (3, 8)]
    cells = [(col, row) for row, col in detour] if turned else detour
    path = np.array([problem.to_flat(cell) for cell in cells], np.int32)
    found = grid_kernels.reoptimise(problem.flat_moves, problem.width, path, 6, 0, FREE)
    assert grid_kernels.length_along(found, problem.width) == 3


def test_two_moves_may_become_one() -> None:
    problem = an.Problem.from_cells(grid_of("..", ".."), (0, 0), (1, 1))
    path = np.array([problem.to_flat(cell) for cell in [(0, 0), (0, 1), (1, 1)]], np.int32)
    assert windows.improved(path, problem.terrain, 3).tolist() == path[::2].tolist()


@settings(max_examples=80, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), rule=st.sampled_from(list(CornerRule)))
def test_the_box_is_a_wall(seed: int, rule: CornerRule) -> None:
    """A search inside a box equals the exact search on the map cropped to the box."""
    rng = np.random.default_rng(seed)
    cells = (rng.random((14, 15)) < 0.3).astype(np.uint8)
    top, left = rng.integers(0, 5, size=2)
    bottom, right = top + rng.integers(3, 9), left + rng.integers(3, 9)
    cells[top, left] = cells[bottom - 1, right - 1] = 0
    ends = (int(top), int(left)), (int(bottom) - 1, int(right) - 1)
    problem = an.Problem.from_cells(an.GridMap(cells), *ends, corner_rule=rule)
    cropped = an.GridMap(cells[top:bottom, left:right])
    inside = an.Problem.from_cells(cropped, (0, 0), (cropped.rows - 1, cropped.cols - 1), corner_rule=rule)
    expected = exact.shortest_path(inside).length
    size = cropped.rows * cropped.cols
    path, box = np.empty(size, np.int32), (top + 1, bottom + 1, left + 1, right + 1)
    arguments = problem.flat_moves, problem.width, box, problem.to_flat(ends[0]), problem.to_flat(ends[1])
    scratch = np.empty(size, np.uint8), grid_kernels.new_scratch(size)
    steps = grid_kernels.search_box(*arguments, np.inf, *scratch, path, FREE, FREE)
    if steps < 0:
        assert expected == np.inf
        return
    found = problem.from_flat(path[: steps + 1])
    assert an.check_path(found, problem) == pytest.approx(expected)
    assert (found >= [top, left]).all()
    assert (found < [bottom, right]).all()
    assert (
        grid_kernels.search_box(*arguments, expected, *scratch, path, FREE, FREE) == -1
    )  # only shorter than the bound
    assert grid_kernels.search_box(*arguments, expected + 1e-6, *scratch, path, FREE, FREE) == steps


def test_a_longer_way_is_replaced() -> None:
    problem = an.Problem.from_cells(grid_of("......", ".#..#.", "..##.."), (0, 0), (0, 5), corner_rule="allow")
    down = np.array(
        [problem.to_flat(cell) for cell in [(0, 0), (1, 0), (2, 1), (1, 2), (1, 3), (2, 4), (1, 5), (0, 5)]]
    )
    found = windows.improved(down.astype(np.int32), problem.terrain, 9)
    assert problem.from_flat(found).tolist() == [[0, col] for col in range(6)]
