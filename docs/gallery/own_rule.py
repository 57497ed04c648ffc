"""A rule of one's own.

Between two iterations a program may change all pheromone. This one forgets everything around the start whenever ten
iterations brought nothing: a colony that is stuck begins anew there, and keeps what it knows elsewhere. It brings
nothing here, as the picture shows; to try one takes ten lines.
"""

import matplotlib.pyplot as plt
import numpy as np

import antnav as an

start, goal = an.maps.builtin_query("equiv40")
problem = an.Problem.from_cells(an.maps.builtin("equiv40"), start, goal, corner_rule="allow")


def best_lengths(seed: int, *, forget: bool) -> list[float]:
    """The best length after each iteration."""
    colony = an.Colony(problem, an.npaco(iterations=150), seed=seed)
    near_start = np.abs(colony.task.grid_graph.cells - start).max(axis=1) < 15
    lengths: list[float] = []
    for iteration in colony:
        lengths.append(iteration.best)
        if forget and len(lengths) % 10 == 0 and lengths[-10] == iteration.best:
            colony.tau[near_start] = 1.0
    return lengths


figure, ax = plt.subplots(figsize=(7, 3.8), layout="constrained")
for forget, colour, label in ((False, "#0072B2", "npaco"), (True, "#D55E00", "npaco, forgetful")):
    median = np.median([best_lengths(seed, forget=forget) for seed in range(20)], axis=0)
    ax.plot(np.arange(1, 151), median, color=colour, label=label)
ax.axhline(an.exact.optimum(problem).cost, color="#26292e", linestyle=":", label="optimum")
ax.set(xlabel="iteration", ylabel="median of the best length, cells", xlim=(1, 150))
ax.spines[["top", "right"]].set_visible(False)
ax.legend(frameon=False)
