"""`antnav algorithms`: every preset with its parts, its parameters, and how sure we are of it."""

from __future__ import annotations

import inspect
from dataclasses import asdict, fields
from typing import Annotated, Any

import typer

from antnav.ants.presets import PRESETS
from antnav.cli.terminal import FOUND, say, say_rich
from antnav.colony.parameters import Algorithm
from antnav.colony.parts import Deadlock

#: Always shown; of the other fields, those that differ from their defaults are.
PARTS = ("heuristic", "pheromone", "deadlock")
PARAMETERS = ("ants", "iterations", "alpha", "beta", "rho", "q", "tau0")
MORE_PARTS = ("transition", "initial", "deposit", "local_search")


def algorithms(
    json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout, by name of the algorithm.")] = False,
) -> int:
    """List the algorithms with their parts, parameters, and how sure it is that they are what their source says."""
    presets = {name: make() for name, make in PRESETS.items()}
    if json:
        import msgspec

        document = {name: {"summary": _summary(name), **asdict(preset)} for name, preset in presets.items()}
        say(msgspec.json.encode(document).decode())
        return FOUND
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, show_lines=True, pad_edge=False)
    table.add_column("algorithm", style="bold", no_wrap=True)
    table.add_column("parts", ratio=4)
    table.add_column("parameters", ratio=3)
    table.add_column("certainty", ratio=4)
    for name, preset in presets.items():
        about = Text(_summary(name), style="dim")
        certainty = Text("\n").join([about, Text(preset.certainty)])
        table.add_row(name, "\n".join(_pairs(_parts(preset))), ", ".join(_pairs(_parameters(preset))), certainty)
    say_rich(table)
    return FOUND


def _summary(name: str) -> str:
    return (inspect.getdoc(PRESETS[name]) or "").split("\n", 1)[0]


def _parts(preset: Algorithm) -> dict[str, Any]:
    split = preset.decomposition
    parts = {part: getattr(preset, part) for part in PARTS}
    special = {part: value for part, value in _special(preset).items() if part in MORE_PARTS}
    return parts | special | (asdict(split) if split else {"undivided": ""})


def _parameters(preset: Algorithm) -> dict[str, Any]:
    values = {name: getattr(preset, name) for name in PARAMETERS}
    special = {name: value for name, value in _special(preset).items() if name not in MORE_PARTS}
    switch = {"switch": "by map size"} if preset.deadlock is Deadlock.HYBRID and preset.switch is None else {}
    return values | special | switch


def _special(preset: Algorithm) -> dict[str, Any]:
    """Fields that are not shown anyway and differ from their defaults."""
    apart = {*PARTS, *PARAMETERS, "name", "certainty", "decomposition"}
    return {
        field.name: getattr(preset, field.name)
        for field in fields(preset)
        if field.name not in apart and getattr(preset, field.name) != field.default
    }


def _pairs(values: dict[str, Any]) -> list[str]:
    return [f"{name} {_text(value)}".strip() for name, value in values.items()]


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)
