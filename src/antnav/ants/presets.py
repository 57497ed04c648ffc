"""The presets: published algorithms, and ours, as choices of parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from inspect import Parameter, Signature
from typing import Any, TypedDict, Unpack, get_type_hints

from antnav.ants.algorithm import Algorithm
from antnav.colony.parameters import Decomposition
from antnav.colony.parts import (
    AntSystem,
    Astar,
    Auto,
    Axis,
    Backtrack,
    BestAndTurns,
    BestAndWorst,
    BestSoFar,
    Cuts,
    DeadlockPart,
    Death,
    Deposit,
    Edge,
    HeuristicPart,
    Hybrid,
    InitialPart,
    Join,
    LocalSearchPart,
    Luo,
    MaxMin,
    MemoryPart,
    Merge,
    Name,
    Octile,
    PheromonePart,
    PseudoRandom,
    RankBased,
    Retract,
    RewardAndPunish,
    Search,
    Shortcut,
    Taut,
    TransitionPart,
    Unequal,
)
from antnav.errors import ParameterError, shown
from antnav.planner.facts import Basis, Certainty, Clause

PAPER = "Si & Bao 2024, doi 10.3934/mbe.2024113"


class Choices(TypedDict, total=False):
    """What a preset may be given, for editors and type checkers: the choices of `Algorithm` and of what it holds."""

    ants: int
    iterations: int
    heuristic: HeuristicPart | str
    pheromone: PheromonePart | str
    deadlock: DeadlockPart | str
    transition: TransitionPart | str
    deposit: Deposit | str
    local_search: LocalSearchPart | str
    graft: bool
    colonies: int
    initial: InitialPart | str
    memory: MemoryPart | str
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
    lambda_r: float
    lambda_e: float
    lambda_t: float
    flatten: float
    elitists: float
    tau_max: float
    immigrants: float
    elite: int
    best_every: int
    restart: int
    block: int
    bend_turn: float
    bend_angle: float
    bend_with_start: bool
    q2: float
    q3: float
    decomposition: Decomposition | None
    name: str
    certainty: Certainty | str


@cache
def _certainty(basis: Basis, source: str, other: Basis | None = None, part: str = "") -> Certainty:
    """The certainty of an algorithm as a whole, and of that part of it which rests on something else."""
    return Certainty((Clause(basis, source), *([Clause(other, part=part)] if other else [])))


def traditional(**choices: Unpack[Choices]) -> Algorithm:
    """The traditional ant algorithm that the paper compares with: Ant System on a grid (section 3).

    Every arrived ant deposits Q/L; a deadlocked ant dies. Heuristic `edge` (eq. 3.2 to the letter), rho 0.3, tau0 1
    [calibrated: the paper prints neither; widespread grid-ant code has tau0 8, which ends farther from its figures].

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="traditional",
        heuristic=Edge(),
        pheromone=AntSystem(),
        deadlock=Death(),
        rho=0.3,
        certainty=_certainty(Basis.PAPER, PAPER, Basis.CALIBRATED, "rho and tau0"),
    )
    return default.changed(**choices)


def npaco(**choices: Unpack[Choices]) -> Algorithm:
    """PACO without its decomposition: eq. (4.1) and the hybrid deadlock strategy in one colony.

    Heuristic `target` [calibrated] on maps of up to 40 cells a side, `detour` [ours] on larger ones.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="npaco",
        heuristic=Auto(),
        pheromone=RewardAndPunish(),
        deadlock=Hybrid(),
        certainty=_certainty(Basis.PAPER, PAPER, Basis.CALIBRATED, "heuristic, rho, tau0 and tau_min"),
    )
    return default.changed(**choices)


def paco(**choices: Unpack[Choices]) -> Algorithm:
    """PACO (Si & Bao 2024, doi 10.3934/mbe.2024113): `npaco` on the two halves of the map, side by side.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm`, parts or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    return replace(npaco(), name="paco", decomposition=Decomposition()).changed(**choices)


def paco_extended(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with our additions: forward deposits; stage two keeps to its half and inherits pheromone; no loops.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm`, parts or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    split = Decomposition(search=Search.HALF, inherit=True, join=Join.REPAIR)
    default = paco(
        deposit=Deposit.FORWARD, decomposition=split, name="paco_extended", certainty=_certainty(Basis.OURS, PAPER)
    )
    return default.changed(**choices)


def paco_taut(**choices: Unpack[Choices]) -> Algorithm:
    """`paco_extended` with paths merged, pulled taut and grafted: few ants, half of the schedule for stage one.

    Ours. Its longer colonies take a fifth of `npaco`'s time, and it is optimal far more often, without exact distances.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm`, parts or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    default = replace(
        paco_extended(ants=10, iterations=16, stage_one=8, beta=2.0),
        name="paco_taut",
        heuristic=Octile(),
        local_search=Taut(),
        graft=True,
        certainty=_certainty(Basis.OURS, PAPER),
    )
    return default.changed(**choices)


def paco_levels(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with any number of pieces: cuts at equal distances from the start, windows over the joints. Ours.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm`, parts or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    split = Decomposition(search=Search.HALF, inherit=True, join=Join.REPAIR, cuts=Cuts.LEVELS, pieces=4)
    default = paco(
        name="paco_levels",
        ants=25,  # pieces are short
        deposit=Deposit.FORWARD,
        decomposition=split,
        windows=60,
        certainty=_certainty(Basis.OURS, PAPER),
    )
    return default.changed(**choices)


def luo(**choices: Unpack[Choices]) -> Algorithm:
    """The improved ant algorithm of Luo et al. 2020 (Neural Comput. Appl. 32) [reconstruction except eq. (4.2)].

    Unequal initial pheromone, pseudo-random choice whose q0 grows from 0.1 to 0.8 and is relieved while the best
    stagnates, the iteration's best path rewarded and its worst punished, dead ends punished by eq. (4.2).

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="luo",
        heuristic=Auto(),
        pheromone=BestAndWorst(),
        deadlock=Luo(),
        transition=PseudoRandom(q0_min=0.1, q0_max=0.8, q0_relief=0.8),
        initial=Unequal(),
        certainty=_certainty(Basis.RECONSTRUCTION, "Luo et al. 2020, except eq. (4.2)"),
    )
    return default.changed(**choices)


def dai(**choices: Unpack[Choices]) -> Algorithm:
    """The ant algorithm of Dai et al. 2019 (Front. Neurorobot. 13:15, doi 10.3389/fnbot.2019.00015) [reconstruction].

    A heuristic as in A* that counts the bend from the ant's last direction, deposits of the best path by length and
    smoothness, pheromone between bounds, retraction at dead ends.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="dai",
        heuristic=Astar(),
        pheromone=BestAndTurns(),
        deadlock=Retract(),
        rho=0.3,
        q=1.2,
        certainty=_certainty(Basis.RECONSTRUCTION, "Dai et al. 2019"),
    )
    return default.changed(**choices)


def rank_as(**choices: Unpack[Choices]) -> Algorithm:
    """Rank-based Ant System (Bullnheimer, Hartl & Strauss 1999) on a grid [source].

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="rank_as",
        heuristic=Auto(),
        pheromone=RankBased(),
        deadlock=Retract(),
        certainty=_certainty(
            Basis.SOURCE, "Bullnheimer, Hartl & Strauss 1999", Basis.OURS, "heuristic and deadlock rule"
        ),
    )
    return default.changed(**choices)


def mmas(**choices: Unpack[Choices]) -> Algorithm:
    """MAX-MIN Ant System (Stuetzle & Hoos 2000) on a grid [source]; 50 iterations are too few for it: give 200 or more.

    doi 10.1016/S0167-739X(00)00043-1. Mean gap with 50, 200 and 1000 iterations: 3.6, 0.06 and 0 % on equiv40, 68, 12
    and 10 % on a map of U-shaped traps.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="mmas",
        heuristic=Auto(),
        pheromone=MaxMin(),
        deadlock=Retract(),
        certainty=_certainty(Basis.SOURCE, "Stuetzle & Hoos 2000", Basis.OURS, "heuristic, rho and deadlock rule"),
    )
    return default.changed(**choices)


def acs(**choices: Unpack[Choices]) -> Algorithm:
    """Ant Colony System (Dorigo & Gambardella 1997, doi 10.1109/4235.585892) on a grid [source].

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="acs",
        heuristic=Auto(),
        pheromone=BestSoFar(),
        deadlock=Retract(),
        transition=PseudoRandom(),
        ants=10,
        local_rate=0.1,
        tau0=0.01,
        certainty=_certainty(
            Basis.SOURCE, "Dorigo & Gambardella 1997", Basis.OURS, "heuristic, tau0 and deadlock rule"
        ),
    )
    return default.changed(**choices)


def akka(**choices: Unpack[Choices]) -> Algorithm:
    """The improved ant algorithm of Akka & Khaber 2018 (doi 10.1177/1729881418774673) [reconstruction].

    A stimulating probability that favours open cells (`openness`), evaporation that changes as the run goes on, the
    iteration's best path rewarded and its worst punished.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="akka",
        heuristic=Auto(),
        pheromone=BestAndWorst(),
        deadlock=Retract(),
        openness=1.0,
        rho=0.3,
        rho_last=0.05,
        certainty=_certainty(Basis.RECONSTRUCTION, "Akka & Khaber 2018"),
    )
    return default.changed(**choices)


def you(**choices: Unpack[Choices]) -> Algorithm:
    """Ant Colony System with the dynamic search-inducing operator of You et al. [reconstruction].

    The pull of the heuristic fades as the run goes on: beta falls from 7 to 2.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = acs(name="you", beta_last=2.0, certainty=_certainty(Basis.RECONSTRUCTION, "You et al."))
    return default.changed(**choices)


def gao(**choices: Unpack[Choices]) -> Algorithm:
    """EH-ACO of Gao et al. 2020 [reconstruction].

    Target visibility as heuristic, pheromone that diffuses around the paths (`spread`), backtracking at dead ends, and
    the good pieces of several paths merged into one.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="gao",
        heuristic=Auto(),
        pheromone=RankBased(),
        deadlock=Backtrack(),
        spread=0.1,
        local_search=Merge(),
        certainty=_certainty(Basis.RECONSTRUCTION, "Gao et al. 2020"),
    )
    return default.changed(**choices)


def deng(**choices: Unpack[Choices]) -> Algorithm:
    """Pheromone on cells instead of edges, after Deng et al. [reconstruction].

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="deng",
        heuristic=Auto(),
        pheromone=RankBased(),
        deadlock=Retract(),
        deposit=Deposit.CELLS,
        certainty=_certainty(Basis.RECONSTRUCTION, "Deng et al."),
    )
    return default.changed(**choices)


def liu(**choices: Unpack[Choices]) -> Algorithm:
    """Diffusion of pheromone and geometric optimisation of paths, after Liu et al. 2017 [reconstruction].

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = Algorithm(
        name="liu",
        heuristic=Auto(),
        pheromone=AntSystem(),
        deadlock=Retract(),
        spread=0.2,
        local_search=Shortcut(),
        certainty=_certainty(Basis.RECONSTRUCTION, "Liu et al. 2017"),
    )
    return default.changed(**choices)


def paco_ls(**choices: Unpack[Choices]) -> Algorithm:
    """PACO with our additions and local search: `shortcut` before each deposit, `windows` on the path at the end.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm`, parts or `Decomposition`: see `help(antnav.Algorithm)`, `help(antnav.Decomposition)`.
    """
    default = replace(
        paco_extended(),
        name="paco_ls",
        local_search=Shortcut(),
        windows=60,
        certainty=_certainty(Basis.OURS, PAPER),
    )
    return default.changed(**choices)


def two_ended(**choices: Unpack[Choices]) -> Algorithm:
    """Colonies from either end for the whole schedule, their paths merged, pulled taut, grafted. Ours.

    `npaco` with other parts and 10 ants a colony. It knows no exact distance and searches nothing exactly.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = npaco(
        name="two_ended",
        colonies=2,
        ants=10,
        heuristic=Octile(),
        beta=1.0,
        deposit=Deposit.FORWARD,
        local_search=Taut(),
        graft=True,
        certainty=_certainty(Basis.OURS, PAPER),
    )
    return default.changed(**choices)


def paco_large(**choices: Unpack[Choices]) -> Algorithm:
    """PACO for large maps: ants on the graph of regions, their routes laid out on cells and improved in windows.

    Two colonies walk from either end, as in PACO's first stage, but on an abstraction of the map whose regions are
    connected exactly where the map is. Their best routes become paths, side by side, and windows of exact search make
    the best of these better. Ours; it knows exact distances in the graph of regions and within windows.

    Parameters
    ----------
    **choices
        Any choice of `Algorithm` or of its parts: see `help(antnav.Algorithm)`.
    """
    default = npaco(
        name="paco_large",
        coarse=16,
        routes=2,
        windows=1000,
        ants=5,
        iterations=5,
        beta=3.0,
        deposit=Deposit.FORWARD,
        certainty=_certainty(Basis.OURS, PAPER),
    )
    return default.changed(**choices)


#: Every preset by name.
PRESETS: dict[str, Callable[..., Algorithm]] = {
    preset.__name__: preset
    for preset in (
        traditional,
        npaco,
        paco,
        paco_extended,
        paco_taut,
        paco_ls,
        paco_levels,
        two_ended,
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
    values = default.choices() | {"decomposition": default.decomposition, "certainty": default.certainty}
    shown = [
        Parameter(name, Parameter.KEYWORD_ONLY, default=_shown(values[name]), annotation=kind)
        for name, kind in kinds.items()
        if name in values
    ]
    return Signature(shown, return_annotation=Algorithm)


def _shown(value: Any) -> Any:
    """The name of a part, which a preset takes as well as the part itself."""
    return value.value if isinstance(value, Name) else value


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
