"""The command line: `antnav plan | tour | batch | pareto | replay | maps | algorithms | study | bench | ...`.

One module a command, imported only for that command: others do not wait for it.
"""

from __future__ import annotations

import atexit
import gc
import os
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

import typer
from typer.main import get_command

import antnav
from antnav.cli.options import in_options
from antnav.cli.terminal import (
    BAD_INPUT,
    FOUND,
    INTERNAL,
    INTERRUPTED,
    complain,
    flush,
    map_warnings_as_lines,
    reader_may_leave,
)
from antnav.errors import AntnavError, ParameterError, PathError
from antnav.plugins.loading import load_all

__all__ = ["load", "main"]

EXIT_CODES = """\b
Exit codes:
  0    done; for plan and tour: a path was found
  1    no path: none exists, or no ant arrived; of check: a check failed
  2    bad input, or an output that cannot be written
  3    of batch: some rows were no queries, the others were planned
  130  interrupted; plan saves and prints the best so far
  70   an error of antnav itself"""
OWN_RULES = """\b
Your own rules, planners and algorithms:
  --plugin FILE  load what a Python file registers; anywhere in the line, repeatable"""
EPILOG = f"{EXIT_CODES}\n\n{OWN_RULES}"

#: Each command: its module here, the function in it or its `app` of subcommands, and what the list of commands says.
COMMANDS = {
    "plan": ("plan", "plan", "Plan a path on a map."),
    "tour": ("tour", "tour", "Plan one trip to many stops, in the best order."),
    "batch": ("batch", "batch", "Plan a path for each row of a file."),
    "pareto": ("pareto", "pareto", "Find the paths that no other beats, for goals that conflict."),
    "replay": ("replay", "replay", "Drive a robot through a map that changes, with any replanner."),
    "view": ("view", "view", "Watch ants in the browser, and draw walls before them."),
    "maps": ("maps", "app", "List, show, generate and convert maps."),
    "algorithms": ("algorithms", "algorithms", "List the algorithms and their parts."),
    "reproduce": ("study", "reproduce", "Rebuild the paper's tables and figures."),
    "study": ("study", "study", "Compare algorithms of your choice on maps of your choice."),
    "merge": ("study", "merge", "Join the runs of several stores of a study."),
    "bench": ("bench", "app", "Measure gaps and times, against published optima or other planners."),
    "check": ("check", "check", "Check rules, planners and algorithms of your own."),
    "new": ("new", "app", "Write a rule of your own to begin with, and its test."),
    "warmup": ("warmup", "warmup", "Compile the kernels now."),
}


def load(arguments: Sequence[str]) -> typer.Typer:
    """The command line with the command that these arguments name; of the others only what the list says of them."""
    app = typer.Typer(
        add_completion=False, rich_markup_mode=None, context_settings={"help_option_names": ["-h", "--help"]}
    )
    app.callback(invoke_without_command=True, epilog=EPILOG)(_antnav)
    wanted = next((word for word in arguments if not word.startswith("-")), "")
    for name, (module, part, words) in COMMANDS.items():
        found = getattr(import_module(f"antnav.cli.{module}"), part) if name == wanted else _unloaded
        if isinstance(found, typer.Typer):
            app.add_typer(found, name=name, short_help=words, epilog=EPILOG)
        else:
            app.command(name, short_help=words, epilog=EPILOG)(found)
    return app


def divided(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """The arguments without `--plugin FILE`, wherever it stands, and these files."""
    rest, plugins, words = [], [], iter(arguments)
    for word in words:
        if word == "--":
            rest += [word, *words]
        elif word == "--plugin":
            plugins.append(next(words, ""))
        elif word.startswith("--plugin="):
            plugins.append(word.partition("=")[2])
        else:
            rest.append(word)
    return rest, plugins


def _unloaded() -> None:
    """Stands in the list of commands for one that nobody asked for."""


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"antnav {antnav.__version__}")
        raise typer.Exit


def _antnav(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version and leave.")
    ] = False,
) -> None:
    """Ant-colony path planning for mobile robots on grid maps, with the exact optimum beside every result.

    Try: antnav plan warehouse --robot-radius 0.25 -o plan.png
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code; no exception leaves, whatever happens inside.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments without the program's name; default: those of the process.

    Returns
    -------
    int
        0 found or done, 1 no path or a failed check, 2 bad input, 3 bad rows, 130 interrupted, 70 an error of antnav
        itself.
    """
    if argv is None:
        atexit.register(gc.freeze)  # or the last collections walk all of Numba: 0.15 s of a command's 0.85 s
    arguments = sys.argv[1:] if argv is None else list(argv)
    if arguments[:2] == ["study", "merge"]:  # a file of that name is ./merge
        del arguments[0]
    try:
        with map_warnings_as_lines():
            return _run(arguments)
    except (KeyboardInterrupt, Exception) as error:
        return _report(error, arguments)


def _report(error: BaseException, arguments: Sequence[str]) -> int:
    """Say in one line what went wrong; the exit code for it."""
    text = in_options(error, _offered(arguments)) if isinstance(error, AntnavError) else str(error)
    kind, code = "error", BAD_INPUT
    if isinstance(error, KeyboardInterrupt) or _came_into_a_kernel(error):
        text, kind, code = "interrupted", "", INTERRUPTED
    elif isinstance(error, MemoryError):
        text = "not enough memory; use fewer ants or iterations, or a smaller map"
    elif isinstance(error, PathError):  # from --check
        kind, code = "internal error", INTERNAL
    elif isinstance(error, OSError) and not isinstance(error, AntnavError):
        text = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    elif not isinstance(error, AntnavError):
        if os.environ.get("ANTNAV_DEBUG"):
            traceback.print_exception(error)
        remedy = "this is an error of antnav itself: please report it, with what ANTNAV_DEBUG=1 shows"
        text, kind, code = f"{type(error).__name__}: {error}; {remedy}", "internal error", INTERNAL
    complain(text, kind)
    return code


def _came_into_a_kernel(error: BaseException) -> bool:
    """Whether Ctrl-C came while compiled code ran: the interpreter then calls that an error of the code."""
    return isinstance(error, SystemError) and isinstance(error.__cause__, KeyboardInterrupt)


def _offered(arguments: Sequence[str]) -> set[str]:
    """The options of the command that these arguments name."""
    command = get_command(load(divided(arguments)[0]))
    for word in arguments:
        command = getattr(command, "commands", {}).get(word, command)
    return {option for parameter in command.params for option in parameter.opts}


def _run(arguments: list[str]) -> int:
    arguments, plugins = divided(arguments)
    if "" in plugins:
        raise ParameterError("--plugin", "a file follows it", "give one, as in --plugin mine.py")
    load_all(plugins)
    command = get_command(load(arguments))
    code: object = FOUND
    try:
        # Not command.main(), which has its own ways with Ctrl-C, closed pipes and usage errors.
        with reader_may_leave(sys.stdout), command.make_context("antnav", arguments) as context:
            code = command.invoke(context)
        flush()
    except typer.Exit as leaving:
        return leaving.exit_code
    except Exception as error:
        # Usage errors: click's own class where typer uses click, typer's where it brings its copy of it.
        message = getattr(error, "format_message", None)
        if message is None:
            raise
        place = getattr(error, "ctx", None)
        where = place.command_path if place else "antnav"
        text = message().rstrip(".")
        complain(f"{text}{' ' if text.endswith('?') else '; '}`{where} --help` explains")
        return BAD_INPUT
    return code if isinstance(code, int) else 0
