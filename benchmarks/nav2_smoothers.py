"""nav2's smoothers of paths, written from their documented rules and parameters, to compare with.

https://docs.nav2.org/configuration/packages/configuring-simple-smoother.html
https://docs.nav2.org/configuration/packages/configuring-savitzky-golay-smoother.html
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_coeffs

import antnav as an
from antnav.kernels.jit import jit

_DATA, _SMOOTH, _TOLERANCE, _ROUNDS, _REFINEMENTS = 0.2, 0.3, 1e-10, 1000, 2
_WINDOW = savgol_coeffs(7, 3)


def simple(path: an.Path, problem: an.Problem, *, costmap: bool) -> NDArray[np.float64]:
    """SimpleSmoother with refinement: points in metres, shape (k, 2).

    Parameters
    ----------
    costmap : bool
        Whether it ends before the first round in which a point enters a cell that is not open.
    """
    grid = path.grid
    plane = grid.world_to_plane(path.points)
    closed = ~problem.passable if costmap else np.zeros(grid.shape, np.bool_)
    for _ in range(1 + _REFINEMENTS):
        plane = _relaxed(plane, closed, _TOLERANCE / grid.resolution)
    return grid.cell_to_world(plane[:, ::-1])


@jit
def _relaxed(given, closed, tolerance):
    now, kept = given.copy(), given.copy()
    for _ in range(_ROUNDS - 1):
        change = 0.0
        for i in range(1, len(given) - 1):
            for k in range(2):
                before = now[i, k]
                pull = _DATA * (given[i, k] - before)
                now[i, k] += pull + _SMOOTH * (now[i + 1, k] + now[i - 1, k] - 2 * before)
                change += abs(now[i, k] - before)
            if closed[int(np.rint(now[i, 1])), int(np.rint(now[i, 0]))]:
                return kept
        kept[:] = now
        if change < tolerance:
            break
    return kept


def savitzky_golay(path: an.Path) -> NDArray[np.float64]:
    """SavitzkyGolaySmoother with refinement: points in metres, shape (k, 2); the ends stay."""
    points = path.points.copy()
    if len(points) < 9:
        return points
    for _ in range(1 + _REFINEMENTS):
        padded = np.pad(points, ((3, 3), (0, 0)), "edge")
        smooth = sum(share * padded[k : k + len(points)] for k, share in enumerate(_WINDOW))
        points[1:-1] = smooth[1:-1]
    return points
