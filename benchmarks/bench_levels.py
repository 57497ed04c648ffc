"""The paper's two pieces against more, cut on levels: `python benchmarks/bench_levels.py`.

Generated maps of 40 to 200 cells a side, corner rule forbid; the algorithms take turns at every seed. "of paco": ratio
of median wall times, two threads. Balance: moves of stage two's busiest colony over the mean. Efficiency: time with one
worker over twice the time with two.
"""

from __future__ import annotations

import argparse

import numpy as np

import antnav as an
from antnav import maps

MAPS = (
    ("u_traps", 40),
    ("caves", 60),
    ("random", 100),
    ("rooms", 100),
    ("caves", 150),
    ("caves", 200),
    ("random", 200),
)
ALGORITHMS = {
    "paco": an.paco(),
    "paco_extended": an.paco_extended(),
    "levels 2": an.paco_levels(pieces=2),
    "paco_levels": an.paco_levels(),
    "levels 8": an.paco_levels(pieces=8),
    "levels 4, m 50": an.paco_levels(ants=50),
    "levels 4, bare": an.paco_levels(windows=0),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    options = parser.parse_args()
    an.warmup()
    print("map         algorithm           ms  of paco   gap %  largest  balance  efficiency")
    for kind, side in MAPS:
        grid = maps.generate(kind, side, side, seed=1)
        problem = an.Problem.from_cells(grid, *maps.ends(grid))
        runs: dict[str, list[an.Result]] = {name: [] for name in ALGORITHMS}
        alone: dict[str, list[float]] = {name: [] for name in ALGORITHMS}
        for seed in range(-1, options.seeds):
            for name, algorithm in ALGORITHMS.items():
                result = an.solve(problem, algorithm, seed=abs(seed))
                serial = an.solve(problem, algorithm, seed=abs(seed), executor=an.spmd.Serial())
                if seed >= 0:  # the first round only warms up
                    runs[name].append(result)
                    alone[name].append(serial.seconds_run)
        base = np.median([run.seconds_run for run in runs["paco"]])
        for name, found in runs.items():
            seconds = np.median([run.seconds_run for run in found])
            gaps = [100 * run.gap for run in found]
            balance = np.median([run.stages[1].balance for run in found if len(run.stages) > 1])
            efficiency = np.median(alone[name]) / (2 * seconds)
            figures = f"{1e3 * seconds:>8.2f}{seconds / base:>9.2f}{np.mean(gaps):>8.2f}{max(gaps):>9.2f}"
            print(f"{kind + str(side):<12}{name:<14}{figures}{balance:>9.2f}{efficiency:>12.2f}", flush=True)


if __name__ == "__main__":
    main()
