"""What guides ants where cells cost: `python benchmarks/bench_costs.py`; gaps to the exact optimum in per cent.

npaco, five seeds, on the stand-ins equiv20 and equiv40 under the corner rule `allow`, with a cost of each cell drawn
from a gamma distribution of shape 1 and scale 2 under a fixed seed; on an empty map of 40 x 40 cells with a dear
middle, from corner to corner; on caves of 60 and 120 cells with a cost near walls. Printed: the least and the
largest gap.
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
    dear = np.zeros((40, 40))
    dear[5:35, 5:35] = 9.0
    empty = an.GridMap(np.zeros((40, 40), np.uint8))
    problems["dear middle"] = an.Problem.from_cells(
        empty, (39, 0), (0, 39), corner_rule="allow", cost=costs.array(dear)
    )
    for side in (60, 120):
        grid = maps.generate("caves", side, side, seed=1)
        free = np.argwhere(grid.cells == 0).tolist()
        field = costs.clearance(grid, 3.0, 4.0)
        problems[f"caves {side}"] = an.Problem.from_cells(grid, tuple(free[0]), tuple(free[-1]), cost=field)
    print("heuristic   " + "".join(f"{name:>18}" for name in problems))
    for heuristic in ("detour", "geodesic", "blocks", "target", "sum", "edge"):
        row = ""
        for problem in problems.values():
            gaps = [100 * an.solve(problem, an.npaco(heuristic=heuristic), seed=seed).gap for seed in SEEDS]
            row += f"{min(gaps):8.2f} to {max(gaps):6.2f}"
        print(f"{heuristic:<12}{row}")


if __name__ == "__main__":
    main()
