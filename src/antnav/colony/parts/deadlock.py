"""Deadlock rules: what happens to an ant that has no free, unvisited neighbour (section 4.2)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from antnav.colony.parts import names
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part, Share
from antnav.planner.facts import Basis

if TYPE_CHECKING:
    from antnav.colony.parameters import Settings


class DeadlockPart(Part):
    """A deadlock rule."""

    def share(self, schedule: int) -> Share:
        """Its code; no punishment and no retraction that ends."""
        return {"deadlock": self.name.code, "punish": 0.0, "retract_until": 0}


class Death(DeadlockPart):
    """It dies (Wang & Yu) [paper]."""

    name, basis = names.Deadlock.DEATH, Basis.PAPER


class Retract(DeadlockPart):
    """It retracts until a way opens; nothing is punished (Dai et al.) [reconstruction]."""

    name, basis = names.Deadlock.RETRACT, Basis.RECONSTRUCTION


class Punishing(DeadlockPart):
    """A rule that lets the pheromone of dead ends fade by eq. (4.2)."""

    punish: float = parameter(0.2, most=1, sane=(0.05, 0.5), symbol="lambda", certainty=Basis.PAPER)

    def share(self, schedule: int) -> Share:
        """Its code and lambda."""
        return super().share(schedule) | {"punish": float(self.punish)}


class Backtrack(Punishing):
    """One step back, that edge punished; dies if still stuck (Qu et al.) [reconstruction].

    Parameters
    ----------
    punish : float
        lambda of eq. (4.2).
    """

    name, basis = names.Deadlock.BACKTRACK, Basis.RECONSTRUCTION


class Luo(Punishing):
    """It dies, and its last two edges are punished by eq. (4.2) (Luo et al.) [paper].

    Parameters
    ----------
    punish : float
        lambda of eq. (4.2).
    """

    name, basis = names.Deadlock.LUO, Basis.PAPER


class Hybrid(Punishing):
    """For t <= b T it retracts until a way opens, later it dies; eq. (4.2) throughout [paper].

    Parameters
    ----------
    punish : float
        lambda of eq. (4.2).
    switch : float or None
        b. None: the paper's 0.6, 0.7, 0.8 for maps of up to 20, up to 30 and more cells a side [paper for these three
        sizes].
    """

    name, basis = names.Deadlock.HYBRID, Basis.PAPER

    switch: float | None = parameter(None, most=1, sane=(0, 1), symbol="b", certainty=Basis.PAPER)

    def share(self, schedule: int) -> Share:
        """Its code, lambda, and the last iteration in which ants retract."""
        return super().share(schedule) | {"retract_until": math.floor((self.switch or 0.0) * schedule + 1e-9)}

    def on(self, side: int, algorithm: Settings, *, dear: bool) -> Hybrid:
        """With b by the size of the map."""
        switch = self.switch
        if switch is None:
            switch = 0.6 if side <= 20 else 0.7 if side <= 30 else 0.8
        if algorithm.coarse:  # somebody must retract for once, so that somebody arrives
            switch = max(switch, 1.0 / algorithm.iterations)
        return self.changed(switch=switch)
