"""Several ways that truly differ.

Three routes, of which none runs along another for most of its way: other aisles, not copies a cell aside.
"""

import antnav as an

grid = an.maps.builtin("warehouse").inflated(0.25)
problem = an.Problem(grid, start=(1.0, 1.0), goal=(18.0, 6.0))

an.plot_alternatives(an.alternatives(problem, 3))
