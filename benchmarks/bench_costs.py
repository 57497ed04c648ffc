"""What guides ants where cells cost, and what costs cost exact search: `python benchmarks/bench_costs.py [MAP.yaml]`.

Ants: gaps to the exact optimum in per cent, least to largest, of npaco, five seeds, on the stand-ins equiv20 and
equiv40 under the corner rule `allow`, with a cost of each cell drawn from a gamma distribution of shape 1 and scale 2
under a fixed seed; on an empty map of 40 x 40 cells with a dear middle, from corner to corner; on caves of 60 and 120
cells with a cost near walls.

Exact search, with and without costs: cells that A* takes from its queue, and nanoseconds for each, the least of many
rounds in turn. The map is nav2's depot, or another of its size, with walls that cost; the others have costs drawn as
above.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator

import numpy as np

import antnav as an
from antnav import costs, maps
from antnav.kernels import grid_kernels

SEEDS = range(5)


def ants() -> None:
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


def searched(path: str | None) -> Iterator[tuple[str, an.Problem, costs.CostField]]:
    """Name and problem without costs, and the costs."""
    rng = np.random.default_rng(0)
    if path:
        grid = maps.load_map(path)
        ends = (2.0, 2.0), (28.0, 13.0)
        yield "depot", an.Problem(grid.inflated(0.2), *ends), costs.clearance(grid, 0.8, 4.0)
    for name, grid, ends in (
        ("equiv40", maps.builtin("equiv40"), maps.builtin_query("equiv40")),
        ("random 256", random := maps.generate("random", 256, 256, seed=1), maps.ends(random)),
    ):
        problem = an.Problem.from_cells(grid, *ends, corner_rule="allow")
        yield name, problem, costs.array(rng.gamma(1.0, 2.0, grid.shape))


def searches(path: str | None, rounds: int) -> None:
    heads = ("expanded", "with costs", "ratio", "ns each", "with costs", "ratio", "time")
    print(f"{'A*':<12}" + "".join(f"{head:>11}" for head in heads))
    for name, plain, field in searched(path):
        dear = an.Problem.from_cells(
            plain.grid, plain.start_cell, plain.goal_cell, corner_rule=plain.corner_rule, cost=field
        )
        expanded, best = [0, 0], [math.inf, math.inf]
        for _ in range(rounds):
            for i, problem in enumerate((plain, dear)):
                question = problem.flat_moves, problem.width, *problem.flat_ends, True, problem.objective.prices
                begin = time.perf_counter()
                expanded[i] = grid_kernels.search(*question)[2]
                best[i] = min(best[i], time.perf_counter() - begin)
        each = [seconds / cells * 1e9 for seconds, cells in zip(best, expanded, strict=True)]
        counts = f"{expanded[0]:>11}{expanded[1]:>11}{expanded[1] / expanded[0]:>11.1f}"
        times = f"{each[0]:>11.0f}{each[1]:>11.0f}{each[1] / each[0]:>11.2f}{best[1] / best[0]:>11.1f}"
        print(f"{name:<12}{counts}{times}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("map", nargs="?", help="nav2_bringup's depot.yaml")
    parser.add_argument("--rounds", type=int, default=40)
    options = parser.parse_args()
    an.warmup()
    searches(options.map, options.rounds)
    print()
    ants()


if __name__ == "__main__":
    main()
