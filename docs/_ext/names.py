"""The API reference: a directive that lists names of a module and explains each, and links from words in docstrings."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from importlib import import_module
from pkgutil import walk_packages
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective, SphinxRole
from sphinx.util.nodes import make_refnode

import antnav


def thing_at(dotted: str) -> Any:
    """What a dotted name means; `antnav.stop` is no module of its own, but a name in the package."""
    place, _, name = dotted.rpartition(".")
    if not place:
        return import_module(name)
    parent = thing_at(place)
    return getattr(parent, name) if hasattr(parent, name) else import_module(dotted)


def summary(thing: Any) -> str:
    """The first sentence of a docstring."""
    if not inspect.isclass(thing) and not inspect.isroutine(thing):
        return ""
    return " ".join((inspect.getdoc(thing) or "").split("\n\n", maxsplit=1)[0].split())


def explained(dotted: str) -> Iterator[str]:
    """The directive that explains one name, as lines of reStructuredText."""
    thing = thing_at(dotted)
    if inspect.isclass(thing):
        yield f".. {'autoexception' if issubclass(thing, BaseException) else 'autoclass'}:: {dotted}"
    elif inspect.isroutine(thing):
        yield f".. autofunction:: {dotted}"
    else:
        yield f".. py:data:: {dotted}"
        if isinstance(thing, Mapping):
            yield ""
            yield f"   By name: {', '.join(f'``{key}``' for key in thing)}."
    yield ""


class Names(SphinxDirective):
    """`.. names:: MODULE`, and below it one name a line: a table of first sentences, then each in full."""

    required_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        """The nodes of table and explanations."""
        names = [f"{self.arguments[0]}.{name}" for name in self.content if name]
        table = [".. list-table::", "   :class: names", ""]
        for dotted in names:
            table += [f"   * - :py:obj:`~{dotted}`", f"     - {summary(thing_at(dotted))}"]
        lines = [*table, "", *(line for dotted in names for line in explained(dotted))]
        return self.parse_text_to_nodes("\n".join(lines))


class Word(SphinxRole):
    """What stands in single backticks: a link where it names something public, else code."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """A reference, which becomes plain code where nothing answers it."""
        dotted = self.text.removeprefix("an.").removeprefix("antnav.").removesuffix("()")
        if dotted.split(".")[0] not in antnav.__all__ or not dotted.replace(".", "").isidentifier():
            return [nodes.literal(self.text, self.text)], []
        reference = addnodes.pending_xref("", refdomain="py", reftype="obj", reftarget=f"antnav.{dotted}")
        reference += nodes.literal(self.text, self.text, classes=["xref", "py"])
        return [reference], []


def find_elsewhere(
    app: Sphinx, env: BuildEnvironment, node: addnodes.pending_xref, contnode: nodes.Element
) -> nodes.Element | None:
    """A type that a signature names from where it is defined: the page has it under the name that users import."""
    if node["refdomain"] != "py" or node["reftype"] not in ("class", "exc", "obj"):
        return None
    domain = env.domains.python_domain
    found = {
        (entry.docname, entry.node_id)
        for name, entry in domain.objects.items()
        if name.rpartition(".")[2] == node["reftarget"].rpartition(".")[2]
        and entry.objtype in ("class", "exception", "data")
    }
    if len(found) != 1:
        return None
    docname, anchor = found.pop()
    return make_refnode(app.builder, node["refdoc"], docname, anchor, contnode)


def import_types(app: Sphinx) -> None:
    """Make good what modules import for type checkers only, or signatures name types that nobody can find."""
    for found in walk_packages(antnav.__path__, "antnav."):
        if found.name.startswith(("antnav.ros.", "antnav.__main__")):  # need ROS, or do something
            continue
        try:
            module = import_module(found.name)
        except (ImportError, antnav.AntnavError):  # without an extra
            continue
        for node in ast.parse(inspect.getsource(module)).body:
            if isinstance(node, ast.If) and ast.unparse(node.test) in ("TYPE_CHECKING", "_TYPE_CHECKING"):
                imports = [line for line in node.body if isinstance(line, ast.Import | ast.ImportFrom)]
                with suppress(ImportError):  # of an extra
                    exec(compile(ast.Module(imports, []), found.name, "exec"), vars(module))


def keep_colons(app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Napoleon takes what stands before an attribute's first colon for its type, unless a comment comes first."""
    if what in ("attribute", "property"):
        lines[:0] = ["..", ""]


def mend_backlinks(app: Sphinx, pagename: str, templatename: str, context: dict[str, Any], doctree: object) -> None:
    """Pages of sources link back to names as if a module had one prefix; let each link lead to its own."""
    if not pagename.startswith("_modules/"):
        return
    objects = app.env.domains.python_domain.objects

    def mended(link: re.Match[str]) -> str:
        name, before, address = link.groups()
        places = {app.builder.get_relative_uri(pagename, entry.docname): entry.docname for entry in objects.values()}
        wanted = places[address]
        anchors = [
            entry.node_id
            for dotted, entry in objects.items()
            if entry.docname == wanted and not entry.aliased and dotted.endswith(f".{name}")
        ]
        return f'id="{name}">{before}href="{address}#{min(anchors, key=len)}"'

    context["body"] = re.sub(
        r'id="([^"]+)">(\s*<a class="viewcode-back" )href="([^"#]*)#[^"]*"', mended, context["body"]
    )


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive `names` and the role for words in backticks, the default of docstrings."""
    app.add_directive("names", Names)
    app.add_role("word", Word())
    app.connect("builder-inited", import_types)
    app.connect("autodoc-process-docstring", keep_colons, priority=400)
    app.connect("html-page-context", mend_backlinks)
    app.connect("missing-reference", find_elsewhere)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
