"""What each part of paco_large brings: `python benchmarks/bench_large_design.py FOLDER` of MovingAI scenarios.

The longest quarter of every scenario file whose map has a side of 256 cells or more, 20 queries each, rule forbid;
all variants take turns at every query. Gaps are against the published optimum; the last column is the mean over maps
of the median CPU time, all threads together, over that of our own A* in the same turn.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

import antnav as an
from antnav.bench.movingai import gap_of
from antnav.bench.scenarios import TOLERANCE, read_queries
from antnav.search import exact

GREEDY = {"ants": 1, "iterations": 1, "beta": 60.0, "routes": 1, "deadlock": "retract"}
VARIANTS = {
    "as it is": {},
    "one greedy ant": GREEDY,
    "one greedy ant, no windows": GREEDY | {"windows": 0},
    "no windows": {"windows": 0},
    "windows 60": {"windows": 60},
    "windows 192": {"windows": 192},
    "windows 384": {"windows": 384},
    "windows 600": {"windows": 600},
    "routes 1": {"routes": 1},
    "routes 4": {"routes": 4},
    "routes 1, windows 192": {"routes": 1, "windows": 192},
    "beta 7": {"beta": 7.0},
    "beta 1": {"beta": 1.0},
    "10 ants, 10 iterations": {"ants": 10, "iterations": 10},
    "3 ants, 3 iterations": {"ants": 3, "iterations": 3},
    "blocks of 8": {"coarse": 8},
    "blocks of 12": {"coarse": 12},
    "blocks of 24": {"coarse": 24},
    "blocks of 32": {"coarse": 32},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--queries", type=int, default=20)
    options = parser.parse_args()
    an.warmup()
    algorithms = {name: an.paco_large(**choices) for name, choices in VARIANTS.items()}
    gaps: dict[str, list[list[float]]] = {name: [] for name in VARIANTS}
    ratios: dict[str, list[float]] = {name: [] for name in VARIANTS}
    by_map: dict[str, list] = {}
    for query in read_queries(options.folder, options.queries, 0.25):
        if max(query.grid.shape) >= 256:
            by_map.setdefault(query.map_label, []).append(query)
    for queries in by_map.values():
        for algorithm in algorithms.values():
            an.prepare(queries[0].grid, block=algorithm.coarse)
        lengths: dict[str, list[float]] = {name: [] for name in VARIANTS}
        seconds: dict[str, list[float]] = {name: [] for name in (*VARIANTS, "astar")}
        for query in queries:
            begin = time.process_time()
            exact.shortest_path(query.problem(), "astar")
            seconds["astar"].append(time.process_time() - begin)
            for name, algorithm in algorithms.items():
                begin = time.process_time()
                result = an.solve(query.problem(), algorithm, seed=0)
                seconds[name].append(time.process_time() - begin)
                lengths[name].append(100 * gap_of(result.length, query.published, TOLERANCE))
        for name in VARIANTS:
            gaps[name].append(lengths[name])
            ratios[name].append(float(np.median(seconds[name]) / np.median(seconds["astar"])))
    print(f"{len(by_map)} maps, {sum(map(len, by_map.values()))} queries")
    print("variant                      gap %: median    mean  95th  largest  worst map's 95th   time over A*'s")
    for name in VARIANTS:
        every = np.concatenate(gaps[name])
        worst = max(np.percentile(of_map, 95) for of_map in gaps[name])
        figures = f"{np.median(every):>14.2f}{np.mean(every):>8.2f}{np.percentile(every, 95):>6.2f}{every.max():>9.2f}"
        print(f"{name:<28}{figures}{worst:>18.2f}{np.mean(ratios[name]):>17.2f}")


if __name__ == "__main__":
    main()
