"""What guides ants where cells cost: `python benchmarks/bench_costs.py`; gaps to the exact optimum in per cent.

npaco, five seeds, on the stand-ins equiv20 and equiv40 under the corner rule `allow`, with a cost of each cell drawn
from a gamma distribution of shape 1 and scale 2 under a fixed seed. Printed: the least and the largest gap.
"""

from __future__ import annotations

import numpy as np

import antnav as an
from antnav import costs, maps

SEEDS = range(5)


def main() -> None:
    rng = np.random.default_rng(0)
    problems = {}
    for name in ("equiv20", "equiv40"):
        grid = maps.builtin(name)
        field = costs.array(rng.gamma(1.0, 2.0, grid.shape))
        problems[name] = an.Problem.from_cells(grid, *maps.builtin_query(name), corner_rule="allow", cost=field)
    print("heuristic   " + "".join(f"{name:>18}" for name in problems))
    for heuristic in ("detour", "geodesic", "target", "sum", "edge"):
        row = ""
        for problem in problems.values():
            gaps = [100 * an.solve(problem, an.npaco(heuristic=heuristic), seed=seed).gap for seed in SEEDS]
            row += f"{min(gaps):8.2f} to {max(gaps):6.2f}"
        print(f"{heuristic:<12}{row}")


if __name__ == "__main__":
    main()
