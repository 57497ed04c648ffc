"""Goals that conflict.

All paths that no other beats in length and nearness to walls: exact, on a small map. Numbers and colours join a
path with its values.
"""

import antnav as an

grid = an.maps.generate("rooms", 40, 40, seed=3)
start, goal = an.maps.ends(grid)
problem = an.Problem.from_cells(grid, start, goal)
near_walls = an.objectives.Risk(an.costs.clearance(grid, radius=3.0))

front = an.pareto(problem, [an.objectives.Length(), near_walls])

an.plot_front(front)
