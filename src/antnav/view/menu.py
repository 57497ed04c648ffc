"""The menu: algorithms, their parameters with their ranges, and maps, as a page offers them."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from enum import Enum
from typing import Any

from antnav.ants.algorithm import Algorithm
from antnav.ants.presets import PRESETS
from antnav.colony.parameters import FAMILIES, Decomposition, Settings
from antnav.colony.parts import Parameter, parameters_of
from antnav.errors import ParameterError
from antnav.maps import builtin_names, generator_names
from antnav.plan.algorithms import EXACT, REGISTERED, algorithm, names
from antnav.planner.planner import Planner
from antnav.plugins.loading import divided
from antnav.view.messages import FASTEST, MOST_BYTES, MOST_CELLS, Panel
from antnav.world.moves import CornerRule

#: First in the form; the others fold away.
FIRST = ("ants", "iterations", "alpha", "beta", "rho", "q")


def menu() -> dict[str, Any]:
    """All of it, as JSON types."""
    return {
        "is": "menu",
        "algorithms": [_algorithm(name, made(), made) for name, made in PRESETS.items()]
        + [{"name": name, "about": _first_line(EXACT[name]), "parameters": []} for name in EXACT]
        + [_own(name) for name in REGISTERED],
        "maps": list(builtin_names()),
        "generators": list(generator_names()),
        "corner_rules": [rule.value for rule in CornerRule],
        "most_cells": MOST_CELLS,
        "most_bytes": MOST_BYTES,
        "fastest": FASTEST,
    }


def planners(panels: Sequence[Panel]) -> list[Planner]:
    """The planners of panels, all from the menu.

    Raises
    ------
    ParameterError
        There is none of that name, or a parameter is out of its range.
    """
    for panel in panels:
        for name, value in {"algorithm": panel.algorithm, **panel.parameters}.items():
            if isinstance(value, str) and divided(value)[0]:  # a page, or a link, executes no file
                rule = "the view takes what is registered"
                raise ParameterError(f"{name} {value!r}", rule, "load the file with --plugin, and give the name alone")
    shown = (*PRESETS, *EXACT, *REGISTERED)
    for name in {panel.algorithm for panel in panels} - {*shown}:
        if name in names():
            raise ParameterError(f"algorithm {name!r}", f"the view shows {', '.join(shown)}", "choose one")
    return [algorithm(panel.algorithm, **panel.parameters) for panel in panels]


def _own(name: str) -> dict[str, Any]:
    """What a user has registered."""
    made = REGISTERED[name]
    usual = made()
    if isinstance(usual, Algorithm):
        return _algorithm(name, usual, made)
    return {"name": name, "about": _first_line(made), "parameters": []}


def _first_line(described: Any) -> str:
    return (inspect.getdoc(described) or "").partition("\n")[0]


def _algorithm(name: str, preset: Any, described: Any) -> dict[str, Any]:
    known = dict(parameters_of(Settings))
    if preset.decomposition:
        known |= parameters_of(Decomposition)
    for part in preset.parts.values():
        known |= part.parameters
    values = preset.choices()
    ordered = sorted(known, key=lambda key: FIRST.index(key) if key in FIRST else len(FIRST))
    return {
        "name": name,
        "about": _first_line(described),
        "certainty": str(preset.certainty),
        "parameters": [_parameter(key, known[key], values[key]) for key in ordered if key in values]
        + [_part(kind, str(part)) for kind, part in preset.parts.items()],
    }


def _part(kind: str, value: str) -> dict[str, Any]:
    choices = sorted(FAMILIES[kind].known())
    return {
        "name": kind,
        "symbol": "",
        "range": ", ".join(choices),
        "value": value,
        "kind": "choice",
        "choices": choices,
    }


def _parameter(name: str, known: Parameter, value: Any) -> dict[str, Any]:
    told = {"name": name, "symbol": known.symbol, "range": known.range, "value": value}
    if isinstance(known.default, Enum):
        return told | {"kind": "choice", "choices": [str(one) for one in type(known.default)]}
    if isinstance(known.default, bool):
        return told | {"kind": "truth"}
    whole = isinstance(known.default, int)
    return told | {
        "kind": "whole" if whole else "number",
        "least": 0 if known.zero else known.least,
        "most": known.most,
        "sane": known.sane,
        "optional": known.default is None,
    }
