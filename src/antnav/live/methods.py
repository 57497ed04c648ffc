"""Every replanner by its name."""

from __future__ import annotations

from antnav.errors import ParameterError, shown
from antnav.live.ants import Anew
from antnav.live.astar import AStar
from antnav.live.dstar_lite import DStarLite
from antnav.live.lpa_star import LPAStar
from antnav.live.mpgaa_star import MPGAAStar
from antnav.live.regions import Regions
from antnav.live.replanner import Replanner
from antnav.plan.algorithms import REGISTERED, own
from antnav.planner.planner import Planner
from antnav.plugins.loading import HOW
from antnav.values import check_seed

METHODS: dict[str, type[Replanner]] = {kind.name: kind for kind in (Regions, AStar, LPAStar, DStarLite, MPGAAStar)}


def replanner(given: str | Replanner | Planner, seed: int = 0) -> Replanner:
    """A replanner by its name, one that plans anew with a planner, a registered one by its name, or the one handed in.

    Raises
    ------
    ParameterError
        No such name.
    """
    check_seed(seed)
    if isinstance(given, Replanner):
        return given
    if isinstance(given, Planner):
        return Anew(given, int(seed))
    if isinstance(given, str) and given not in METHODS and (found := own(given)):
        return Anew(found(), int(seed))
    if not isinstance(given, str) or given not in METHODS:
        rule = f"the replanners are {', '.join((*METHODS, *REGISTERED))}"
        remedy = f"choose one of them, hand in a Replanner or a planner such as an.npaco(), {HOW}"
        raise ParameterError(f"replanner {shown(given)}", rule, remedy)
    return METHODS[given]()
