"""Budgets: what a run of an algorithm may cost, and how algorithms of a study get the same."""

from __future__ import annotations

from enum import StrEnum

from antnav.errors import ParameterError
from antnav.planner.planner import Planner


class Budget(StrEnum):
    """In what the algorithms of a study are made equal.

    - walks: ant walks, or path evaluations of a rival: iterations are chosen so
    - steps: moves of all ants: a run ends after the last iteration that does not exceed them, and its record says so
      where the first one does
    - seconds: wall seconds: a run ends after the iteration in which they run out
    """

    WALKS = "walks"
    STEPS = "steps"
    SECONDS = "seconds"

    @classmethod
    def of(cls, value: str) -> Budget:
        """The budget of that name.

        Raises
        ------
        ParameterError
            No such budget.
        """
        if value not in list(cls):
            raise ParameterError(f"equal_budget {value!r}", f"it is one of {', '.join(cls)}", "choose one of them")
        return cls(value)


def with_walks(planner: Planner, wanted: int) -> Planner:
    """The planner with a schedule of about so many walks; as it is, where it has as many.

    Raises
    ------
    ParameterError
        It has at least more walks than these, or does not say how many it has.
    """
    return planner if planner.walks == wanted else planner.with_walks(wanted)
