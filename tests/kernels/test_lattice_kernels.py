"""A search over poses: what it finds is one curve between its ends, bent no more than asked and clear."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.kernels import lattice_kernels as lattice
from antnav.kernels import trajectory_kernels as kernels
from antnav.trajectories.pieces import along, length_of
from tests.conftest import grid_of


def ground_of(cells: np.ndarray) -> kernels.Ground:
    return kernels.Ground(an.GridMap(cells).rows_to_wall, cells.copy(), np.zeros((0, 0)))


def assert_joined(pieces: np.ndarray, start: np.ndarray, goal: np.ndarray, radius: float) -> None:
    """Pieces follow each other without a corner, from the start to the goal."""
    pose = np.where(np.isnan(start), pieces[0, :3], start)
    for piece in pieces:
        assert piece[:2] == pytest.approx(pose[:2], abs=1e-6)
        assert math.remainder(piece[2] - pose[2], math.tau) == pytest.approx(0, abs=1e-6)
        pose = along(piece, piece[3])
    assert pose[:2] == pytest.approx(goal[:2], abs=1e-6)
    if not math.isnan(goal[2]):
        assert math.remainder(pose[2] - goal[2], math.tau) == pytest.approx(0, abs=1e-6)
    assert np.abs(pieces[:, 4]).max() <= 1 / radius + 1e-9


@pytest.mark.parametrize("seed", range(30))
def test_a_way_is_one_curve_and_clear_and_made_shorter(seed: int) -> None:
    draw = np.random.default_rng(seed)
    cells = (draw.random((40, 50)) < 0.02).astype(np.uint8)
    ground, need = ground_of(cells), 0.8
    free = [(x, y) for y, x in np.argwhere(cells == 0).tolist() if kernels.clear(ground, x, y, x, y, need)]
    heads = draw.uniform(-3, 3, 2)
    heads[draw.random(2) < 0.3] = math.nan
    start, goal = (np.array((*free[draw.integers(len(free))], heading)) for heading in heads)
    found, looked = lattice.search(ground, start, goal, 4.0, need, 20_000)
    assert 0 < looked <= 20_000
    if not len(found):
        pytest.skip("none was found")
    assert kernels.pieces_clear(ground, found, need)
    assert_joined(found, start, goal, 4.0)
    short = lattice.shortened(ground, found, goal, 4.0, need)
    assert kernels.pieces_clear(ground, short, need)
    assert_joined(short, start, goal, 4.0)
    assert length_of(short) <= length_of(found) + 1e-6


def test_where_none_leads_on_the_search_ends() -> None:
    cells = np.ones((9, 30), np.uint8)
    cells[1:8, 1:29] = 0
    ground = ground_of(cells)
    start, goal = np.array((20.0, 4.0, 0.0)), np.array((5.0, 4.0, math.nan))
    found, looked = lattice.search(ground, start, goal, 4.0, 1.0, 50_000)  # it looks away, and cannot turn
    assert (len(found), looked < 2_000) == (0, True)
    found, _ = lattice.search(ground, np.array((20.0, 4.0, math.nan)), goal, 4.0, 1.0, 50_000)
    assert length_of(found) == pytest.approx(15.0, rel=0.05)
    walled = ground_of(grid_of("..#..", "..#..").cells.copy())
    assert lattice.search(walled, np.array((0.0, 0, 0)), np.array((4.0, 0, 0)), 1.0, 0.1, 99)[1] == 0


def test_an_arc_and_a_line_where_the_heading_is_free() -> None:
    ground = ground_of(np.zeros((20, 20), np.uint8))
    start, goal = np.array((5.0, 5.0, 0.0)), np.array((9.0, 15.0, math.nan))
    found = lattice.onto(ground, start, goal, 4.0, 0.0)
    assert_joined(found, start, goal, 4.0)
    assert length_of(found) == pytest.approx(4 * math.pi / 2 + 6)
    within = np.array((5.0, 6.0, math.nan))  # of the circle to one side: the other one leads there
    assert_joined(lattice.onto(ground, np.array((5.0, 5.0, 0.0)), within, 2.0, 0.0), start, within, 2.0)
