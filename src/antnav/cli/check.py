"""`antnav check`: what every rule, planner and algorithm of a user's must do, checked one by one."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from antnav.ants.presets import npaco
from antnav.cli.running import compilation_announced
from antnav.cli.terminal import FAILED, PASSED, complain, is_terminal, say, say_table
from antnav.conformance.model import Finding
from antnav.conformance.running import LIMIT, check_rules
from antnav.plan.warmup import warmup


def check(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="A Python file that registers them, or the name of one that is registered or installed.",
            show_default=False,
        ),
    ],
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Those to be checked; default: all in the file.", show_default=False),
    ] = None,
    quick: Annotated[
        bool,
        typer.Option("--quick", help="Leave out worker processes, the comparison with blind ants, and times."),
    ] = False,
    time_limit: Annotated[
        float, typer.Option("--time-limit", metavar="SECONDS", help="A check that takes longer is ended, and fails.")
    ] = LIMIT,
    json: Annotated[bool, typer.Option("--json", help="One JSON object on stdout.")] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Only the exit code, and errors.")] = False,
) -> int:
    """Check rules, planners and algorithms of your own: same seed, same bytes; legal paths; better than blind; ...

    antnav check mine.py
    """

    def told(finding: Finding) -> None:
        if not (json or quiet) and is_terminal(sys.stderr):
            complain(f"{finding.name}, {finding.check}: {finding.verdict}", kind="")

    with compilation_announced(quiet or json):
        warmup(npaco())
    found = check_rules(file, *(names or ()), quick=quick, time_limit=time_limit, told=told)
    if json:
        import msgspec

        say(msgspec.json.encode(found.document()).decode())
    elif not quiet:
        head, *rows = found.table
        say_table(head, rows, [False] * len(head))
        say(f"{len(found.findings)} checks: {found.summary}")
    return PASSED if found.passed else FAILED
