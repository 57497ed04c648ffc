"""DynamicRecord: what a study of maps that change keeps of one run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from antnav.planner.facts import Certainty
from antnav.study.record import Mark


@dataclass(frozen=True, kw_only=True)
class DynamicRecord:
    """One run over a sequence of changes, as it is stored and as tables and figures see it.

    Attributes
    ----------
    key : str
        Hexadecimal digest of everything that decides the outcome: code, map, ends, rules, changes, algorithm, seed.
    map, algorithm : str
        Labels of the study.
    seed : int
    optima : tuple of float
        Exact, of the map as it is first, and after each change; in cells.
    best : tuple of tuple of float or None
        For each of these maps, best cost so far on it by iteration; None before the first arrival.
    steps : int
        Moves of all ants.
    seconds : float
        Wall seconds of all searches. Only these and the environment differ between two runs of one key.
    certainty : Certainty
    notes : tuple of str
    marks : tuple of Mark
    environment : dict of str to str
        Versions of Python and libraries, and the machine.
    """

    table: ClassVar[str] = "dynamic"

    key: str
    map: str
    algorithm: str
    seed: int
    optima: tuple[float, ...]
    best: tuple[tuple[float | None, ...], ...]
    steps: int
    seconds: float
    certainty: Certainty
    notes: tuple[str, ...]
    marks: tuple[Mark, ...] = ()
    environment: dict[str, str]
