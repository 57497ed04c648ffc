"""A parameter: its default, range and certainty, said once for the validator, the docs and the command line."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from typing import Any

from antnav.colony.parts.names import Name
from antnav.errors import ParameterError, check_type, shown
from antnav.planner.facts import Basis
from antnav.values import finite_number

#: Largest whole number that a parameter takes.
LARGEST = 10**9


class Parameter:
    """A class attribute that says which values the attribute of an instance may have; read, it is the default.

    Attributes
    ----------
    name : str
        As users write it.
    default : number, bool, Name or None
        Its type is the parameter's; None stands for a number that may be left open.
    least, most : float
        Range, both ends included but for an `above`.
    above : bool
        Whether the value has to be larger than `least`.
    zero : bool
        Whether 0, which turns it off, is allowed besides.
    sane : tuple of two floats, or None
        What makes sense on most maps.
    symbol : str
        In formulas.
    certainty : Basis or None
        Of the default.
    """

    __slots__ = ("above", "certainty", "default", "least", "most", "name", "sane", "symbol", "zero")

    def __init__(
        self,
        default: Any,
        least: float,
        most: float,
        *,
        above: bool,
        zero: bool,
        sane: tuple[float, float] | None,
        symbol: str,
        certainty: Basis | None,
    ) -> None:
        self.name, self.default = "", default
        self.least, self.most, self.above, self.zero = least, most, above, zero
        self.sane, self.symbol, self.certainty = sane, symbol, certainty

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        return self.default

    def checked(self, value: Any) -> Any:
        """The value, as it is kept.

        Raises
        ------
        ParameterError
            It is out of range.
        """
        default = self.default
        if isinstance(default, Name):
            return type(default).of(value)
        if isinstance(default, bool):
            if not isinstance(value, bool):
                raise ParameterError(f"{self.name} {shown(value)}", "it is true or false", "give one of them")
        elif isinstance(default, int):
            self._check_whole(value)
        elif not (value is None and default is None):
            self._check_number(value)
        return value

    def _check_whole(self, value: Any) -> None:
        whole = isinstance(value, int) and not isinstance(value, bool)
        if not (whole and (self.least <= value <= self.most or (self.zero and value == 0))):
            rule = f"{self.name} is a whole number from {self.least:g} to {self.most:g}"
            raise ParameterError(
                f"{self.name} {shown(value)}",
                rule + (", or 0 for none" if self.zero else ""),
                f"give one, such as {min(max(int(self.least), 50), int(self.most))}",
            )

    def _check_number(self, value: Any) -> None:
        if not (isinstance(value, int | float) and self.least <= finite_number(value) <= self.most):
            rule = f"{self.name} lies in {self.least:g}..{self.most:g}"
            raise ParameterError(f"{self.name} {shown(value)}", rule, "give a number in that range")
        if self.above and value == self.least:
            rule = f"{self.name} is above {self.least:g}"
            raise ParameterError(f"{self.name} {value:g}", rule, "give a positive number, such as 1")

    @property
    def range(self) -> str:
        """The values that it takes, in words."""
        if isinstance(self.default, Enum):
            return ", ".join(type(self.default))
        if isinstance(self.default, bool):
            return "true or false"
        least, most = f"{self.least:g}", f"{self.most:g}"
        if self.most >= LARGEST:
            return f"{least} or more"
        words = f"above {least}, up to {most}" if self.above else f"{least} to {most}"
        return ("0, or " if self.zero else "") + words


def parameter(
    default: Any,
    *,
    least: float = 0,
    most: float = LARGEST,
    above: bool = False,
    zero: bool = False,
    sane: tuple[float, float] | None = None,
    symbol: str = "",
    certainty: Basis | None = None,
) -> Any:
    """A parameter with its range, as the default of an attribute of a part, or of an argument of your own rule.

    Parameters
    ----------
    default : number, bool or None
        None stands for a number that may be left open.
    least, most : float
        Range, both ends included.
    above : bool
        Whether the value has to be larger than `least`.
    zero : bool
        Whether 0, which turns it off, is allowed besides.
    sane : tuple of two floats, optional
        What makes sense on most maps.
    symbol : str
        In formulas.
    certainty : Basis, optional
        Of the default.

    Returns
    -------
    Parameter

    Raises
    ------
    ParameterError
        There is no such range, or the default is none of the values.
    """
    if not finite_number(least) <= finite_number(most):
        rule = "least and most are numbers, least the smaller one"
        raise ParameterError(f"a parameter in {shown(least)}..{shown(most)}", rule, "give such a range")
    if not (
        sane is None or (isinstance(sane, tuple) and len(sane) == 2 and all(map(isfinite, map(finite_number, sane))))
    ):
        raise ParameterError(
            f"sane {shown(sane)}", "it is a pair of numbers", "give one, such as (1, 5), or leave it out"
        )
    if not (default is None or isinstance(default, Name | bool) or isfinite(finite_number(default))):
        rule = "it is a number, True, False, or None for a number that may be left open"
        raise ParameterError(f"default {shown(default)}", rule, "give one")
    check_type("symbol", symbol, str, 'give a text, such as "rho"')
    return Parameter(default, least, most, above=above, zero=zero, sane=sane, symbol=symbol, certainty=certainty)


#: What `parameters_of` has found: every choice of an algorithm is checked by it.
_FOUND: dict[type, dict[str, Parameter]] = {}


def parameters_of(kind: type) -> dict[str, Parameter]:
    """The parameters of a class, those of its bases first."""
    if kind not in _FOUND:
        _FOUND[kind] = {
            name: value
            for base in reversed(kind.__mro__)
            for name, value in vars(base).items()
            if isinstance(value, Parameter)
        }
    return _FOUND[kind]
