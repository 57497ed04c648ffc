"""Subject: a rule, planner or algorithm of a user's that is to be checked."""

from __future__ import annotations

import inspect
import os
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, Self

from antnav.ants.algorithm import Algorithm
from antnav.ants.presets import npaco, paco
from antnav.colony.parts import Part
from antnav.errors import ParameterError, shown
from antnav.objectives.named import REGISTERED as OBJECTIVES
from antnav.objectives.objective import Objective
from antnav.plan.algorithms import REGISTERED
from antnav.planner.planner import Planner
from antnav.plugins.loading import divided, load, load_installed
from antnav.plugins.source import Source
from antnav.register.parts import KINDS
from antnav.register.sending import by_value
from antnav.register.whole import OwnAlgorithm

#: Kinds that a kernel calls in each iteration, step or dead end.
ASKED = ("pheromone", "local_search", "transition", "deadlock")


@dataclass(frozen=True)
class Subject:
    """What is checked.

    Attributes
    ----------
    kind : str
        As its decorator is called.
    made : Part, OwnAlgorithm, Planner or Objective
    """

    kind: str
    made: Any

    @property
    def source(self) -> Source:
        """Where it comes from."""
        source: Source = self.made.source
        return source

    @property
    def name(self) -> str:
        """By which it is registered."""
        return self.source.name

    @property
    def doc(self) -> str:
        """Its documentation."""
        described = self.made if isinstance(self.made, OwnAlgorithm) else type(self.made)
        found = inspect.cleandoc(vars(described).get("__doc__") or "")
        return "" if found.startswith(f"{described.__name__}(") else found  # which dataclasses write themselves

    def planner(self, **choices: Any) -> Planner:
        """An algorithm with it; choices are for those that only it makes complete."""
        if isinstance(self.made, Planner):
            return self.made
        if isinstance(self.made, OwnAlgorithm):
            return self.made()
        preset = paco if self.kind == "cuts" else npaco
        return preset(**{self.kind: self.made, "ants": 20, "iterations": 20} | choices)

    def packed(self) -> bytes:
        """For another process, by value."""
        made = self.made
        if not isinstance(made, OwnAlgorithm):
            return by_value(type(made).__module__, (self, ()))
        parts = [part() for base, *_ in KINDS.values() for part in base.registered.values()]
        return by_value(made.__module__, (self, parts))

    @classmethod
    def unpacked(cls, packed: bytes) -> Self:
        """From there, with all that it may name made known here."""
        subject: Self
        subject, parts = pickle.loads(packed)
        for part in (*parts, subject.made):
            if isinstance(part, Part):
                type(part).registered[part.source.name] = type(part)
        return subject


def is_one_colony(planner: Planner) -> bool:
    """Whether a `Colony` can step through it."""
    return isinstance(planner, Algorithm) and not (
        planner.decomposition or planner.coarse or planner.windows or planner.colonies > 1
    )


def subjects_of(what: Any, names: Sequence[str] = ()) -> list[Subject]:
    """What is registered in a file or a module, or one thing that is registered.

    Parameters
    ----------
    what : str, path, module, or what a decorator returned, or made of it
        A text is a file, "mine.py:name", or a name that is registered, if need be by an installed package.
    names : sequence of str
        Of those that are wanted; default: all.

    Raises
    ------
    ParameterError
        Nothing is registered there, or nothing of such a name.
    """
    found = _known(what)
    if not found:
        rule = "it registers nothing"
        raise ParameterError(
            f"rules of {shown(what)}", rule, "write @an.register.pheromone, or another kind, above one"
        )
    if missing := [name for name in names if name not in {one.name for one in found}]:
        rule = f"there are {', '.join(one.name for one in found)}"
        raise ParameterError(f"rule {shown(missing[0])}", rule, "name one of them, or none for all")
    return [one for one in found if not names or one.name in names]


def _known(what: Any) -> list[Subject]:
    if isinstance(what, str | os.PathLike):
        return _of_text(what)
    if isinstance(what, ModuleType):
        place = getattr(what, "__file__", None)
        return _of_place(str(Path(place).resolve()) if place else what.__name__)
    if isinstance(what, type) and issubclass(what, Part | Planner | Objective) and "source" in vars(what):
        what = what()
    if isinstance(what, OwnAlgorithm):
        return [Subject("algorithm", what)]
    if isinstance(what, Part) and what.own:
        return [Subject(next(kind for kind, (base, *_) in KINDS.items() if isinstance(what, base)), what)]
    if isinstance(what, Planner) and hasattr(what, "source"):
        return [Subject("planner", what)]
    if isinstance(what, Objective) and hasattr(what, "source"):
        return [Subject("objective", what)]
    rule = "it is a file, a module, or what a decorator of an.register returned"
    raise ParameterError(f"rules of {shown(what)}", rule, 'give one, such as "mine.py"')


def _of_text(what: str | os.PathLike[str]) -> list[Subject]:
    """All of a file, one of it, or what is registered under a name."""
    file, name = divided(os.fspath(what))
    if isinstance(what, str) and not file and not what.endswith(".py") and not Path(what).exists():
        return _of_name(what)
    known = _of_place(str(load(file or what).__file__))
    return [one for one in known if not file or one.name == name]


def _of_place(place: str) -> list[Subject]:
    """All that a file or a module has registered."""
    return _registered(lambda source: source.place == place)


def _of_name(name: str) -> list[Subject]:
    """All that is registered under a name."""
    load_installed(name)
    if found := _registered(lambda source: source.name == name):
        return found
    rule = "it is neither a file nor a name that is registered here or by an installed package"
    raise ParameterError(f"rules of {shown(name)}", rule, "give a file, such as mine.py")


def _registered(wanted: Callable[[Source], bool]) -> list[Subject]:
    parts = {kind: base.registered.values() for kind, (base, *_) in KINDS.items()}
    found = [Subject(kind, part()) for kind, known in parts.items() for part in known if wanted(part.source)]
    for one in REGISTERED.values():
        if wanted(one.source):
            own = isinstance(one, OwnAlgorithm)
            found.append(Subject("algorithm", one) if own else Subject("planner", one()))
    found += [Subject("objective", kind()) for kind in OBJECTIVES.values() if wanted(_source_of(kind))]
    return found


def _source_of(kind: Any) -> Source:
    found: Source = kind.source
    return found
