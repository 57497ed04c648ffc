"""What a value is: a finite number, a whole one, a seed, an array that is closed to writing."""

from __future__ import annotations

import math
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown

Array = TypeVar("Array", bound=NDArray[Any])


def finite_number(value: Any) -> float:
    """The number that a value is, NumPy's included; nan where it is none: a bool, a text, an infinity."""
    if isinstance(value, bool | np.bool_ | str | bytes):
        return math.nan
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan
    return number if math.isfinite(number) else math.nan


def is_whole(value: Any) -> bool:
    """Whether a value is a whole number, NumPy's included; a bool is none."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def whole_in(name: str, value: Any, least: int, most: int) -> int:
    """A whole number in a range, or a `ParameterError`."""
    if not is_whole(value) or not least <= value <= most:
        raise ParameterError(f"{name} {shown(value)}", f"it is a whole number in {least}..{most}", "give one")
    return int(value)


def finite_row(name: str, given: Any, length: int) -> NDArray[np.float64]:
    """So many finite numbers, shape (length,), or a `ParameterError`."""
    try:
        row = np.asarray(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        row = np.empty((0, 0))
    if row.shape != (length,) or not np.isfinite(row).all():
        rule = f"there are {length} finite numbers, one for each objective"
        raise ParameterError(f"{name} {shown(given)}", rule, "give them in the order of the objectives")
    return row


def read_only(array: Array) -> Array:
    """The array, closed to writing: it is kept and handed out more than once."""
    array.flags.writeable = False
    return array


def check_seed(seed: int) -> int:
    """A seed in 0..2**64 - 1, or a `ParameterError`."""
    if not is_whole(seed) or not 0 <= seed < 2**64:
        raise ParameterError(f"seed {shown(seed)}", "a seed is a whole number in 0..2**64 - 1", "give one, such as 7")
    return int(seed)
