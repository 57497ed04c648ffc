"""Every replanner by its name."""

from __future__ import annotations

from antnav.errors import ParameterError, shown
from antnav.live.astar import AStar
from antnav.live.dstar_lite import DStarLite
from antnav.live.lpa_star import LPAStar
from antnav.live.mpgaa_star import MPGAAStar
from antnav.live.regions import Regions
from antnav.live.replanner import Replanner

METHODS: dict[str, type[Replanner]] = {kind.name: kind for kind in (Regions, AStar, LPAStar, DStarLite, MPGAAStar)}


def replanner(given: str | Replanner) -> Replanner:
    """A replanner by its name, or the one that was handed in.

    Raises
    ------
    ParameterError
        No such name.
    """
    if isinstance(given, Replanner):
        return given
    if not isinstance(given, str) or given not in METHODS:
        rule = f"the replanners are {', '.join(METHODS)}"
        raise ParameterError(f"replanner {shown(given)}", rule, "choose one of them, or hand in a Replanner")
    return METHODS[given]()
