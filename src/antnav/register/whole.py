"""Whole algorithms and planners of users, by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, fields, replace
from typing import Any

from antnav.ants.algorithm import Algorithm
from antnav.ants.presets import PRESETS
from antnav.errors import AntnavError, ParameterError, shown
from antnav.plan.algorithms import EXACT, REGISTERED
from antnav.planner.facts import Basis, Certainty, Clause
from antnav.planner.planner import KINDS, Planner
from antnav.plugins.loading import said
from antnav.plugins.source import Source
from antnav.register.checks import check_free, check_version, checked_name
from antnav.register.sending import packed, received

#: What a planner's class has already, or documents say of it.
_RESERVED = {"kind", "label", "own", "preset", "rival", "source"}


class OwnAlgorithm:
    """A preset of a user's: a function that makes a planner.

    Attributes
    ----------
    source : Source
    function : callable
    """

    role = "algorithm"

    def __init__(self, function: Callable[..., Planner], source: Source) -> None:
        self.function, self.source = function, source
        self.__doc__, self.__name__ = function.__doc__, source.name
        self.__module__, self.__wrapped__ = function.__module__, function

    def __call__(self, **choices: Any) -> Planner:
        """The planner with these choices.

        Raises
        ------
        ParameterError
            The function raised an error, or made no planner; a choice is out of its range.
        """
        given, remedy = f"own algorithm {self.source}", "mend it"
        try:
            made = self.function(**choices)
        except AntnavError:
            raise
        except Exception as error:
            raise ParameterError(given, f"it raised {said(error)}", remedy) from error
        if not isinstance(made, Planner):
            raise ParameterError(given, f"it returns a planner, not {shown(made)}", "return one, as in an.npaco()")
        if not isinstance(made, Algorithm):
            return made
        clause = Clause(Basis.OWN, f"own algorithm {self.source}")
        certainty = Certainty((clause, *made.certainty.clauses), made.certainty.known)
        return replace(made, name=str(choices.get("name", self.source.name)), certainty=certainty)

    def __repr__(self) -> str:
        return f"<own algorithm {self.source}>"


def algorithm(function: Callable[..., Planner] | None = None, *, name: str | None = None, version: str = "") -> Any:
    """Register an algorithm: a preset of your own.

    Parameters
    ----------
    function : callable
        It returns a planner, such as ``an.npaco(pheromone=share, **choices)``; its keyword arguments are its choices.
    name, version
        As of `heuristic`.

    Returns
    -------
    OwnAlgorithm
        In place of the function; the planners of ants that it makes bear the name, and tell of it in their certainty.

    Raises
    ------
    ParameterError
        The name is taken.
    """

    def register(function: Callable[..., Planner]) -> OwnAlgorithm:
        source = _source("algorithm", function, name, version)
        found = OwnAlgorithm(function, source)
        REGISTERED[source.name] = found
        return found

    return register if function is None else register(function)


def planner(kind: type[Planner] | None = None, *, name: str | None = None, version: str = "") -> Any:
    """Register a planner: a class of your own that derives from `Planner`, a rival of the ants or another searcher.

    Parameters
    ----------
    kind : type of Planner
        A frozen dataclass whose fields, its parameters, are numbers, texts or truths with defaults.
    name : str, optional
        Default: its field ``name``.
    version
        As of `heuristic`.

    Returns
    -------
    type of Planner
        The class itself: results of it can be run again, and other processes need not import it.

    Raises
    ------
    ParameterError
        The name is taken, or it is no such class.
    """

    def register(kind: type[Planner]) -> type[Planner]:
        usual = _usual(kind)
        source = _source("planner", kind, usual.name if name is None else name, version)
        return _known(kind, source)

    return register if kind is None else register(kind)


def _source(kind: str, defined: Any, name: str | None, version: str) -> Source:
    known = checked_name(kind, defined, name)
    check_version(known, version)
    source = Source.of(defined, known, version)
    from antnav.rivals.planning import RIVALS

    check_free(kind, source, {**PRESETS, **EXACT, **RIVALS}, REGISTERED)
    return source


def _usual(kind: Any) -> Planner:
    """The planner with its defaults, if the class is what it should be."""
    rule = "it is a class that derives from an.Planner"
    if not (isinstance(kind, type) and issubclass(kind, Planner)):
        raise ParameterError(f"planner {shown(kind)}", rule, "write @an.register.planner above such a class")
    given = f"planner {kind.__qualname__}"
    if not getattr(getattr(kind, "__dataclass_params__", None), "frozen", False):
        rule = "its class is a frozen dataclass"
        raise ParameterError(given, rule, "write @dataclass(frozen=True) between @an.register.planner and the class")
    for one in fields(kind):  # type: ignore[arg-type]
        if one.name in _RESERVED:
            raise ParameterError(f"{given}, field {one.name}", "files use that name for something else", "rename it")
        if one.default is MISSING and one.default_factory is MISSING:
            rule = "files name it without its parameters, which have defaults then"
            raise ParameterError(f"{given}, field {one.name}", rule, f"give it one, as in {one.name}: float = 1.0")
        if not isinstance(one.default, bool | int | float | str | None):
            rule = "its fields are numbers, texts or truths"
            raise ParameterError(f"{given}, field {one.name}", rule, "give it such a default")
    return kind()


def _known(kind: type[Planner], source: Source) -> type[Planner]:
    """The class, marked as a user's, by its name and by the kind that files give."""
    alone = kind.__module__ == "__main__" or kind.__module__.startswith("antnav_plugin_")
    module = source.file.removesuffix(".py") if alone and source.file else kind.__module__
    named = f"{module}.{kind.__qualname__}"
    namesakes = [other.source for other in REGISTERED.values() if isinstance(other, _Named) and other.files == named]
    for other in namesakes:
        if other.place != source.place and other.digest != source.digest:
            rule = f"files would take it for {other}, a class of that name in another file of that name"
            raise ParameterError(f"planner {source}", rule, "rename the class or the file")
    kind.source = source  # type: ignore[attr-defined]
    kind.own = (kind,)  # type: ignore[assignment]
    if "certainty" not in {one.name for one in fields(kind)} and kind.certainty == Planner.certainty:  # type: ignore[arg-type]
        kind.certainty = f"own planner {source}"  # type: ignore[assignment]
    kind.kind = named  # type: ignore[assignment]
    kind.__reduce__ = _packed  # type: ignore[method-assign, assignment]
    KINDS[named] = lambda document: _again(kind, document)
    REGISTERED[source.name] = _Named(kind, source)
    return kind


class _Named:
    """A planner's class by its name."""

    def __init__(self, kind: type[Planner], source: Source) -> None:
        self.kind, self.source, self.__doc__ = kind, source, kind.__doc__
        self.files = str(kind.kind)  #: as files name it

    def __call__(self, **choices: Any) -> Planner:
        known = [one.name for one in fields(self.kind)]  # type: ignore[arg-type]
        if unknown := [choice for choice in choices if choice not in known]:
            rule = f"{self.source.name} has {', '.join(known) or 'no parameters'}"
            raise ParameterError(f"parameter {unknown[0]!r}", rule, "leave it out")
        try:
            return self.kind(**choices)
        except AntnavError:
            raise
        except Exception as error:
            raise ParameterError(f"own planner {self.source}", f"it raised {said(error)}", "mend it") from error


def _again(kind: type[Planner], document: dict[str, Any]) -> Planner:
    """The planner of a document."""
    return kind(**{one.name: document[one.name] for one in fields(kind) if one.name in document})  # type: ignore[arg-type]


def _packed(given: Planner) -> tuple[Callable[..., Planner], tuple[Any, ...]]:
    """A planner for `pickle`: the code of its class, and its fields."""
    kind = type(given)
    source: Source = kind.source  # type: ignore[attr-defined]
    code = packed("planner", source, kind.__module__, kind)
    values = {one.name: getattr(given, one.name) for one in fields(kind)}  # type: ignore[arg-type]
    return planner_again, (source, code, values)


def planner_again(source: Source, code: bytes, values: dict[str, Any]) -> Planner:
    """The planner that was packed; of the class that is registered here, where that is the same code."""
    known = REGISTERED.get(source.name)
    if isinstance(known, _Named) and known.source == source:
        return known.kind(**values)
    made: Planner = received("planner", source, code, _readable)(**values)
    return made


def _readable(kind: Any) -> Any:
    """A class that was sent, which results name here, too."""
    KINDS[kind.kind] = lambda document: _again(kind, document)
    return kind
