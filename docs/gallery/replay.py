"""A map that changes.

Twelve people walk through caves while a robot crosses them; the default replanner beside A* from anew at each tick.
The picture has moments of the drive; films of it are made by `an.save_film`.
"""

import antnav as an

grid = an.maps.generate("caves", 60, 60, seed=4)
start, goal = an.maps.ends(grid)
problem = an.Problem.from_cells(grid, start, goal)
scenario = an.scenarios.named("people:12", problem, seed=3)

an.plot_replay([an.replay(problem, scenario, "regions"), an.replay(problem, scenario, "astar")])
