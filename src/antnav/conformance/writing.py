"""new: files to begin with, a rule and its test, which pass as they are."""

from __future__ import annotations

import keyword
import os
import re
import sys
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from string import Template

from antnav.conformance.subject import ASKED
from antnav.errors import OutputError, ParameterError, shown
from antnav.files import as_path, write_whole
from antnav.objectives.named import PLAIN
from antnav.plan.algorithms import names as planners
from antnav.register.parts import KINDS

#: Kinds of rules that there is a file for.
RULES = (*KINDS, "objective")
_NAME = re.compile(r"[a-z][a-z0-9_]*")


def write_new(name: str, kind: str, folder: str | os.PathLike[str] = ".", *, jit: bool = False) -> tuple[Path, Path]:
    """Write NAME.py with a rule, an algorithm or a planner that works, and test_NAME.py, neither over an older file.

    Parameters
    ----------
    name : str
        In small letters: of the file, of the function in it, and by which it is registered.
    kind : str
        As its decorator in `antnav.register` is called.
    folder : str or path
        Is made where it is missing.
    jit : bool
        Whether the rule is compiled; transition rules are, since they are asked at every step.

    Returns
    -------
    tuple of two paths

    Raises
    ------
    ParameterError
        No such kind, a name that is none or taken, a file that is there already, or a kind that is not compiled.
    OutputError
        A file cannot be written; then neither is there.
    """
    if kind not in (*RULES, "algorithm", "planner"):
        rule = f"the kinds are {', '.join(RULES)}, algorithm and planner"
        raise ParameterError(f"kind {shown(kind)}", rule, "give one of them")
    if jit and kind not in ASKED:
        rule = f"rules of the kinds {', '.join(ASKED)} can be compiled"
        raise ParameterError(f"kind {kind} with jit", rule, "leave jit out")
    check_new_name(name, kind)
    into = as_path(folder)
    files = into / f"{name}.py", into / f"test_{name}.py"
    for file in files:
        if os.path.lexists(file):
            raise ParameterError(f"file {file}", "it is there already", "choose another name or folder")
    values = {"name": name, "class_name": "".join(map(str.capitalize, name.split("_")))}
    values["jit"] = "(jit=True)" if jit else ""
    texts = [_template(template).substitute(values) for template in (kind, f"test_{kind}")]
    try:
        into.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        rule = error.strerror or str(error)
        raise OutputError(f"folder {into}", rule, "name a folder that can be made or written to") from error
    write_whole(files[0], texts[0].encode())
    try:
        write_whole(files[1], texts[1].encode())
    except BaseException:
        files[0].unlink()
        raise
    return files


def _template(name: str) -> Template:
    text = resources.files("antnav.conformance").joinpath("templates", f"{name}.py.txt").read_text("utf-8")
    return Template(text)


def check_new_name(name: str, kind: str) -> None:
    """Refuse a name that no file, function and rule can have.

    Raises
    ------
    ParameterError
    """
    given = f"name {shown(name)}"
    if not isinstance(name, str) or not _NAME.fullmatch(name) or keyword.iskeyword(name):
        rule = "it is a word of small letters, digits and underscores, and none of Python's own"
        raise ParameterError(given, rule, "give one, such as elite_share")
    if name.startswith("test_") or name == "conftest":
        raise ParameterError(given, "pytest takes such a file for tests", "choose another name")
    taken = {"objective": [*PLAIN, "risk", "time", "energy"]}.get(kind) or (
        [*KINDS[kind][0].kind()] if kind in KINDS else planners()
    )
    if name in taken:
        article = "an" if kind[0] in "aeiou" else "a"
        raise ParameterError(given, f"antnav has {article} {kind} of that name", f"choose another, such as my_{name}")
    if name in sys.stdlib_module_names or _is_installed(name):
        raise ParameterError(given, "a module of that name is there, which the file would hide", "choose another name")


def _is_installed(name: str) -> bool:
    """Whether a package of that name is installed; a file beside does not count."""
    try:
        found = find_spec(name)
    except (ImportError, ValueError):
        return False
    return name == "antnav" or bool(found and found.origin and "-packages" in found.origin)
