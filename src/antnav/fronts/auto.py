"""Auto: the whole front where that takes seconds, ants where it does not."""

from __future__ import annotations

from dataclasses import dataclass, replace

from antnav.fronts.colonies import Colonies
from antnav.fronts.exact import Exact
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.planner.call import Call
from antnav.planner.plan import StoppedBy
from antnav.values import whole_in


@dataclass(frozen=True)
class Auto(Method):
    """Exact search up to a number of labels, and ants where that is not enough; what both found is kept.

    How many labels a front takes is not known before: it grows with the map, with every objective, and with how much
    they conflict.

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
        exact = Exact(self.limit).find(instance, call)
        if exact.complete:
            return replace(exact, notes=("auto took exact search",))
        if exact.stopped_by is not StoppedBy.SCHEDULE:
            return exact
        ants = Colonies().find(instance, call)
        note = f"auto took ants: {self.limit} labels were not enough for exact search; other paths may be missing"
        return replace(ants, paths=[*exact.paths, *ants.paths], work=exact.work | ants.work, notes=(note, *ants.notes))
