"""Speeds: worked out by hand, beside a slow twin in fine steps, within their limits on drawn curves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.errors import ParameterError
from antnav.trajectories import pieces as curves
from antnav.trajectories.model import Trajectory
from antnav.trajectories.speeds import Limits, driven
from tests.conftest import grid_of

GRID = an.GridMap(np.zeros((4, 4), np.uint8))


def curve_of(*parts: tuple[float, float], spacing: float = 0.05) -> Trajectory:
    """A trajectory of parts, each a length and a curvature."""
    pieces, pose = [], (0.0, 0.0, 0.0)
    for length, curvature in parts:
        pieces.append((*pose, length, curvature))
        pose = curves.end_of(np.array(pieces))
    return Trajectory(*curves.sampled(np.array(pieces), spacing), GRID)


def timed(trajectory: Trajectory, **limits: float) -> Trajectory:
    return driven(trajectory, Limits(**limits).checked())


def naive_duration(parts: list[tuple[float, float]], limits: dict[str, float]) -> float:
    """Seconds, in steps of half a millimetre, each at the speed in its middle."""
    step = 5e-4
    caps = []
    for length, bend in parts:
        cap = limits["max_speed"]
        if bend:
            cap = min(cap, math.sqrt(limits["max_lateral_acceleration"] / abs(bend)))
            cap = min(cap, limits["max_angular_speed"] / abs(bend))
        caps += [cap] * round(length / step)
    squares = [0.0]
    for cap, following in zip(caps, [*caps[1:], 0.0], strict=True):
        squares.append(min(squares[-1] + 2 * limits["max_acceleration"] * step, min(cap, following) ** 2))
    for i in range(len(squares) - 2, -1, -1):
        squares[i] = min(squares[i], squares[i + 1] + 2 * limits["max_acceleration"] * step)
    speeds = np.sqrt(squares)
    return float((2 * step / (speeds[1:] + speeds[:-1])).sum())


def test_by_hand() -> None:
    straight = curve_of((6.0, 0.0))
    made = timed(straight, max_speed=2.0, max_acceleration=1.0)  # 2 s and 2 m to speed up, 1 s at 2 m/s, 2 s to brake
    assert made.duration == pytest.approx(5.0)
    assert made.speeds is not None
    assert (made.speeds[0], made.speeds[-1], made.speeds.max()) == (0.0, 0.0, pytest.approx(2.0))
    assert timed(straight, max_speed=2.0).duration == pytest.approx(3.0)
    assert timed(curve_of((1.0, 0.0), spacing=9.0), max_speed=9.0, max_acceleration=1.0).duration == pytest.approx(2.0)
    bent = timed(curve_of((2.0, 0.5)), max_speed=9.0, max_lateral_acceleration=0.5)
    assert bent.duration == pytest.approx(2.0)
    assert timed(curve_of((2.0, -0.5)), max_speed=9.0, max_angular_speed=0.25).duration == pytest.approx(4.0)


def test_the_robot_stands_while_it_turns_on_the_spot() -> None:
    corner = np.array([(0.0, 0.0, 0.0, 1.0, 0.0), (1.0, 0.0, math.pi / 2, 1.0, 0.0)])
    made = timed(Trajectory(*curves.sampled(corner, 0.5), GRID), max_speed=9, max_acceleration=4, max_angular_speed=0.5)
    assert made.duration == pytest.approx(1.0 + math.pi + 1.0)
    assert made.speeds is not None
    assert np.flatnonzero(made.speeds == 0).tolist() == [0, 2, 3, 5]


PARTS = st.lists(st.tuples(st.floats(0.1, 3), st.sampled_from([0.0, 0.0, 0.5, -1.0, 3.0])), min_size=1, max_size=6)
LIMIT = st.floats(0.05, 3)
NAMES = ("max_speed", "max_acceleration", "max_lateral_acceleration", "max_angular_speed")


@settings(max_examples=25, deadline=None)
@given(PARTS, st.tuples(LIMIT, LIMIT, LIMIT, LIMIT))
def test_as_fast_as_in_fine_steps(parts: list[tuple[float, float]], numbers: tuple[float, ...]) -> None:
    limits = dict(zip(NAMES, numbers, strict=True))
    parts = [(round(length, 2), bend) for length, bend in parts]
    assert timed(curve_of(*parts, spacing=0.3), **limits).duration == pytest.approx(
        naive_duration(parts, limits), rel=0.01
    )


@settings(max_examples=50, deadline=None)
@given(PARTS, st.tuples(LIMIT, LIMIT, LIMIT, LIMIT), st.sampled_from(NAMES), st.floats(0.02, 0.5))
def test_limits_hold_and_larger_ones_are_never_slower(
    parts: list[tuple[float, float]], numbers: tuple[float, ...], larger: str, spacing: float
) -> None:
    limits = dict(zip(NAMES, numbers, strict=True))
    curve = curve_of(*parts, spacing=spacing)
    made = timed(curve, **limits)
    assert made.speeds is not None
    assert made.times is not None
    assert made.duration is not None
    assert (made.speeds <= limits["max_speed"] + 1e-9).all()
    assert (made.speeds**2 * np.abs(curve.curvature) <= limits["max_lateral_acceleration"] + 1e-9).all()
    assert (made.speeds * np.abs(curve.curvature) <= limits["max_angular_speed"] + 1e-9).all()
    pushed = np.abs(np.diff(made.speeds**2)) / 2
    assert (pushed <= limits["max_acceleration"] * np.diff(curve.arc_length) + 1e-9).all()
    assert (np.diff(made.times) > 0).all()
    limits[larger] *= 1.5
    faster = timed(curve, **limits).duration
    assert faster is not None
    assert faster <= made.duration * (1 + 1e-9)


def test_of_a_trajectory_and_in_its_files(tmp_path: Any) -> None:
    problem = an.Problem.from_cells(grid_of("....", "....", ".#.."), (2, 0), (2, 3))
    path = an.exact.optimum(problem).path
    assert path is not None
    plain = an.trajectory(path, problem)
    assert (plain.speeds, plain.times, plain.duration) == (None, None, None)
    assert "duration_s" not in plain.to_dict()
    made = an.trajectory(path, problem, max_speed=1.0, max_acceleration=0.5, max_angular_speed=2.0)
    assert made.duration == pytest.approx(made.to_dict()["duration_s"])
    made.save(tmp_path / "drive.csv")
    table = np.genfromtxt(tmp_path / "drive.csv", delimiter=",", names=True)
    assert table.dtype.names == ("s", "x", "y", "heading", "curvature", "speed", "t")
    assert table["t"][-1] == made.duration
    for odd in (
        {"max_speed": 0},
        {"max_speed": math.nan},
        {"max_acceleration": 1.0},
        {"max_speed": 1.0, "max_angular_speed": "fast"},
    ):
        with pytest.raises(ParameterError):
            an.trajectory(path, problem, **odd)  # type: ignore[arg-type]


@pytest.mark.parametrize("yaw", [0.0, 0.3, 2.0])
def test_it_stands_where_it_turns_on_the_spot(yaw: float) -> None:
    """Both poses are in exactly one place, at the ends, too; a step of one last digit would have a speed."""
    grid = an.GridMap(np.zeros((40, 60), bool), 0.1, (3.0, -2.0, yaw))
    start, goal = grid.cell_to_world([(20.2, 5.3), (8.1, 50.4)]).tolist()
    result = an.solve(an.Problem(grid, tuple(start), tuple(goal)), an.astar())
    drive = result.trajectory(start_heading=3.0, goal_heading=1.0, max_curvature=1e-3, max_speed=0.5)
    assert not drive.smooth
    jumps = np.flatnonzero(np.abs(np.diff(drive.poses[:, 2])) > 1e-6)
    assert len(jumps) >= 2
    assert (drive.points[jumps] == drive.points[jumps + 1]).all()
    assert drive.speeds is not None
    assert (drive.speeds[jumps] == 0).all()
    assert (drive.speeds[jumps + 1] == 0).all()
