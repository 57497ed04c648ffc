"""Pheromone grows.

One colony, stopped after 1, 5, 15 and 50 iterations: what no ant uses only evaporates, dead ends fade at once,
because lost ants punish them, and what is left is a band around the best path. `Colony.tau` has a value for each of
the eight moves out of a cell; a cell is shaded by the largest of them, logarithmically.
"""

import matplotlib.pyplot as plt
import numpy as np

import antnav as an

start, goal = an.maps.builtin_query("equiv30")
problem = an.Problem.from_cells(an.maps.builtin("equiv30"), start, goal, corner_rule="allow")
colony = an.Colony(problem, an.npaco(), seed=7)
graph = colony.task.grid_graph

figure, panels = plt.subplots(1, 4, figsize=(11, 3.2), layout="constrained")
for ax, iterations in zip(panels, (1, 5, 15, 50), strict=True):
    colony.step(iterations - colony.iteration)
    moves = graph.graph.neighbours < len(graph)
    strongest = np.where(moves, colony.tau, 0).max(axis=1)
    ax.imshow(graph.on_map(np.log(strongest).astype(np.float32)), cmap="Blues", vmin=-7, vmax=1)
    path = colony.best_path(problem)
    ax.plot(path.cells[:, 1], path.cells[:, 0], color="#D55E00", linewidth=1.5)
    ax.set_title(f"iteration {iterations}: {path.length:.1f} cells")
    ax.set_facecolor("#26292e")  # walls
    ax.set_xticks([])
    ax.set_yticks([])
