"""Weights: vectors that turn several objectives into one sum, and exact searches for such sums."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.fronts.instance import Instance
from antnav.kernels import front_kernels

#: The ranges of all objectives are this many weight units wide.
SCALE = 10**9


def lattice(k: int, parts: int) -> NDArray[np.float64]:
    """Weight vectors of k parts that sum to 1, in steps of 1 / parts, shape (w, k) (Das & Dennis 1998)."""
    if k == 1:
        return np.array([[1.0]])
    rows = []
    for share in range(parts + 1):
        rest = lattice(k - 1, parts - share) if share < parts else np.zeros((1, k - 1))
        rows.append(np.column_stack((np.full(len(rest), share / parts), rest * (1 - share / parts))))
    return np.concatenate(rows)


def scaled(weights: NDArray[np.float64], ranges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Weights in whole numbers, each objective's divided by its range; at least 1, so that no path found is beaten."""
    whole = np.rint(SCALE * weights / np.maximum(ranges, 1)).astype(np.int64)
    return np.maximum(whole, 1)


def ends(instance: Instance) -> tuple[list[NDArray[np.int32]], NDArray[np.int64], NDArray[np.int64]]:
    """A best path for each objective by itself, the least of each objective, and the range over these paths."""
    paths = []
    for j in range(instance.k):
        weights = np.ones(instance.k, np.int64)
        weights[j] = SCALE
        paths.append(best(instance, weights))
    values = instance.steps(paths)
    return paths, values.min(axis=0), values.max(axis=0) - values.min(axis=0)


def best(instance: Instance, weights: NDArray[np.int64]) -> NDArray[np.int32]:
    """A path of least weighted sum, in nodes."""
    found: NDArray[np.int32] = front_kernels.weighted(
        *instance.arrays, weights, instance.ideal, instance.start, instance.goal
    )
    if not len(found):
        rule = "the weighted sum of a path stays below 2**62"
        raise ParameterError("prices of the objectives", rule, "give their steps, coarser ones, or leave steps out")
    return found


def simplex(chance: np.random.Generator, k: int) -> NDArray[np.float64]:
    """Weights >= 0 with the sum 1, all alike likely: the gaps between k - 1 drawn numbers."""
    gaps: NDArray[np.float64] = np.diff(np.sort(chance.random(k - 1)), prepend=0.0, append=1.0)
    return gaps
