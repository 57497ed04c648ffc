"""CostField: what it costs to cross each cell of a map, beside the way itself."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from functools import cached_property, reduce
from operator import add
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.values import finite_number, read_only
from antnav.world.grid import GridMap

#: Largest cost per metre of a cell: sums over any path stay exact enough to be compared.
LARGEST = 1e9


@dataclass(frozen=True, eq=False)
class Slope:
    """Elevation, and the cost in metres of each metre up and down; made by `antnav.costs.slope`.

    Parameters
    ----------
    elevation : array_like of numbers, shape (rows, cols)
        Metres, finite, -1e9 to 1e9; converted to float64, copied, read-only.
    up, down : float
        0 to 1e9, one of them above 0.

    Raises
    ------
    ParameterError
        They are something else.
    """

    elevation: NDArray[np.float64]
    up: float
    down: float

    def __post_init__(self) -> None:
        elevation = table("elevation", self.elevation, "iuf", "a number").astype(np.float64, order="C") + 0.0
        if not (np.abs(elevation) <= LARGEST).all():  # nan fails, too
            worst = elevation[~(np.abs(elevation) <= LARGEST)][0]
            rule = f"heights are {-LARGEST:g} to {LARGEST:g} metres"
            raise ParameterError(f"elevation {worst}", rule, "fill gaps, and close such cells with costs.keepout")
        for way in ("up", "down"):
            object.__setattr__(self, way, check_weight(way, getattr(self, way)))
        if self.up == self.down == 0:
            raise ParameterError("up 0 and down 0", "one of them is above 0", "leave the slope out where it is free")
        object.__setattr__(self, "elevation", read_only(elevation))

    def __setstate__(self, state: dict[str, Any]) -> None:
        read_only(state["elevation"])  # pickling drops the flag
        self.__dict__.update(state)

    def __add__(self, other: Slope) -> Self:
        """Both costs, on one ground."""
        if not np.array_equal(self.elevation, other.elevation):
            remedy = "give one of them the sum of their costs, costs.slope(elevation, up=..., down=...)"
            raise ParameterError("slopes of two elevations", "a map has one", remedy)
        return type(self)(self.elevation, self.up + other.up, self.down + other.down)

    def climb(self, rise: NDArray[np.float64]) -> NDArray[np.float64]:
        """Cost of moves that lead up by so much, or down where it is negative, in the same unit."""
        cost: NDArray[np.float64] = self.up * np.maximum(rise, 0.0) + self.down * np.maximum(-rise, 0.0)
        return cost


@dataclass(frozen=True, eq=False)
class CostField:
    """Cost per metre of each cell of a map, on top of 1 for the metre itself, and of slopes. Fields of one map add.

    Made by `antnav.costs`. How they price a move stands in `PathCost`.

    Parameters
    ----------
    values : array_like, shape (rows, cols)
        Finite, 0 to 1e9; converted to float64, copied, read-only.
    blocked : array_like of bool, shape (rows, cols), optional
        Cells that the robot may not enter; default: none.
    name : str
        For legends and reports.
    slope : Slope, optional
        What moves cost by going up and down, of the same shape.

    Raises
    ------
    ParameterError
        A value that is no number in that range, or another shape.
    """

    values: NDArray[np.float64]
    blocked: NDArray[np.bool_] = field(default_factory=lambda: np.zeros((0, 0), np.bool_))
    name: str = "cost"
    slope: Slope | None = None

    def __post_init__(self) -> None:
        values = table("cost", self.values, "biuf", "a number").astype(np.float64, order="C") + 0.0  # no -0.0
        if not ((values >= 0) & (values <= LARGEST)).all():  # nan fails, too
            worst = values[~((values >= 0) & (values <= LARGEST))][0]
            rule = f"a cell costs 0 to {LARGEST:g} per metre"
            raise ParameterError(f"cost {worst}", rule, "mend the values, or block the cell with costs.keepout")
        blocked = np.zeros(values.shape, np.bool_)
        if not (isinstance(self.blocked, np.ndarray) and self.blocked.size == 0):
            blocked = table("blocked", self.blocked, "b", "a truth").copy(order="C")
        rows, cols = values.shape
        if blocked.shape != values.shape:
            rule = f"it has a truth for each of {rows} x {cols} cells"
            raise ParameterError(f"blocked of shape {blocked.shape}", rule, "give such an array")
        check_type("name", self.name, str, "give a text")
        check_type("slope", self.slope, Slope | None, "make one with costs.slope")
        if self.slope and self.slope.elevation.shape != values.shape:
            rule = f"it has a height for each cell, shape {values.shape}"
            raise ParameterError(f"elevation of shape {self.slope.elevation.shape}", rule, "give such an array")
        for name, array in (("values", values), ("blocked", blocked)):
            object.__setattr__(self, name, read_only(array))

    def __add__(self, other: CostField) -> Self:
        """Both costs, and both blocks. Slopes add where they are of one elevation."""
        if not isinstance(other, CostField):
            return NotImplemented
        if self.values.shape != other.values.shape:
            rule = "fields of one map have its shape"
            raise ParameterError(
                f"fields of shapes {self.values.shape} and {other.values.shape}", rule, "make them anew"
            )
        slopes = [field.slope for field in (self, other) if field.slope]
        return type(self)(
            self.values + other.values,
            self.blocked | other.blocked,
            " + ".join(field.name for field in (self, other) if field.prices or not (self.prices or other.prices)),
            reduce(add, slopes) if slopes else None,
        )

    @cached_property
    def prices(self) -> bool:
        """Whether it has a price of anything, and does not only close cells."""
        return self.slope is not None or bool(self.values.any())

    def __radd__(self, other: object) -> Self:
        """Itself, for `sum`, which begins with 0."""
        return self if isinstance(other, int) and other == 0 else NotImplemented

    def __setstate__(self, state: dict[str, Any]) -> None:
        for array in (state["values"], state["blocked"]):
            read_only(array)  # pickling drops the flag
        self.__dict__.update(state)

    def __repr__(self) -> str:
        rows, cols = self.values.shape
        blocks = f", {int(self.blocked.sum())} cells blocked" if self.blocked.any() else ""
        slope = f", up {self.slope.up:.4g}, down {self.slope.down:.4g}" if self.slope else ""
        return f"CostField({self.name!r}, {rows} x {cols} cells, 0..{self.values.max():.4g}{slope}{blocks})"

    @cached_property
    def digest(self) -> str:
        """SHA-256 of shape, values, blocks and slope, hexadecimal."""
        head = f"{self.values.shape}\n".encode()
        said = hashlib.sha256(head + self.values.tobytes() + self.blocked.tobytes())
        if self.slope:
            said.update(f"{self.slope.up!r} {self.slope.down!r}\n".encode() + self.slope.elevation.tobytes())
        return said.hexdigest()

    def check_fits(self, grid: GridMap) -> None:
        """Refuse a field that is not of this map's shape.

        Raises
        ------
        ParameterError
        """
        if self.values.shape != grid.shape:
            given = f"a cost field of {self.values.shape[0]} x {self.values.shape[1]} cells"
            raise ParameterError(given, f"the map has {grid.rows} x {grid.cols}", "make the field for this map")


def table(what: str, given: ArrayLike, kinds: str, each: str) -> NDArray[Any]:
    """What is given, as an array of rows and columns.

    Parameters
    ----------
    what : str
        Its name in errors.
    given : array_like
    kinds : str
        Kinds of dtype that are taken: some of "b" bool, "i" and "u" whole numbers, "f" floats.
    each : str
        What it has for each cell, for errors.

    Raises
    ------
    ParameterError
        Another kind, other dimensions, no cells, masked cells.
    """
    rule = f"it has {each} for each cell"
    try:
        array = np.asarray(given)
    except (TypeError, ValueError, OverflowError) as error:
        raise ParameterError(f"{what} {shown(given)}", rule, "give an array of rows and columns") from error
    if array.dtype.kind not in kinds:
        raise ParameterError(f"{what} {shown(given)} of type {array.dtype}", rule, "convert the array")
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(f"{what} of shape {array.shape}", "it has rows and columns", "give a 2-D array")
    if np.ma.is_masked(given):
        raise ParameterError(f"{what} with masked cells", rule, "fill them, array.filled(...)")
    return array


def check_weight(name: str, value: Any) -> float:
    """A weight: a finite number from 0 to 1e9, or a `ParameterError`."""
    number = finite_number(value)
    if math.isnan(number) or not 0 <= number <= LARGEST:
        raise ParameterError(
            f"{name} {shown(value)}", f"{name} is a number from 0 to {LARGEST:g}", "give one, such as 1"
        )
    return number
