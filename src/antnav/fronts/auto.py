"""Auto: the whole front where that takes seconds, ants where it does not."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import msgspec

from antnav.fronts.colonies import Colonies
from antnav.fronts.exact import Exact
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.planner.call import Call
from antnav.run.stop import Progress, Stop
from antnav.values import whole_in


@dataclass(frozen=True)
class _Share(Stop):
    """A third of what another criterion allows."""

    whole: Stop

    def fraction(self, progress: Progress) -> float:
        """How near the end is."""
        return min(1.0, 3 * self.whole.fraction(progress))


@dataclass(frozen=True)
class Auto(Method):
    """Exact search up to a number of labels, and ants where that is not enough; what both found is kept.

    Where there is a criterion to stop by, exact search gets a third of what that allows. How many labels a front takes
    is not known before: it grows with the map, with every objective, and with how much they conflict.

    Parameters
    ----------
    limit : int
        Labels of the exact search, 1 to 10**9; a million takes half a second to three.
    """

    limit: int = 2_000_000

    def __post_init__(self) -> None:
        whole_in("limit", self.limit, 1, 10**9)

    @property
    def name(self) -> str:
        """As `antnav.pareto` takes it."""
        return "auto"

    @property
    def certainty(self) -> str:
        """Where it comes from."""
        return f"where complete: {Exact().certainty}; else: {Colonies().certainty}"

    @property
    def parts(self) -> tuple[Method, ...]:
        """Both."""
        return Exact(), Colonies()

    def find(self, instance: Instance, call: Call) -> Found:
        """Search exactly, then, where that was not enough, with ants."""
        shared = msgspec.structs.replace(call, stop=_Share(call.stop)) if call.stop else call
        exact = Exact(self.limit).find(instance, shared)
        if exact.complete:
            return replace(exact, notes=("auto took exact search",))
        if call.ending(0, math.inf):
            return exact
        ants = Colonies().find(instance, call)
        note = f"auto took ants: {exact.work['labels']} labels were not enough for exact search; paths may be missing"
        return replace(ants, paths=[*exact.paths, *ants.paths], work=exact.work | ants.work, notes=(note, *ants.notes))
