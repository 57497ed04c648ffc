"""Any numbers as a cost field."""

from __future__ import annotations

from numpy.typing import ArrayLike

from antnav.world.cost import CostField


def array(values: ArrayLike, name: str = "cost") -> CostField:
    """A field of any numbers.

    Parameters
    ----------
    values : array_like of numbers, shape (rows, cols)
        Cost per metre of each cell on top of 1, finite, 0 to 1e9; row 0 is the top of the map. Copied.
    name : str
        For legends and reports.

    Raises
    ------
    ParameterError
        Not such numbers; a name that is no text.
    """
    return CostField(values, name=name)  # type: ignore[arg-type]  # it converts
