"""Indicators of how good a front is, by the library moocore (Lopez-Ibanez et al., LGPL, extra ``antnav[fronts]``)."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError
from antnav.values import finite_row


def _moocore() -> ModuleType:
    try:
        import moocore  # type: ignore[import-untyped]
    except ImportError as error:
        raise ParameterError("an indicator", "moocore is not installed", 'pip install "antnav[fronts]"') from error
    library: ModuleType = moocore
    return library


def require() -> None:
    """Raise the error that names the extra where moocore is not installed."""
    _moocore()


def undominated(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rows (p, k) that no other beats, of equal ones one, sorted."""
    kept: NDArray[np.float64] = _moocore().filter_dominated(values)
    return kept[np.lexsort(kept.T[::-1])]


def hypervolume(values: NDArray[np.float64], reference: ArrayLike) -> float:
    """Volume that values (p, k) beat, up to a reference point (k,) (Zitzler & Thiele 1998).

    Raises
    ------
    ParameterError
        No such point, or moocore is not installed.
    """
    point = finite_row("reference", reference, values.shape[1])
    return float(_moocore().hypervolume(values, ref=point)) if len(values) else 0.0


def compare(values: NDArray[np.float64], truth: NDArray[np.float64]) -> dict[str, Any]:
    """A front (p, k) beside a better one (q, k), ranges of that one scaled to 1.

    Returns
    -------
    dict
        hypervolume: share of the better one's, up to `reference`, 1.1 in each scaled objective, given in the values'
        units. epsilon: what must be taken off each value so that nothing is missed (Zitzler et al. 2003, additive).
        igd_plus: mean distance from the better one's points (Ishibuchi et al. 2015).
    """
    low, high = truth.min(axis=0), truth.max(axis=0)
    width = np.where(high > low, high - low, 1.0)
    mine, theirs = (values - low) / width, (truth - low) / width
    library, edge = _moocore(), np.full(truth.shape[1], 1.1)
    return {
        "hypervolume": float(library.hypervolume(mine, ref=edge) / library.hypervolume(theirs, ref=edge)),
        "epsilon": float(library.epsilon_additive(mine, ref=theirs)),
        "igd_plus": float(library.igd_plus(mine, ref=theirs)),
        "reference": (low + 1.1 * width).tolist(),
    }
