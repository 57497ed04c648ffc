"""Source: where a function or a class of a user's comes from, and a digest of its code."""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from pathlib import Path
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any, NamedTuple

from antnav.errors import check_type

_PLAIN = int | float | complex | str | bytes | bool | None
#: What the interpreter adds to a class, and what does nothing.
_NOT_CODE = {"__dict__", "__doc__", "__firstlineno__", "__module__", "__qualname__", "__static_attributes__"} | {
    "__weakref__"
}

#: Folders of installed packages.
_INSTALLED = {"site-packages", "dist-packages"}


class Source(NamedTuple):
    """Where something of a user's comes from.

    Attributes
    ----------
    name : str
        By which it is registered.
    digest : str
        Of its code, see `digest_of`.
    file : str
        Name of its file, without folders, behind its package where that is installed: "swarmlib: rules.py"; empty
        where it has none, as in notebooks.
    place : str
        What tells its file from others of that name: the whole path, or the module where there is no file.
    version : str
        As whoever wrote it counts; empty where that is left open.
    """

    name: str
    digest: str
    file: str
    place: str
    version: str = ""

    @classmethod
    def of(cls, defined: Any, name: str, version: str = "") -> Source:
        """The source of a function or a class."""
        file = file_of(defined)
        place = defined.__module__ if file is None else str(file.resolve())
        shown = "" if file is None else file.name
        if file is not None and _INSTALLED & set(file.parts):
            shown = f"{defined.__module__.partition('.')[0]}: {shown}"
        return cls(name, digest_of(defined), shown, place, version)

    @classmethod
    def read(cls, document: Mapping[str, str]) -> Source:
        """That of a document.

        Raises
        ------
        ParameterError
            It is none.
        """
        check_type("own", document, Mapping, "give name, version, source and file")
        name, digest, file, version = (str(document.get(key, "")) for key in ("name", "source", "file", "version"))
        return cls(name, digest, file, "", version)

    @property
    def label(self) -> str:
        """As it stands behind the name: "mine.py, 1.2"."""
        return ", ".join(filter(None, (self.file, self.version)))

    def __str__(self) -> str:
        return f"{self.name} ({self.label})" if self.label else self.name

    def document(self) -> dict[str, str]:
        """What files keep; the whole path is nobody else's business."""
        return {"name": self.name, "version": self.version, "source": self.digest, "file": self.file}


def file_of(defined: Any) -> Path | None:
    """The file of the module in which a function or a class is defined; None where there is none to be read."""
    file = getattr(sys.modules.get(defined.__module__), "__file__", None)
    return Path(file) if file is not None and Path(file).is_file() else None


def digest_of(defined: Any) -> str:
    """SHA-256 of the code of a function or a class.

    Of its text and the file of its module, so that what it calls there counts, too. Where there is no file, as in
    notebooks, of its bytecode and of that of all functions and constants that it refers to, which is another with each
    version of Python.
    """
    file = file_of(defined)
    if file is None:
        return _hashed(_pieces(defined, set()))
    try:
        text = inspect.getsource(defined)
    except (OSError, TypeError):
        text = defined.__qualname__
    return _hashed((text.encode(), file.read_bytes()))


def _hashed(pieces: Iterator[bytes] | tuple[bytes, ...]) -> str:
    total = hashlib.sha256()
    for piece in pieces:
        total.update(len(piece).to_bytes(8, "little") + piece)
    return total.hexdigest()


def _pieces(thing: Any, seen: set[int]) -> Iterator[bytes]:
    """What makes a thing what it is, each thing once."""
    if isinstance(thing, _PLAIN):
        yield repr(thing).encode()
        return
    if id(thing) in seen:
        return
    seen.add(id(thing))
    inside = partial(_all_pieces, seen=seen)
    yield type(thing).__qualname__.encode()
    match thing:
        case CodeType():
            yield thing.co_code
            yield " ".join((*thing.co_names, *thing.co_varnames)).encode()
            yield from inside(thing.co_consts)
        case FunctionType():
            yield from inside((thing.__code__, thing.__defaults__, thing.__kwdefaults__))
            for cell in thing.__closure__ or ():
                with suppress(ValueError):  # nothing is in it yet
                    yield from inside((cell.cell_contents,))
            yield from inside(thing.__globals__[name] for name in _names(thing.__code__) if name in thing.__globals__)
        case ModuleType():
            yield thing.__name__.encode()
        case type():
            yield f"{thing.__module__}.{thing.__qualname__}".encode()
            if file_of(thing) is None and thing.__module__ not in sys.stdlib_module_names | {"builtins"}:
                yield from inside(thing.__bases__)
                own = {key: value for key, value in vars(thing).items() if key not in _NOT_CODE}
                yield from inside(part for key in sorted(own) for part in (key, own[key]))
        case property():
            yield from inside((thing.fget, thing.fset))
        case classmethod() | staticmethod() | MethodType():
            yield from inside((thing.__func__,))
        case tuple() | list():
            yield from inside(thing)
        case set() | frozenset():
            yield "".join(sorted(_hashed(_pieces(one, set(seen))) for one in thing)).encode()
        case dict():
            yield from inside(part for item in thing.items() for part in item)
        case _ if hasattr(thing, "py_func"):  # of Numba
            yield from inside((thing.py_func,))
        case _ if hasattr(thing, "tobytes"):  # of NumPy
            yield f"{getattr(thing, 'dtype', '')}{getattr(thing, 'shape', '')}".encode()
            yield thing.tobytes()
        case Enum():
            yield thing.name.encode()
        case _ if is_dataclass(thing):
            yield from inside((type(thing), *(getattr(thing, one.name) for one in fields(thing))))


def _all_pieces(things: Any, seen: set[int]) -> Iterator[bytes]:
    for thing in things:
        yield from _pieces(thing, seen)


def _names(code: CodeType) -> list[str]:
    """Global names of a code and of those inside it."""
    return [
        *code.co_names,
        *(name for inner in code.co_consts if isinstance(inner, CodeType) for name in _names(inner)),
    ]
