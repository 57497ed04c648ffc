"""Typed errors: what was given, which rule it breaks, what to do."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from pathlib import PurePath
from types import UnionType


class AntnavError(Exception):
    """Base of every error that antnav raises on purpose.

    Attributes
    ----------
    given, rule, remedy : str
        The offending value, the rule that it breaks, and what helps.
    nav2_code : int
        The error code of nav2's ComputePathToPose action that means the same (200 unknown, 201 planner).
    """

    nav2_code = 201

    def __init__(self, given: str, rule: str, remedy: str) -> None:
        super().__init__(given, rule, remedy)
        self.given, self.rule, self.remedy = given, rule, remedy

    def __str__(self) -> str:
        return f"{self.given}: {self.rule}; {self.remedy}"


class ParameterError(AntnavError, ValueError):
    """A parameter lies outside its range, or parts were combined that do not fit."""


class RuleError(AntnavError, RuntimeError):
    """A rule of the user's own raised, cannot be compiled, or does what it must not."""


class MapError(AntnavError, ValueError):
    """A map, or a file that should hold one, is not usable."""


class MapFileError(MapError):
    """A map file, or the image that it names, is missing or cannot be read."""


class MapFormatError(MapError):
    """A map file breaks the rules of its format."""


class MapSizeError(MapError):
    """A map is empty or larger than antnav takes."""


class EndpointError(AntnavError, ValueError):
    """The start or the goal cannot be used; `end` says which."""

    def __init__(self, end: str, given: str, rule: str, remedy: str) -> None:
        super().__init__(given, rule, remedy)
        self.args = (end, given, rule, remedy)
        self.end = end


class OutsideMapError(EndpointError):
    """The start or the goal lies outside the map."""

    @property
    def nav2_code(self) -> int:  # type: ignore[override]
        """203 for the start, 204 for the goal."""
        return 203 if self.end == "start" else 204


class OccupiedError(EndpointError):
    """The start or the goal lies on a cell that is not free."""

    @property
    def nav2_code(self) -> int:  # type: ignore[override]
        """205 for the start, 206 for the goal."""
        return 205 if self.end == "start" else 206


class PathError(AntnavError, ValueError):
    """A path breaks one of the rules that `check_path` verifies."""


class ResultFormatError(AntnavError, ValueError):
    """A file is not a result that this version of antnav can read."""


class OutputError(AntnavError, OSError):
    """An output file could not be written; nothing of it was left behind."""


class WorkerLostError(AntnavError, RuntimeError):
    """A worker died while it ran a job, and again each time the job was tried anew."""


def check_type(what: str, value: object, kind: type | UnionType, remedy: str) -> None:
    """Refuse what is not of a type.

    Raises
    ------
    ParameterError
        It is of another one.
    """
    if not isinstance(value, kind):
        name = getattr(kind, "__name__", str(kind).rpartition(".")[2])
        raise ParameterError(f"{what} {shown(value)}", f"its type is {name}", remedy)


def likely(given: str, known: Iterable[str]) -> str:
    """Names that are near to what was given: "share", "share or shore"; empty where none is."""
    from difflib import get_close_matches  # errors only need it

    return " or ".join(get_close_matches(given, list(known), 3))


def shown(value: object) -> str:
    """A value for the first part of an error: short, whatever it is."""
    if isinstance(value, PurePath):
        value = str(value)
    try:
        return reprlib.repr(value)
    except ValueError:  # an integer with thousands of digits
        return "of enormous size"
