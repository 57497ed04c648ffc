"""An algorithm as a frozen choice of parts and parameters, validated."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

from antnav.colony.parts import (
    Axis,
    Cuts,
    Deadlock,
    Deposit,
    Heuristic,
    InitialPheromone,
    Join,
    LocalSearch,
    PheromoneRule,
    Search,
    Transition,
)
from antnav.errors import ParameterError, shown
from antnav.values import finite_number
from antnav.world.grid import GridMap

#: Longer side in cells up to which the heuristic "auto" is `target`: the paper's range. At 50 cells its median gap is
#: 17-53 % on generated maps, at 100 cells 118-210 %.
LARGEST_TARGET_SIDE = 40


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
    cuts : {"line", "levels"}
        What divides the map; see `Cuts`.
    pieces : int
        K, pieces of stage two, 2 to 64; default 2 [paper]; more with levels [ours].
    """

    stage_one: int = 3
    axis: Axis = Axis.AUTO
    search: Search = Search.WHOLE
    inherit: bool = False
    join: Join = Join.PAPER
    cuts: Cuts = Cuts.LINE
    pieces: int = 2

    def __post_init__(self) -> None:
        _whole("stage_one", self.stage_one, 1)
        object.__setattr__(self, "axis", Axis.of(self.axis))
        object.__setattr__(self, "search", Search.of(self.search))
        object.__setattr__(self, "join", Join.of(self.join))
        object.__setattr__(self, "cuts", Cuts.of(self.cuts))
        _whole("pieces", self.pieces, 2, 64)
        if self.pieces > 2 and self.cuts is Cuts.LINE:
            raise ParameterError(f"pieces {self.pieces} with cuts line", "a line makes two", "give cuts levels")


@dataclass(frozen=True, kw_only=True, slots=True)
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
    coarse : int
        Side in cells of the blocks of an abstraction whose graph of regions the ants walk on, 4 to 128; 0 (default):
        they walk on the cells [ours]. See `abstraction`.
    routes : int
        With `coarse`: how many of the ants' routes are laid out on cells, >= 1; default 1. Sane: 1 to 8.
    windows : int
        Moves of the windows in which the path found is searched anew, exactly, >= 3; 0 (default): none [ours]. See
        `windows`. Sane: 30 to 300.
    straighten : bool
        Whether the path found gets fewer turns by another order of its moves, at exactly its length [ours]; False shows
        the raw path. See `windows.straightened`.
    local_search : LocalSearch
        Default "none" [paper].
    rho_last, beta_last : float or None
        Values of rho and beta at the last iteration, reached linearly; None (default): they stay. A beta that changes
        uses powers, which differ in the last digit between machines.
    openness : float
        Exponent >= 0 on the share of free neighbours of a cell, a factor of eta; default 0: none. Sane: 0 to 3.
    spread : float
        Share in [0, 1] of each deposit that also goes to all edges into the cells of the path; default 0. Sane: 0 to
        0.3.
    transition : Transition
        Default "roulette" [paper].
    q0_min, q0_max : float
        q0 of the pseudo-random rule at t = 0, before the first iteration, and at the last one, in [0, 1]; default 0.9
        [source: ACS]. Sane: 0.1 to 0.95.
    q0_relief : float
        Factor on q0, in (0, 1], for every 5 iterations without improvement; default 1.
    local_rate : float
        xi in [0, 1] of the Ant Colony System's local update, tau <- (1 - xi) tau + xi tau0 at each step; default 0.
    initial : InitialPheromone
        Default "uniform" [paper].
    initial_weight : float
        w of the unequal initial pheromone, >= 0; default 1 [calibrated].
    elite : int
        w of the rank-based rule, >= 1; default 6 [source].
    best_every : int
        `PheromoneRule.MAX_MIN`: the best so far deposits every so many iterations, >= 1; default 25 [source].
    restart : int
        `PheromoneRule.MAX_MIN`: iterations without improvement before all pheromone is reset, >= 1; default 50
        [calibrated].
    bend_turn, bend_angle : float
        phi and psi of the heuristic `astar`, >= 0; default 2 and 10/pi per radian [paper of Dai et al.].
    bend_with_start : bool
        Whether `astar` adds g, the straight distance to the start; default False: with g the map is almost flat.
    q2, q3 : float
        Q2 of `astar` and Q3 of `PheromoneRule.BEST_AND_TURNS`, > 0; default 1.5 and 1.2 [paper of Dai et al.].
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
    coarse: int = 0
    routes: int = 1
    windows: int = 0
    straighten: bool = True
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
    local_search: LocalSearch = LocalSearch.NONE
    rho_last: float | None = None
    beta_last: float | None = None
    openness: float = 0.0
    spread: float = 0.0
    transition: Transition = Transition.ROULETTE
    q0_min: float = 0.9
    q0_max: float = 0.9
    q0_relief: float = 1.0
    local_rate: float = 0.0
    initial: InitialPheromone = InitialPheromone.UNIFORM
    initial_weight: float = 1.0
    elite: int = 6
    best_every: int = 25
    restart: int = 50
    bend_turn: float = 2.0
    bend_angle: float = 10.0 / math.pi
    bend_with_start: bool = False
    q2: float = 1.5
    q3: float = 1.2
    certainty: str = "own composition"

    def __post_init__(self) -> None:
        object.__setattr__(self, "heuristic", Heuristic.of(self.heuristic))
        object.__setattr__(self, "pheromone", PheromoneRule.of(self.pheromone))
        object.__setattr__(self, "deadlock", Deadlock.of(self.deadlock))
        object.__setattr__(self, "deposit", Deposit.of(self.deposit))
        object.__setattr__(self, "local_search", LocalSearch.of(self.local_search))
        object.__setattr__(self, "transition", Transition.of(self.transition))
        object.__setattr__(self, "initial", InitialPheromone.of(self.initial))
        for name in ("ants", "iterations", "elite", "best_every", "restart", "routes"):
            _whole(name, getattr(self, name), 1)
        for name, least, most in (("coarse", 4, 128), ("windows", 3, 10_000)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float) or value != 0:
                _whole(name, value, least, most)
        if not isinstance(self.straighten, bool):
            raise ParameterError(f"straighten {shown(self.straighten)}", "it is true or false", "give one of them")
        for name, low, high in (
            ("alpha", 0, 20),
            ("beta", 0, 60),
            ("rho", 0, 1),
            ("q", 0, 1e6),
            ("tau0", 0, 1e6),
            ("tau_min", 0, 1),
            ("punish", 0, 1),
            ("q0_min", 0, 1),
            ("q0_max", 0, 1),
            ("q0_relief", 0, 1),
            ("local_rate", 0, 1),
            ("initial_weight", 0, 1e6),
            ("bend_turn", 0, 1e6),
            ("bend_angle", 0, 1e6),
            ("q2", 0, 1e6),
            ("q3", 0, 1e6),
            ("openness", 0, 20),
            ("spread", 0, 1),
        ):
            value = _number(name, getattr(self, name), low, high)
            if name in {"q", "q2", "q3", "q0_relief", "tau0", "tau_min"} and value == 0:
                raise ParameterError(f"{name} 0", f"{name} is above 0", "give a positive number, such as 1")
        for name, low, high in (("switch", 0, 1), ("rho_last", 0, 1), ("beta_last", 0, 60)):
            if getattr(self, name) is not None:
                _number(name, getattr(self, name), low, high)
        if not (self.decomposition is None or isinstance(self.decomposition, Decomposition)):
            raise ParameterError(
                f"decomposition {shown(self.decomposition)}",
                "it is None or a Decomposition",
                "give axis, search, ... by name",
            )
        if self.decomposition is not None and self.decomposition.stage_one >= self.iterations:
            raise ParameterError(
                f"stage_one {self.decomposition.stage_one}",
                f"stage one is shorter than the run of {self.iterations} iterations",
                "give fewer iterations to stage one or more to the run",
            )

        self._check_parts()

    def _check_parts(self) -> None:
        """Refuse parts that do not fit together, with the reason."""
        if self.coarse:
            self._check_coarse()
        rates = {self.rho, self.rho if self.rho_last is None else self.rho_last}
        if 0 in rates and self.pheromone in {PheromoneRule.MAX_MIN, PheromoneRule.BEST_SO_FAR}:
            reason = (
                "its upper bound is Q / (rho L)" if self.pheromone is PheromoneRule.MAX_MIN else "it deposits rho Q / L"
            )
            raise ParameterError(
                f"rho 0 with {self.pheromone}", f"{self.pheromone} needs rho above 0: {reason}", "give rho, such as 0.1"
            )
        if 1 in rates and self.pheromone is PheromoneRule.BEST_AND_TURNS:
            reason = "its upper bound is 1 / ((1 - rho) L)"
            raise ParameterError(
                f"rho 1 with {self.pheromone}", f"it needs rho below 1: {reason}", "give rho, such as 0.3"
            )
        if self.beta_last is not None and self.beta == 0:
            raise ParameterError(
                "beta_last with beta 0", "beta changes in proportion to its first value", "give beta, such as 7"
            )
        if (
            self.transition is Transition.PSEUDO_RANDOM
            and min(self.q0_min, self.q0_max) == 1
            and self.q0_relief == 1
            and not self.local_rate
        ):
            raise ParameterError(
                "q0 1 without a local update",
                "then every ant of an iteration walks the same way",
                "give q0 below 1, or a local_rate",
            )

    def _check_coarse(self) -> None:
        """Refuse what a graph of regions cannot carry."""
        reasons = {
            self.decomposition is not None: ("a decomposition", "regions divide the map already"),
            self.heuristic is Heuristic.EDGE: ("heuristic edge", "edges inside a region have length 0"),
            self.heuristic is Heuristic.ASTAR: ("heuristic astar", "edges between regions have no direction"),
            self.pheromone is PheromoneRule.BEST_AND_TURNS: (
                "pheromone best_and_turns",
                "edges between regions have no direction",
            ),
            self.local_search is not LocalSearch.NONE: (
                f"local search {self.local_search}",
                "a jump between regions need not be shorter",
            ),
        }
        if True in reasons:
            given, reason = reasons[True]
            raise ParameterError(f"coarse {self.coarse} with {given}", reason, "leave one of them out")

    def on(self, grid: GridMap) -> Self:
        """The same algorithm with the choices made that depend on the map: `switch` and an "auto" heuristic."""
        side = max(grid.shape)
        switch, heuristic, certainty = self.switch, self.heuristic, self.certainty
        if switch is None:
            switch = 0.6 if side <= 20 else 0.7 if side <= 30 else 0.8
        if heuristic is Heuristic.AUTO:
            small = side <= LARGEST_TARGET_SIDE and not self.coarse
            heuristic = Heuristic.TARGET if small else Heuristic.DETOUR
            if heuristic is Heuristic.DETOUR:
                where = " on the graph of regions" if self.coarse else ""
                certainty += f"; heuristic detour ours: it knows the exact distances{where}"
        if self.coarse:  # somebody must retract for once, so that somebody arrives
            switch = max(switch, 1.0 / self.iterations)
        return replace(self, switch=switch, heuristic=heuristic, certainty=certainty)


def _whole(name: str, value: int, low: int, high: int = 10**9) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise ParameterError(
            f"{name} {shown(value)}",
            f"{name} is a whole number from {low} to {high:g}",
            f"give one, such as {max(low, 50)}",
        )


def _number(name: str, value: float, low: float, high: float) -> float:
    if not (isinstance(value, int | float) and low <= finite_number(value) <= high):
        raise ParameterError(f"{name} {shown(value)}", f"{name} lies in {low}..{high}", "give a number in that range")
    return float(value)
