"""Events: what `solve(events=...)` tells on the way, one at a time."""

from __future__ import annotations

import msgspec

from antnav.planner.call import Event
from antnav.planner.result import Result
from antnav.planner.view import View

__all__ = ["Ended", "Event", "Improved", "Iterated", "StageBegan", "Started"]


class Started(Event, msgspec.Struct, frozen=True, eq=False):
    """A planner begins."""

    planner: str
    seed: int


class StageBegan(Event, msgspec.Struct, frozen=True, eq=False):
    """Colonies begin to run side by side."""

    stage: str  #: a `Phase`
    colonies: int


class Iterated(Event, msgspec.Struct, frozen=True, eq=False):
    """A colony has done iterations. Told some thirty times a second, and after its last one."""

    stage: str
    colony: int  #: 0, 1, ... in its stage
    number: int  #: iterations that it has done
    fraction: float  #: of the whole schedule, in [0, 1]
    best: float  #: least cost, or length without costs, from start to goal in this stage so far; inf before the first
    view: View | None  #: the colony; None where it is too large to be sent from another process


class Improved(Event, msgspec.Struct, frozen=True, eq=False):
    """There is a cheaper path from start to goal than before in this stage; without costs, a shorter one."""

    stage: str
    best: float  #: its cost, which is length where the problem has no costs


class Ended(Event, msgspec.Struct, frozen=True, eq=False):
    """The planner is done."""

    result: Result
