"""Jump point search in boxes and below bounds, against A* and jumps taken cell by cell."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.kernels import grid_kernels, jump_kernels
from antnav.kernels.bits import lowest_bit
from antnav.world.moves import STEPS, CornerRule
from antnav.world.path_cost import FREE


def drawn(seed: int, rows: int, cols: int, density: float, blocks: bool) -> np.ndarray:
    """A map of single cells or of blocks of three, with two free corners."""
    rng = np.random.default_rng(seed)
    side = 3 if blocks else 1
    coarse = rng.random((-(-rows // side), -(-cols // side))) < density
    cells = np.kron(coarse, np.ones((side, side)))[:rows, :cols].astype(np.uint8)
    cells[0, 0] = cells[-1, -1] = 0
    return cells


def in_box(terrain: an.Terrain, box: tuple[int, int, int, int], start: int, goal: int) -> tuple[float, int]:
    """Length of a shortest path in a box and number of its cells, by A*."""
    size = (box[1] - box[0]) * (box[3] - box[2])
    path = np.empty(size, np.int32)
    scratch = grid_kernels.new_scratch(size), path, FREE, grid_kernels.room(FREE, size)
    question = terrain.flat_moves, terrain.width, box, start, goal, math.inf, np.empty(size, np.uint8)
    steps = grid_kernels.search_box(*question, *scratch)
    return (grid_kernels.length_along(path[: steps + 1], terrain.width), steps + 1) if steps >= 0 else (math.inf, 0)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    rows=st.integers(1, 40),
    cols=st.integers(2, 150),
    tall=st.booleans(),
    density=st.floats(0, 0.5),
    blocks=st.booleans(),
    seed=st.integers(0, 2**32 - 1),
    rule=st.sampled_from(list(CornerRule)),
)
def test_jumps_find_what_a_star_finds(
    rows: int, cols: int, tall: bool, density: float, blocks: bool, seed: int, rule: CornerRule
) -> None:
    cells = drawn(seed, rows, cols, density, blocks)
    terrain = an.Terrain.of(an.GridMap(cells.T if tall else cells), rule)
    graph = terrain.flat_moves, terrain.width, terrain.jumps
    rng = np.random.default_rng(seed)
    free = np.argwhere(terrain.passable)
    height, width = terrain.grid.shape
    for corners in [free[[0, -1]], *(free[rng.integers(len(free), size=2)] for _ in range(4))]:
        start, goal = (terrain.to_flat((row, col)) for row, col in corners.tolist())
        (top, left), (bottom, right) = corners.min(axis=0), corners.max(axis=0) + 1
        wider = rng.integers(0, 9, 4)
        box = max(1, top + 1 - wider[0]), min(height + 1, bottom + 1 + wider[1])
        box += max(1, left + 1 - wider[2]), min(width + 1, right + 1 + wider[3])
        for where in ((1, height + 1, 1, width + 1), tuple(map(int, box))):
            length, cells_on_it = in_box(terrain, where, start, goal)
            path, expanded = jump_kernels.jump_search(*graph, where, start, goal, math.inf)
            assert len(path) == cells_on_it
            assert expanded > 0
            if not cells_on_it:
                continue
            assert [path[0], path[-1]] == [start, goal]
            assert grid_kernels.length_along(path, terrain.width) == length
            ends = [tuple(map(int, corner)) for corner in corners]
            an.check_path(terrain.from_flat(path), an.Problem.from_cells(terrain.grid, *ends, corner_rule=rule))
            assert (terrain.from_flat(path) + 1 >= where[::2]).all()
            assert (terrain.from_flat(path) + 1 < where[1::2]).all()
            back, _ = jump_kernels.jump_search(*graph, where, goal, start, length + 1e-6)
            assert grid_kernels.length_along(back, terrain.width) == length
            if length > 0:
                assert not len(jump_kernels.jump_search(*graph, where, start, goal, length)[0])


@pytest.mark.parametrize("rule", CornerRule)
def test_a_jump_goes_on_to_the_first_cell_that_forces_a_turn(rule: CornerRule) -> None:
    """Along every row and column, both ways, cell by cell."""
    terrain = an.Terrain.of(an.GridMap(drawn(7, 70, 135, 0.2, blocks=True)), rule)
    moves, width, jumps = terrain.flat_moves, terrain.width, terrain.jumps
    box = 1, terrain.grid.rows + 1, 1, terrain.grid.cols + 1
    found = np.empty((600, 4), np.int32)
    for cell in np.random.default_rng(1).choice(np.flatnonzero(moves), 400):
        for k in (1, 3, 4, 6):
            step = STEPS[k][0] * width + STEPS[k][1]
            at, forced = cell, 0
            while not forced and moves[at] >> k & 1:
                at += step
                forced = jumps.onward[k, moves[at]] & ~np.uint8(1 << k)
            count = jump_kernels._successors(moves, width, jumps, box, 0, int(cell), 1 << k, found)
            expected = [[at, abs(at - cell) // abs(step), 0, jumps.onward[k, moves[at]]]] if forced else []
            assert found[:count].tolist() == expected


def test_the_lowest_bit_of_every_word() -> None:
    for place in range(64):
        for word in (1 << place, (1 << place) | -(1 << 63), -1 << place):
            assert lowest_bit(np.int64(word - (1 << 64) if word >= 1 << 63 else word)) == place
