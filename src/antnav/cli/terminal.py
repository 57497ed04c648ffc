"""What all commands share: exit codes, lines on stdout and stderr, tables."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TextIO

from antnav.errors import OutputError
from antnav.maps import MapWarning

if TYPE_CHECKING:
    from rich.console import RenderableType

FOUND, NO_PATH, BAD_INPUT, BAD_ROWS, INTERNAL, INTERRUPTED = 0, 1, 2, 3, 70, 130
#: Of `antnav check`.
PASSED, FAILED = 0, 1

#: Longest message on stderr; a longer one repeats a megabyte that the user typed or a file held.
LONGEST_LINE = 1000
#: Width of tables that go to a file or a pipe.
PIPE_WIDTH = 120
#: Letters of a text that `say_table` does not wrap.
LONGEST_NAME = 30


def say(text: str = "") -> None:
    """Print a line, or several, on stdout. A reader that has gone (`| head`) ends the printing, not the work."""
    stream = sys.stdout
    if stream is None:  # started with stdout closed
        return
    with reader_may_leave(stream):
        stream.write(_encodable(text + "\n", stream))


def flush() -> None:
    """Flush stdout, so that a full disk is noticed while it can still be told."""
    if sys.stdout is not None:
        with reader_may_leave(sys.stdout):
            sys.stdout.flush()


def complain(text: str, kind: str = "error") -> None:
    """Print exactly one line on stderr, whatever the text holds."""
    printable = "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)
    if len(printable) > LONGEST_LINE:
        half = LONGEST_LINE // 2
        printable = f"{printable[:half]} ... {printable[-half:]}"
    line = f"antnav: {kind}: {printable}\n" if kind else f"antnav: {printable}\n"
    stream = sys.stderr
    if stream is not None:
        with contextlib.suppress(OSError):
            stream.write(_encodable(line, stream))
            stream.flush()


@contextlib.contextmanager
def map_warnings_as_lines() -> Iterator[None]:
    """Show what `antnav.maps` warns of as lines on stderr, and no other warning: they are for programmers."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        complain(str(message), kind="warning")

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", MapWarning)
        warnings.showwarning = show
        yield


def is_terminal(stream: TextIO | None) -> bool:
    """Whether a person looks at the stream."""
    return stream is not None and not stream.closed and stream.isatty()


def say_rows(rows: Sequence[tuple[str, str]]) -> None:
    """Print pairs of name and text: aligned and wrapped for a person, one line a pair for a program."""
    width = max(len(name) for name, _ in rows) + 2
    if not is_terminal(sys.stdout):
        say("\n".join(f"{name:<{width}}{' '.join(text.splitlines())}" for name, text in rows))
        return
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(style="dim", no_wrap=True, width=width - 2)
    table.add_column(overflow="fold")
    for name, text in rows:
        table.add_row(name, Text(text, style=_style(name, text)))
    say_rich(table)


def _style(name: str, text: str) -> str:
    if name == "status":
        return "bold green" if text.startswith("found") else "bold red"
    return "bold" if name in {"length", "gap", "why", "remedy"} else ""


def say_rich(*renderables: RenderableType, width: int = 0) -> None:
    """Print what rich can draw, on stdout, at least so wide."""
    from rich.console import Console

    if sys.stdout is None:
        return
    console = Console(file=sys.stdout, highlight=False, width=None if is_terminal(sys.stdout) else PIPE_WIDTH)
    console.width = max(console.width, width)
    with console.capture() as capture:
        console.print(*renderables)
    say("\n".join(line.rstrip() for line in capture.get().rstrip("\n").split("\n")))


def say_table(heads: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[bool]) -> None:
    """Print a table; `right` tells which columns hold numbers, set flush right below heads of two lines.

    Where it is wider than the terminal, its lines are too: half a number would be a lie.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    width = 0
    for index, (head, flush_right) in enumerate(zip(heads, right, strict=True)):
        title = "\n".join(part.rstrip(",") for part in head.rsplit(" ", 1)) if flush_right else head
        longest = max(len(text) for text in [*title.split("\n"), *(row[index] for row in rows)])
        whole = flush_right or longest <= LONGEST_NAME
        table.add_column(Text(title), justify="right" if flush_right else "left", overflow="fold", no_wrap=whole)
        width += min(longest, LONGEST_NAME) + 3
    for row in rows:
        table.add_row(*map(Text, row))
    say_rich(table, width=width)


def draws_unicode(stream: TextIO | None) -> bool:
    """Whether block characters arrive on the stream as such."""
    return stream is not None and (stream.encoding or "").lower().replace("-", "").startswith("utf")


def _encodable(text: str, stream: TextIO) -> str:
    encoding = stream.encoding or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


@contextlib.contextmanager
def reader_may_leave(stream: TextIO | None) -> Iterator[None]:
    """Go on where the reader of a stream has closed it, as `head` does; what else is written goes nowhere."""
    try:
        yield
    except OSError as error:
        if error.filename or error.errno not in {errno.EPIPE, errno.ENOSPC}:
            raise
        if stream is not None:
            _discard(stream)
        if error.errno == errno.ENOSPC:
            raise OutputError("standard output", "no space is left", "send it where there is room") from error


def _discard(stream: TextIO) -> None:
    """Send the rest to nowhere, or Python would complain once more when it flushes at its end."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
