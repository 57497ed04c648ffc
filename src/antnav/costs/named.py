"""named: cost fields by a text, as the command line and study files give them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from operator import add
from pathlib import Path

from antnav.costs.clearance import clearance
from antnav.costs.inflation import inflation
from antnav.costs.keepout import keepout
from antnav.costs.slope import slope
from antnav.costs.speed import speed
from antnav.errors import ParameterError, shown
from antnav.maps import load_grades, load_map
from antnav.world.cost import CostField
from antnav.world.grid import GridMap


def _slope(grid: GridMap, file: Path, up: float, down: float = 0.0) -> CostField:
    return slope(file, up=up, down=down)


#: Fields by name: the maker, and the numbers that it takes, after a file for some, the last one optional.
KINDS: dict[str, tuple[Callable[..., CostField], tuple[str, ...]]] = {
    "clearance": (clearance, ("radius", "weight")),
    "inflation": (inflation, ("inflation_radius", "cost_scaling_factor", "inscribed_radius", "weight")),
    "slope": (_slope, ("file", "up", "down")),
}


def named(text: str, grid: GridMap, folder: Path = Path()) -> CostField:
    """The field that a text stands for, such as "clearance:0.5" or "slope:heights.npy:10": a kind and its numbers.

    Parameters
    ----------
    folder : Path
        Where files are.

    Raises
    ------
    ParameterError
        No such field, numbers that it does not take, a file of another shape than the map.
    MapFileError, MapFormatError, MapSizeError
        A file that cannot be read.
    """
    kind, *given = text.split(":") if isinstance(text, str) else [""]
    forms = " or ".join(":".join([name, *map(str.upper, what)]) for name, (_, what) in KINDS.items())
    rule, remedy = f"it is {forms}, the last number optional", "give one, such as clearance:0.5"
    if kind not in KINDS:
        raise ParameterError(f"cost {shown(text)}", rule, remedy)
    make, parameters = KINDS[kind]
    try:
        values = [
            folder / word if name == "file" else float(word) for name, word in zip(parameters, given, strict=False)
        ]
    except ValueError:
        values = []
    if not len(parameters) - 1 <= len(values) == len(given) <= len(parameters):
        raise ParameterError(f"cost {shown(text)}", rule, remedy)
    try:
        field = make(grid, *values)
        field.check_fits(grid)
        return field
    except ParameterError as error:
        raise ParameterError(f"cost {shown(text)}, {error.given}", error.rule, error.remedy) from None


def collected(
    grid: GridMap,
    texts: Sequence[str] = (),
    keepouts: Sequence[str] = (),
    speeds: Sequence[str] = (),
    *,
    folder: Path = Path(),
) -> CostField | None:
    """All fields of a query added up, from files in a folder; None without any.

    Texts are as `named` takes them, the others files of nav2's filter masks.
    """
    fields = [named(text, grid, folder) for text in texts]
    for mask in keepouts:
        closing = keepout(load_map(folder / mask), grid)
        if not closing.blocked.any():
            raise ParameterError(f"keepout {mask}", "the mask closes no cell of the map", "give the mask of this map")
        fields.append(closing)
    fields += [slow_zones(mask, grid, folder) for mask in speeds]
    return reduce(add, fields) if fields else None


def slow_zones(mask: str, grid: GridMap, folder: Path = Path()) -> CostField:
    """The field of a speed mask of nav2's, from a file in a folder.

    Raises
    ------
    ParameterError
        It slows no cell of the map.
    """
    slow = speed(load_grades(folder / mask), grid)
    if not slow.values.any():
        rule = "the mask slows no cell of the map: speed masks have mode: scale or raw, and values between"
        raise ParameterError(f"speed {mask}", rule, "give the speed mask of this map")
    return slow
