"""The reference of the command line, from the program itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from typer.main import get_command

from antnav.cli import COMMANDS, load


def prose(text: str) -> Iterator[str]:
    """Help as reStructuredText; paragraphs that begin with click's mark keep their lines."""
    for paragraph in text.replace("\f", "").split("\n\n"):
        lines = [line.replace("\\", "\\\\").replace("*", "\\*").replace("`", "``") for line in paragraph.splitlines()]
        if lines and lines[0].strip() == "\b":
            yield from (f"| {line.strip()}" for line in lines[1:])
        elif lines and lines[0].strip().startswith("antnav "):
            yield from (".. code-block:: text", "", *(f"   {line.strip()}" for line in paragraph.splitlines()))
        else:
            yield from (line.strip() for line in lines)
        yield ""


def page_of(command: Any, context: Any, depth: int) -> Iterator[str]:
    """A command with its options and subcommands, as lines of reStructuredText."""
    path = context.command_path
    yield f".. _{path.replace(' ', '-')}:"
    yield ""
    yield path
    yield "=-~"[depth] * len(path)
    yield ""
    yield from prose(command.help or "")
    yield ".. code-block:: text"
    yield ""
    yield f"   {path} {' '.join(command.collect_usage_pieces(context))}"
    yield ""
    yield f".. program:: {path}"
    yield ""
    for parameter in command.params:
        record = parameter.get_help_record(context)
        if record is None or parameter.name == "help":
            continue
        yield f".. option:: {record[0].replace(' / ', ', ')}"
        yield ""
        yield from (f"   {line}" for line in prose(record[1] or ""))
        yield ""
    for name, inner in getattr(command, "commands", {}).items():
        yield from page_of(inner, type(context)(inner, parent=context, info_name=name), depth + 1)


class Commands(SphinxDirective):
    """`.. commands::`, every command of antnav, each with all its options."""

    def run(self) -> list[nodes.Node]:
        """The sections, one a command."""
        lines: list[str] = []
        for name in COMMANDS:
            root = get_command(load([name]))
            context = root.context_class(root, info_name="antnav")
            command = root.commands[name]
            lines += page_of(command, root.context_class(command, parent=context, info_name=name), 0)
        return self.parse_text_to_nodes("\n".join(lines), allow_section_headings=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive `commands`."""
    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
