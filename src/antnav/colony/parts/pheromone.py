"""Pheromone rules: who deposits how much at the end of an iteration."""

from __future__ import annotations

from typing import TYPE_CHECKING

from antnav.colony.parts import names
from antnav.colony.parts.parameter import parameter
from antnav.colony.parts.part import Part, Share
from antnav.errors import ParameterError
from antnav.planner.facts import Basis

if TYPE_CHECKING:
    from antnav.colony.parameters import Settings


class PheromonePart(Part):
    """A pheromone rule.

    Attributes
    ----------
    needs_rho : str
        Why rho cannot be 0; empty where it can.
    """

    needs_rho = ""

    def share(self, schedule: int) -> Share:
        """Its code; the parameters of other rules at values that do nothing."""
        return {"pheromone": self.name.code, "elite": 1, "q3": 0.0, "best_every": 1, "restart": 1}

    def refuse(self, algorithm: Settings) -> None:
        """Refuse rates of evaporation that its formula divides by."""
        if self.needs_rho and 0 in algorithm.rates:
            raise ParameterError(
                f"rho 0 with {self}", f"{self} needs rho above 0: {self.needs_rho}", "give rho, such as 0.1"
            )


class AntSystem(PheromonePart):
    """Every arrived ant, Q / L: eq. (3.3), (3.4) [paper]."""

    name, basis = names.PheromoneRule.ANT_SYSTEM, Basis.PAPER


class RewardAndPunish(PheromonePart):
    """The best ants more, the worst ants less than nothing: eq. (4.1) [paper]."""

    name, basis = names.PheromoneRule.REWARD_AND_PUNISH, Basis.PAPER


class RankBased(PheromonePart):
    """The best w - 1 by rank and the best so far w times (Bullnheimer et al.) [source].

    Parameters
    ----------
    elite : int
        w.
    """

    name, basis = names.PheromoneRule.RANK_BASED, Basis.SOURCE

    elite: int = parameter(6, least=1, sane=(3, 10), symbol="w", certainty=Basis.SOURCE)

    def share(self, schedule: int) -> Share:
        """Its code and w."""
        return super().share(schedule) | {"elite": self.elite}


class MaxMin(PheromonePart):
    """The best of the iteration or so far, between bounds (Stuetzle & Hoos) [source].

    Parameters
    ----------
    best_every : int
        The best so far deposits every so many iterations.
    restart : int
        Iterations without improvement before all pheromone is reset.
    """

    name, basis = names.PheromoneRule.MAX_MIN, Basis.SOURCE
    needs_rho = "its upper bound is Q / (rho L)"

    best_every: int = parameter(25, least=1, certainty=Basis.SOURCE)
    restart: int = parameter(50, least=1, certainty=Basis.CALIBRATED)

    def share(self, schedule: int) -> Share:
        """Its code, and when the best so far deposits and all begins anew."""
        return super().share(schedule) | {"best_every": self.best_every, "restart": self.restart}


class BestSoFar(PheromonePart):
    """The best path, tau <- (1 - rho) tau + rho Q / L (Dorigo & Gambardella) [source]."""

    name, basis = names.PheromoneRule.BEST_SO_FAR, Basis.SOURCE
    needs_rho = "it deposits rho Q / L"


class BestAndWorst(PheromonePart):
    """The iteration's best +Q / L, its worst -Q / L (Luo et al.) [reconstruction]."""

    name, basis = names.PheromoneRule.BEST_AND_WORST, Basis.RECONSTRUCTION


class BestAndTurns(PheromonePart):
    """The iteration's best Q / L + Q3 / C, C its turns (Dai et al.) [reconstruction].

    Parameters
    ----------
    q3 : float
        Q3.
    """

    name, basis = names.PheromoneRule.BEST_AND_TURNS, Basis.RECONSTRUCTION
    no_regions = "edges between regions have no direction"

    q3: float = parameter(1.2, most=1e6, above=True, symbol="Q3", certainty=Basis.PAPER)

    def share(self, schedule: int) -> Share:
        """Its code and Q3."""
        return super().share(schedule) | {"q3": float(self.q3)}

    def refuse(self, algorithm: Settings) -> None:
        """Refuse a rate that its upper bound divides by."""
        super().refuse(algorithm)
        if 1 in algorithm.rates:
            reason = "its upper bound is 1 / ((1 - rho) L)"
            raise ParameterError(f"rho 1 with {self}", f"it needs rho below 1: {reason}", "give rho, such as 0.3")
