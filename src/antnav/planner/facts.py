"""Facts about an algorithm as data, from which sentences are printed: what it rests on, what it knows of a map."""

from __future__ import annotations

from collections.abc import Iterator
from enum import Flag, StrEnum, auto

import msgspec

from antnav.errors import check_type


class Basis(StrEnum):
    """What a choice, or a whole algorithm, rests on: the tags of the documentation.

    - paper: the paper says so
    - source: the source of a classic says so
    - calibrated: the paper is silent; this comes closest to its figures
    - reconstruction: rebuilt from a work that leaves choices open
    - ours: an addition of antnav's
    - exact: exact search, which no ant did
    - modified: a user's change of a preset
    - own: a rule or a preset of a user's
    - stated: the words of whoever composed it
    """

    PAPER = "paper"
    SOURCE = "source"
    CALIBRATED = "calibrated"
    RECONSTRUCTION = "reconstruction"
    OURS = "ours"
    EXACT = "exact"
    MODIFIED = "modified"
    OWN = "own"
    STATED = "stated"


_WHOLE = {
    Basis.PAPER: "paper ({})",
    Basis.SOURCE: "source ({})",
    Basis.CALIBRATED: "calibrated: {}",
    Basis.RECONSTRUCTION: "reconstruction of {}",
    Basis.OURS: "ours, built on {}",
    Basis.EXACT: "{}",
    Basis.MODIFIED: "modified: {}",
    Basis.OWN: "{}",
    Basis.STATED: "{}",
}


class Clause(msgspec.Struct, frozen=True):
    """One statement on certainty.

    Attributes
    ----------
    basis : Basis
    text : str
        The source, or what is to be added; of `MODIFIED`, the changes.
    part : str
        What of the algorithm it is about; empty: the whole.
    """

    basis: Basis
    text: str = ""
    part: str = ""

    def __str__(self) -> str:
        if not self.part:
            return _WHOLE[self.basis].format(self.text) if self.text else str(self.basis)
        return f"{self.part} {self.basis}" + (f": {self.text}" if self.text else "")


class Knows(Flag):
    """Exact distances that an algorithm is given before the first ant walks, or works out later, which no ant did.

    - TO_GOAL: from every cell to the goal
    - FROM_START: from the start to every cell
    - REGIONS: between the regions of an abstraction
    - WINDOWS: inside the windows in which the path is searched anew
    - GAPS: across the gaps of remembered paths
    - WOVEN: among the cells that the ants of an iteration have visited
    """

    NOTHING = 0
    TO_GOAL = auto()
    FROM_START = auto()
    REGIONS = auto()
    WINDOWS = auto()
    GAPS = auto()
    WOVEN = auto()

    @property
    def names(self) -> tuple[str, ...]:
        """What is known, for files."""
        return tuple(str(one.name).lower() for one in Knows if one in self)


class Certainty(msgspec.Struct, frozen=True, eq=False):
    """How sure it is that an algorithm is what its source describes.

    Two that say the same are equal, since files of results keep no more than the sentence.

    Attributes
    ----------
    clauses : tuple of Clause
        What its composer states.
    known : tuple of Clause
        What follows from its parts, whatever its composer states.
    """

    clauses: tuple[Clause, ...]
    known: tuple[Clause, ...] = ()

    @classmethod
    def of(cls, given: Certainty | str) -> Certainty:
        """The words of a user, as they are.

        Raises
        ------
        ParameterError
            No text.
        """
        check_type("certainty", given, Certainty | str, "give a text")
        return given if isinstance(given, Certainty) else cls((Clause(Basis.STATED, given),))

    @property
    def bases(self) -> frozenset[Basis]:
        """All that it rests on."""
        return frozenset(clause.basis for clause in self)

    def modified(self, changes: str) -> Certainty:
        """The same with a user's changes added."""
        clauses = [clause for clause in self.clauses if clause.basis is not Basis.MODIFIED]
        earlier = [clause.text for clause in self.clauses if clause.basis is Basis.MODIFIED]
        return Certainty((*clauses, Clause(Basis.MODIFIED, ", ".join([*earlier, changes]))), self.known)

    def with_known(self, known: tuple[Clause, ...]) -> Certainty:
        """The same with what follows from the parts in place of what was known before."""
        return Certainty(self.clauses, known)

    def __iter__(self) -> Iterator[Clause]:
        return iter((*self.clauses, *self.known))

    def __str__(self) -> str:
        return "; ".join(map(str, self))

    def __repr__(self) -> str:
        return repr(str(self))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Certainty) and str(self) == str(other)

    def __hash__(self) -> int:
        return hash(str(self))
