"""Algorithms as frozen choices of parts and parameters, and the presets that make them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

from antnav.colony.parts import Axis, Deadlock, Deposit, Heuristic, Join, PheromoneRule, Search
from antnav.errors import ParameterError
from antnav.grid import GridMap

#: Longer side in cells up to which the heuristic "auto" is `target`: the paper's range. At 50 cells its median gap is
#: 17-53 % on generated maps, at 100 cells 118-210 %.
LARGEST_TARGET_SIDE = 40
PAPER = "Si & Bao 2024, doi 10.3934/mbe.2024113"


@dataclass(frozen=True, kw_only=True)
class Decomposition:
    """PACO's division of the map at an auxiliary cell (sections 4.3, 4.4).

    Parameters
    ----------
    stage_one : int
        T0, iterations of the two colonies that look for the auxiliary cell, >= 1; default 3 [paper].
    axis : {"auto", "row", "column"}
        Dividing line; see `Axis`. "auto" is the paper's rule, "row" what its figures show.
    search : {"whole", "half"}
        Where stage two walks; see `Search`. "whole" [paper], "half" [ours].
    inherit : bool
        Whether stage two starts from the pheromone of stage one [ours]; default False: from fresh pheromone [paper].
    join : {"paper", "repair"}
        How the sub-paths become one; see `Join`.
    """

    stage_one: int = 3
    axis: Axis = Axis.AUTO
    search: Search = Search.WHOLE
    inherit: bool = False
    join: Join = Join.PAPER

    def __post_init__(self) -> None:
        _whole("stage_one", self.stage_one, 1)
        object.__setattr__(self, "axis", Axis.of(self.axis))
        object.__setattr__(self, "search", Search.of(self.search))
        object.__setattr__(self, "join", Join.of(self.join))


@dataclass(frozen=True, kw_only=True)
class Algorithm:
    """An ant algorithm, composed of parts.

    Parameters
    ----------
    name : str
        For reports.
    ants : int
        m, ants an iteration, >= 1; default 50 [paper]. Sane: 10 to 200.
    iterations : int
        T, >= 1; default 50 [paper]. Sane: 20 to 500.
    alpha : float
        Weight of the pheromone, >= 0; default 1 [paper]. Sane: 0.5 to 3. Runs with whole alpha and beta give the same
        bytes on every machine; other powers depend on the mathematical library.
    beta : float
        Weight of the heuristic, >= 0; default 7 [paper]. Sane: 1 to 12; larger is greedier.
    rho : float
        Evaporation rate in [0, 1]; default 0.1 [calibrated; not printed in the paper]. Sane: 0.02 to 0.5.
    q : float
        Q, pheromone of one deposit, > 0; default 1 [paper].
    tau0 : float
        Initial pheromone, > 0; default 1 [calibrated].
    tau_min : float
        Lower bound of the pheromone as a share of tau0, in (0, 1]; default 1e-3 [calibrated: eq. (4.1) can make it
        negative, which the paper leaves open].
    heuristic : Heuristic
    pheromone : PheromoneRule
    deadlock : Deadlock
    deposit : Deposit
        Default "both" [calibrated].
    punish : float
        lambda of eq. (4.2) in [0, 1]; default 0.2 [paper].
    switch : float or None
        b in [0, 1]: `Deadlock.HYBRID` kills dead ants once t > b T. None: the paper's 0.6, 0.7, 0.8 for maps of up to
        20, up to 30 and more cells a side [paper for these three sizes].
    decomposition : Decomposition or None
        None: one colony on the whole map.
    certainty : str
        How sure it is that this is what its source describes.

    Raises
    ------
    ParameterError
        A value out of its range.
    """

    name: str
    heuristic: Heuristic
    pheromone: PheromoneRule
    deadlock: Deadlock
    deposit: Deposit = Deposit.BOTH
    decomposition: Decomposition | None = None
    ants: int = 50
    iterations: int = 50
    alpha: float = 1.0
    beta: float = 7.0
    rho: float = 0.1
    q: float = 1.0
    tau0: float = 1.0
    tau_min: float = 1e-3
    punish: float = 0.2
    switch: float | None = None
    certainty: str = "own composition"

    def __post_init__(self) -> None:
        object.__setattr__(self, "heuristic", Heuristic.of(self.heuristic))
        object.__setattr__(self, "pheromone", PheromoneRule.of(self.pheromone))
        object.__setattr__(self, "deadlock", Deadlock.of(self.deadlock))
        object.__setattr__(self, "deposit", Deposit.of(self.deposit))
        _whole("ants", self.ants, 1)
        _whole("iterations", self.iterations, 1)
        for name, low, high in (
            ("alpha", 0, 20),
            ("beta", 0, 60),
            ("rho", 0, 1),
            ("q", 0, math.inf),
            ("tau0", 0, math.inf),
            ("tau_min", 0, 1),
            ("punish", 0, 1),
        ):
            value = _number(name, getattr(self, name), low, high)
            if name in {"q", "tau0", "tau_min"} and value == 0:
                raise ParameterError(f"{name} 0", f"{name} is above 0", "give a positive number, such as 1")
        if self.switch is not None:
            _number("switch", self.switch, 0, 1)
        if self.decomposition is not None and self.decomposition.stage_one >= self.iterations:
            raise ParameterError(
                f"stage_one {self.decomposition.stage_one}",
                f"stage one is shorter than the run of {self.iterations} iterations",
                "give fewer iterations to stage one or more to the run",
            )

    def on(self, grid: GridMap) -> Algorithm:
        """The same algorithm with the choices made that depend on the map: `switch` and an "auto" heuristic."""
        side = max(grid.shape)
        switch, heuristic, certainty = self.switch, self.heuristic, self.certainty
        if switch is None:
            switch = 0.6 if side <= 20 else 0.7 if side <= 30 else 0.8
        if heuristic is Heuristic.AUTO:
            heuristic = Heuristic.TARGET if side <= LARGEST_TARGET_SIDE else Heuristic.DETOUR
            if heuristic is Heuristic.DETOUR:
                certainty += "; heuristic detour ours: it knows the exact distances"
        return replace(self, switch=switch, heuristic=heuristic, certainty=certainty)


def _whole(name: str, value: int, low: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= 10**9:
        raise ParameterError(
            f"{name} {value!r}", f"{name} is a whole number from {low} to 1e9", f"give one, such as {max(low, 50)}"
        )


def _number(name: str, value: float, low: float, high: float) -> float:
    good = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if not good or not low <= value <= high:
        raise ParameterError(f"{name} {value!r}", f"{name} lies in {low}..{high}", "give a number in that range")
    return float(value)


_SPLIT = {field.name for field in fields(Decomposition)}


def _compose(default: Algorithm, choices: dict[str, Any]) -> Algorithm:
    """`default` with some choices replaced; those of the decomposition may stand among them."""
    known = {field.name for field in fields(Algorithm)} | (_SPLIT if default.decomposition else set())
    unknown = sorted(set(choices) - known)
    if unknown:
        raise ParameterError(
            f"parameter {unknown[0]!r}", f"{default.name} has {', '.join(sorted(known))}", "choose one of them"
        )
    split = {name: choices.pop(name) for name in _SPLIT & set(choices)}
    if split and default.decomposition:
        choices["decomposition"] = replace(choices.get("decomposition", default.decomposition), **split)
    return replace(default, **choices)


def traditional(**choices: Any) -> Algorithm:
    """The traditional ant algorithm that the paper compares with: Ant System on a grid (section 3).

    Every arrived ant deposits Q/L; a deadlocked ant dies. Heuristic `edge` (eq. 3.2 to the letter), rho 0.3, tau0 8
    [calibrated: the values of widespread grid-ant code; the paper prints neither].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`.
    """
    default = Algorithm(
        name="traditional",
        heuristic=Heuristic.EDGE,
        pheromone=PheromoneRule.ANT_SYSTEM,
        deadlock=Deadlock.DEATH,
        rho=0.3,
        tau0=8.0,
        certainty=f"paper ({PAPER}); rho and tau0 calibrated",
    )
    return _compose(default, choices)


def npaco(**choices: Any) -> Algorithm:
    """PACO without its decomposition: eq. (4.1) and the hybrid deadlock strategy in one colony.

    Heuristic `target` [calibrated] on maps of up to 40 cells a side, `detour` [ours] on larger ones.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`.
    """
    default = Algorithm(
        name="npaco",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.REWARD_AND_PUNISH,
        deadlock=Deadlock.HYBRID,
        certainty=f"paper ({PAPER}); heuristic, rho, tau0 and tau_min calibrated",
    )
    return _compose(default, choices)


def paco(**choices: Any) -> Algorithm:
    """PACO (Si & Bao 2024, doi 10.3934/mbe.2024113): `npaco` on the two halves of the map, side by side.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`.
    """
    return _compose(replace(npaco(), name="paco", decomposition=Decomposition()), choices)


def paco_extended(**choices: Any) -> Algorithm:
    """PACO with our additions: forward deposits; stage two keeps to its half and inherits pheromone; no loops.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`.
    """
    split = Decomposition(search=Search.HALF, inherit=True, join=Join.REPAIR)
    default = paco(
        deposit=Deposit.FORWARD, decomposition=split, name="paco_extended", certainty=f"ours, built on {PAPER}"
    )
    return _compose(default, choices)


#: Every preset by name.
PRESETS: dict[str, Callable[..., Algorithm]] = {
    preset.__name__: preset for preset in (traditional, npaco, paco, paco_extended)
}


def preset(name: str, **choices: Any) -> Algorithm:
    """An algorithm by the name of its preset.

    Raises
    ------
    ParameterError
        No such preset.
    """
    if name not in PRESETS:
        raise ParameterError(f"algorithm {name!r}", f"the algorithms are {', '.join(PRESETS)}", "choose one of them")
    return PRESETS[name](**choices)
