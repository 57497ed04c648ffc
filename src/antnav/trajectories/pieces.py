"""Pieces: straight lines and arcs, one after the other, in the plane of a map's cells.

An array of shape (n, 5): x and y where a piece begins, its heading, length and curvature. x is the column, y the row:
headings and curvatures turn the other way round than in the world.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Pieces = NDArray[np.float64]
Pose = tuple[float, float, float]


def along(piece: ArrayLike, s: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Poses at so much of a piece's length, shape (..., 3)."""
    x, y, heading, _, curvature = np.asarray(piece, np.float64)
    s = np.asarray(s, np.float64)
    now = heading + curvature * s
    if curvature == 0:
        return np.stack((x + s * math.cos(heading), y + s * math.sin(heading), now), axis=-1)
    dx = (np.sin(now) - math.sin(heading)) / curvature
    dy = (math.cos(heading) - np.cos(now)) / curvature
    return np.stack((x + dx, y + dy, now), axis=-1)


def length_of(pieces: Pieces) -> float:
    """Length of all pieces."""
    return float(pieces[:, 3].sum())


def end_of(pieces: Pieces) -> Pose:
    """Pose at the end of the last piece."""
    x, y, heading = along(pieces[-1], pieces[-1, 3]).tolist()
    return x, y, heading


def part(pieces: Pieces, begin: float, end: float) -> Pieces:
    """What lies between two arc lengths."""
    found = []
    before = 0.0
    for piece in pieces:
        low, high = max(begin - before, 0.0), min(end - before, piece[3])
        if high - low > 1e-12:
            found.append((*along(piece, low), high - low, piece[4]))
        before += piece[3]
    return np.array(found).reshape(-1, 5)


def backwards(pieces: Pieces) -> Pieces:
    """The same curve from its end to its start."""
    turned = []
    for piece in pieces[::-1]:
        x, y, heading = along(piece, piece[3])
        turned.append((x, y, heading + math.pi, piece[3], -piece[4]))
    return np.array(turned).reshape(-1, 5)


def polyline(line: NDArray[np.float64]) -> Pieces:
    """The straight pieces between points, shape (k, 2)."""
    steps = np.diff(line, axis=0)
    lengths = np.hypot(*steps.T)
    pieces = np.column_stack((line[:-1], np.arctan2(steps[:, 1], steps[:, 0]), lengths, np.zeros(len(steps))))
    kept: Pieces = pieces[lengths > 0]
    return kept


def sampled(pieces: Pieces, spacing: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Poses, shape (k, 3), and curvatures, shape (k,), no farther apart than `spacing`; each end of a piece is one.

    Where the heading jumps, the corner is there twice, and its curvature is infinite.
    """
    poses: list[NDArray[np.float64]] = []
    curvatures: list[NDArray[np.float64]] = []
    heading = math.nan
    for piece in pieces[(pieces[:, 3] == 0) | (pieces[:, 3] > 1e-9)]:
        steps = math.ceil(piece[3] / spacing - 1e-9)
        found = along(piece, np.linspace(0.0, piece[3], steps + 1))
        curvature = np.full(steps + 1, piece[4])
        if abs(math.remainder(found[0, 2] - heading, math.tau)) < 1e-6:
            found, curvature = found[1:], curvature[1:]
        elif poses:
            curvature[0] = curvatures[-1][-1] = math.inf
            found[0, :2] = poses[-1][-1, :2]  # exactly: a turn over the last digit of a place would have a speed
        if len(found):
            poses.append(found)
            curvatures.append(curvature)
            heading = float(found[-1, 2])
    return np.concatenate(poses), np.concatenate(curvatures)
