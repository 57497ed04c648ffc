"""named: cost fields by a text, as the command line and study files give them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from operator import add

from antnav.costs.clearance import clearance
from antnav.costs.inflation import inflation
from antnav.costs.keepout import keepout
from antnav.costs.speed import speed
from antnav.errors import ParameterError, shown
from antnav.maps import load_grades, load_map
from antnav.world.cost import CostField
from antnav.world.grid import GridMap

#: Fields by name: the maker, and the numbers that it takes, the last one optional.
KINDS: dict[str, tuple[Callable[..., CostField], tuple[str, ...]]] = {
    "clearance": (clearance, ("radius", "weight")),
    "inflation": (inflation, ("inflation_radius", "cost_scaling_factor", "inscribed_radius", "weight")),
}


def named(text: str, grid: GridMap) -> CostField:
    """The field that a text stands for, such as "clearance:0.5" or "inflation:0.7:3:0.2:2": a kind and its numbers.

    Raises
    ------
    ParameterError
        No such field, numbers that it does not take.
    """
    kind, *numbers = text.split(":") if isinstance(text, str) else [""]
    forms = " or ".join(":".join([name, *map(str.upper, what)]) for name, (_, what) in KINDS.items())
    rule, remedy = f"it is {forms}, the last number optional", "give one, such as clearance:0.5"
    if kind not in KINDS:
        raise ParameterError(f"cost {shown(text)}", rule, remedy)
    make, parameters = KINDS[kind]
    try:
        values = [float(number) for number in numbers]
    except ValueError:
        values = []
    if not len(parameters) - 1 <= len(values) <= len(parameters):
        raise ParameterError(f"cost {shown(text)}", rule, remedy)
    try:
        return make(grid, *values)
    except ParameterError as error:
        raise ParameterError(f"cost {shown(text)}, {error.given}", error.rule, error.remedy) from None


def collected(
    grid: GridMap, texts: Sequence[str] = (), keepouts: Sequence[str] = (), speeds: Sequence[str] = ()
) -> CostField | None:
    """All fields of a query added up: texts as `named` takes them, files of nav2's filter masks; None without any."""
    fields = [named(text, grid) for text in texts]
    for mask in keepouts:
        closing = keepout(load_map(mask), grid)
        if not closing.blocked.any():
            raise ParameterError(f"keepout {mask}", "the mask closes no cell of the map", "give the mask of this map")
        fields.append(closing)
    for mask in speeds:
        slow = speed(load_grades(mask), grid)
        if not slow.values.any():
            rule = "the mask slows no cell of the map: speed masks have mode: scale or raw, and values between"
            raise ParameterError(f"speed {mask}", rule, "give the speed mask of this map")
        fields.append(slow)
    return reduce(add, fields) if fields else None
