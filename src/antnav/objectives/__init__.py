"""Objectives: what may be said of a path, less being better, for questions with several goals that conflict.

Each gives the price of every move, or of every turn between two moves; a path's value is their sum. `antnav.pareto`
finds the paths that no other beats. For one of your own derive from `Objective`.
"""

from antnav.objectives.objective import Objective, over_cells
from antnav.objectives.turning import TurningAngle, Turns
from antnav.objectives.way import Energy, Length, Risk, Time

__all__ = ["Energy", "Length", "Objective", "Risk", "Time", "TurningAngle", "Turns", "over_cells"]
