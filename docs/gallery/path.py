"""A path, and how the colony found it.

The paper's setting on `equiv40`, a stand-in for its largest map: the path over the pheromone of both halves, start
and goal, the auxiliary cell where the way was divided, and the convergence beside it, with the optimum as a line.
"""

import antnav as an

start, goal = an.maps.builtin_query("equiv40")
problem = an.Problem.from_cells(an.maps.builtin("equiv40"), start, goal, corner_rule="allow")
result = an.solve(problem, an.paco_extended(), seed=7)

an.plot_result(result)
