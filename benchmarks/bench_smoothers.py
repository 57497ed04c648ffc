"""Trajectories beside what others make of a query.

`python benchmarks/bench_smoothers.py [QUERIES] [DATA]`, 100 a map by default: random queries on ROS maps inflated
strictly by radius and margin, the same for all; smoothers get the grid's shortest path, Theta* and Lazy Theta* the same
test of a moved disc. A row of docs/trajectories.md for each map and line: length beside that of the trajectory; largest
curvature of a line, by the circle through three points 0.1 m or two cells apart, median and most; sum of turns; least
distance from the squares of walls; share of lines that come nearer than the radius, or than radius and margin;
milliseconds from the query to the line, without compile time. Then trajectories without a radius beside the shortest
lines at any angle on small maps.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import nav2_smoothers as nav2
import numpy as np
from bench_trajectories import MAPS, queries
from numpy.typing import NDArray
from theta_star import theta_star

import antnav as an
from antnav import maps
from antnav.kernels import trajectory_kernels

Points = NDArray[np.float64]
NAMES = (
    *("nav2_bringup/depot", "nav2_bringup/warehouse", "nav2_bringup/tb3_sandbox", "patrolling_sim/DIAG_labs"),
    *("patrolling_sim/1r5", "mr_goto/cave", "nav2_tests/smoothers_world", "turtlebot3/map"),
)
SMALL = ("iqaco_20", "iqaco_30", "pelayo_map2_12", "pelayo_map3_31", "winsleo_mixed_20", "winsleo_walls_20")


def shortest(problem: an.Problem) -> an.Path:
    path = an.exact.shortest_path(problem).path
    assert path is not None
    return path


def methods(radius: float, margin: float, limit: float) -> dict[str, Callable[[an.Problem], Points]]:
    """What makes a line of a query, by its name."""

    def drive(problem: an.Problem, path: an.Path | None) -> Points:
        assert path is not None
        return an.trajectory(path, problem, radius=radius, margin=margin, max_curvature=limit).points

    return {
        "trajectory": lambda problem: drive(problem, shortest(problem)),
        "trajectory, any angle's path": lambda problem: drive(problem, an.exact.any_angle(problem).path),
        "Theta*": lambda problem: theta_star(problem, radius + margin),
        "Lazy Theta*": lambda problem: theta_star(problem, radius + margin, lazy=True),
        "shortest at any angle, of a point": lambda problem: an.exact.any_angle(problem).points,
        "grid path": lambda problem: shortest(problem).points,
        "SimpleSmoother": lambda problem: nav2.simple(shortest(problem), problem, costmap=True),
        "SimpleSmoother, no costmap": lambda problem: nav2.simple(shortest(problem), problem, costmap=False),
        "SavitzkyGolaySmoother": lambda problem: nav2.savitzky_golay(shortest(problem)),
    }


def length_of(points: Points) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def bends(points: Points, spacing: float) -> tuple[float, float]:
    """Largest curvature, by the circle through three points, and the sum of turns, of points so far apart."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    at = np.linspace(0.0, along[-1], max(int(along[-1] / spacing), 2) + 1)
    x, y = (np.interp(at, along, points[:, k]) for k in (0, 1))
    dx, dy = np.diff(x), np.diff(y)
    sides = np.hypot(dx, dy)
    cross = dx[:-1] * dy[1:] - dy[:-1] * dx[1:]
    across = np.hypot(x[2:] - x[:-2], y[2:] - y[:-2])
    turns = np.abs(np.arctan2(cross, dx[:-1] * dx[1:] + dy[:-1] * dy[1:]))
    circles = 2 * np.abs(cross) / np.maximum(sides[:-1] * sides[1:] * across, 1e-12)
    return float(circles.max(initial=0.0)), float(turns.sum())


def compare(name: str, grid: an.GridMap, radius: float, margin: float, limit: float, count: int) -> None:
    """The rows of one map."""
    closed = grid.inflated(radius + margin + 1e-6, strict=True)
    problems = queries(closed, count)
    lines = methods(radius, margin, limit)
    lengths = {}
    for method, line_of in lines.items():
        line_of(problems[0])  # compiles
        found, ms = [], []
        for problem in problems:
            begin = time.perf_counter()
            found.append(line_of(problem))
            ms.append(1e3 * (time.perf_counter() - begin))
        lengths[method] = np.array([length_of(points) for points in found])
        bent, turned = np.array([bends(points, max(2 * grid.resolution, 0.1)) for points in found]).T
        reach = (radius + margin) / grid.resolution + 1
        away = [trajectory_kernels.least_distance(grid.cells, grid.world_to_plane(points), reach) for points in found]
        spare = np.array(away) * grid.resolution + 1e-6
        shares = lengths[method] / lengths["trajectory"]
        print(
            f"| {name} | {method} | {100 * np.mean(shares) - 100:+.2f} % | {np.median(bent):.1f}, {bent.max():.0f} ",
            end="",
        )
        print(f"| {np.degrees(np.mean(turned)):.0f} | {min(away) * grid.resolution:.3f} m ", end="")
        print(f"| {100 * np.mean(spare < radius):.0f} % | {100 * np.mean(spare < radius + margin):.0f} % ", end="")
        print(f"| {np.median(ms):.1f} | {np.percentile(ms, 95):.1f} |", flush=True)
        name = ""
    for method in ("trajectory", "trajectory, any angle's path"):
        ratio = lengths[method] / lengths["Theta*"]
        print(
            f"# {method}: {np.mean(ratio):.4f} of Theta*'s length, {ratio.max():.4f} at most, shorter in "
            f"{100 * np.mean(ratio < 1):.0f} %",
            file=sys.stderr,
            flush=True,
        )


def against_the_optimum(data: Path) -> None:
    """Trajectories of a point on small maps, 50 queries each: by how much they are longer than the shortest line."""
    print(
        "\n| map | grid path | its trajectory, mean | most | along any angle's path, mean | most |",
        "|---|---|---|---|---|---|",
        sep="\n",
    )
    files = [data / "aco_grids" / f"{name}.txt" for name in SMALL]
    files += [data / "paper_equivalent" / f"equiv{side}.txt" for side in (20, 30, 40)]
    for file in files:
        grid = an.load_map(file)
        shares = []
        for problem in queries(grid, 50):
            best, path = an.exact.any_angle(problem), shortest(problem)
            assert best.path is not None
            drives = [an.trajectory(given, problem).length for given in (path, best.path)]
            shares.append(np.array((path.length_m, *drives)) / (best.length * grid.resolution))
        mean, most = 100 * np.mean(shares, 0) - 100, 100 * np.max(shares, 0) - 100
        print(f"| {file.stem} | {mean[0]:.1f} % | {mean[1]:.2f} % | {most[1]:.1f} % ", end="")
        print(f"| {mean[2]:.2f} % | {most[2]:.1f} % |", flush=True)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    data = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).resolve().parents[2] / "shared" / "data"
    warnings.simplefilter("ignore", maps.MapWarning)
    print(
        "| map | line | length | curvature: median, most | turns, degrees | least distance | nearer than the radius |",
        end="",
    )
    print(" than radius + margin | ms, median | 95 % |\n|---|---|---|---|---|---|---|---|---|---|")
    for name in NAMES:
        file = data / "ros" / f"{name}.yaml"
        if file.exists():
            compare(name, an.load_map(file), *MAPS[name], count)
        else:
            print(f"{file} skipped: it is not there")
    against_the_optimum(data)


if __name__ == "__main__":
    main()
