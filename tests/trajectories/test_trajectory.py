"""Trajectories on real maps and drawn ones: ends, walls, curvature; what is refused."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from tests.conftest import grid_of


def least_distance(points: np.ndarray, grid: an.GridMap) -> float:
    """Metres from a line to the squares of occupied cells, by brute force at a tenth of a cell."""
    fine = np.concatenate([np.linspace(a, b, 11) for a, b in itertools.pairwise(points)])
    squares = grid.cell_to_world(np.argwhere(grid.cells == an.Cell.OCCUPIED))
    least = math.inf
    for part in np.array_split(fine, max(len(fine) // 100, 1)):
        gaps = np.maximum(np.abs(part[:, None] - squares) - grid.resolution / 2, 0)
        least = min(least, float(np.hypot(gaps[..., 0], gaps[..., 1]).min()))
    return least


def test_around_a_corner() -> None:
    grid = an.GridMap(np.pad(np.ones((10, 10), np.uint8), ((10, 0), (10, 0))), 0.1)
    problem = an.Problem.from_cells(grid.inflated(0.2, strict=True), (18, 3), (3, 18))
    path = an.exact.optimum(problem).path
    assert path is not None
    made = an.trajectory(path, problem, radius=0.2, max_curvature=2.5)
    assert made.smooth
    assert made.max_curvature <= 2.5
    assert 0.2 <= made.wall_distance == pytest.approx(least_distance(made.points, grid), abs=0.01)
    assert math.dist(problem.start, problem.goal) < made.length < path.length_m
    assert np.hypot(*np.diff(made.points, axis=0).T).max() <= 0.05 + 1e-9
    assert an.check_trajectory(made, problem, 0.2, 2.5) == pytest.approx(made.length, rel=1e-3)
    assert (tuple(made.points[0]), tuple(made.points[-1])) == (problem.start, problem.goal)


def drawn(grid: an.GridMap, need: float, count: int, seed: int) -> list[an.Problem]:
    closed, draw = grid.inflated(need, strict=True), np.random.default_rng(seed)
    cells = np.argwhere(closed.cells == an.Cell.FREE)
    problems = []
    while len(problems) < count:
        one, other = cells[draw.integers(len(cells), size=2)].tolist()
        problem = an.Problem.from_cells(closed, tuple(one), tuple(other))
        if problem.connected and one != other:
            problems.append(problem)
    return problems


@pytest.mark.filterwarnings("ignore::antnav.maps.MapWarning")
@pytest.mark.parametrize(("name", "radius", "limit"), [("depot", 0.2, 2.0), ("warehouse", 0.25, None)])
@pytest.mark.slow
def test_nothing_is_touched_on_real_maps(data: Path, name: str, radius: float, limit: float | None) -> None:
    grid = an.load_map(data / "ros" / "nav2_bringup" / f"{name}.yaml")
    smooth = 0
    for problem in drawn(grid, radius + 0.05, 100, 4):
        path = an.exact.shortest_path(problem).path
        assert path is not None
        made = an.trajectory(path, problem, radius=radius, margin=0.05, max_curvature=limit)
        an.check_trajectory(made, problem, radius + 0.05)
        assert made.wall_distance >= radius + 0.05 - 1e-9
        smooth += made.smooth
        if made.smooth and limit:
            assert made.max_curvature <= limit * (1 + 1e-9)
    assert smooth >= 95


def test_what_is_refused() -> None:
    problem = an.Problem.from_cells(grid_of("....", "....", "..#."), (0, 0), (0, 3))
    path = an.exact.optimum(problem).path
    assert path is not None
    for odd in (
        {"spacing": 0},
        {"spacing": math.nan},
        {"radius": -1},
        {"margin": "wide"},
        {"max_curvature": 0},
        {"start_heading": math.nan},
        {"goal_heading": math.inf},
        {"radius": 3.0},
        {"margin": 1e9},
    ):
        with pytest.raises(ParameterError):
            an.trajectory(path, problem, **odd)  # type: ignore[arg-type]
