"""Trajectories on ROS maps: `python benchmarks/bench_trajectories.py [QUERIES] [DATA]`, 200 a map by default.

Random queries on maps of DATA (default: ../shared/data), inflated strictly by radius and margin; paths of A*. A row of
docs/trajectories.md for each map: queries, smooth curves, curves nearer to a wall's edge than radius and margin, curves
bent more than the limit, by how much the mean curve is shorter than its path, mean length, and milliseconds, median and
95 %, without the path, compile time and the map's first use. Every curve is checked by `an.check_trajectory`, too.
"""

from __future__ import annotations

import sys
import time
import warnings
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps

#: Radius and margin in metres, limit of the curvature in 1/m.
USUAL, SMALL = (0.2, 0.05, 2.0), (0.1, 0.03, 4.0)
MAPS = {
    "nav2_bringup/depot": USUAL,
    "nav2_bringup/warehouse": (0.25, 0.05, 2.0),
    "nav2_bringup/tb3_sandbox": SMALL,
    "turtlebot3/map": SMALL,
    **dict.fromkeys([f"patrolling_sim/{name}" for name in ("DIAG_labs", "1r5", "broughton", "example", "grid")], USUAL),
    "mr_goto/cave": USUAL,
    "willow/lse_arena": USUAL,
    "nav2_tests/smoothers_world": USUAL,
    "nav2_tests/map_circular": USUAL,
}


def queries(grid: an.GridMap, count: int) -> list[an.Problem]:
    """Pairs of cells that a way joins."""
    rng, free, found = np.random.default_rng(7), np.argwhere(grid.passable()), list[an.Problem]()
    while len(found) < count:
        start, goal = (tuple(cell) for cell in free[rng.integers(len(free), size=2)].tolist())
        problem = an.Problem.from_cells(grid, start, goal)
        if problem.connected and start != goal:
            found.append(problem)
    return found


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    data = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).resolve().parents[2] / "shared" / "data"
    warnings.simplefilter("ignore", maps.MapWarning)
    print(
        "| map, cells | radius + margin, limit | queries | smooth | touch | above the limit | shorter than the path |",
        end="",
    )
    print(" mean length | ms, median | 95 % |\n|---|---|---|---|---|---|---|---|---|---|")
    for name, (radius, margin, limit) in MAPS.items():
        file = data / "ros" / f"{name}.yaml"
        if not file.exists():
            print(f"{file} skipped: it is not there")
            continue
        grid = an.load_map(file).inflated(radius + margin + 1e-6, strict=True)
        ms, shares, drives = [], [], list[an.Trajectory]()
        for problem in queries(grid, count):
            path = an.exact.shortest_path(problem).path
            begin = time.perf_counter()
            drive = an.trajectory(path, problem, radius=radius, margin=margin, max_curvature=limit)
            ms.append(1e3 * (time.perf_counter() - begin))
            an.check_trajectory(drive, problem, radius=radius + margin, max_curvature=limit if drive.smooth else None)
            shares.append(1 - drive.length / path.length_m)
            drives.append(drive)
        smooth = [drive for drive in drives if drive.smooth]
        touch = sum(drive.wall_distance < radius + margin - 1e-9 for drive in drives)
        bent = sum(drive.max_curvature > limit * (1 + 1e-9) for drive in smooth)
        length = np.mean([drive.length for drive in drives])
        print(f"| {name}, {grid.rows} x {grid.cols} | {radius + margin:.2f} m, {limit:g} / m | {count} ", end="")
        print(f"| {len(smooth)} | {touch} | {bent} | {100 * np.mean(shares):.1f} % | {length:.1f} m ", end="")
        print(f"| {np.median(ms):.1f} | {np.percentile(ms, 95):.1f} |", flush=True)


if __name__ == "__main__":
    main()
