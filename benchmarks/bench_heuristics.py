"""How far each heuristic guides: `python benchmarks/bench_heuristics.py`.

NPACO, m 50, T 50, on caves and random blocks of growing side; median over seeds of gap, ant steps and run time.
"""

from __future__ import annotations

import argparse
import statistics

import antnav as an
from antnav import maps
from antnav.maps import generators
from antnav.run import stop


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sides", nargs="*", type=int, default=[30, 50, 75, 100, 200, 400])
    parser.add_argument("--seeds", type=int, default=5)
    options = parser.parse_args()
    an.warmup()
    print(f"{'map':<10}{'side':>5} {'heuristic':<10}{'arrived':>8}{'gap %':>9}{'steps':>12}{'run s':>9}")
    for kind in ("caves", "random"):
        for side in options.sides:
            for heuristic in ("target", "geodesic", "detour"):
                results = []
                for seed in range(options.seeds):
                    grid = maps.generate(kind, side, side, seed=seed)
                    problem = an.Problem.from_cells(grid, *generators.ends(grid))
                    algorithm = an.npaco(heuristic=heuristic)
                    results.append(an.solve(problem, algorithm, seed=seed, stop=stop.Seconds(20)))
                found = [result for result in results if result.path]
                gap = f"{100 * statistics.median(r.gap for r in found):9.2f}" if found else "        -"
                steps = statistics.median(r.steps for r in results)
                run = statistics.median(r.seconds_run for r in results)
                head = f"{kind:<10}{side:>5} {heuristic:<10}{len(found):>6}/{len(results)}"
                print(f"{head}{gap}{steps:>12.0f}{run:>9.4f}", flush=True)


if __name__ == "__main__":
    main()
