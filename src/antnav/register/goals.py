"""Objectives of users, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from antnav.errors import ParameterError, shown
from antnav.objectives.named import PLAIN, REGISTERED
from antnav.objectives.objective import Objective
from antnav.plugins.loading import said
from antnav.plugins.source import Source
from antnav.register.checks import check_free, check_version, checked_name
from antnav.register.sending import packed, received


def objective(kind: type[Objective] | None = None, *, name: str | None = None, version: str = "") -> Any:
    """Register an objective: what is to be small about a path, for fronts.

    Parameters
    ----------
    kind : type of Objective
        A class that derives from `antnav.objectives.Objective` and can be made without arguments.
    name : str, optional
        Default: its attribute ``name``.
    version
        As of `heuristic`.

    Returns
    -------
    type of Objective
        The class itself.

    Raises
    ------
    ParameterError
        The name is taken, or it is no such class.
    """

    def register(kind: type[Objective]) -> type[Objective]:
        given: Any = kind
        if not (isinstance(given, type) and issubclass(given, Objective)):
            rule = "it is a class that derives from antnav.objectives.Objective"
            raise ParameterError(f"objective {shown(kind)}", rule, "write @an.register.objective above such a class")
        try:
            usual = kind()
        except Exception as error:
            rule = f"it is made without arguments, and that raised {said(error)}"
            raise ParameterError(f"objective {kind.__qualname__}", rule, "give its fields defaults") from error
        known = checked_name("objective", kind, usual.name if name is None else name)
        check_version(known, version)
        source = Source.of(kind, known, version)
        check_free("objective", source, {*PLAIN, "risk", "time", "energy"}, REGISTERED)
        kind.source = source  # type: ignore[attr-defined]
        kind.__reduce__ = _packed  # type: ignore[method-assign, assignment]
        REGISTERED[known] = kind
        return kind

    return register if kind is None else register(kind)


def _packed(given: Objective) -> tuple[Callable[..., Objective], tuple[Any, ...]]:
    """An objective for `pickle`: the code of its class, and its attributes."""
    kind = type(given)
    source: Source = kind.source  # type: ignore[attr-defined]
    return objective_again, (source, packed("objective", source, kind.__module__, kind), vars(given))


def objective_again(source: Source, code: bytes, values: dict[str, Any]) -> Objective:
    """The objective that was packed; of the class that is registered here, where that is the same code."""
    known = REGISTERED.get(source.name)
    if known is None or known.source != source:  # type: ignore[attr-defined]
        known = received("objective", source, code, lambda kind: kind)
    made: Objective = known.__new__(known)
    vars(made).update(values)
    return made
