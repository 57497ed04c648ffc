"""The shortest curve of bounded curvature between two poses.

L. E. Dubins, On curves of minimal length with a constraint on average curvature, and with prescribed initial and
terminal positions and tangents, American Journal of Mathematics 79 (1957) 497-516; the formulas of its six words:
A. M. Shkel & V. Lumelsky, Classification of the Dubins set, Robotics and Autonomous Systems 34 (2001) 179-202,
doi 10.1016/S0921-8890(00)00127-5 [source].
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from antnav.trajectories.pieces import Pieces, Pose, along

_Word = tuple[str, float, float, float]


def dubins(start: Pose, goal: Pose, radius: float) -> list[Pieces]:
    """The words that lead from a pose to a pose, shortest first, as pieces with turns of this radius."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    d, towards = math.hypot(dx, dy) / radius, math.atan2(dy, dx)
    found = sorted(_words(d, (start[2] - towards) % math.tau, (goal[2] - towards) % math.tau), key=lambda w: sum(w[1:]))
    return [_pieces(start, word, radius) for word in found]


def _words(d: float, alpha: float, beta: float) -> Iterator[_Word]:
    """Letters and lengths of the three parts, in radii (Shkel & Lumelsky 2001, section 3)."""
    sa, sb, ca, cb, cab = math.sin(alpha), math.sin(beta), math.cos(alpha), math.cos(beta), math.cos(alpha - beta)
    p2 = 2 + d * d - 2 * cab + 2 * d * (sa - sb)
    if p2 >= 0:
        turn = math.atan2(cb - ca, d + sa - sb)
        yield "LSL", (turn - alpha) % math.tau, math.sqrt(p2), (beta - turn) % math.tau
    p2 = 2 + d * d - 2 * cab + 2 * d * (sb - sa)
    if p2 >= 0:
        turn = math.atan2(ca - cb, d - sa + sb)
        yield "RSR", (alpha - turn) % math.tau, math.sqrt(p2), (turn - beta) % math.tau
    p2 = -2 + d * d + 2 * cab + 2 * d * (sa + sb)
    if p2 >= 0:
        p = math.sqrt(p2)
        turn = math.atan2(-ca - cb, d + sa + sb) - math.atan2(-2, p)
        yield "LSR", (turn - alpha) % math.tau, p, (turn - beta) % math.tau
    p2 = -2 + d * d + 2 * cab - 2 * d * (sa + sb)
    if p2 >= 0:
        p = math.sqrt(p2)
        turn = math.atan2(ca + cb, d - sa - sb) - math.atan2(2, p)
        yield "RSL", (alpha - turn) % math.tau, p, (beta - turn) % math.tau
    middle = (6 - d * d + 2 * cab + 2 * d * (sa - sb)) / 8
    if abs(middle) <= 1:
        p = math.tau - math.acos(middle)
        t = (alpha - math.atan2(ca - cb, d - sa + sb) + p / 2) % math.tau
        yield "RLR", t, p, (alpha - beta - t + p) % math.tau
    middle = (6 - d * d + 2 * cab + 2 * d * (sb - sa)) / 8
    if abs(middle) <= 1:
        p = math.tau - math.acos(middle)
        t = (math.atan2(cb - ca, d + sa - sb) - alpha + p / 2) % math.tau
        yield "LRL", t, p, (beta - alpha - t + p) % math.tau


def _pieces(start: Pose, word: _Word, radius: float) -> Pieces:
    pieces = []
    pose = start
    for letter, share in zip(word[0], word[1:], strict=True):
        curvature = {"L": 1 / radius, "R": -1 / radius, "S": 0.0}[letter]
        length = 0.0 if letter != "S" and math.tau - share < 1e-9 else share * radius
        if length > 1e-9:
            pieces.append((*pose, length, curvature))
            pose = tuple(along(pieces[-1], length).tolist())
    return np.array(pieces).reshape(-1, 5)
