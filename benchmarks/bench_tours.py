"""Orders of stops: `python benchmarks/bench_tours.py [DATA]`, rows of docs/tours.md.

Places drawn on maps of DATA (default: ../shared/data), inflated strictly by 0.25 m where they are of a robot's world,
with the way back. For each map and number of stops: milliseconds for all distances, and of each method by how much its
order is longer than the best that any run found, and milliseconds; the bound below that, and milliseconds. Best known
is the best of all methods and of five more runs of iterated local search. Milliseconds are CPU time: distances are
searched in two threads or more, which share it. The library is skipped where PyVRP is not installed.
"""

from __future__ import annotations

import sys
import time
import warnings
from importlib.util import find_spec
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps
from antnav.kernels import tour_kernels
from antnav.tours import order
from antnav.tours.distances import between
from antnav.tours.tour import prepare

MAPS = {"depot": "ros/nav2_bringup/depot.yaml", "warehouse": "ros/nav2_bringup/warehouse.yaml"}
MAPS |= {"Berlin_0_256": "movingai/cities/Berlin_0_256.map"}
COUNTS = (10, 20, 50, 100, 500)
METHODS = ("exact", "ils", "ants", "library")
REPEATS = 5


def places(terrain: an.Terrain, count: int) -> np.ndarray:
    """Cells of the largest component, flat."""
    sizes = np.bincount(terrain.components)
    cells = np.flatnonzero(terrain.components == 1 + int(np.argmax(sizes[1:])))
    return np.random.default_rng(count).choice(cells, count + 1).astype(np.int32)


def timed(call, repeats: int = REPEATS):
    """What a call returns, and the least milliseconds that it took."""
    least = np.inf
    for _ in range(repeats):
        begin = time.process_time()
        found = call()
        least = min(least, 1e3 * (time.process_time() - begin))
    return found, least


def main() -> None:
    data = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2] / "shared" / "data"
    warnings.simplefilter("ignore", maps.MapWarning)
    prepare()
    methods = [name for name in METHODS if name != "library" or find_spec("pyvrp")]
    heads = [f"{name}, % above best known | ms" for name in methods]
    print("| map, cells | stops | distances, ms | " + " | ".join(heads) + " | bound, % below | ms |")
    print("|---" * (5 + 2 * len(methods)) + "|")
    for name, file in MAPS.items():
        path = data / file
        if not path.exists():
            print(f"{path} skipped: it is not there")
            continue
        grid = an.load_map(path)
        terrain = an.Terrain.of(grid.inflated(0.25, strict=True) if "ros" in file else grid)
        for count in COUNTS:
            cells = places(terrain, count)
            costs, ms = timed(lambda terrain=terrain, cells=cells: between(terrain, cells), 1)
            matrix = order._with_end(costs, np.zeros(count + 1), back=True)
            found = {}
            for method in methods:
                if method == "exact" and count > 12:
                    continue
                run = timed(
                    lambda matrix=matrix, method=method: order._nodes(matrix, method, 0), 1 if count > 100 else 3
                )
                found[method] = float(tour_kernels.cost_of(matrix, run[0])), run[1]
            long = [order._nodes(matrix, "ils", seed) for seed in range(1, 6)]
            best = min(
                [cost for cost, _ in found.values()] + [float(tour_kernels.cost_of(matrix, one)) for one in long]
            )
            bound, bound_ms = timed(lambda matrix=matrix, best=best: order.bound_of(matrix, best), 1)
            told = [
                f"{100 * (found[m][0] / best - 1):.2f} | {found[m][1]:.1f}" if m in found else "- | -" for m in methods
            ]
            print(f"| {name}, {grid.rows} x {grid.cols} | {count} | {ms:.0f} | {' | '.join(told)} ", end="")
            print(f"| {100 * abs(1 - bound / best):.2f} | {bound_ms:.1f} |", flush=True)


if __name__ == "__main__":
    main()
