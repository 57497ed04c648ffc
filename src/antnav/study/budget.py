"""Budgets: what a run of an algorithm may cost, and how algorithms of a study get the same."""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum
from typing import Any

from antnav.colony.parameters import Algorithm
from antnav.errors import ParameterError
from antnav.rivals.metaheuristics import Metaheuristic
from antnav.rivals.planning import Rival
from antnav.rivals.potential_field import PotentialField


class Budget(StrEnum):
    """In what the algorithms of a study are made equal.

    - walks: ant walks, or path evaluations of a rival: iterations are chosen so
    - steps: moves of all ants: a run ends after the last iteration that does not exceed them
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


def walks(chosen: Algorithm | Rival) -> int:
    """Paths that an algorithm tries on its schedule: walks of all ants of all colonies, or evaluations of a rival.

    Where no ant arrives in stage one, a level has no cell or a potential field arrives early, a run tries others.

    Raises
    ------
    ParameterError
        A rival of somebody's own, whose effort nobody knows beforehand.
    """
    if isinstance(chosen, Algorithm):
        split = chosen.decomposition
        if chosen.coarse:
            return 2 * chosen.ants * chosen.iterations
        if split is None:
            return chosen.ants * chosen.iterations
        return chosen.ants * (2 * split.stage_one + split.pieces * (chosen.iterations - split.stage_one))
    if isinstance(chosen, Metaheuristic):
        return chosen.evaluations
    if isinstance(chosen, PotentialField):
        return chosen.escapes + 1
    rule = "only antnav's own rivals say how many paths they try"
    raise ParameterError(f"rival {chosen.name!r} with equal_budget walks", rule, "leave it out, or give seconds")


def with_walks(chosen: Algorithm | Rival, wanted: int) -> Any:
    """The algorithm with iterations, or the rival with evaluations, of about so many walks.

    Ants, stage one and pieces stay, so the count of iterations is rounded.

    Raises
    ------
    ParameterError
        It has at least more walks than these, or is a rival of somebody's own.
    """
    if walks(chosen) == wanted:
        return chosen
    if isinstance(chosen, Metaheuristic):
        return replace(chosen, evaluations=wanted)
    if isinstance(chosen, PotentialField):
        return replace(chosen, escapes=wanted - 1)
    assert isinstance(chosen, Algorithm)
    split, rounds = chosen.decomposition, wanted / chosen.ants
    if chosen.coarse:
        return replace(chosen, iterations=max(1, round(rounds / 2)))
    if split is None:
        return replace(chosen, iterations=max(1, round(rounds)))
    rest = round((rounds - 2 * split.stage_one) / split.pieces)
    if rest < 1:
        raise ParameterError(
            f"{chosen.name} with {wanted} ant walks",
            f"stage one alone has {2 * split.stage_one * chosen.ants}",
            "give the baseline more iterations, or this one fewer ants",
        )
    return replace(chosen, iterations=split.stage_one + rest)
