"""Footprints: what is read, and drives on which the polygon keeps off walls, measured by brute force."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError, PathError

LONG = [(0.4, 0.12), (0.4, -0.12), (-0.2, -0.12), (-0.2, 0.12)]


def test_what_is_known_of_it() -> None:
    long = an.Footprint(LONG)  # type: ignore[arg-type]
    assert (long.inscribed, long.circumscribed) == (pytest.approx(0.12), pytest.approx(math.hypot(0.4, 0.12)))
    assert long.padded(0.03).inscribed == pytest.approx(0.15)
    assert long == an.Footprint.of_nav2(" [[.4, 0.12], [.4, -0.12], [-.2, -0.12], [0.1, 0], [-.2, 0.12]] ")
    disc = an.Footprint.disc(0.5)
    assert len(disc.points) == 16
    assert disc.circumscribed == pytest.approx(0.5)
    assert disc.inscribed == pytest.approx(0.5 * math.cos(math.pi / 16))


@pytest.mark.parametrize(
    "odd",
    [[], [(0, 1)], "[[1, 2]", "open(0)", [(0, 0), (1, 1), (2, 2)], [(1, 1), (2, 1), (1, 2)], [(0, math.nan)] * 3, 7],
)
def test_what_is_no_footprint(odd: object) -> None:
    with pytest.raises(ParameterError, match="footprint"):
        an.Footprint.of(odd)


def room(draw: np.random.Generator) -> an.GridMap:
    cells = np.pad((draw.random((70, 90)) < 0.004).astype(np.uint8), 1, constant_values=1)
    return an.GridMap(cells, 0.05, (2.0, -3.0, float(draw.uniform(-1, 1))))


def covered(drive: an.Trajectory, grid: an.GridMap, corners: np.ndarray) -> float:
    """Least distance in metres from occupied squares of points that fill the polygon, in poses at a fine spacing."""
    share = np.linspace(0, 1, 25)
    outline = np.concatenate(
        [a + share[:, None] * (b - a) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    )
    filled = np.concatenate([outline * scale for scale in (0.2, 0.5, 0.8, 1.0)])
    occupied = np.argwhere(grid.cells == an.Cell.OCCUPIED)[:, ::-1]
    least = math.inf
    for x, y, heading in drive.poses:
        turn = np.array(((math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading))))
        local = (filled @ turn + (x, y) - grid.origin[:2]) / grid.resolution
        yaw = grid.origin[2]
        right = local[:, 0] * math.cos(yaw) + local[:, 1] * math.sin(yaw) - 0.5
        down = grid.rows - 0.5 - (local[:, 1] * math.cos(yaw) - local[:, 0] * math.sin(yaw))
        near = occupied[np.hypot(*(occupied - (right.mean(), down.mean())).T) < 25]
        gaps = np.maximum(np.abs(np.column_stack((right, down))[:, None] - near) - 0.5, 0)
        least = min(least, float(np.hypot(gaps[..., 0], gaps[..., 1]).min(initial=math.inf)) * grid.resolution)
    return least


@pytest.mark.parametrize("seed", range(12))
def test_the_polygon_keeps_its_margin(seed: int) -> None:
    draw = np.random.default_rng(seed)
    grid, long = room(draw), an.Footprint(LONG)  # type: ignore[arg-type]
    closed = grid.inflated(long.inscribed + 0.02, strict=True)
    free = np.argwhere(closed.cells == an.Cell.FREE).tolist()
    start, goal = (tuple(free[i]) for i in draw.integers(len(free), size=2))
    problem = an.Problem.from_cells(closed, start, goal)  # type: ignore[arg-type]
    path = an.exact.optimum(problem).path
    if path is None:
        pytest.skip("no path")
    limit = [None, 2.0][seed % 2]
    try:
        drive = an.trajectory(path, problem, footprint=LONG, margin=0.02, max_curvature=limit, spacing=0.02)
    except ParameterError as error:
        assert "footprint" in error.rule + error.given
        return
    assert drive.footprint == long
    assert covered(drive, grid, long.corners) >= 0.02 - 2e-3
    an.check_trajectory(drive, problem)
    with pytest.raises(PathError, match=r"from the footprint|a distance of"):
        an.check_trajectory(drive, problem, footprint=[(9, 9), (-9, 9), (0, -9)])


def corridor() -> an.GridMap:
    """A corridor of nine cells with a corner in which a long robot has little room."""
    cells = np.ones((60, 60), np.uint8)
    cells[5:55, 5:14] = 0
    cells[46:55, 5:55] = 0
    return an.GridMap(cells, 0.05)


def test_on_the_spot_the_polygon_sweeps_walls() -> None:
    problem = an.Problem.from_cells(corridor().inflated(0.13, strict=True), (12, 9), (50, 30))
    path = an.exact.optimum(problem).path
    assert path is not None
    disc = an.trajectory(path, problem, radius=0.12)
    corners = problem.grid.cell_to_world([(12, 9), (50, 9), (50, 30)])
    poses = np.array([(*corners[0], -math.pi / 2), (*corners[1], -math.pi / 2), (*corners[1], 0.0), (*corners[2], 0.0)])
    turning = replace(disc, poses=poses, curvature=np.array((0, math.inf, math.inf, 0)), smooth=False, note="")
    an.check_trajectory(turning, problem)
    an.check_trajectory(turning, problem, footprint=[(0.2, 0.1), (0.2, -0.1), (-0.2, -0.1), (-0.2, 0.1)])
    with pytest.raises(PathError, match="from the footprint"):
        an.check_trajectory(turning, problem, footprint=LONG)
    with pytest.raises(ParameterError, match="no drive was found on which it keeps the margin"):
        an.trajectory(path, problem, footprint=[(1.0, 0.1), (1.0, -0.1), (-0.2, -0.1), (-0.2, 0.1)])
    with pytest.raises(ParameterError, match=r"start .* with heading 0 the footprint does not keep"):
        an.trajectory(path, problem, footprint=LONG, start_heading=0.0)
    with pytest.raises(ParameterError, match="disc or a polygon"):
        an.trajectory(path, problem, footprint=LONG, radius=0.2)
    with pytest.raises(ParameterError, match="for a footprint"):
        an.trajectory(path, problem, footprint_padding=0.1)


def test_files_tell_it(tmp_path: Path) -> None:
    grid = an.GridMap(np.zeros((20, 20), np.uint8), 0.1)
    problem = an.Problem.from_cells(grid, (3, 3), (15, 15))
    path = an.exact.optimum(problem).path
    assert path is not None
    drive = an.trajectory(path, problem, footprint="[[0.3, 0.1], [0.3, -0.1], [-0.3, 0.0]]", footprint_padding=0.01)
    assert drive.smooth
    assert drive.to_dict()["footprint"] == drive.footprint.points  # type: ignore[union-attr]
    drive.save(tmp_path / "drive.json")
    assert an.Trajectory.load(tmp_path / "drive.json", grid).footprint == drive.footprint
