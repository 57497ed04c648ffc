"""The shortest curve of bounded curvature between two poses.

L. E. Dubins, On curves of minimal length with a constraint on average curvature, and with prescribed initial and
terminal positions and tangents, American Journal of Mathematics 79 (1957) 497-516; the formulas of its six words:
A. M. Shkel & V. Lumelsky, Classification of the Dubins set, Robotics and Autonomous Systems 34 (2001) 179-202,
doi 10.1016/S0921-8890(00)00127-5 [source].
"""

from __future__ import annotations

import math

import numpy as np

from antnav.kernels import lattice_kernels
from antnav.trajectories.pieces import Pieces, Pose, along


def dubins(start: Pose, goal: Pose, radius: float) -> list[Pieces]:
    """The words that lead from a pose to a pose, shortest first, as pieces with turns of this radius."""
    dx, dy = goal[0] - start[0], goal[1] - start[1]
    d, towards = math.hypot(dx, dy) / radius, math.atan2(dy, dx)
    lengths = lattice_kernels.words(d, (start[2] - towards) % math.tau, (goal[2] - towards) % math.tau)
    total = lengths.sum(axis=1)
    order = [k for k in np.argsort(total, kind="stable").tolist() if not math.isnan(total[k])]
    return [_pieces(start, lattice_kernels.WORDS[k].tolist(), lengths[k].tolist(), radius) for k in order]


def _pieces(start: Pose, sides: list[int], lengths: list[float], radius: float) -> Pieces:
    pieces = []
    pose = start
    for side, share in zip(sides, lengths, strict=True):
        length = 0.0 if side and math.tau - share < 1e-9 else share * radius
        if length > 1e-9:
            pieces.append((*pose, length, side / radius))
            pose = tuple(along(pieces[-1], length).tolist())
    return np.array(pieces).reshape(-1, 5)
