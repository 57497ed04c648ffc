"""Keep off walls.

The shortest path hugs walls; a cost near them, here of up to 4 per metre within 0.6 m, makes room where there is
some. Both by A*.
"""

import matplotlib.pyplot as plt

import antnav as an

walls = an.maps.builtin("warehouse")
grid = walls.inflated(0.25)
field = an.costs.clearance(walls, radius=0.6, weight=4)

figure, panels = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
for ax, cost, title in zip(panels, (None, field), ("shortest", "with a cost near walls"), strict=True):
    problem = an.Problem(grid, start=(1.0, 1.0), goal=(18.0, 6.0), cost=cost)
    result = an.solve(problem, an.astar())
    an.plot_result(result, ax)
    ax.set_title(f"{title}: {result.length_m:.2f} m, walls {result.path.clearance:.2f} m away at least")
