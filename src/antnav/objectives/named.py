"""named: objectives by a text, as the command line gives them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from antnav.costs.named import named as named_field
from antnav.costs.named import slow_zones
from antnav.errors import ParameterError, shown
from antnav.objectives.objective import Objective
from antnav.objectives.turning import TurningAngle, Turns
from antnav.objectives.way import Energy, Length, Risk, Time
from antnav.plugins.loading import HOW, PARTS, sought
from antnav.world.grid import GridMap

#: Objectives that need nothing else.
PLAIN: dict[str, Callable[[], Objective]] = {"length": Length, "turns": Turns, "angle": TurningAngle}

#: Those of users by name, see `antnav.register`.
REGISTERED: dict[str, type[Objective]] = {}

FORMS = (
    "length, turns, angle, risk:FIELD with a field as --cost takes it, time:MASK with a speed mask, "
    "energy:HEIGHTS:UP[:DOWN] with a file of heights"
)


def named(text: str, grid: GridMap) -> Objective:
    """The objective that a text stands for: "length", "risk:clearance:0.5", "time:speed.yaml", "mine.py:name", ...

    Raises
    ------
    ParameterError
        No such objective.
    """
    kind, _, rest = text.partition(":") if isinstance(text, str) else ("", "", "")
    if kind in PLAIN and not rest:
        return PLAIN[kind]()
    try:
        if kind == "risk" and rest:
            return Risk(named_field(rest, grid), name=f"risk {rest}")
        if kind == "time" and rest:
            return Time(1.0, slow_zones(rest, grid))
        if kind == "energy" and rest:
            return Energy(named_field(f"slope:{rest}", grid))
    except ParameterError as error:
        raise ParameterError(f"objective {text}: {error.given}", error.rule, error.remedy) from None
    if isinstance(text, str) and (own := sought(text, REGISTERED.get, PARTS)):
        return own()
    yours = f"; your own {', '.join(REGISTERED)}" if REGISTERED else ""
    rule = f"it is one of {FORMS}{yours}"
    raise ParameterError(f"objective {shown(text)}", rule, f"give one, such as risk:clearance:0.5, {HOW}")


def collected(texts: Sequence[str], grid: GridMap) -> list[Objective]:
    """The objectives of a query; the second time is called "time 2", and so on.

    Raises
    ------
    ParameterError
        One that is none.
    """
    found: list[Objective] = []
    for text in texts:
        objective = named(text, grid)
        alike = sum(type(other) is type(objective) for other in found)
        if alike and isinstance(objective, Time | Energy):
            objective = replace(objective, name=f"{objective.name} {alike + 1}")
        found.append(objective)
    return found
