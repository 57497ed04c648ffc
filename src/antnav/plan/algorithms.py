"""algorithm: every planner of antnav by its name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any

from antnav.ants.presets import PRESETS
from antnav.errors import ParameterError, shown
from antnav.planner.exact import astar, dijkstra, jps
from antnav.planner.planner import KINDS, Planner

#: Exact planners by name.
EXACT: Mapping[str, Callable[[], Planner]] = {"astar": astar, "dijkstra": dijkstra, "jps": jps}


def names() -> tuple[str, ...]:
    """Names that `algorithm` takes: presets, exact planners, rivals."""
    return (*PRESETS, *EXACT, *_rivals())


def algorithm(name: str, /, **choices: Any) -> Planner:
    """The planner of that name, with some parameters chosen.

    Parameters
    ----------
    name : str
        A preset such as "paco", "astar", "dijkstra" or "jps", or a rival such as "pso-straight".
    **choices
        Parameters of that planner.

    Raises
    ------
    ParameterError
        No such planner, or a parameter that it does not have or that is out of range.
    """
    if isinstance(name, str) and name in PRESETS:
        return PRESETS[name](**choices)
    named = isinstance(name, str)
    made = EXACT[name]() if named and name in EXACT else _rivals().get(name) if named else None
    if made is None:
        from difflib import get_close_matches

        near = get_close_matches(shown(name), names(), 3)
        rule = f"the planners are {', '.join((*PRESETS, *EXACT))} and the rivals {', '.join(_rivals())}"
        raise ParameterError(f"algorithm {shown(name)}", rule, f"choose {' or '.join(near) or 'one of them'}")
    known = [] if name in EXACT else [field.name for field in fields(made)]  # type: ignore[arg-type]
    if unknown := [choice for choice in choices if choice not in known]:
        rule = f"{name} has {', '.join(known) or 'no parameters'}"
        raise ParameterError(f"parameter {unknown[0]!r}", rule, "leave it out")
    return replace(made, **choices) if choices else made  # type: ignore[type-var]


def _rival(document: dict[str, Any]) -> Planner:
    """A rival of its document, for files that are read before anybody has asked for rivals."""
    _rivals()
    return KINDS[document["kind"]](document)


for _kind in ("metaheuristic", "potential-field"):
    KINDS.setdefault(_kind, _rival)


def _rivals() -> Mapping[str, Planner]:
    from antnav.rivals.planning import RIVALS  # SciPy and others come with it

    return RIVALS
