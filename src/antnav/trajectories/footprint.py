"""Footprint: the outline of a robot that is no disc, as nav2's costmaps know it."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.values import finite_number

_MOST = 1_000  #: Corners that are read.
_SIDES = 16  #: Of the polygon that nav2 makes of a radius.

_Points = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Footprint:
    """A convex polygon around the robot's centre, on which it turns.

    Parameters
    ----------
    points : sequence of (x, y)
        Corners in metres, in the robot's frame: x ahead, y to the left. Kept is their convex hull, counter-clockwise.

    Raises
    ------
    ParameterError
        No such points, or the centre does not lie inside.
    """

    points: _Points

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _hull(_numbers(self.points)))
        if not self.inscribed > 0:
            rule = "the robot's centre (0, 0) lies inside of its footprint"
            raise ParameterError(f"footprint {shown(self.points)}", rule, "give corners on all sides of it")

    @classmethod
    def disc(cls, radius: float) -> Footprint:
        """The polygon of 16 corners that nav2 takes for a robot_radius in metres; they lie on the circle."""
        number = finite_number(radius)
        if not number > 0:
            raise ParameterError(f"radius {shown(radius)}", "it is a finite number > 0", "give one, such as 0.2")
        angles = math.tau * np.arange(_SIDES) / _SIDES
        return cls(tuple(zip((number * np.cos(angles)).tolist(), (number * np.sin(angles)).tolist(), strict=True)))

    @classmethod
    def of_nav2(cls, text: str) -> Footprint:
        """The footprint of a text such as nav2's parameter `footprint`: "[[0.3, 0.2], [0.3, -0.2], [-0.3, 0.0]]"."""
        try:
            given = ast.literal_eval(text.strip()) if len(text) < 100 * _MOST else None
        except (ValueError, SyntaxError, TypeError, AttributeError, MemoryError, RecursionError):
            given = None
        if not isinstance(given, list | tuple):
            rule = "it is a list of corners in metres"
            raise ParameterError(f"footprint {shown(text)}", rule, 'give one, such as "[[0.3, 0.2], [0.3, -0.2], ...]"')
        return cls(given)  # type: ignore[arg-type]

    @classmethod
    def of(cls, given: object) -> Footprint:
        """The footprint itself, or of nav2's text, or of corners."""
        if isinstance(given, Footprint):
            return given
        return cls.of_nav2(given) if isinstance(given, str) else cls(given)  # type: ignore[arg-type]

    def padded(self, padding: float) -> Footprint:
        """The footprint with nav2's footprint_padding: so many metres more for ``|x|`` and ``|y|`` of each corner."""
        number = finite_number(padding)
        if not number >= 0:
            rule = "it is a finite number, >= 0"
            raise ParameterError(f"footprint_padding {shown(padding)}", rule, "give one, such as 0.01")
        corners = np.array(self.points)
        return replace(self, points=tuple(map(tuple, (corners + number * np.sign(corners)).tolist())))

    @property
    def corners(self) -> NDArray[np.float64]:
        """Corners in metres, shape (n, 2), counter-clockwise."""
        return np.array(self.points)

    @property
    def inscribed(self) -> float:
        """Radius in metres of the largest disc around the centre that lies inside."""
        here = self.corners
        edges = np.roll(here, -1, axis=0) - here
        return float(((here[:, 0] * edges[:, 1] - here[:, 1] * edges[:, 0]) / np.hypot(*edges.T)).min())

    @property
    def circumscribed(self) -> float:
        """Radius in metres of the smallest disc around the centre that it lies in."""
        return float(np.hypot(*self.corners.T).max())


def _numbers(given: object) -> list[tuple[float, float]]:
    """Corners as finite numbers, or a `ParameterError`."""
    rule = f"it is 3 to {_MOST} corners (x, y), finite numbers of metres"
    try:
        corners = np.asarray(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        corners = np.empty(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or not 3 <= len(corners) <= _MOST or not (abs(corners) < 1e6).all():
        raise ParameterError(f"footprint {shown(given)}", rule, "give them, such as [(0.3, 0.2), (0.3, -0.2), ...]")
    return [(x, y) for x, y in corners.tolist()]


def _hull(corners: list[tuple[float, float]]) -> _Points:
    """The convex hull, counter-clockwise (A. M. Andrew, Information Processing Letters 9 (1979) 216-219)."""
    ordered = sorted(set(corners))
    hull: list[tuple[float, float]] = []
    for way in (ordered, ordered[::-1]):
        base = len(hull)
        for x, y in way:
            while len(hull) >= base + 2:
                (ax, ay), (bx, by) = hull[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                    break
                hull.pop()
            hull.append((x, y))
        hull.pop()
    if len(hull) < 3:
        rule = "its corners do not lie on one line"
        raise ParameterError(f"footprint {shown(corners)}", rule, "give the corners of an area")
    return tuple(hull)
