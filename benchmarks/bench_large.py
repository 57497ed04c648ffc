"""A large map from file to exact path, and the ants on it: `python benchmarks/bench_large.py [SIDE ...]`.

Times and peak memory of one process for loading, inflating, checking and solving, corner rule forbid.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps
from antnav.maps import generators
from antnav.search import exact


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sides", nargs="*", type=int, default=[500, 1000, 2000])
    parser.add_argument("--kinds", nargs="*", default=["caves"])
    options = parser.parse_args()
    an.warmup()
    print("map              cells    load  inflate   check      A*   sum s  paco s  gap %  peak MB")
    with tempfile.TemporaryDirectory() as folder:
        for side in options.sides:
            for kind in options.kinds:
                path = Path(folder) / f"{kind}{side}.yaml"
                an.save_map(maps.generate(kind, side, side, seed=1), path)
                times = [time.perf_counter()]
                grid = an.load_map(path)
                times.append(time.perf_counter())
                grid = grid.inflated(1.0)
                times.append(time.perf_counter())
                start, goal = generators.ends(grid)
                times[-1] = time.perf_counter()
                problem = an.Problem.from_cells(grid, start, goal)
                connected = problem.connected
                times.append(time.perf_counter())
                exact.optimum(problem)
                times.append(time.perf_counter())
                result = an.solve(problem, an.paco(), seed=1)
                spent = np.diff(times)
                peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
                row = "".join(f"{value:>{width}.3f}" for value, width in zip(spent, (8, 9, 8, 8), strict=True))
                gap = f"{100 * result.gap:>7.2f}" if connected else "      -"
                ants = f"{sum(spent):>8.3f}{result.seconds_run:>8.3f}{gap}{peak:>9.0f}"
                print(f"{kind + str(side):<12}{side * side:>10}{row}{ants}")


if __name__ == "__main__":
    main()
