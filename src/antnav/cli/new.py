"""`antnav new`: a file with a rule, an algorithm or a planner of your own to begin with, and its test."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from antnav.cli.terminal import PASSED, say
from antnav.conformance.writing import RULES, write_new

app = typer.Typer(
    help="Write a rule, an algorithm or a planner of your own to begin with, and its test.", rich_markup_mode=None
)

Name = Annotated[
    str,
    typer.Argument(
        metavar="NAME",
        help="Of the file, the function in it, and the rule.",
        show_default=False,
    ),
]
Folder = Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Folder; is made where it is missing.")]
HERE = Path()


@app.callback(invoke_without_command=True)
def _new(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command("rule", short_help="A rule of colonies, or an objective.")
def rule(
    name: Name,
    kind: Annotated[str, typer.Option("--kind", metavar="|".join(RULES), help="What it decides.")] = "pheromone",
    jit: Annotated[bool, typer.Option("--jit", help="Have Numba compile it; transition rules always are.")] = False,
    output: Folder = HERE,
) -> int:
    """Write NAME.py, a rule that works, and test_NAME.py: its slow twin and the conformance checks.

    antnav new rule elite_share --kind pheromone

    Neither file is written over one that is there.
    """
    return _written(name, kind, output, jit=jit)


@app.command("algorithm", short_help="A preset: parts and parameters under a name.")
def algorithm(name: Name, output: Folder = HERE) -> int:
    """Write NAME.py, an algorithm composed of parts, and test_NAME.py."""
    return _written(name, "algorithm", output)


@app.command("planner", short_help="A search of your own, without ants or with them.")
def planner(name: Name, output: Folder = HERE) -> int:
    """Write NAME.py, a planner, and test_NAME.py."""
    return _written(name, "planner", output)


def _written(name: str, kind: str, folder: Path, *, jit: bool = False) -> int:
    file, test = write_new(name, kind, folder, jit=jit)
    say(f"change    {file}: what it does, its parameters and its source; and its twin in {test}")
    say(f"check     antnav check {file}, and pytest {test}")
    say(f"use       {_use(kind, f'{file}:{name}')}")
    return PASSED


def _use(kind: str, name: str) -> str:
    """How it is used for the first time."""
    if kind in {"algorithm", "planner"}:
        return f"antnav plan warehouse --algorithm {name}"
    if kind == "objective":
        return f"antnav pareto warehouse --objective length --objective {name}"
    return f"antnav plan warehouse --algorithm {'paco' if kind == 'cuts' else 'npaco'} --set {kind}={name}"
