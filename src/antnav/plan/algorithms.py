"""algorithm: every planner of antnav by its name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from inspect import Parameter, signature
from typing import Any, Protocol

from antnav.ants.presets import PRESETS
from antnav.colony.parameters import RULES
from antnav.errors import ParameterError, likely, shown
from antnav.planner.exact import astar, dijkstra, jps
from antnav.planner.planner import KINDS, Planner
from antnav.plugins.loading import ALGORITHMS, HOW, divided, sought
from antnav.plugins.source import Source


class Registered(Protocol):
    """An algorithm or a planner of a user's."""

    source: Source

    def __call__(self, **choices: Any) -> Planner: ...  # noqa: D102


#: Exact planners by name.
EXACT: Mapping[str, Callable[[], Planner]] = {"astar": astar, "dijkstra": dijkstra, "jps": jps}
#: Those of users by name, see `antnav.register`.
REGISTERED: dict[str, Registered] = {}


def names() -> tuple[str, ...]:
    """Names that `algorithm` takes: presets, exact planners, rivals, and what users have registered."""
    return (*PRESETS, *EXACT, *_rivals(), *REGISTERED)


def algorithm(name: str, /, **choices: Any) -> Planner:
    """The planner of that name, with some parameters chosen.

    Parameters
    ----------
    name : str
        A preset such as "paco", "astar", "dijkstra" or "jps", a rival such as "pso-straight", or one of your own: by
        its name once it is registered, or as "mine.py:name".
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
    if made is None and named:
        try:
            found = own(name)
        except ParameterError:
            if instead := _rule(name):
                raise instead from None
            raise
        if found:
            return found(**choices)
    if made is None:
        if named and (instead := _rule(name)):
            raise instead
        rule = f"the planners are {', '.join((*PRESETS, *EXACT))} and the rivals {', '.join(_rivals())}"
        rule += f"; your own {', '.join(REGISTERED)}" if REGISTERED else ""
        remedy = f"choose {(named and likely(name, names())) or 'one of them'}, {HOW}"
        raise ParameterError(f"algorithm {shown(name)}", rule, remedy)
    known = [] if name in EXACT else [field.name for field in fields(made)]  # type: ignore[arg-type]
    if unknown := [choice for choice in choices if choice not in known]:
        rule = f"{name} has {', '.join(known) or 'no parameters'}"
        raise ParameterError(f"parameter {unknown[0]!r}", rule, "leave it out")
    return replace(made, **choices) if choices else made  # type: ignore[type-var]


def _rule(name: str) -> ParameterError | None:
    """What is told where a user's rule of a colony is taken for an algorithm; None where there is no such rule."""
    known = divided(name)[1]
    kinds = [kind for kind, family in RULES.items() if known in family.registered]
    if not kinds:
        return None
    preset = "paco" if kinds[0] == "cuts" else "npaco"
    remedy = f'give {kinds[0]}="{name}" to a preset such as {preset}, on the command line --set {kinds[0]}={name}'
    return ParameterError(f"algorithm {shown(name)}", f"it is a {kinds[0].replace('_', ' ')} rule", remedy)


def own(name: Any) -> Registered | None:
    """What a user has registered under a name, or in "mine.py:name", which is loaded; None: nothing."""
    if not isinstance(name, str):
        return None
    builtin = name in PRESETS or name in EXACT or (not divided(name)[0] and name in _rivals())
    return None if builtin else sought(name, REGISTERED.get, ALGORITHMS)


def short_name(name: str) -> str:
    """The name alone of "mine.py:name", which is loaded."""
    return divided(name)[1] if own(name) else name


def arguments(name: str) -> dict[str, Any]:
    """Keyword arguments of the function that makes a user's algorithm, with their defaults."""
    function = getattr(REGISTERED.get(divided(name)[1]), "function", None)
    if function is None:
        return {}
    return {
        one.name: one.default for one in signature(function).parameters.values() if one.default is not Parameter.empty
    }


def _rival(document: dict[str, Any]) -> Planner:
    """A rival of its document, for files that are read before anybody has asked for rivals."""
    _rivals()
    return KINDS[document["kind"]](document)


for _kind in ("metaheuristic", "potential-field"):
    KINDS.setdefault(_kind, _rival)


def _rivals() -> Mapping[str, Planner]:
    from antnav.rivals.planning import RIVALS  # SciPy and others come with it

    return RIVALS
