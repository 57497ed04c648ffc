"""The integer codes by which kernels know the parts. A code stands beside its member and keeps its meaning for ever.

`colony.parts` has the same classes and members, with what users call them and what they do.
"""

from __future__ import annotations

from enum import IntEnum

#: Of any kind of part: the user's own, which the kernel asks through `plugs`.
OWN = 100


class PheromoneRule(IntEnum):
    """Who deposits how much."""

    ANT_SYSTEM = 0
    REWARD_AND_PUNISH = 1
    RANK_BASED = 2
    MAX_MIN = 3
    BEST_SO_FAR = 4
    BEST_AND_WORST = 5
    BEST_AND_TURNS = 6


class Deadlock(IntEnum):
    """What happens in a dead end."""

    DEATH = 0
    BACKTRACK = 1
    LUO = 2
    RETRACT = 3
    HYBRID = 4


class Deposit(IntEnum):
    """Which directions of an edge get pheromone."""

    BOTH = 0
    CELLS = 1
    FORWARD = 2


class LocalSearch(IntEnum):
    """What is done to the paths of arrived ants."""

    NONE = 0
    SHORTCUT = 1
    MERGE = 2
    TAUT = 3
    WEAVE = 4


class Transition(IntEnum):
    """How an ant chooses."""

    ROULETTE = 0
    PSEUDO_RANDOM = 1
