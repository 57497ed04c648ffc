"""A moved disc against squares, by brute force: points of the segment at a hundredth of a cell, every square."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an
from antnav.kernels import trajectory_kernels as kernels
from antnav.trajectories.pieces import along

Line = np.ndarray


def drawn(seed: int) -> tuple[np.ndarray, kernels.Ground, Line]:
    draw = np.random.default_rng(seed)
    cells = (draw.random(draw.integers(3, 14, 2)) < draw.choice([0.05, 0.2])).astype(np.uint8)
    line = draw.uniform(-0.4, np.array(cells.shape)[::-1] - 0.6, (2, 2))
    if seed % 4 == 0:
        line[1, seed // 4 % 2] = line[0, seed // 4 % 2]  # upright, or level
    if seed % 5 == 0:
        line = np.rint(line)
    ground = kernels.Ground(an.GridMap(cells).rows_to_wall, cells.copy(), np.zeros((0, 0)))
    return cells, ground, line


def naive_distance(cells: np.ndarray, line: Line) -> float:
    share = np.linspace(0, 1, 100 * math.ceil(math.dist(*line)) + 1)[:, None]
    points = line[0] + share * (line[1] - line[0])
    squares = np.argwhere(cells)[:, ::-1]
    gaps = np.maximum(np.abs(points[:, None] - squares) - 0.5, 0)
    return float(np.hypot(gaps[..., 0], gaps[..., 1]).min(initial=math.inf))


@pytest.mark.parametrize("seed", range(100))
def test_clear_and_distance(seed: int) -> None:
    cells, ground, line = drawn(seed)
    least = naive_distance(cells, line)
    found = kernels.least_distance(cells, line, 99.0)
    assert found <= min(least, 99.0) + 1e-12
    assert found == pytest.approx(min(least, 99.0), abs=0.006)
    for need in (0.3, 1.0, 2.7):
        if abs(least - need) > 0.006:
            assert kernels.clear(ground, *line[0], *line[1], need) == (least > need)
    if abs(found) > 0.006:
        assert kernels.clear(ground, *line[0], *line[1], found - 1e-7)
        assert not kernels.clear(ground, *line[0], *line[1], found + 1e-7) or found == 99


def test_outside_of_the_map_nothing_is_clear() -> None:
    cells = np.zeros((4, 5), np.uint8)
    ground = kernels.Ground(an.GridMap(cells).rows_to_wall, cells, np.zeros((0, 0)))
    assert kernels.clear(ground, 0.0, 0.0, 4.0, 3.0, 0.0)
    for x, y in ((-0.6, 0.0), (4.6, 0.0), (0.0, -0.6), (0.0, 3.6)):
        assert not kernels.clear(ground, 2.0, 2.0, x, y, 0.0)


def test_between_two_closed_cells_that_touch_nothing_is_clear() -> None:
    cells = np.zeros((5, 4), np.uint8)
    cells[2, 1:3] = 1
    ground = kernels.Ground(an.GridMap(cells).rows_to_wall, cells, np.zeros((0, 0)))
    assert not kernels.clear(ground, 1.5, 0.0, 1.5, 4.0, 0.0)  # along the edge between them
    assert not kernels.clear(ground, 1.2, 2.0, 1.2, 2.0, 0.0)
    assert kernels.clear(ground, 0.0, 0.0, 0.0, 4.0, 0.5)


@pytest.mark.parametrize("seed", range(30))
def test_a_pulled_line_is_clear_and_shorter(seed: int) -> None:
    draw = np.random.default_rng(seed)
    cells = (draw.random((20, 25)) < 0.12).astype(np.uint8)
    problem = an.Problem.from_cells(an.GridMap(cells).inflated(0.6, strict=True), *_ends(cells, draw))
    path = an.exact.optimum(problem).path
    if path is None:
        pytest.skip("no path")
    ground = kernels.Ground(problem.grid.rows_to_wall, cells.copy(), np.zeros((0, 0)))
    line = path.cells[:, ::-1].astype(float)
    assert kernels.line_clear(ground, line, 0.6) == -1
    pulled = kernels.pulled(ground, line, 0.6)
    assert kernels.line_clear(ground, pulled, 0.6) == -1
    assert (pulled[0] == line[0]).all()
    assert (pulled[-1] == line[-1]).all()
    assert np.hypot(*np.diff(pulled, axis=0).T).sum() <= path.length + 1e-9


def _ends(cells: np.ndarray, draw: np.random.Generator) -> list[tuple[int, int]]:
    free = np.argwhere(an.GridMap(cells).inflated(0.6, strict=True).cells == 0)
    return [tuple(cell) for cell in free[draw.integers(len(free), size=2)].tolist()]


def polygon(draw: np.random.Generator) -> np.ndarray:
    """A convex polygon around the origin."""
    n = int(draw.integers(3, 9))
    angles = math.tau / n * (np.arange(n) + draw.uniform(0, 0.4, n))
    return draw.uniform(0.8, 3.5) * np.column_stack((np.cos(angles), 0.6 * np.sin(angles)))


def swept_distance(cells: np.ndarray, body: np.ndarray, piece: np.ndarray) -> float:
    """By poses at a two hundredth of the way, and points of the outline at a two hundredth of an edge."""
    squares = np.argwhere(cells)[:, ::-1]
    edges = np.concatenate([np.linspace(a, b, 200) for a, b in zip(body, np.roll(body, -1, 0), strict=True)])
    least = math.inf
    for x, y, heading in along(piece, np.linspace(0, piece[3], 200)):
        turn = np.array(((math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading))))
        gaps = np.maximum(np.abs((edges @ turn + (x, y))[:, None] - squares) - 0.5, 0)
        least = min(least, float(np.hypot(gaps[..., 0], gaps[..., 1]).min(initial=math.inf)))
        local = (squares - (x, y)) @ turn.T
        ahead = np.roll(body, -1, 0) - body
        sides = ahead[:, 0] * (local[:, None, 1] - body[:, 1]) - ahead[:, 1] * (local[:, None, 0] - body[:, 0])
        if (sides >= 0).all(axis=1).any():
            return 0.0
    return least


@pytest.mark.parametrize("seed", range(60))
def test_a_polygon_that_turns_as_it_drives(seed: int) -> None:
    draw = np.random.default_rng(seed)
    cells = (draw.random(draw.integers(14, 20, 2)) < 0.02).astype(np.uint8)
    body = polygon(draw)
    ground = kernels.Ground(an.GridMap(cells).rows_to_wall, np.zeros_like(cells), np.zeros((0, 0)), body, 0.0)
    bend = draw.choice([0.0, 0.3, -0.5])
    piece = np.array((8.0, 7.0, draw.uniform(-3, 3), draw.uniform(0.5, 5), bend)) + np.append(
        draw.uniform(-1, 1, 2), [0, 0, 0]
    )
    least = swept_distance(cells, body, piece)
    poses = along(piece, np.linspace(0, piece[3], 400))
    assert kernels.body_distance(cells, body, poses, 3.0) == pytest.approx(min(least, 3.0), abs=0.02)
    for need in (0.0, 0.4, 1.3):
        if kernels.pieces_clear(ground, piece[None], need):
            assert least >= need - 1e-6
        else:
            assert least < need + 0.05


def test_the_corners_of_a_body_in_two_poses() -> None:
    body = np.array(((2.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (2.0, -1.0)))
    ground = kernels.Ground(np.zeros((1, 1), np.int32), np.zeros((1, 1), np.uint8), np.zeros((0, 0)), body, 1.0)
    hull = kernels._corners(ground, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0)
    assert sorted(map(tuple, hull[:-1].tolist())) == [(-1, -1), (-1, 1), (5, -1), (5, 1)]
    assert (hull[0] == hull[-1]).all()
