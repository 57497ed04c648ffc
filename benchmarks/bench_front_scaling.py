"""Exact fronts as maps and objectives grow: `python benchmarks/bench_front_scaling.py [SECONDS]`, CPU time.

Caves of 32 to 512 cells a side with two to five of the objectives of `bench_pareto.py`, from end to end. A search is
cut after SECONDS (default 30), and its row says so. The last lines are slopes: the power of the side with which time
grows over the complete ones, and the factor from one number of objectives to the next at a side that all complete.
"""

from __future__ import annotations

import sys

import numpy as np
from bench_pareto import CpuSeconds, asked

import antnav as an
from antnav import maps
from antnav.fronts.pareto import warmup

SIDES = (32, 64, 128, 256, 512)


def main() -> None:
    limit = float(sys.argv[1]) if len(sys.argv) > 1 else 30.0
    warmup("exact")
    took: dict[tuple[int, int], float] = {}
    print("side  objectives  seconds   paths     labels")
    for side in SIDES:
        grid = maps.generate("caves", side, side, seed=1)
        problem = an.Problem.from_cells(grid, *maps.ends(grid))
        for k in (2, 3, 4, 5):
            if (side // 2, k) not in took and side > SIDES[0]:
                continue  # the smaller map was cut
            clock = CpuSeconds(limit)
            front = an.pareto(problem, asked(grid, k), algorithm=an.fronts.Exact(10**9), stop=clock)
            seconds = clock.spent()
            if front.complete:
                took[side, k] = seconds
            cut = "" if front.complete else "  cut"
            print(f"{side:4}  {k:10}  {seconds:7.2f}  {len(front):6}  {front.work['labels']:9}{cut}", flush=True)
    for k in (2, 3, 4, 5):
        sides = [side for side in SIDES if (side, k) in took]
        if len(sides) > 2:
            slope = np.polyfit(np.log(sides[1:]), np.log([took[side, k] for side in sides[1:]]), 1)[0]
            print(f"{k} objectives: time grows with side ** {slope:.1f}, from {sides[1]} to {sides[-1]}")
    for k in (3, 4, 5):
        side = max((side for side in SIDES if (side, k) in took and (side, k - 1) in took), default=None)
        if side:
            print(f"{k - 1} to {k} objectives at {side}: {took[side, k] / took[side, k - 1]:.1f} times the time")


if __name__ == "__main__":
    main()
