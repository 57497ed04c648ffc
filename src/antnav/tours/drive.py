"""One trajectory over all legs of a tour."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from antnav.planner.result import Result
from antnav.trajectories.model import Trajectory

_SAME = 1e-9  #: Radians.


def driven(
    legs: Sequence[Result],
    stops: Sequence[int],
    start_heading: float | None,
    goal_heading: float | None,
    **choices: Any,
) -> Trajectory:
    """The trajectories of legs as one; each begins with the heading in which the one before ended.

    Where no smooth curve does, the robot turns on the spot at the stop, which the note says.

    Parameters
    ----------
    stops : sequence of int
        The number of the place where each leg ends, 0 of the start.
    choices
        As `Result.trajectory` takes them.
    """
    moving = [number for number, leg in enumerate(legs) if leg.path is not None and leg.path.length_m > 0] or [0]
    drives, turns, notes = list[Trajectory](), list[int](), list[str]()
    for number in moving:
        leg, last = legs[number], number == moving[-1]
        choices["goal_heading"] = goal_heading if last else None
        entry = float(drives[-1].poses[-1, 2]) if drives else start_heading
        drive = leg.trajectory(start_heading=entry, **choices)
        if drives and not drive.smooth:
            turns.append(stops[number - 1])
            free = leg.trajectory(**choices)  # smooth but for the turn at the stop
            drive = free if free.smooth else drive
        if drive.note:
            notes.append(f"to {_named(stops[number])}: {drive.note}")
        drives.append(drive)
    if turns:
        notes.insert(
            0, f"no smooth curve leads through {', '.join(map(_named, turns))}: the robot turns on the spot there"
        )
    joined = drives[0]
    for drive in drives[1:]:
        joined = _joined(joined, drive, choices.get("max_angular_speed"))
    return replace(joined, smooth=not turns and all(drive.smooth for drive in drives), note="; ".join(notes))


def _joined(one: Trajectory, other: Trajectory, turning_speed: float | None) -> Trajectory:
    """Two trajectories as one: all that is told of each pose, one after the other."""
    turn = abs(math.remainder(one.poses[-1, 2] - other.poses[0, 2], math.tau))
    together = turn < _SAME
    columns: dict[str, Any] = {}
    for field in fields(one):
        first, second = getattr(one, field.name), getattr(other, field.name)
        if isinstance(first, np.ndarray) and isinstance(second, np.ndarray) and len(first) == len(one):
            begun = first[-1] + (turn / turning_speed if turning_speed else 0.0) if field.name == "times" else 0.0
            columns[field.name] = np.concatenate((first, second[int(together) :] + begun))
    if not together:
        columns["curvature"][len(one) - 1 : len(one) + 1] = math.inf
    elif math.isinf(other.curvature[0]):  # it begins with a turn on the spot
        columns["curvature"][len(one) - 1] = math.inf
    return replace(one, **columns)


def _named(place: int) -> str:
    return f"stop {place}" if place else "the start"
