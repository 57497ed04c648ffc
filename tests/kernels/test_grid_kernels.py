"""Searches on the padded map where no result of a whole plan would show the difference."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.kernels import grid_kernels
from antnav.search import exact, windows
from antnav.world.moves import STEPS, CornerRule
from antnav.world.path_cost import FREE
from tests.conftest import grid_of


def test_ties_are_broken_towards_the_goal() -> None:
    """On open ground every cell between the ends is as good; only those of one path are looked at."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((9, 12), np.uint8)), (4, 6), (0, 0))
    start = problem.to_flat((4, 6))
    for cell in np.ndindex(9, 12):
        ends = start, problem.to_flat(cell)
        *_, expanded = grid_kernels.search(problem.flat_moves, problem.width, *ends, True, FREE)
        assert expanded == max(abs(cell[0] - 4), abs(cell[1] - 6)) + 1


def test_a_flood_counts_what_it_sees() -> None:
    problem = an.Problem.from_cells(grid_of("..#.", ".##.", "...#"), (0, 0), (2, 2))
    seen, count = grid_kernels.flood(problem.flat_moves, problem.width, problem.flat_ends[0])
    assert count == seen.sum() == 6
    assert problem.from_flat(np.flatnonzero(seen)).tolist() == [[0, 0], [0, 1], [1, 0], [2, 0], [2, 1], [2, 2]]


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    density=st.floats(0, 0.5),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
    block=st.integers(4, 9),
)
def test_a_route_is_shortest_within_each_block(density: float, seed: int, rule: CornerRule, block: int) -> None:
    """Each piece equals an exact search on the map of its block alone."""
    cells = (np.random.default_rng(seed).random((13, 15)) < density).astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (12, 14), corner_rule=rule)
    short = an.prepare(problem.grid, rule, block=block)
    regions = short.between(*problem.flat_ends) if problem.connected else None
    if regions is None:
        return
    nodes, distance = [regions.start], regions.distances_to(regions.goal)
    while nodes[-1] != regions.goal:
        around = [j for j in regions.graph.neighbours[nodes[-1]] if j < len(regions) and j not in nodes]
        nodes.append(min(around, key=lambda j: distance[j]))
    stops = short.stops(np.array(nodes, np.int32), regions, *problem.flat_ends)
    path = windows.laid_out(stops, short)
    an.check_path(problem.from_flat(path), problem)
    ends = problem.from_flat(stops).tolist()
    assert [path[0], path[-1]] == [stops[0], stops[-1]]
    place = 0
    for one, other in zip(ends[::2], ends[1::2], strict=True):
        top, left = (x // block * block for x in one)
        inside = an.GridMap(cells[top : top + block, left : left + block])
        moved = [(row - top, col - left) for row, col in (one, other)]
        piece = exact.shortest_path(an.Problem.from_cells(inside, *moved, corner_rule=rule))
        first, place = place, place + len(piece.path)
        found = problem.from_flat(path[first:place])
        assert [found[0].tolist(), found[-1].tolist()] == [one, other]
        assert grid_kernels.length_along(path[first:place], problem.width) == pytest.approx(piece.length)
    assert place == len(path)


def test_only_cells_that_follow_each_other_are_joined_by_a_line() -> None:
    """From the last cell to the second one a line would pass the obstacle; the path goes round far from it."""
    walk = [*((0, col) for col in range(9)), *((row, 8) for row in range(1, 7))]
    cells = np.zeros((7, 9), np.uint8)
    cells[6, 1] = 1
    rows_to_wall = an.GridMap(cells).rows_to_wall
    assert grid_kernels.distance_to_walls(rows_to_wall, np.array(walk, np.int32), True) == 5.5


@pytest.mark.parametrize(("entry", "onward", "by"), [((0, 1), (1, 1), (0, 1)), ((1, 1), (0, 1), (1, 1))])
def test_turns_into_a_piece_and_out_of_it_count(
    entry: tuple[int, int], onward: tuple[int, int], by: tuple[int, int]
) -> None:
    """Two cells right and one down: straight or diagonal first, whichever the way before and after goes on with."""
    problem = an.Problem.from_cells(an.GridMap(np.zeros((5, 7), np.uint8)), (1, 2), (2, 4), turning=1.0)
    turns, slots = problem.objective.turns(), [STEPS.index(entry), STEPS.index(onward)]
    assert turns is not None
    question = problem.flat_moves, problem.width, *problem.flat_ends, True, problem.objective.prices, turns
    for bound in (math.inf, 4.0):
        cost, path, _ = grid_kernels.search_turning(*question, slots[0] + 1, slots[1], bound)
        assert cost == pytest.approx(1 + math.sqrt(2) + math.pi / 4)
        assert problem.from_flat(path)[1].tolist() == [1 + by[0], 2 + by[1]]
    assert not len(grid_kernels.search_turning(*question, slots[0] + 1, slots[1], 3.0)[1])
