"""Loading: files and installed packages that define rules, planners and algorithms of users."""

from __future__ import annotations

import hashlib
import os
import re
import sys
import threading
import traceback
from collections.abc import Callable, Iterable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

from antnav.errors import AntnavError, ParameterError, likely, shown
from antnav.files import as_path, open_regular

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Found = TypeVar("Found")

#: Entry points of installed packages: rules of colonies, cuts and objectives; whole algorithms and planners.
PARTS, ALGORITHMS = "antnav.parts", "antnav.algorithms"
#: How to make a name known, for errors.
HOW = "or load the file that registers it: --plugin mine.py, or mine.py:name in place of the name"

_NO_WORD = re.compile(r"\W")
_LOADED: dict[Path, tuple[str, ModuleType]] = {}
_LOADING = threading.RLock()  # a file may load others


def load(file: str | os.PathLike[str]) -> ModuleType:
    """Execute a Python file as a module of its own, once; again only after it has changed.

    Raises
    ------
    ParameterError
        It cannot be read, or raises an error; it says where.
    """
    path = as_path(file)
    try:
        with open_regular(path) as stream:
            text = stream.read()
    except OSError as error:
        rule = error.strerror or str(error)
        raise ParameterError(f"plugin {path}", rule, "name a Python file that can be read") from error
    path, digest = path.resolve(), hashlib.sha256(text).hexdigest()
    with _LOADING:
        before = _LOADED.get(path)
        if before is not None and before[0] == digest:
            return before[1]
        module = _module(path)
        _LOADED[path] = digest, module  # already, for files that load each other
        try:
            _execute(module, path, text)
        except BaseException:
            del _LOADED[path]
            if before is not None:
                _LOADED[path] = before
            raise
        return module


def _module(path: Path) -> ModuleType:
    place = hashlib.sha256(os.fsencode(path)).hexdigest()[:8]
    name = f"antnav_plugin_{_NO_WORD.sub('_', path.stem)}_{place}"
    module = ModuleType(name)
    module.__file__ = str(path)
    return module


def _execute(module: ModuleType, path: Path, text: bytes) -> None:
    name = module.__name__
    before = sys.modules.get(name)
    sys.modules[name] = module  # dataclasses and pickle look there
    try:
        exec(compile(text, path, "exec"), vars(module))
    except BaseException as error:
        del sys.modules[name]
        if before is not None:
            sys.modules[name] = before
        if isinstance(error, AntnavError):
            error.given = f"{where(error, path)}, {error.given}"
            raise
        if isinstance(error, Exception | SystemExit):
            raise ParameterError(f"plugin {where(error, path)}", f"it raised {said(error)}", "mend it") from error
        raise


def where(error: BaseException, file: Path) -> str:
    """The last line of a file at which an error came about: "mine.py, line 3"."""
    if isinstance(error, SyntaxError) and error.filename == str(file):
        return f"{file.name}, line {error.lineno}"
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
    return f"{file.name}, line {lines[-1]}" if lines else file.name


def said(error: BaseException) -> str:
    """An error in one line: its class and what it says."""
    text = error.msg if isinstance(error, SyntaxError) else str(error)
    return f"{type(error).__name__}: {text}".replace("\n", " ").removesuffix(": ")


def innermost(error: BaseException) -> str:
    """Where an error was raised: "line 3 of plan"."""
    trace = error.__traceback__
    while trace and trace.tb_next:
        trace = trace.tb_next
    return f"line {trace.tb_lineno} of {trace.tb_frame.f_code.co_name}" if trace else "nowhere"


def said_by_compiler(error: BaseException, function: Callable[..., Any]) -> str:
    """The first sentence of Numba's error, with the line of the user's file: "mine.py, line 3: ..."."""
    python = getattr(function, "py_func", function)  # of Numba
    file = Path(python.__code__.co_filename).name
    place = re.compile(rf"""[^\s"]*{re.escape(file)}"?(?:, line | \()(\d+)\)?""")
    text = str(error)
    found = place.search(text)
    lines = [
        line.strip().lstrip("> ") for line in text.splitlines() if line.strip() and not line.startswith("Failed in ")
    ]
    sentence = " ".join(lines[: 2 if lines and lines[0].endswith(":") else 1]) or type(error).__name__
    sentence = place.sub(r"line \1", re.sub(r"\W*Raised from .*", "", sentence))
    sentence = re.sub(r"of type ([A-Z]\w*)\(.*\)", r"of type \1", sentence).rstrip(" .")
    return f"{file}{f', line {found[1]}' if found else ''}: {sentence}"


def sought(text: str, known: Callable[[str], Found | None], group: str) -> Found | None:
    """What is registered under a name, its file or its package loaded first where need be.

    Parameters
    ----------
    text : str
        A name, or "mine.py:name", relative to the working directory.
    known : callable
        What is registered under a name, or None.
    group : str
        Of the entry points to look in.

    Raises
    ------
    ParameterError
        The file or the package cannot be loaded, or defines nothing of that name.
    """
    if (found := known(text)) is not None:
        return found
    file, name = divided(text)
    if file:
        place, found = load(file).__file__, known(name)
        if found is None or getattr(getattr(found, "source", None), "place", None) != place:
            raise _missing(text, str(place))
        return found
    return known(text) if _from_package(text, group) else None


def _missing(text: str, place: str) -> ParameterError:
    """What is told where a file, which is loaded, does not register what it was named for."""
    file, name = divided(text)
    there = registered_at(place)
    told = [f"{one} ({kind})" if kind else one for one, kind in there.items()]
    rule = f"{Path(file).name} registers nothing of that name and kind, but {', '.join(told) or 'nothing at all'}"
    near = likely(name, there.keys() - {name})
    return ParameterError(
        shown(text), rule, f"did you mean {near}?" if near else f"register {name} there with @an.register"
    )


def registered_at(place: str) -> dict[str, str]:
    """Names that a file which is loaded has registered in itself, each with its kind, where it tells."""
    loaded = _LOADED.get(Path(place))
    found = vars(loaded[1]).values() if loaded else ()
    sources: list[tuple[Any, Any]] = [(getattr(one, "source", None), getattr(one, "role", "")) for one in [*found]]
    return {source.name: role for source, role in sources if getattr(source, "place", None) == place}


def divided(text: str) -> tuple[str, str]:
    """File and name of "mine.py:name"; no file where the text is a mere name."""
    file, _, name = text.rpartition(":")
    return (file, name) if file.endswith(".py") and name else ("", text)


def beside(text: str, folder: str | os.PathLike[str]) -> str:
    """A name as a file in a folder gives it: that of "mine.py:name" is found from there."""
    file, name = divided(text)
    return f"{Path(folder) / file}:{name}" if file else text


def load_all(files: Iterable[str | os.PathLike[str]]) -> None:
    """Execute these files, see `load`."""
    for file in files:
        load(file)


def load_installed(name: str) -> None:
    """Import what installed packages announce under a name, rules and algorithms.

    Raises
    ------
    ParameterError
        One raises an error.
    """
    for group in (PARTS, ALGORITHMS):
        _from_package(name, group)


def load_all_installed() -> list[AntnavError]:
    """Import all that installed packages announce; why those cannot be imported that are left out."""
    from importlib.metadata import entry_points

    failed = []
    for point in (*entry_points(group=PARTS), *entry_points(group=ALGORITHMS)):
        try:
            _import(point)
        except AntnavError as error:
            failed.append(error)
    return failed


def _from_package(name: str, group: str) -> bool:
    """Import what an installed package announces under a name; whether one does."""
    from importlib.metadata import entry_points

    found = list(entry_points(group=group, name=name))
    for point in found:
        _import(point)
    return bool(found)


def _import(point: EntryPoint) -> None:
    try:
        point.load()
    except AntnavError:
        raise
    except (Exception, SystemExit) as error:
        given = f"{point.name}, entry point {point.value}"
        remedy = f"mend or remove the package {point.dist.name if point.dist else ''}".strip()
        raise ParameterError(given, f"it raised {said(error)}", remedy) from error
