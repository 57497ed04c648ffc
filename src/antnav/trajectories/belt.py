"""Corners rounded: a belt around circles, tangent by tangent, whose circles are moved until the robot stays clear."""

from __future__ import annotations

import cmath
import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from antnav.kernels import trajectory_kernels
from antnav.kernels.trajectory_kernels import Ground
from antnav.trajectories.pieces import Pieces

_PUSHES = 0.02 * 1.5 ** np.arange(20)  #: By which a circle is tried farther out, in cells; 66 at most.
_ROUNDS = 40
_SHRUNK = 0.7
_WIDEST = 2.4  #: Turn in radians up to which two corners become one.


@dataclass(frozen=True)
class _Circle:
    """What the belt goes around; an end has the radius 0."""

    x: float
    y: float
    radius: float
    side: float  #: 1 where headings grow along the arc, -1 where they shrink.
    inward: tuple[float, float] = (0.0, 0.0)  #: From the corner to the centre.
    secant: float = 1.0  #: How far the centre lies from the corner, in radii.
    corner: tuple[float, float] = (0.0, 0.0)

    def moved(self, distance: float) -> _Circle:
        return replace(self, x=self.x + distance * self.inward[0], y=self.y + distance * self.inward[1])

    def shrunk(self, radius: float) -> _Circle:
        return replace(self.moved((radius - self.radius) * self.secant), radius=radius)


def rounded(ground: Ground, line: NDArray[np.float64], need: float, least: float, preferred: float) -> Pieces | None:
    """Straight lines and arcs of at least a radius near a line with corners, on which a disc stays clear.

    Parameters
    ----------
    line : ndarray, shape (k, 2)
        x and y, each segment clear.
    need : float
        Radius of the disc, in cells.
    least, preferred : float
        Radius of arcs, in cells, the smallest that is allowed and the one that is tried first.

    Returns
    -------
    Pieces or None
        None where no such curve was found.

    Notes
    -----
    An arc inside a corner of a taut line comes nearer to what the line bends around. So circles are pushed out until
    the belt is clear, shrunk where there is no room for that, and left out where the belt no longer touches them.
    """
    line = _merged(line, preferred)
    circles = [_at_corner(line, i, preferred) for i in range(1, len(line) - 1)]
    circles = [_end(line[0]), *circles, _end(line[-1])]
    for _ in range(_ROUNDS):
        loose = _loose(circles)
        if loose is not None:
            del circles[loose]
            continue
        failing = _failing(ground, circles, need)
        if not failing:
            return np.array(_belt(circles)).reshape(-1, 5)
        better = False
        for i in failing:
            other = _repaired(ground, circles, i, need, least)
            if other is not None:
                circles[i], better = other, True
        if not better:
            return None
    return None


def _merged(line: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """One corner for two that turn to the same side, where arcs of a radius would overlap on the leg between."""
    points = [point for point, _ in itertools.groupby(complex(x, y) for x, y in line.tolist())]
    i = 1
    while i + 2 < len(points):
        before, leg, after = (points[k + 1] - points[k] for k in (i - 1, i, i + 1))
        one, other = cmath.phase(leg / before), cmath.phase(after / leg)
        if one * other >= 0 and abs(one + other) < _WIDEST:
            tangents = radius * (math.tan(abs(one) / 2) + math.tan(abs(other) / 2))
            if tangents > abs(leg):
                turn = (before.conjugate() * after).imag
                ahead = (leg.conjugate() * after).imag / turn if turn else 0.0
                points[i : i + 2] = [points[i] + ahead * before]
                points = [point for point, _ in itertools.groupby(points)]
                i = max(i - 1, 1)
                continue
        i += 1
    return np.array([(point.real, point.imag) for point in points])


def _end(point: NDArray[np.float64]) -> _Circle:
    x, y = point.tolist()
    return _Circle(x, y, 0.0, 1.0, corner=(x, y))


def _at_corner(line: NDArray[np.float64], i: int, radius: float) -> _Circle:
    """The circle that touches both legs of a corner from inside."""
    (x, y), before, after = line[i].tolist(), line[i] - line[i - 1], line[i + 1] - line[i]
    before, after = before / np.hypot(*before), after / np.hypot(*after)
    inward = after - before
    size = float(np.hypot(*inward))
    inward = inward / size if size > 1e-9 else np.array((-before[1], before[0]))
    side = 1.0 if before[0] * after[1] - before[1] * after[0] >= 0 else -1.0
    secant = 1 / math.sqrt(max(1 - size * size / 4, 1 / 16))
    away = radius * secant
    return _Circle(
        x + away * float(inward[0]), y + away * float(inward[1]), radius, side, tuple(inward.tolist()), secant, (x, y)
    )


def _tangent(one: _Circle, other: _Circle) -> tuple[float, float] | None:
    """Heading and length of the belt between two circles; None where they lie too near to each other."""
    dx, dy = other.x - one.x, other.y - one.y
    apart, lever = math.hypot(dx, dy), other.side * other.radius - one.side * one.radius
    if apart <= abs(lever):
        return None
    return math.atan2(dy, dx) - math.asin(lever / apart), math.sqrt(apart * apart - lever * lever)


def _sweep(circle: _Circle, arrival: float, departure: float) -> float:
    """By how much the belt turns around a circle, in [0, tau)."""
    sweep = circle.side * (departure - arrival) % math.tau
    return 0.0 if math.tau - sweep < 1e-9 else sweep


def _loose(circles: list[_Circle]) -> int | None:
    """A circle that the belt does not need: it would go once around it, or it lies within its neighbour."""
    tangents = [_tangent(one, other) for one, other in itertools.pairwise(circles)]
    for i, tangent in enumerate(tangents):
        if tangent and len(circles) > 2:
            (from_x, from_y), (to_x, to_y) = circles[i].corner, circles[i + 1].corner
            if math.cos(tangent[0]) * (to_x - from_x) + math.sin(tangent[0]) * (to_y - from_y) < 0:
                inner = [k for k in (i, i + 1) if 0 < k < len(circles) - 1]
                return max(inner, key=lambda k: circles[k].secant * -1)
    for i in range(1, len(circles) - 1):
        before, after = tangents[i - 1], tangents[i]
        if before and after and _sweep(circles[i], before[0], after[0]) > 1.5 * math.pi:
            return i
        if after is None and i + 2 < len(circles) and circles[i].side == circles[i + 1].side:
            return i
    return None


def _belt(circles: list[_Circle]) -> list[tuple[float, float, float, float, float]]:
    """The pieces; circles must not be loose."""
    pieces = []
    arrival = None
    for i, (one, other) in enumerate(itertools.pairwise(circles)):
        tangent = _tangent(one, other)
        if tangent is None:
            return []
        heading, length = tangent
        if i and arrival is not None:
            sweep = _sweep(one, arrival, heading)
            x, y = one.x + one.side * one.radius * math.sin(arrival), one.y - one.side * one.radius * math.cos(arrival)
            if sweep > 0:
                pieces.append((x, y, arrival, sweep * one.radius, one.side / one.radius))
        x, y = one.x + one.side * one.radius * math.sin(heading), one.y - one.side * one.radius * math.cos(heading)
        pieces.append((x, y, heading, length, 0.0))
        arrival = heading
    return pieces


def _failing(ground: Ground, circles: list[_Circle], need: float) -> list[int]:
    """Circles at which the belt is not clear, or cannot be."""
    found = set()
    for i in range(1, len(circles) - 1):
        if not _fits(ground, circles[max(i - 2, 0) : i + 3], min(i, 2), need):
            found.add(i)
    if len(circles) == 2 and not _clear(ground, _belt(circles), need):
        return [0]
    return sorted(found)


def _fits(ground: Ground, near: list[_Circle], i: int, need: float) -> bool:
    """Whether the belt is clear on its way to, around and from a circle."""
    before, after = _tangent(near[i - 1], near[i]), _tangent(near[i], near[i + 1])
    if before is None or after is None or _sweep(near[i], before[0], after[0]) > 1.5 * math.pi:
        return False
    return _clear(ground, _belt(near[i - 1 : i + 2]), need)


def _clear(ground: Ground, pieces: list[tuple[float, float, float, float, float]], need: float) -> bool:
    return bool(pieces) and bool(trajectory_kernels.pieces_clear(ground, np.array(pieces), need))


def _repaired(ground: Ground, circles: list[_Circle], i: int, need: float, least: float) -> _Circle | None:
    """A circle farther out, or a smaller one, at which the belt is clear; None where none is."""
    if not 0 < i < len(circles) - 1:
        return None
    near = list(circles[i - 1 : i + 2])
    circle = circles[i]
    while True:
        low = 0.0
        for push in _PUSHES:
            near[1] = circle.moved(-push)
            if _fits(ground, near, 1, need):
                high = float(push)
                for _ in range(5):
                    middle = (low + high) / 2
                    near[1] = circle.moved(-middle)
                    low, high = (low, middle) if _fits(ground, near, 1, need) else (middle, high)
                return circle.moved(-high)
            low = float(push)
        if circle.radius <= least:
            return None
        circle = circle.shrunk(max(circle.radius * _SHRUNK, least))
        near[1] = circle
        if _fits(ground, near, 1, need):
            return circle
