"""Three algorithms, thirty seeds.

Best length by iteration, median and quartiles over seeds. `history.best` of a result has one value an iteration.
`npaco` and `mmas` know the straight line to the goal, `two_ended` the octile distance; none of them knows exact
distances.
"""

import matplotlib.pyplot as plt
import numpy as np

import antnav as an

start, goal = an.maps.builtin_query("equiv40")
problem = an.Problem.from_cells(an.maps.builtin("equiv40"), start, goal, corner_rule="allow")

figure, ax = plt.subplots(figsize=(7, 3.8), layout="constrained")
colours = ("#0072B2", "#E69F00", "#009E73")
for algorithm, colour in zip((an.npaco(), an.mmas(), an.two_ended()), colours, strict=True):
    histories = np.array([an.solve(problem, algorithm, seed=seed).history.best for seed in range(30)])
    low, median, high = np.quantile(histories, (0.25, 0.5, 0.75), axis=0, method="nearest")
    iterations = np.arange(1, len(median) + 1)
    ax.fill_between(iterations, low, high, color=colour, alpha=0.2, linewidth=0)
    ax.plot(iterations, median, color=colour, label=algorithm.name)
ax.axhline(an.exact.optimum(problem).cost, color="#26292e", linestyle=":", label="optimum")
ax.set(xlabel="iteration", ylabel="best length, cells", xlim=(1, 50))
ax.spines[["top", "right"]].set_visible(False)
ax.legend(frameon=False)
