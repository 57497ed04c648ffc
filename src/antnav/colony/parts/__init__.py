"""The interchangeable parts of an algorithm, each with its own parameters: a module for each kind of rule."""

from antnav.colony.parts.deadlock import Backtrack, DeadlockPart, Death, Hybrid, Luo, Retract
from antnav.colony.parts.heuristic import Astar, Auto, Detour, Edge, Geodesic, HeuristicPart, Sum, Target
from antnav.colony.parts.initial import InitialPart, Unequal, Uniform
from antnav.colony.parts.names import (
    Axis,
    Cuts,
    Deadlock,
    Deposit,
    Heuristic,
    InitialPheromone,
    Join,
    LocalSearch,
    Name,
    PheromoneRule,
    Search,
    Transition,
)
from antnav.colony.parts.parameter import Parameter, parameter, parameters_of
from antnav.colony.parts.part import Part
from antnav.colony.parts.pheromone import (
    AntSystem,
    BestAndTurns,
    BestAndWorst,
    BestSoFar,
    MaxMin,
    PheromonePart,
    RankBased,
    RewardAndPunish,
)
from antnav.colony.parts.transition import PseudoRandom, Roulette, TransitionPart

__all__ = [
    "AntSystem",
    "Astar",
    "Auto",
    "Axis",
    "Backtrack",
    "BestAndTurns",
    "BestAndWorst",
    "BestSoFar",
    "Cuts",
    "Deadlock",
    "DeadlockPart",
    "Death",
    "Deposit",
    "Detour",
    "Edge",
    "Geodesic",
    "Heuristic",
    "HeuristicPart",
    "Hybrid",
    "InitialPart",
    "InitialPheromone",
    "Join",
    "LocalSearch",
    "Luo",
    "MaxMin",
    "Name",
    "Parameter",
    "Part",
    "PheromonePart",
    "PheromoneRule",
    "PseudoRandom",
    "RankBased",
    "Retract",
    "RewardAndPunish",
    "Roulette",
    "Search",
    "Sum",
    "Target",
    "Transition",
    "TransitionPart",
    "Unequal",
    "Uniform",
    "parameter",
    "parameters_of",
]
