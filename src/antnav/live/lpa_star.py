"""LPA*: what D* Lite came from."""

from __future__ import annotations

from typing import ClassVar

from antnav.live.dstar_lite import DStarLite


class LPAStar(DStarLite):
    """Lifelong Planning A* from the goal to the robot; where the robot has moved, its whole queue is put in order anew.

    LPA* itself knows no robot that moves: this is what D* Lite's authors set out from, and it is exact.
    """

    name: ClassVar[str] = "lpa_star"
    source: ClassVar[str] = "Koenig, Likhachev & Furcy 2004, doi 10.1016/j.artint.2003.12.001"
    reorder: ClassVar[bool] = True
