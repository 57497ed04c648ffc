"""`antnav algorithms`: every planner and method of fronts, and how sure we are of it; or all of one."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from dataclasses import fields
from enum import Enum
from typing import Annotated, Any

import typer

from antnav.ants.algorithm import Algorithm
from antnav.ants.presets import PRESETS
from antnav.cli.terminal import FOUND, complain, say, say_rich
from antnav.colony.parameters import FAMILIES, RULES
from antnav.colony.parts import Parameter, Part, parameters_of
from antnav.fronts.method import Method
from antnav.fronts.pareto import METHODS
from antnav.plan.algorithms import EXACT, REGISTERED, algorithm, names
from antnav.planner.planner import Planner, parameters
from antnav.plugins.loading import divided, load, load_all_installed, load_installed

#: Always shown; of the others, those that differ from their defaults are.
PARTS = ("heuristic", "pheromone", "deadlock")
PARAMETERS = ("ants", "iterations", "alpha", "beta", "rho", "q", "tau0")


def algorithms(
    name: Annotated[
        str | None, typer.Argument(help="One of them, with all its parameters, their ranges and what they rest on.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout, by name of the algorithm.")] = False,
) -> int:
    """List the algorithms with their parts, parameters, and how sure it is that they are what their source says."""
    if name is not None and (parts := divided(name))[0]:
        load(parts[0])
        name = parts[1]
    elif name is None:
        for failed in load_all_installed():
            complain(str(failed), kind="warning")
    elif name not in {*PRESETS, *EXACT, *METHODS}:
        load_installed(name)
    methods = {key: METHODS[key]() for key in (METHODS if name is None else [name]) if key in METHODS}
    rules = {key: part for key, part in _rules() if name in (None, key)}
    planners = {key: algorithm(key) for key in (names() if name is None else {name} - methods.keys() - rules.keys())}
    if json:
        import msgspec

        document = {key: {"summary": _summary(key, chosen), **chosen.document()} for key, chosen in planners.items()}
        document |= {
            key: {"summary": _first_line(type(method)), "kind": "front", "certainty": method.certainty}
            | method.document()
            for key, method in methods.items()
        }
        document |= {key: _told(part) for key, part in rules.items()}
        say(msgspec.json.encode(document).decode())
    elif name is None:
        _list({key: chosen for key, chosen in planners.items() if isinstance(chosen, Algorithm)})
        _list_without_ants({key: chosen for key, chosen in planners.items() if not chosen.ants})
        _list_methods(methods)
        _list_rules(rules)
    elif name in rules:
        _show_rule(rules[name])
    elif name in methods:
        method = methods[name]
        _tell(inspect.getdoc(type(method)) or "", method.certainty, _own(method))
    else:
        chosen = planners[name]
        _show(name, chosen) if isinstance(chosen, Algorithm) else _show_without_ants(name, chosen)
    return FOUND


def _list(presets: dict[str, Algorithm]) -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, show_lines=True, pad_edge=False)
    table.add_column("algorithm", style="bold", no_wrap=True)
    table.add_column("parts", ratio=4)
    table.add_column("parameters", ratio=3)
    table.add_column("certainty", ratio=4)
    for name, chosen in presets.items():
        about = Text(_summary(name, chosen), style="dim")
        certainty = Text("\n").join([about, Text(str(chosen.certainty))])
        table.add_row(name, "\n".join(_pairs(_parts(chosen))), ", ".join(_pairs(_parameters(chosen))), certainty)
    say_rich(table)


def _list_without_ants(planners: dict[str, Planner]) -> None:
    """Those of one summary and certainty in one row."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    alike: dict[tuple[str, str], list[str]] = {}
    for name, chosen in planners.items():
        certainty = str(chosen.certainty)
        if chosen.own and str(chosen.own[0].source) not in certainty:
            certainty = f"own planner {chosen.own[0].source}; {certainty}"
        alike.setdefault((_summary(name, chosen), certainty), []).append(name)
    table = Table(box=box.SIMPLE_HEAD, show_lines=True, pad_edge=False)
    table.add_column("without ants", style="bold", ratio=1)
    table.add_column("certainty", ratio=1)
    for (about, words), together in alike.items():
        table.add_row(", ".join(together), Text("\n").join([Text(about, style="dim"), Text(words)]))
    say_rich(table)


def _list_methods(methods: dict[str, Method]) -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, show_lines=True, pad_edge=False)
    table.add_column("fronts", style="bold", no_wrap=True)
    table.add_column("parameters", ratio=1)
    table.add_column("certainty", ratio=2)
    for name, method in methods.items():
        certainty = Text("\n").join([Text(_first_line(type(method)), style="dim"), Text(method.certainty)])
        table.add_row(name, ", ".join(_pairs(_own(method))), certainty)
    say_rich(table)


def _rules() -> Iterator[tuple[str, type[Part]]]:
    """Users' rules by name, with their kind where two kinds have one of that name."""
    known = [part for family in RULES.values() for part in family.registered.values()]
    for part in known:
        alone = sum(other.name == part.name for other in known) == 1
        yield (part.source.name if alone else f"{_kind(part)} {part.name}"), part


def _kind(part: type[Part]) -> str:
    return next(kind for kind, family in RULES.items() if issubclass(part, family))


def _list_rules(rules: dict[str, type[Part]]) -> None:
    from rich import box
    from rich.table import Table

    if not rules:
        return
    table = Table(box=box.SIMPLE_HEAD, show_lines=True, pad_edge=False)
    table.add_column("your rules", style="bold", no_wrap=True)
    table.add_column("kind", no_wrap=True)
    table.add_column("parameters", ratio=2)
    table.add_column("what it is", ratio=3)
    for name, part in rules.items():
        values = {one.name: one.default for one in part.parameters.values()}
        about = f"{_first_line(part)}\n{part.source.label}".strip()
        table.add_row(name, _kind(part), ", ".join(_pairs(values)), about)
    say_rich(table)


def _told(part: type[Part]) -> dict[str, Any]:
    """A rule as JSON types."""
    own = {one.name: {"default": one.default, "range": one.range} for one in part.parameters.values()}
    return {"summary": _first_line(part), "kind": _kind(part), "own": part.source.document(), "parameters": own}


def _show_rule(part: type[Part]) -> None:
    from rich import box
    from rich.table import Table

    say("\n".join([inspect.getdoc(part) or "", "", f"your own {_kind(part)} rule: {part.source}"]))
    table = Table("parameter", "symbol", "default", "range", "sane", box=box.SIMPLE_HEAD, pad_edge=False)
    for one in part.parameters.values():
        sane = " to ".join(f"{end:g}" for end in one.sane) if one.sane else ""
        table.add_row(one.name, one.symbol, "-" if one.default is None else _text(one.default), one.range, sane)
    if part.parameters:
        say_rich(table)


def _own(method: Method) -> dict[str, Any]:
    return {key: value for key, value in method.document().items() if key != "name"}


def _show(name: str, chosen: Algorithm) -> None:
    from rich import box
    from rich.table import Table

    about = [
        f"{kind} {part}: {(inspect.getdoc(part) or '').partition(chr(10))[0]}" for kind, part in chosen.parts.items()
    ]
    about += [
        f"{one.name} {value}: {_member(value)}"
        for owner, one, value in _owned(chosen)
        if owner == "algorithm" and isinstance(value, Enum) and value != one.default
    ]
    say("\n".join([_summary(name, chosen), f"certainty: {chosen.certainty}", *about, ""]))
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for head in ("part", "parameter", "symbol", "default", "range", "sane", "rests on"):
        table.add_column(head, no_wrap=head == "parameter")
    last = ""
    for owner, one, value in _owned(chosen):
        sane = " to ".join(f"{end:g}" for end in one.sane) if one.sane else ""
        basis = (one.certainty or "") if value == one.default else "the preset"
        default = "by map size" if (one.name, value) == ("switch", None) else "-" if value is None else _text(value)
        table.add_row(owner if owner != last else "", one.name, one.symbol, default, one.range, sane, basis)
        last = owner
    say_rich(table)


def _show_without_ants(name: str, chosen: Planner) -> None:
    """What it is in the words of its class, which tell ranges, and its defaults."""
    own = parameters(chosen) if name not in EXACT else {}
    about = inspect.getdoc(type(chosen)) if own else _summary(name, chosen)
    _tell(about or "", chosen.certainty, own)


def _tell(about: str, certainty: object, own: dict[str, Any]) -> None:
    from rich import box
    from rich.table import Table

    say("\n".join([about, *[""] * bool(own), f"certainty: {certainty}"]))
    if not own:
        say("no parameters")
        return
    table = Table("parameter", "default", box=box.SIMPLE_HEAD, pad_edge=False)
    for parameter, value in own.items():
        table.add_row(parameter, _text(value))
    say_rich(table)


def _owned(chosen: Algorithm) -> Iterator[tuple[str, Parameter, Any]]:
    """Every parameter with its owner and its value; a part without one by its kind."""
    owners = {f"{kind} {part}": part for kind, part in chosen.parts.items()}
    split = {"decomposition": chosen.decomposition} if chosen.decomposition else {}
    for owner, holder in {**owners, "algorithm": chosen, **split}.items():
        for one in parameters_of(type(holder)).values():
            yield owner, one, getattr(holder, one.name)


def _summary(name: str, chosen: Planner) -> str:
    return _first_line({**PRESETS, **EXACT, **REGISTERED}.get(name, type(chosen)))


def _first_line(described: object) -> str:
    return (inspect.getdoc(described) or "").split("\n", 1)[0]


def _member(value: Enum) -> str:
    """What the docstring of its class says of one member."""
    lines = (inspect.getdoc(type(value)) or "").splitlines()
    return next(line.partition(": ")[2] for line in lines if line.startswith(f"- {value}: "))


def _parts(chosen: Algorithm) -> dict[str, Any]:
    usual = {field.name: field.default for field in fields(chosen) if field.name in FAMILIES}
    parts = {kind: part for kind, part in chosen.parts.items() if kind in PARTS or part != usual[kind]}
    named = {
        one.name: value
        for owner, one, value in _owned(chosen)
        if owner != "decomposition" and isinstance(value, Enum) and value != one.default
    }
    split = chosen.decomposition
    return parts | named | (vars(split) if split else {"undivided": ""})


def _parameters(chosen: Algorithm) -> dict[str, Any]:
    """Of the algorithm and its parts."""
    values = {name: getattr(chosen, name) for name in PARAMETERS}
    for owner, one, value in _owned(chosen):
        if owner != "decomposition" and value != one.default and not isinstance(value, Enum):
            values[one.name] = value
    return values | ({"switch": "by map size"} if chosen.choices().get("switch", 0) is None else {})


def _pairs(values: dict[str, Any]) -> list[str]:
    return [f"{name} {_text(value)}".strip() for name, value in values.items()]


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)
