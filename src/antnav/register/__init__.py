"""an.register: decorators by which your own rules, cuts, objectives, planners and algorithms get names.

What is registered works wherever a name does: in Python, study files, the command line, results, worker processes.

>>> import antnav as an
>>> @an.register.heuristic
... def homing(ground, reach=an.parameter(2.0, least=0, most=9)):
...     "1 / (reach + the straight distance to the goal)."
...     rows, cols = (ground.cells - ground.cells[ground.goal]).T
...     return 1 / (reach + (rows**2 + cols**2) ** 0.5 + 0.1)
>>> an.npaco(heuristic="homing", reach=1.5).heuristic
homing(reach=1.5)
"""

from antnav.colony.parts.ground import Ground
from antnav.kernels.plugs import Ants, Choice, Stuck
from antnav.register.goals import objective
from antnav.register.parts import cuts, deadlock, heuristic, initial, local_search, pheromone, transition
from antnav.register.whole import OwnAlgorithm, algorithm, planner

__all__ = [
    "Ants",
    "Choice",
    "Ground",
    "OwnAlgorithm",
    "Stuck",
    "algorithm",
    "cuts",
    "deadlock",
    "heuristic",
    "initial",
    "local_search",
    "objective",
    "pheromone",
    "planner",
    "transition",
]
