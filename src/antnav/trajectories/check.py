"""A check of trajectories that trusts nothing: numbers, ends, walls, headings and curvature, by code of its own."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, PathError, check_type, shown
from antnav.kernels import trajectory_kernels
from antnav.trajectories.footprint import Footprint
from antnav.trajectories.model import Trajectory
from antnav.values import finite_number
from antnav.world.grid import Cell
from antnav.world.problem import Problem, check_problem

_CLOSE = 1e-6  #: Metres, radians, or a share.


def check_trajectory(
    trajectory: Trajectory,
    problem: Problem,
    radius: float | None = None,
    max_curvature: float | None = None,
    footprint: Footprint | str | Sequence[Sequence[float]] | None = None,
) -> float:
    """Verify a trajectory against the raw map, sharing no code with what made it.

    Parameters
    ----------
    trajectory : Trajectory
    problem : Problem
    radius : float, optional
        Metres that the line through the poses must keep from the squares of occupied cells; default: what the
        trajectory claims to keep, radius and margin.
    max_curvature : float, optional
        Limit in 1/m of what the poses bend; default: what the trajectory claims.
    footprint : Footprint, str, or sequence of (x, y), optional
        Must keep the trajectory's margin from occupied cells, at a tenth of a cell; default: the trajectory's own.

    Returns
    -------
    float
        The length in metres of the line through the poses, added up anew.

    Raises
    ------
    PathError
        The first rule that is broken.
    """
    check_type("trajectory", trajectory, Trajectory, "make one with antnav.trajectory")
    check_problem(problem)
    poses, grid = trajectory.poses, problem.grid
    if poses.ndim != 2 or poses.shape[1:] != (3,) or not len(poses) or not np.isfinite(poses).all():
        raise _broken(f"poses of shape {poses.shape}", "there are some, three finite numbers each")
    for end, pose, point in (("start", poses[0], problem.start), ("goal", poses[-1], problem.goal)):
        if tuple(pose[:2].tolist()) != point:
            raise _broken(f"{end} {tuple(pose[:2].tolist())}", f"it must be {point}, exactly")
    yaw = grid.origin[2]
    dx, dy = (poses[:, :2] - grid.origin[:2]).T / grid.resolution
    x = dx * math.cos(yaw) + dy * math.sin(yaw) - 0.5  # whole numbers at centres of cells
    y = grid.rows - 0.5 - (dy * math.cos(yaw) - dx * math.sin(yaw))
    line = np.column_stack((np.append(x, x[-1]), np.append(y, y[-1])))
    _check_cells(line, problem)
    need = trajectory.radius + trajectory.margin if radius is None else _number("radius", radius)
    cells = need / grid.resolution
    least = float(trajectory_kernels.least_distance(grid.cells, line, cells + 2.0))
    if not least >= cells - _CLOSE:
        raise _broken(f"a distance of {least * grid.resolution} m", f"radius and margin are {need} m")
    outline = trajectory.footprint if footprint is None else Footprint.of(footprint)
    if outline is not None:
        _check_body(np.column_stack((x, y, -poses[:, 2])), outline, trajectory.margin, problem)
    _check_bends(poses, trajectory.max_curvature if max_curvature is None else _number("max_curvature", max_curvature))
    return float(np.hypot(*np.diff(poses[:, :2], axis=0).T).sum())


def _check_cells(line: NDArray[np.float64], problem: Problem) -> None:
    """Refuse a centre outside the map, in a wall, or where the problem keeps the robot out, each tenth of a cell."""
    steps = np.diff(line, axis=0)
    counts = np.maximum(np.ceil(10 * np.hypot(*steps.T)), 1).astype(np.int64)
    chord = np.repeat(np.arange(len(steps)), counts)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chord]
    points = line[chord] + share[:, None] * steps[chord]
    nearest = np.rint(points)
    col, row = nearest.T.astype(np.int64)
    rows, cols = problem.grid.shape
    outside = (row < 0) | (row >= rows) | (col < 0) | (col >= cols)
    row, col = np.clip(row, 0, rows - 1), np.clip(col, 0, cols - 1)
    wrong = np.isin(problem.grid.cells[row, col], [Cell.OCCUPIED] + [Cell.UNKNOWN] * (not problem.allow_unknown))
    if problem.grid.covered is not None and not problem.allow_unknown:
        wrong |= problem.grid.covered[row, col] & (problem.grid.cells[row, col] == Cell.INFLATED)
    if problem.cost is not None:
        wrong |= problem.cost.blocked[row, col]
    wrong = (wrong | outside) & (np.abs(points - nearest).max(axis=1) < 0.5 - _CLOSE)  # on an edge two cells count
    if wrong.any():
        first = int(np.argmax(wrong))
        raise _broken(f"cell {(int(row[first]), int(col[first]))}", "it is outside the map or not open")


def _check_body(poses: NDArray[np.float64], footprint: Footprint, margin: float, problem: Problem) -> None:
    """Refuse a pose in which the robot is nearer to an occupied cell than the margin, each tenth of a cell."""
    side = problem.grid.resolution
    steps = np.diff(poses, axis=0)
    steps[:, 2] = np.remainder(steps[:, 2] + math.pi, math.tau) - math.pi
    moved = np.hypot(*steps[:, :2].T) + footprint.circumscribed / side * np.abs(steps[:, 2])
    counts = np.maximum(np.ceil(10 * moved), 1).astype(np.int64)
    chord = np.repeat(np.arange(len(steps)), counts)
    share = (np.arange(len(chord)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chord]
    dense = np.concatenate((poses[chord] + share[:, None] * steps[chord], poses[-1:]))
    dense[:, 2] += problem.grid.origin[2]
    corners = np.array([(x, -y) for x, y in footprint.points]) / side
    need = margin / side
    least = float(trajectory_kernels.body_distance(problem.grid.cells, corners, dense, need + 2.0))
    if not least >= max(need - _CLOSE, _CLOSE):
        raise _broken(f"a distance of {least * side} m from the footprint", f"the margin is {margin} m, and > 0")


def _check_bends(poses: NDArray[np.float64], limit: float) -> None:
    """Refuse poses that bend more than the limit, or do not head where the robot drives."""
    steps = np.diff(poses[:, :2], axis=0)
    chords = np.hypot(*steps.T)
    turns = np.remainder(np.diff(poses[:, 2]) + math.pi, math.tau) - math.pi
    moving = chords > 0
    # an arc that turns by a has the chord 2 r sin(a / 2), in the mean of both headings
    bent = 2 * np.abs(np.sin(turns[moving] / 2)) / chords[moving]
    if not (bent <= limit * (1 + _CLOSE) + _CLOSE / np.maximum(chords[moving], _CLOSE)).all():
        raise _broken(f"a curvature of {bent.max()} / m", f"the limit is {limit} / m")
    if not moving.all() and math.isfinite(limit):
        raise _broken("a turn on the spot", f"the limit of curvature is {limit} / m")
    towards = np.arctan2(steps[moving, 1], steps[moving, 0])
    off = np.remainder(poses[:-1, 2][moving] + turns[moving] / 2 - towards + math.pi, math.tau) - math.pi
    if not (np.abs(off) * chords[moving] <= _CLOSE + 1e-3 * chords[moving] * (np.abs(turns[moving]) > _CLOSE)).all():
        raise _broken(f"a heading that is {np.abs(off).max()} rad off", "poses head where the robot drives")


def _number(name: str, given: object) -> float:
    number = finite_number(given)
    if not number >= 0:
        raise ParameterError(f"{name} {shown(given)}", "it is a finite number, >= 0", "give one, or leave it out")
    return number


def _broken(given: str, rule: str) -> PathError:
    return PathError(given, rule, "report this as an error of what made the trajectory")
