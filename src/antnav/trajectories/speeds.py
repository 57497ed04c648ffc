"""Speeds along a curve: as fast as limits of speed, acceleration and turning allow, from rest to rest.

A forward and a backward pass over the poses: J. E. Bobrow, S. Dubowsky & J. S. Gibson, Time-optimal control of robotic
manipulators along specified paths, International Journal of Robotics Research 4(3) (1985) 3-17, doi
10.1177/027836498500400301; that two passes are enough for a car: L. Consolini, M. Locatelli, A. Minari & A. Piazzi, An
optimal complexity algorithm for minimum-time velocity planning, Systems & Control Letters 103 (2017) 50-57, doi
10.1016/j.sysconle.2017.02.001 [source].
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.trajectories.model import Trajectory
from antnav.values import finite_number

_Values = NDArray[np.float64]


@dataclass(frozen=True)
class Limits:
    """What a robot may do: m/s, m/s^2 along the curve and across it, rad/s; None for no limit."""

    max_speed: float | None = None
    max_acceleration: float | None = None
    max_lateral_acceleration: float | None = None
    max_angular_speed: float | None = None

    @property
    def given(self) -> bool:
        """Whether there is any."""
        return any(getattr(self, limit.name) is not None for limit in fields(self))

    def checked(self) -> Limits:
        """The limits as numbers, inf where there is none, or a `ParameterError`."""
        numbers = {limit.name: _positive(limit.name, getattr(self, limit.name)) for limit in fields(self)}
        if self.given and self.max_speed is None:
            rule = "speeds need a limit on straight lines, too"
            raise ParameterError("limits without max_speed", rule, "give one in m/s, such as max_speed=0.5")
        return Limits(**numbers)


def driven(trajectory: Trajectory, limits: Limits) -> Trajectory:
    """The trajectory with the highest speeds within checked limits, and the times at which each pose is reached.

    Lines and arcs have one limit each, so the times are exact, not sums over steps: between two poses the robot
    accelerates, drives at the limit, and brakes. Where it turns on the spot it stands.
    """
    most, push, aside, turn = (getattr(limits, limit.name) for limit in fields(limits))
    steps = np.diff(trajectory.arc_length)
    turns = np.abs(np.remainder(np.diff(trajectory.poses[:, 2]) + math.pi, math.tau) - math.pi)
    moving = steps > 0
    bends = np.divide(turns, steps, out=np.zeros_like(steps), where=moving)
    bent = np.where(np.isfinite(trajectory.curvature), np.abs(trajectory.curvature), 0.0)
    with np.errstate(divide="ignore"):
        caps = np.minimum(most, np.minimum(np.sqrt(aside / bends), turn / bends))
        own = np.minimum(np.sqrt(aside / bent), turn / bent)
    speeds = np.minimum(own, np.minimum(np.append(caps, 0.0), np.insert(caps, 0, 0.0)))
    speeds[:-1][~moving] = speeds[1:][~moving] = 0.0
    if math.isfinite(push):
        s = 2 * push * trajectory.arc_length
        squares = speeds**2
        ahead = np.minimum.accumulate(squares - s) + s
        back = np.minimum.accumulate((squares + s)[::-1])[::-1] - s
        speeds = np.minimum(speeds, np.sqrt(np.maximum(np.minimum(ahead, back), 0.0)))
        speeds[0] = speeds[-1] = 0.0
    one, other = speeds[:-1] ** 2, speeds[1:] ** 2
    gained = np.where(moving, push, 0.0) * steps
    peaks = np.maximum(np.minimum(caps, np.sqrt((one + other) / 2 + gained)), np.sqrt(np.maximum(one, other)))
    times = np.zeros_like(steps)
    cruise = np.maximum(steps - (2 * peaks**2 - one - other) / (2 * push), 0.0)
    changes = (2 * peaks - speeds[:-1] - speeds[1:]) / push
    times[moving] = changes[moving] + cruise[moving] / peaks[moving]
    times[~moving] = turns[~moving] / turn
    return replace(trajectory, speeds=speeds, times=np.append(0.0, np.cumsum(times)))


def _positive(name: str, given: object) -> float:
    if given is None:
        return math.inf
    number = finite_number(given)
    if not 1e-6 <= number <= 1e9:  # beyond, differences of squares of speeds are lost in rounding
        rule = "it is a finite number, >= 1e-06 and <= 1e+09"
        raise ParameterError(f"{name} {shown(given)}", rule, "give one, such as 0.5, or leave it out for no limit")
    return number
