"""Transition rules: how an ant chooses among the neighbours that it may enter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from antnav.colony.parts import names
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part, Share
from antnav.errors import ParameterError
from antnav.planner.facts import Basis

if TYPE_CHECKING:
    from antnav.colony.parameters import Settings


class TransitionPart(Part):
    """A transition rule."""

    def share(self, schedule: int) -> Share:
        """Its code; q0 0 for rules without one."""
        return {"transition": self.name.code, "q0_min": 0.0, "q0_max": 0.0, "q0_relief": 1.0}


class Roulette(TransitionPart):
    """By the probabilities of eq. (3.1) [paper]."""

    name, basis = names.Transition.ROULETTE, Basis.PAPER


class PseudoRandom(TransitionPart):
    """With probability q0 the best one, else roulette (Dorigo & Gambardella) [source].

    Parameters
    ----------
    q0_min, q0_max : float
        q0 at t = 0, before the first iteration, and at the last one.
    q0_relief : float
        Factor on q0 for every 5 iterations without improvement.
    """

    name, basis = names.Transition.PSEUDO_RANDOM, Basis.SOURCE

    q0_min: float = parameter(0.9, most=1, sane=(0.1, 0.95), symbol="q0", certainty=Basis.SOURCE)
    q0_max: float = parameter(0.9, most=1, sane=(0.1, 0.95), symbol="q0", certainty=Basis.SOURCE)
    q0_relief: float = parameter(1.0, most=1, above=True, sane=(0.5, 1), certainty=Basis.RECONSTRUCTION)

    def share(self, schedule: int) -> Share:
        """Its code and q0."""
        own = {"q0_min": self.q0_min, "q0_max": self.q0_max, "q0_relief": self.q0_relief}
        return super().share(schedule) | {name: float(value) for name, value in own.items()}

    def refuse(self, algorithm: Settings) -> None:
        """Refuse ants that all walk the same way."""
        if min(self.q0_min, self.q0_max) == 1 and self.q0_relief == 1 and not algorithm.local_rate:
            raise ParameterError(
                "q0 1 without a local update",
                "then every ant of an iteration walks the same way",
                "give q0 below 1, or a local_rate",
            )
