"""What users call the parts; those that kernels know have their codes in `kernels.codes`."""

from __future__ import annotations

from enum import StrEnum
from functools import cached_property
from typing import Self

from antnav.errors import ParameterError, shown
from antnav.kernels import codes


class Name(StrEnum):
    """The name of a part."""

    @cached_property
    def code(self) -> int:
        """Integer code for the kernels, a plain int: an enum argument misses Numba's disk cache."""
        return int(getattr(codes, type(self).__name__)[self.name])

    @classmethod
    def of(cls, value: str) -> Self:
        """The part of that name.

        Raises
        ------
        ParameterError
            No such part.
        """
        try:
            return cls(value)
        except ValueError:
            kind = cls.__name__
            raise ParameterError(
                f"{kind} {shown(value)}", f"it is one of {', '.join(cls)}", "choose one of them"
            ) from None


class OwnName(str):
    """The name of a user's part."""

    __slots__ = ()

    #: Integer code for the kernels, the same for all of them.
    code = codes.OWN


class Heuristic(Name):
    """What draws an ant from cell i to its neighbour j: eta_ij of eq. (3.1). d is the length of the move.

    - auto: `target` on maps of up to 40 cells a side, where cells cost `blocks`; `detour` on larger ones [calibrated]
    - edge: 1 / d_ij: eq. (3.2) taken literally [paper]
    - target: 1 / straight distance from j to the goal [calibrated]
    - sum: 1 / (d_ij + straight distance from j to the goal); common in the literature [source]
    - geodesic: 1 / true remaining length from j, from an exact backward search [ours]
    - astar: Q2 / (h + bend), h from j to the goal, bend by the last direction (Dai et al.) [reconstruction]
    - detour: 1 / (1 + d_ij + G_j - G_i), G the true remaining length: guides at any distance [ours]
    - blocks: 1 / (1 + d_ij + G_j - G_i), G the remaining cost as estimated on a coarser map [ours]
    - octile: 1 / (1 + d_ij + h_j - h_i), h the octile distance to the goal, as if there were no walls [ours]
    """

    AUTO = "auto"
    EDGE = "edge"
    TARGET = "target"
    SUM = "sum"
    GEODESIC = "geodesic"
    ASTAR = "astar"
    DETOUR = "detour"
    BLOCKS = "blocks"
    OCTILE = "octile"


class InitialPheromone(Name):
    """Pheromone before the first iteration.

    - uniform: tau0 everywhere [paper]
    - unequal: more on the way: tau0 (1 + w d_SG / (d_Sj + d_jG)) (Luo et al.) [reconstruction]
    """

    UNIFORM = "uniform"
    UNEQUAL = "unequal"


class MemoryStrategy(Name):
    """What is done to remembered pheromone where a run begins with it.

    - keep: all of it stays as it is; tau0 where no edge is known [ours]
    - restart: it is forgotten, or a share of it everywhere (Guntsch & Middendorf) [reconstruction]
    - eta: it is equalised around the change, by distance (Guntsch & Middendorf) [reconstruction]
    - tau: it is equalised where pheromone leads to the change (Guntsch & Middendorf) [reconstruction]
    - repair: flattened, then as `eta`; the best path, its gaps searched exactly, counts as found and deposits [ours]
    - population: it is laid out anew from the latest paths, mended (P-ACO, Guntsch & Middendorf) [reconstruction]
    - random_immigrants: as `population`, a share drawn at random (RIACO, Mavrovouniotis & Yang) [reconstruction]
    - elitism_immigrants: as `population`, a share the best path mutated (EIACO, Mavrovouniotis & Yang) [reconstruction]
    - memory_immigrants: as `population`, a share the best ever mutated (MIACO, Mavrovouniotis & Yang) [reconstruction]
    """

    KEEP = "keep"
    RESTART = "restart"
    ETA = "eta"
    TAU = "tau"
    REPAIR = "repair"
    POPULATION = "population"
    RANDOM_IMMIGRANTS = "random_immigrants"
    ELITISM_IMMIGRANTS = "elitism_immigrants"
    MEMORY_IMMIGRANTS = "memory_immigrants"


class Transition(Name):
    """How an ant chooses among the neighbours that it may enter.

    - roulette: by the probabilities of eq. (3.1) [paper]
    - pseudo_random: with probability q0 the best one, else roulette (Dorigo & Gambardella) [source]
    """

    ROULETTE = "roulette"
    PSEUDO_RANDOM = "pseudo_random"


class PheromoneRule(Name):
    """Who deposits how much at the end of an iteration.

    - ant_system: every arrived ant, Q / L: eq. (3.3), (3.4) [paper]
    - reward_and_punish: the best ants more, the worst ants less than nothing: eq. (4.1) [paper]
    - rank_based: the best w - 1 by rank and the best so far w times (Bullnheimer et al.) [source]
    - max_min: the best of the iteration or so far, between bounds (Stuetzle & Hoos) [source]
    - best_so_far: the best path, tau <- (1 - rho) tau + rho Q / L (Dorigo & Gambardella) [source]
    - best_and_worst: the iteration's best +Q / L, its worst -Q / L (Luo et al.) [reconstruction]
    - best_and_turns: the iteration's best Q / L + Q3 / C, C its turns (Dai et al.) [reconstruction]
    """

    ANT_SYSTEM = "ant_system"
    REWARD_AND_PUNISH = "reward_and_punish"
    RANK_BASED = "rank_based"
    MAX_MIN = "max_min"
    BEST_SO_FAR = "best_so_far"
    BEST_AND_WORST = "best_and_worst"
    BEST_AND_TURNS = "best_and_turns"


class Deposit(Name):
    """Which directions of an edge get the pheromone that an ant leaves there.

    - both: both [calibrated: the paper is silent]
    - cells: none: pheromone belongs to cells, so all edges into a cell get it (Deng et al.) [reconstruction]
    - forward: the one in which the ant went [ours: fewer steps and more optimal runs]
    """

    BOTH = "both"
    CELLS = "cells"
    FORWARD = "forward"


class LocalSearch(Name):
    """What is done to the paths of arrived ants before they count.

    - none: nothing [paper]
    - shortcut: from each cell on, jump to the farthest later cell of the path that is a neighbour [ours]
    - merge: shortcut; then the ten shortest give their shorter pieces to the best (after Gao et al.) [ours]
    - taut: merge; then the best goes straight between two of its cells wherever that is shorter [ours]
    - weave: taut, but in place of merge the best becomes the cheapest way over the cells of all of them [ours]
    """

    NONE = "none"
    SHORTCUT = "shortcut"
    MERGE = "merge"
    TAUT = "taut"
    WEAVE = "weave"


class Deadlock(Name):
    """What happens to an ant that has no free, unvisited neighbour (section 4.2).

    - death: it dies (Wang & Yu) [paper]
    - backtrack: one step back, that edge punished; dies if still stuck (Qu et al.) [reconstruction]
    - luo: it dies, and its last two edges are punished by eq. (4.2) (Luo et al.) [paper]
    - retract: it retracts until a way opens; nothing is punished (Dai et al.) [reconstruction]
    - hybrid: for t <= b T it retracts until a way opens, later it dies; eq. (4.2) throughout [paper]
    """

    DEATH = "death"
    BACKTRACK = "backtrack"
    LUO = "luo"
    RETRACT = "retract"
    HYBRID = "hybrid"


class Axis(Name):
    """Which middle line divides the map in step 2 of PACO.

    - auto: the row where rows differ at least as much as columns, else the column [paper]
    - row: the row: what the paper's three maps show
    - column: the column
    """

    AUTO = "auto"
    ROW = "row"
    COLUMN = "column"


class Cuts(Name):
    """What divides the map in step 2 of PACO.

    - line: a middle line, see `Axis`: two pieces [paper]
    - levels: equal steps of the exact distance from the start: any number of pieces, of one length [ours]
    """

    LINE = "line"
    LEVELS = "levels"


class Search(Name):
    """Where the colonies of PACO's second stage may walk.

    - whole: on the whole map [paper]
    - half: on their own side of the line, as the paper's complexity formula assumes, or between levels [ours]
    """

    WHOLE = "whole"
    HALF = "half"


class Join(Name):
    """What becomes of the two sub-paths.

    - paper: end to end, as they are [paper]
    - repair: loops are cut out, and a shorter path of stage one is kept instead [ours]
    """

    PAPER = "paper"
    REPAIR = "repair"
