"""Local searches: what is done to the paths of arrived ants before they count."""

from __future__ import annotations

from antnav.colony.parts import names
from antnav.colony.parts.part import Part, Share
from antnav.planner.facts import Basis, Knows


class LocalSearchPart(Part):
    """A local search."""

    no_regions = "a jump between regions need not be shorter"

    def share(self, schedule: int) -> Share:
        """Its code; of one's own none, which the kernel asks for in its place."""
        return {"local_search": names.LocalSearch.NONE.code if self.own else self.name.code}


class Unsearched(LocalSearchPart):
    """Nothing [paper]."""

    name, basis = names.LocalSearch.NONE, Basis.PAPER
    no_regions = ""


class Shortcut(LocalSearchPart):
    """From each cell on, jump to the farthest later cell of the path that is a neighbour [ours]."""

    name, basis = names.LocalSearch.SHORTCUT, Basis.OURS


class Merge(LocalSearchPart):
    """Shortcut; then the ten shortest give their shorter pieces to the best (after Gao et al.) [ours]."""

    name, basis = names.LocalSearch.MERGE, Basis.OURS


class Taut(LocalSearchPart):
    """Merge; then the best goes straight between two of its cells wherever that is shorter [ours]."""

    name, basis = names.LocalSearch.TAUT, Basis.OURS


class Weave(LocalSearchPart):
    """Taut, but in place of merge the best becomes the cheapest way over the cells of all of them [ours]."""

    name, basis, knows = names.LocalSearch.WEAVE, Basis.OURS, Knows.WOVEN
