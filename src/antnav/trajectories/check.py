"""A check of trajectories that trusts nothing: numbers, ends, walls, headings and curvature, by code of its own."""

from __future__ import annotations

import math

import numpy as np

from antnav.errors import PathError, check_type
from antnav.kernels import trajectory_kernels
from antnav.trajectories.model import Trajectory
from antnav.values import finite_number
from antnav.world.grid import Cell
from antnav.world.problem import Problem, check_problem

_CLOSE = 1e-6  #: Metres, radians, or a share.


def check_trajectory(
    trajectory: Trajectory, problem: Problem, radius: float | None = None, max_curvature: float | None = None
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
    if poses.ndim != 2 or poses.shape[1:] != (3,) or len(poses) < 2 or not np.isfinite(poses).all():
        raise _broken(f"poses of shape {poses.shape}", "there are two or more, three finite numbers each")
    for end, pose, point in (("start", poses[0], problem.start), ("goal", poses[-1], problem.goal)):
        if tuple(pose[:2].tolist()) != point:
            raise _broken(f"{end} {tuple(pose[:2].tolist())}", f"it must be {point}, exactly")
    steps = np.diff(poses[:, :2], axis=0)
    chords = np.hypot(*steps.T)
    fine = np.concatenate(
        [
            poses[i, :2] + np.arange(count)[:, None] / count * steps[i]
            for i, count in enumerate(np.maximum(np.ceil(chords / (grid.resolution / 10)), 1).astype(int))
        ]
        + [poses[-1:, :2]]
    )
    _check_cells(fine, problem)
    need = trajectory.radius + trajectory.margin if radius is None else finite_number(radius)
    yaw, (x0, y0) = grid.origin[2], grid.origin[:2]
    dx, dy = (poses[:, 0] - x0) / grid.resolution, (poses[:, 1] - y0) / grid.resolution
    line = np.column_stack(
        (dx * math.cos(yaw) + dy * math.sin(yaw) - 0.5, grid.rows - 0.5 - (dy * math.cos(yaw) - dx * math.sin(yaw)))
    )
    cells = need / grid.resolution
    least = float(trajectory_kernels.least_distance(grid.cells, line, cells + 2.0))
    if not least >= cells - _CLOSE:
        raise _broken(f"a distance of {least * grid.resolution} m", f"radius and margin are {need} m")
    turns = np.remainder(np.diff(poses[:, 2]) + math.pi, math.tau) - math.pi
    limit = trajectory.max_curvature if max_curvature is None else finite_number(max_curvature)
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
    return float(chords.sum())


def _check_cells(points: np.ndarray, problem: Problem) -> None:
    """Refuse a centre outside the map, in a wall, or where the problem keeps the robot out."""
    grid = problem.grid
    low, high = grid.corners().min(axis=0), grid.corners().max(axis=0)
    inside = grid.world_to_cell(np.clip(points, low, high))
    inside = np.clip(inside, 0, np.array(grid.shape) - 1)
    kinds = grid.cells[tuple(inside.T)]
    closed = [Cell.OCCUPIED] if problem.allow_unknown else [Cell.OCCUPIED, Cell.UNKNOWN]
    wrong = np.isin(kinds, closed)
    if problem.cost is not None:
        wrong |= problem.cost.blocked[tuple(inside.T)]
    apart = np.abs(grid.cell_to_world(inside) - points).max(axis=1)
    wrong &= _depth(points, inside, problem) > _CLOSE  # on an edge the neighbour counts, too
    wrong |= apart > grid.resolution
    if wrong.any():
        first = int(np.argmax(wrong))
        raise _broken(f"point {tuple(points[first].tolist())}", f"cell {tuple(inside[first].tolist())} is not open")


def _depth(points: np.ndarray, cells: np.ndarray, problem: Problem) -> np.ndarray:
    """How deep points lie in their cells, in cells."""
    grid = problem.grid
    away = (points - grid.cell_to_world(cells)) / grid.resolution
    yaw = grid.origin[2]
    right = away[:, 0] * math.cos(yaw) + away[:, 1] * math.sin(yaw)
    up = away[:, 1] * math.cos(yaw) - away[:, 0] * math.sin(yaw)
    return np.asarray(0.5 - np.maximum(np.abs(right), np.abs(up)))


def _broken(given: str, rule: str) -> PathError:
    return PathError(given, rule, "report this as an error of what made the trajectory")
