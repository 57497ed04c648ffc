"""The presets: published algorithms, and ours, as choices of parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields, replace
from inspect import Parameter, Signature
from typing import Any, TypedDict, Unpack, get_type_hints

from antnav.ants.algorithm import Algorithm
from antnav.colony.parameters import Decomposition
from antnav.colony.parts import (
    Axis,
    Cuts,
    Deadlock,
    Deposit,
    Heuristic,
    InitialPheromone,
    Join,
    LocalSearch,
    Part,
    PheromoneRule,
    Search,
    Transition,
)
from antnav.errors import ParameterError, shown

PAPER = "Si & Bao 2024, doi 10.3934/mbe.2024113"


class Choices(TypedDict, total=False):
    """What a preset may be given, for editors and type checkers: the fields of `Algorithm` and `Decomposition`."""

    ants: int
    iterations: int
    heuristic: Heuristic | str
    pheromone: PheromoneRule | str
    deadlock: Deadlock | str
    transition: Transition | str
    deposit: Deposit | str
    local_search: LocalSearch | str
    initial: InitialPheromone | str
    axis: Axis | str
    stage_one: int
    search: Search | str
    inherit: bool
    join: Join | str
    cuts: Cuts | str
    pieces: int
    alpha: float
    beta: float
    beta_last: float | None
    rho: float
    rho_last: float | None
    q: float
    tau0: float
    tau_min: float
    punish: float
    switch: float | None
    coarse: int
    routes: int
    windows: int
    straighten: bool
    openness: float
    spread: float
    q0_min: float
    q0_max: float
    q0_relief: float
    local_rate: float
    initial_weight: float
    elite: int
    best_every: int
    restart: int
    bend_turn: float
    bend_angle: float
    bend_with_start: bool
    q2: float
    q3: float
    decomposition: Decomposition | None
    name: str
    certainty: str


_SPLIT = {field.name for field in fields(Decomposition)}


def _compose(default: Algorithm, given: Choices) -> Algorithm:
    """`default` with some choices replaced; those of the decomposition may stand among them."""
    choices: dict[str, Any] = {**given}
    known = {field.name for field in fields(Algorithm)} | (_SPLIT if default.decomposition else set())
    unknown = sorted(set(choices) - known)
    if unknown:
        raise ParameterError(
            f"parameter {unknown[0]!r}", f"{default.name} has {', '.join(sorted(known))}", "choose one of them"
        )
    split = {name: choices.pop(name) for name in _SPLIT & set(choices)}
    if split:
        whole = choices.get("decomposition", default.decomposition)
        if not isinstance(whole, Decomposition):
            raise ParameterError(
                f"{min(split)} with decomposition {shown(whole)}",
                "it belongs to a Decomposition",
                "leave one of them out",
            )
        choices["decomposition"] = replace(whole, **split)
    made = replace(default, **choices)
    changed = "" if "certainty" in choices else _changes(default, made)
    return replace(made, certainty=f"{made.certainty}; modified: {changed}") if changed else made


#: Choices that do not make an algorithm another: how much it runs, how it is called, the axis that the paper varies.
_FREE = {"name", "certainty", "ants", "iterations", "decomposition", "axis", "straighten"}


def _changes(default: Algorithm, made: Algorithm) -> str:
    """What was changed of a published algorithm, as text."""
    pairs: list[tuple[Any, Any]] = [(default, made)]
    if default.decomposition and made.decomposition:
        pairs.append((default.decomposition, made.decomposition))
    changes = [
        f"{field.name} {getattr(after, field.name)}"
        for before, after in pairs
        for field in fields(after)
        if field.name not in _FREE and getattr(before, field.name) != getattr(after, field.name)
    ]
    if bool(default.decomposition) != bool(made.decomposition):
        changes.append("decomposition")
    return ", ".join(changes)


def traditional(**choices: Unpack[Choices]) -> Algorithm:
    """The traditional ant algorithm that the paper compares with: Ant System on a grid (section 3).

    Every arrived ant deposits Q/L; a deadlocked ant dies. Heuristic `edge` (eq. 3.2 to the letter), rho 0.3, tau0 1
    [calibrated: the paper prints neither; widespread grid-ant code has tau0 8, which ends farther from its figures].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="traditional",
        heuristic=Heuristic.EDGE,
        pheromone=PheromoneRule.ANT_SYSTEM,
        deadlock=Deadlock.DEATH,
        rho=0.3,
        certainty=f"paper ({PAPER}); rho and tau0 calibrated",
    )
    return _compose(default, choices)


def npaco(**choices: Unpack[Choices]) -> Algorithm:
    """PACO without its decomposition: eq. (4.1) and the hybrid deadlock strategy in one colony.

    Heuristic `target` [calibrated] on maps of up to 40 cells a side, `detour` [ours] on larger ones.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="npaco",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.REWARD_AND_PUNISH,
        deadlock=Deadlock.HYBRID,
        certainty=f"paper ({PAPER}); heuristic, rho, tau0 and tau_min calibrated",
    )
    return _compose(default, choices)


def paco(**choices: Unpack[Choices]) -> Algorithm:
    """PACO (Si & Bao 2024, doi 10.3934/mbe.2024113): `npaco` on the two halves of the map, side by side.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    return _compose(replace(npaco(), name="paco", decomposition=Decomposition()), choices)


def paco_extended(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with our additions: forward deposits; stage two keeps to its half and inherits pheromone; no loops.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    split = Decomposition(search=Search.HALF, inherit=True, join=Join.REPAIR)
    default = paco(
        deposit=Deposit.FORWARD, decomposition=split, name="paco_extended", certainty=f"ours, built on {PAPER}"
    )
    return _compose(default, choices)


def paco_levels(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with any number of pieces: cuts at equal distances from the start, windows over the joints. Ours.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    split = Decomposition(search=Search.HALF, inherit=True, join=Join.REPAIR, cuts=Cuts.LEVELS, pieces=4)
    default = paco(
        name="paco_levels",
        ants=25,  # pieces are short
        deposit=Deposit.FORWARD,
        decomposition=split,
        windows=60,
        certainty=f"ours, built on {PAPER}; the cuts know exact distances, windows are searched exactly",
    )
    return _compose(default, choices)


def luo(**choices: Unpack[Choices]) -> Algorithm:
    """The improved ant algorithm of Luo et al. 2020 (Neural Comput. Appl. 32) [reconstruction except eq. (4.2)].

    Unequal initial pheromone, pseudo-random choice whose q0 grows from 0.1 to 0.8 and is relieved while the best
    stagnates, the iteration's best path rewarded and its worst punished, dead ends punished by eq. (4.2).

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="luo",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.BEST_AND_WORST,
        deadlock=Deadlock.LUO,
        transition=Transition.PSEUDO_RANDOM,
        q0_min=0.1,
        q0_max=0.8,
        q0_relief=0.8,
        initial=InitialPheromone.UNEQUAL,
        certainty="reconstruction of Luo et al. 2020, except eq. (4.2)",
    )
    return _compose(default, choices)


def dai(**choices: Unpack[Choices]) -> Algorithm:
    """The ant algorithm of Dai et al. 2019 (Front. Neurorobot. 13:15, doi 10.3389/fnbot.2019.00015) [reconstruction].

    A heuristic as in A* that counts the bend from the ant's last direction, deposits of the best path by length and
    smoothness, pheromone between bounds, retraction at dead ends.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="dai",
        heuristic=Heuristic.ASTAR,
        pheromone=PheromoneRule.BEST_AND_TURNS,
        deadlock=Deadlock.RETRACT,
        rho=0.3,
        q=1.2,
        certainty="reconstruction of Dai et al. 2019",
    )
    return _compose(default, choices)


def rank_as(**choices: Unpack[Choices]) -> Algorithm:
    """Rank-based Ant System (Bullnheimer, Hartl & Strauss 1999) on a grid [source].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="rank_as",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.RANK_BASED,
        deadlock=Deadlock.RETRACT,
        certainty="source (Bullnheimer, Hartl & Strauss 1999); heuristic and deadlock rule ours",
    )
    return _compose(default, choices)


def mmas(**choices: Unpack[Choices]) -> Algorithm:
    """MAX-MIN Ant System (Stuetzle & Hoos 2000) on a grid [source]; 50 iterations are too few for it: give 200 or more.

    doi 10.1016/S0167-739X(00)00043-1. Mean gap with 50, 200 and 1000 iterations: 3.6, 0.06 and 0 % on equiv40, 68, 12
    and 10 % on a map of U-shaped traps.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="mmas",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.MAX_MIN,
        deadlock=Deadlock.RETRACT,
        certainty="source (Stuetzle & Hoos 2000); heuristic, rho and deadlock rule ours",
    )
    return _compose(default, choices)


def acs(**choices: Unpack[Choices]) -> Algorithm:
    """Ant Colony System (Dorigo & Gambardella 1997, doi 10.1109/4235.585892) on a grid [source].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="acs",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.BEST_SO_FAR,
        deadlock=Deadlock.RETRACT,
        transition=Transition.PSEUDO_RANDOM,
        ants=10,
        local_rate=0.1,
        tau0=0.01,
        certainty="source (Dorigo & Gambardella 1997); heuristic, tau0 and deadlock rule ours",
    )
    return _compose(default, choices)


def akka(**choices: Unpack[Choices]) -> Algorithm:
    """The improved ant algorithm of Akka & Khaber 2018 (doi 10.1177/1729881418774673) [reconstruction].

    A stimulating probability that favours open cells (`openness`), evaporation that changes as the run goes on, the
    iteration's best path rewarded and its worst punished.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="akka",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.BEST_AND_WORST,
        deadlock=Deadlock.RETRACT,
        openness=1.0,
        rho=0.3,
        rho_last=0.05,
        certainty="reconstruction of Akka & Khaber 2018",
    )
    return _compose(default, choices)


def you(**choices: Unpack[Choices]) -> Algorithm:
    """Ant Colony System with the dynamic search-inducing operator of You et al. [reconstruction].

    The pull of the heuristic fades as the run goes on: beta falls from 7 to 2.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = acs(name="you", beta_last=2.0, certainty="reconstruction of You et al.")
    return _compose(default, choices)


def gao(**choices: Unpack[Choices]) -> Algorithm:
    """EH-ACO of Gao et al. 2020 [reconstruction].

    Target visibility as heuristic, pheromone that diffuses around the paths (`spread`), backtracking at dead ends, and
    the good pieces of several paths merged into one.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="gao",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.RANK_BASED,
        deadlock=Deadlock.BACKTRACK,
        spread=0.1,
        local_search=LocalSearch.MERGE,
        certainty="reconstruction of Gao et al. 2020",
    )
    return _compose(default, choices)


def deng(**choices: Unpack[Choices]) -> Algorithm:
    """Pheromone on cells instead of edges, after Deng et al. [reconstruction].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="deng",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.RANK_BASED,
        deadlock=Deadlock.RETRACT,
        deposit=Deposit.CELLS,
        certainty="reconstruction of Deng et al.",
    )
    return _compose(default, choices)


def liu(**choices: Unpack[Choices]) -> Algorithm:
    """Diffusion of pheromone and geometric optimisation of paths, after Liu et al. 2017 [reconstruction].

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="liu",
        heuristic=Heuristic.AUTO,
        pheromone=PheromoneRule.ANT_SYSTEM,
        deadlock=Deadlock.RETRACT,
        spread=0.2,
        local_search=LocalSearch.SHORTCUT,
        certainty="reconstruction of Liu et al. 2017",
    )
    return _compose(default, choices)


def paco_ls(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with our additions and local search: `shortcut` before each deposit, `windows` on the path at the end.

    Parameters
    ----------
    **choices
        Any field of `Algorithm` or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    default = replace(
        paco_extended(),
        name="paco_ls",
        local_search=LocalSearch.SHORTCUT,
        windows=60,
        certainty=f"ours, built on {PAPER}; windows are searched exactly",
    )
    return _compose(default, choices)


def paco_large(**choices: Unpack[Choices]) -> Algorithm:
    """PACO for large maps: ants on the graph of regions, their routes laid out on cells and improved in windows.

    Two colonies walk from either end, as in PACO's first stage, but on an abstraction of the map whose regions are
    connected exactly where the map is. Their best routes become paths, side by side, and windows of exact search make
    the best of these better. Ours; it knows exact distances in the graph of regions and within windows.

    Parameters
    ----------
    **choices
        Any field of `Algorithm`: see `help(antnav.Algorithm)`.
    """
    default = npaco(
        name="paco_large",
        coarse=16,
        routes=4,
        windows=192,
        ants=10,
        iterations=10,
        beta=3.0,
        deposit=Deposit.FORWARD,
        certainty=f"ours, built on {PAPER}; windows are searched exactly",
    )
    return _compose(default, choices)


#: Every preset by name.
PRESETS: dict[str, Callable[..., Algorithm]] = {
    preset.__name__: preset
    for preset in (
        traditional,
        npaco,
        paco,
        paco_extended,
        paco_ls,
        paco_levels,
        paco_large,
        luo,
        dai,
        rank_as,
        mmas,
        acs,
        akka,
        you,
        gao,
        deng,
        liu,
    )
}


def _signature(default: Algorithm, kinds: dict[str, Any]) -> Signature:
    """What `help()` shows of a preset: every choice with its type and its value."""
    values = {field.name: getattr(default, field.name) for field in fields(default)}
    values |= asdict(default.decomposition) if default.decomposition else {}
    shown = [
        Parameter(name, Parameter.KEYWORD_ONLY, default=_shown(values[name]), annotation=kind)
        for name, kind in kinds.items()
        if name in values
    ]
    return Signature(shown, return_annotation=Algorithm)


def _shown(value: Any) -> Any:
    """The name of a part, which a preset takes as well as the part itself."""
    return value.value if isinstance(value, Part) else value


def _sign() -> None:
    kinds = get_type_hints(Choices)
    for made in PRESETS.values():
        made.__signature__ = _signature(made(), kinds)  # type: ignore[attr-defined]


_sign()


def preset(name: str, /, **choices: Any) -> Algorithm:
    """An algorithm by the name of its preset.

    Raises
    ------
    ParameterError
        No such preset.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise ParameterError(
            f"algorithm {shown(name)}", f"the algorithms are {', '.join(PRESETS)}", "choose one of them"
        )
    return PRESETS[name](**choices)
