"""Planner: what `solve` carries out, with ants or without."""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self

import msgspec
import numpy as np

from antnav.errors import ParameterError
from antnav.planner.call import Call
from antnav.planner.facts import Certainty, Knows
from antnav.planner.plan import Plan
from antnav.plugins.source import Source, digest_of, file_of
from antnav.world.grid import GridMap
from antnav.world.problem import Problem


class Registered(Protocol):
    """What a user has registered."""

    @property
    def source(self) -> Source: ...  # noqa: D102


class Planner:
    """A way to plan. One of your own derives from this class and needs no more than a `name` and `plan`.

    Make it a frozen dataclass of numbers, texts and truths: so studies know its runs again, and files can hold it.
    Studies run it anew once the code of its class is another; what that calls elsewhere goes unwatched: see `identity`.

    Attributes
    ----------
    name : str
        As it stands in tables.
    certainty : str or Certainty
        How sure it is that this is what its source describes.
    knows : Knows
        Exact distances that it uses.
    ants : int
        Ants an iteration; 0 for a planner without.
    remembers : bool
        Whether it begins with `call.warm` and leaves a memory where the call says `remember`.
    own : sequence
        What of it users have registered, each with its `source`.
    """

    __slots__ = ()

    if TYPE_CHECKING:  # nobody sets them, and dataclasses may have fields of these names

        @property
        def name(self) -> str:  # noqa: D102 - above
            ...

        @property
        def certainty(self) -> Certainty | str:  # noqa: D102
            ...

        @property
        def ants(self) -> int:  # noqa: D102
            ...

        @property
        def knows(self) -> Knows:  # noqa: D102
            ...

        @property
        def remembers(self) -> bool:  # noqa: D102
            ...

        @property
        def own(self) -> Sequence[Registered]:  # noqa: D102
            ...

    else:
        name, certainty, ants, knows, remembers, own = "own", "own planner", 0, Knows.NOTHING, False, ()

    @property
    def kind(self) -> str:
        """By which `KINDS` knows it: of your own, its class."""
        return f"{type(self).__module__}.{type(self).__qualname__}"

    @property
    def walks(self) -> int | None:
        """Paths that it tries on its schedule, arrived or not; None where nobody can say."""
        return None

    def with_walks(self, wanted: int) -> Self:
        """The same planner with a schedule of about so many walks.

        Raises
        ------
        ParameterError
            It cannot have as few, or does not say how many it has.
        """
        rule = "it does not say how many paths it tries"
        remedy = "give its class a property walks and a method with_walks, or leave it out, or give seconds"
        raise ParameterError(f"{self.name} with {wanted} walks", rule, remedy)

    @property
    def outline(self) -> str:
        """What it is, in a line: its name and what else readers want to know first."""
        return self.name

    @property
    def schedule(self) -> str:
        """How long it runs at most, in words that follow a count of iterations: "of 50, 50 ants"; "" if nothing is."""
        return ""

    def on(self, grid: GridMap) -> Self:
        """The same planner with the choices made that depend on the map."""
        return self

    def suited(self, problem: Problem) -> Self:
        """The same planner with all choices made: those that depend on the map, and on whether its cells cost."""
        return self.on(problem.grid)

    def prepare(self, problem: Problem | None = None) -> float:
        """Compile or load what it needs; with a problem also work out what all runs on its map share.

        Returns
        -------
        float
            Seconds that compiling and loading took; 0 once that is done in this process.
        """
        return 0.0

    def versions(self) -> dict[str, str]:
        """Versions of the libraries beside antnav's own that decide its outcome."""
        return {}

    def plan(self, problem: Problem, call: Call) -> Plan:
        """Search for a path between two different cells.

        The same seed gives the same plan. Of a planner from outside antnav, `solve` verifies every move.
        """
        rule = "its class has no method plan(problem, call)"
        raise ParameterError(f"planner {self.name!r}", rule, "define one that returns an.Plan(cells=...)")

    def document(self) -> dict[str, Any]:
        """Everything that makes it what it is, as JSON types, with its kind: see `read`."""
        about = {"kind": self.kind, "name": self.name, "certainty": str(self.certainty), **(_fields(self) or {})}
        return about | ({"own": {"planner": self.own[0].source.document()}} if self.own else {})

    def choices(self) -> dict[str, Any]:
        """The document without what it does not use, and flat."""
        return self.document()


def _fields(planner: Any) -> dict[str, Any] | None:
    """The fields of a dataclass; None for anything else."""
    return {field.name: getattr(planner, field.name) for field in fields(planner)} if is_dataclass(planner) else None


def identity(planner: Planner, problem: Problem) -> dict[str, Any]:
    """Everything but the seed by which a planner decides the outcome of a run on a problem.

    Two names for one thing have one identity. Classes from outside antnav are known by their code too, under "source":
    a digest for each, of the text of the class, or of its module's file where that text cannot be read. A change of
    functions beside the class goes unnoticed, unless it is registered (`antnav.register`): then the whole file counts.
    Without a file, as in notebooks, all bytecode counts that the class refers to.

    Raises
    ------
    ParameterError
        It is no dataclass of numbers, texts and truths.
    """
    resolved = planner.suited(problem)
    if _fields(resolved) is None:
        raise _opaque(planner)
    document = plain(resolved, resolved.document())
    own = {key: value for key, value in document.items() if key not in {"name", "certainty"}}
    outside = code_outside(type(resolved))
    source = {"source": outside} if outside else {}
    return own | source | {"versions": planner.versions()}


def code_outside(kind: type) -> list[str]:
    """Digests of the code of a class and its bases, as far as they are from outside antnav; see `identity`."""
    known = {"antnav", *sys.stdlib_module_names}
    return [_digest_of_code(base) for base in kind.__mro__ if base.__module__.partition(".")[0] not in known]


@cache
def _digest_of_code(kind: type) -> str:
    """Of a class as it stands when it is first asked for; see `identity`."""
    if isinstance(source := vars(kind).get("source"), Source):
        return source.digest
    file = file_of(kind)
    if file is None:
        return digest_of(kind)
    try:
        code = inspect.getsource(kind).encode()
    except (OSError, TypeError):
        code = file.read_bytes()
    return hashlib.sha256(code).hexdigest()


def plain(planner: Planner, values: dict[str, Any]) -> dict[str, Any]:
    """What a planner says of itself as JSON types, NumPy's numbers as Python's.

    Raises
    ------
    ParameterError
        There is something else in it, such as an array.
    """
    try:
        found: dict[str, Any] = msgspec.to_builtins(values, enc_hook=_scalar)
    except TypeError as error:
        raise _opaque(planner) from error
    return found


def _scalar(value: object) -> bool | int | float | str:
    match value:
        case np.bool_():
            return bool(value)
        case np.integer():
            return int(value)
        case np.floating():
            return float(value)
        case np.str_():
            return str(value)
    raise TypeError(type(value))


def _opaque(planner: Planner) -> ParameterError:
    rule = "its class is a dataclass of numbers and texts, by which files and studies know it"
    return ParameterError(f"planner {planner.name!r}", rule, "make it one")


def parameters(chosen: Planner) -> dict[str, Any]:
    """All parameters that a planner has, those of its parts among them; None: off, or chosen by map."""
    about = {"kind", "name", "certainty", "own"}
    return {name: value for name, value in chosen.choices().items() if name not in about}


#: Makes a planner of its document again, by the document's kind.
KINDS: dict[str, Callable[[dict[str, Any]], Planner]] = {}


class _Told(NamedTuple):
    """What a file says that a user has registered."""

    kind: str
    source: Source


class Recorded(Planner):
    """A planner that a file tells of and nobody here knows: it can be named, not run."""

    def __init__(self, document: dict[str, Any]) -> None:
        self._document = document

    @property
    def name(self) -> str:
        """As the file says."""
        return str(self._document.get("name", "unknown"))

    @property
    def certainty(self) -> str:
        """As the file says."""
        return str(self._document.get("certainty", ""))

    @property
    def own(self) -> list[_Told]:
        """As the file says."""
        own = self._document.get("own")
        told = own.items() if isinstance(own, dict) else ()
        return [_Told(kind, Source.read(about)) for kind, about in told if isinstance(about, dict)]

    @property
    def _missing(self) -> str:
        if not self.own:
            return f"nothing here makes a {self._document.get('kind')}"
        told = [f"its {'planner' if one.kind == 'planner' else 'rule'} {one.source}" for one in self.own]
        return f"{' and '.join(told)} {'is' if len(told) == 1 else 'are'} not registered here"

    def __repr__(self) -> str:
        return f"<recorded planner {self.name!r}: {self._missing}>"

    def document(self) -> dict[str, Any]:
        """As it stood in the file."""
        return self._document

    def plan(self, problem: Problem, call: Call) -> Plan:
        """Refused."""
        remedy = "import or load its file" if self.own else "import what defines it"
        raise ParameterError(f"planner {self.name!r}", self._missing, remedy)


def differing(planner: Planner, document: dict[str, Any]) -> list[str]:
    """What of a planner that a file names has other code here than in the file's run, as notes."""
    own = document.get("own")
    if not isinstance(own, dict) or isinstance(planner, Recorded):
        return []
    then = [Source.read(told) for told in own.values()]
    changed = [one.source for one in planner.own if one.source.digest not in {told.digest for told in then}]
    return [
        f"own rule {now} has other code here than in the run: {told}, sha256 {told.digest[:16]}"
        for now in changed
        for told in then
        if told.name == now.name
    ]


def read(document: dict[str, Any]) -> Planner:
    """The planner of a document: of the kind "ants" where it names none."""
    make = KINDS.get(document.get("kind", "ants"))
    return make(document) if make else Recorded(document)
