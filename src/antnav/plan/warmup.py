"""warmup: compile or load kernels before they are needed."""

from __future__ import annotations

from antnav.ants import warmup as ants
from antnav.errors import check_type
from antnav.planner.planner import Planner


def warmup(algorithm: Planner | None = None, *, turns: bool = False) -> float:
    """Compile kernels, or load them from the disk cache; what this process has done before is not done again.

    Parameters
    ----------
    algorithm : Planner, optional
        Whose kernels are wanted, and those of a result's figures; default: all kernels, those of `antnav.rivals` too.
    turns : bool
        Whether problems have a price of turns, which takes an exact search of its own.

    Returns
    -------
    float
        Seconds that it took: seconds on a machine that has never run antnav, tenths later, 0 once done.
    """
    if algorithm is None:
        return ants.kernels(windows=True, regions=True, rivals=True, searches=True) + ants.turning()
    check_type("algorithm", algorithm, Planner, "call a preset, as in an.paco(), or give None")
    return algorithm.prepare() + (ants.turning() if turns is True else 0.0)
