"""What can be registered: names that are free, functions with arguments that parameters can be made of."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import fields
from typing import Any

from antnav.colony.parameters import RULES, Decomposition, Settings
from antnav.colony.parts import Parameter, Part, parameter
from antnav.colony.parts.parameter import LARGEST
from antnav.errors import ParameterError, check_type, shown
from antnav.planner.facts import Knows
from antnav.plugins.source import Source
from antnav.values import finite_number

_NAME = re.compile(r"[^\W\d][\w.-]{0,99}")
_NO_WORD = re.compile(r"\W")
#: Names that documents and study files have for something else.
_RESERVED = {"certainty", "kind", "label", "method", "name", "own", "preset", "rival"} | {
    one.name for kind in (Settings, Decomposition) for one in fields(kind)
}
#: What parts get beside what their classes have, and what Python calls them in there.
_OF_PARTS = {"function", "self", "source"}


def checked_name(kind: str, defined: Any, name: str | None) -> str:
    """The name under which a function or a class is to be registered.

    Raises
    ------
    ParameterError
        It is no word, or it is neither a function nor a class.
    """
    if not (callable(defined) and hasattr(defined, "__qualname__")):  # such as functools.partial
        rule = f"an own {kind} is defined by a function or a class"
        raise ParameterError(f"{kind} {shown(defined)}", rule, f"write @an.register.{kind} above its definition")
    found = defined.__name__ if name is None else name
    if not isinstance(found, str) or not _NAME.fullmatch(found):
        rule = "a name is a word of up to 100 letters, digits, dots and hyphens"
        raise ParameterError(f"name {shown(found)} of an own {kind}", rule, 'give another, as in name="share"')
    return found


def check_version(name: str, version: str) -> None:
    """Refuse a version that is no text."""
    check_type(f"version of {name}", version, str, 'give a text, such as "1.2"')


def check_free(kind: str, source: Source, builtin: Container[str], registered: Mapping[str, Any]) -> None:
    """Refuse a name that is taken: by antnav, or by another file with other code.

    Code that is registered once more, or anew after a change of its file or cell, takes the place of what was.
    """
    name = source.name
    remedy = f'give another, as in @an.register.{kind}(name="my_{name}")'
    if name in builtin:
        raise ParameterError(f"{kind} {name}", "antnav has one of that name", remedy)
    before = registered.get(name)
    if before is not None and before.source.place != source.place and before.source.digest != source.digest:
        rule = f"{before.source.file or before.source.place} has registered another one of that name"
        raise ParameterError(f"{kind} {source}", rule, remedy)


def parameters_of_function(function: Callable[..., Any], given: Sequence[str], source: Source) -> dict[str, Parameter]:
    """The parameters that the arguments of a function after the first few stand for.

    Parameters
    ----------
    given : sequence of str
        What the first arguments are, in words.

    Raises
    ------
    ParameterError
        The first ones are missing, or a further one is no parameter.
    """
    try:
        arguments = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        arguments = []
    by_position = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    first, further = arguments[: len(given)], arguments[len(given) :]
    if len(first) < len(given) or any(one.kind not in by_position for one in first):
        call = f"{source.name}({', '.join(given)}, ...)"
        raise ParameterError(f"own rule {source}", f"it is called as {call}", f"give it the argument {given[-1]}")
    return {one.name: _parameter(one, source) for one in further}


def _parameter(argument: inspect.Parameter, source: Source) -> Parameter:
    what, default = f"{argument.name} of own rule {source}", argument.default
    if argument.kind not in (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY):
        rule, remedy = "each parameter has a name and a default", "write its parameters out, as in top=3"
        raise ParameterError(what, rule, remedy)
    if isinstance(default, Parameter):
        default.name = argument.name
        _check_default(what, default)
        return default
    if not isinstance(default, bool) and finite_number(default) != finite_number(default):
        rule = "the default of a parameter is a number, True or False"
        given = "none" if default is inspect.Parameter.empty else shown(default)
        raise ParameterError(f"{what}, default {given}", rule, "give one, as in top=3, or an.parameter(3, least=1)")
    made: Parameter = parameter(default, least=-LARGEST, most=LARGEST)
    made.name = argument.name
    return made


def _check_default(what: str, declared: Parameter) -> None:
    if not isinstance(declared.default, bool | int | float | None):
        rule = "the default of a parameter is a number, True, False, or None for a number that may be left open"
        raise ParameterError(f"{what}, default {shown(declared.default)}", rule, "give one")
    try:
        declared.checked(declared.default)
    except ParameterError as error:
        raise ParameterError(
            f"{what}, default {shown(declared.default)}", error.rule, "give one in its range"
        ) from None


def check_parameters(kind: str, part: type[Part], source: Source) -> None:
    """Refuse parameters whose names stand for something else in study files, presets and documents.

    Raises
    ------
    ParameterError
        A field of `Algorithm` or `Decomposition`, something that each part has, or a parameter of another kind of part.
    """
    base = part.__bases__[0]
    others = {
        name: f"{other} {owner}"
        for other, family in RULES.items()
        if other != kind
        for owner, known in family.known().items()
        for name in known.parameters
    }
    for name in (one for one in part.parameters if one in vars(part)):
        if name in _RESERVED or name in _OF_PARTS or hasattr(base, name):
            owner = "every algorithm" if name in _RESERVED else "every part"
        elif name in others:
            owner = others[name]
        else:
            continue
        rule = f"a parameter's name stands for one thing, and {name} belongs to {owner}"
        remedy = f"call it another, such as {_NO_WORD.sub('_', source.name)}_{name}"
        raise ParameterError(f"{name} of own rule {source}", rule, remedy)


def knows_of(function: Callable[..., Any]) -> Knows:
    """What a function of a `Ground` knows of exact distances: those to the goal, where it asks for any."""
    code = getattr(function, "__code__", None)
    return Knows.TO_GOAL if code is not None and "distances_to" in code.co_names else Knows.NOTHING
