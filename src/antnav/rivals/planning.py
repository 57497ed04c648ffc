"""RIVALS: planners without ants, with their defaults, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from antnav.planner.planner import KINDS
from antnav.rivals.encoding import Segments
from antnav.rivals.metaheuristics import Metaheuristic, Method
from antnav.rivals.potential_field import PotentialField
from antnav.rivals.rival import Rival


def _rivals() -> dict[str, Rival]:
    rivals: list[Rival] = [Metaheuristic(method=method, segments=join) for method in Method for join in Segments]
    return {rival.name: rival for rival in [*rivals, PotentialField()]}


#: Every rival with its defaults, by name.
RIVALS: Mapping[str, Rival] = MappingProxyType(_rivals())


def _made(kind: type[Rival], document: dict[str, Any]) -> Rival:
    """A rival of its document."""
    return kind(**{key: value for key, value in document.items() if key not in {"kind", "name", "certainty"}})


KINDS["metaheuristic"] = lambda document: _made(Metaheuristic, document)
KINDS["potential-field"] = lambda document: _made(PotentialField, document)
