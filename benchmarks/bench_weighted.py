"""How near ants come to the optimum where cells cost: `python benchmarks/bench_weighted.py [--data FOLDER]`.

Maps times cost fields times random pairs of cells that a path joins, times seeds, under a fixed seed: nav2's depot,
warehouse and tb3_sandbox of FOLDER (default: ../shared/data), with the robot's radius of 0.2 m inflated, the stand-ins
equiv20, equiv30 and equiv40, and the grids of FOLDER/aco_grids under the corner rule `allow`. What FOLDER does not have
is skipped. Gaps to the exact optimum, in per cent: median, 95th percentile, largest, and the share of runs at the
optimum; time as the median of ratios to exact A* on the same problem, which takes turns with the ants.
"""

from __future__ import annotations

import argparse
import warnings
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np

import antnav as an
from antnav import costs, maps
from antnav.search import exact

ROS = ("depot", "warehouse", "tb3_sandbox")
RADIUS = 0.2
PLANNERS: dict[str, Callable[[], an.Algorithm]] = {
    "paco_ls": an.paco_ls,
    "paco_large": an.paco_large,
    "npaco blocks": partial(an.npaco, heuristic="blocks"),
    "npaco detour": partial(an.npaco, heuristic="detour"),
}
Case = tuple[str, str, an.GridMap, str, costs.CostField]


def hill(grid: an.GridMap) -> costs.CostField:
    """Three round hills, as high as a tenth of the map's longer side."""
    rng = np.random.default_rng(3)
    rows, cols = np.indices(grid.shape)
    side = max(grid.shape)
    heights = np.zeros(grid.shape)
    for _ in range(3):
        row, col = rng.uniform(0, 1, 2) * grid.shape
        heights += np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / (0.15 * side) ** 2)
    return costs.slope(0.1 * side * grid.resolution * heights, up=10.0, down=2.0)


def on_ros(grid: an.GridMap, folder: Path, name: str) -> Iterator[tuple[str, costs.CostField]]:
    yield "clearance 0.5:1", costs.clearance(grid, 0.5, 1.0)
    yield "clearance 0.8:4", costs.clearance(grid, 0.8, 4.0)
    yield "clearance 2:20", costs.clearance(grid, 2.0, 20.0)
    yield "hills", hill(grid)
    rng = np.random.default_rng(1)
    yield "gamma", costs.array(rng.gamma(1.0, 2.0, grid.shape))
    if name == "depot":
        keepout = costs.keepout(maps.load_map(folder / "depot_keepout.yaml"), grid)
        speed = costs.speed(maps.load_grades(folder / "depot_speed.yaml"), grid)
        yield "masks, clearance", keepout + speed + costs.clearance(grid, 0.8, 4.0)


def on_grid(grid: an.GridMap) -> Iterator[tuple[str, costs.CostField]]:
    rng = np.random.default_rng(1)
    yield "gamma", costs.array(rng.gamma(1.0, 2.0, grid.shape))
    yield "gamma, heavy tail", costs.array(rng.gamma(0.3, 20.0, grid.shape))
    yield "clearance 2:4", costs.clearance(grid, 2.0, 4.0)
    yield "hills", hill(grid)


def cases(data: Path) -> Iterator[Case]:
    """Kind and name of a map, the map, and a field with its name."""
    folder = data / "ros" / "nav2_bringup"
    for name in ROS:
        if not (folder / f"{name}.yaml").exists():
            print(f"{name} skipped: no {folder}")
            continue
        grid = maps.load_map(folder / f"{name}.yaml")
        for what, field in on_ros(grid, folder, name):
            yield "ros", name, grid.inflated(RADIUS), what, field
    grids = {name: maps.builtin(name) for name in ("equiv20", "equiv30", "equiv40")}
    files = sorted((data / "aco_grids").glob("*.txt"))
    if not files:
        print(f"aco_grids skipped: none in {data}")
    for name, grid in (grids | {file.stem: maps.load_map(file) for file in files}).items():
        for what, field in on_grid(grid):
            yield "grids", name, grid, what, field


def problems(case: Case, turning: float, pairs: int) -> Iterator[an.Problem]:
    kind, _, grid, _, field = case
    rule = "forbid" if kind == "ros" else "allow"
    rng = np.random.default_rng(5)
    free = np.argwhere((grid.cells == 0) & ~field.blocked)
    while pairs:
        start, goal = (tuple(cell.tolist()) for cell in rng.choice(free, 2, replace=False))
        problem = an.Problem.from_cells(grid, start, goal, corner_rule=rule, cost=field, turning=turning)
        if problem.connected and max(abs(np.subtract(start, goal))) > 3:
            pairs -= 1
            yield problem


def line(head: str, found: list[tuple[float, float]]) -> str:
    gaps, ratios = np.array(found).T
    optimal = 100 * np.mean(gaps < 1e-7)
    return (
        f"{head:<62}{np.median(gaps):>8.2f}{np.percentile(gaps, 95):>8.2f}{gaps.max():>8.2f}{optimal:>8.0f}"
        f"{np.median(ratios):>8.1f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=Path("../shared/data"))
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--maps", nargs="*", help="only these")
    parser.add_argument("--planners", nargs="*", choices=PLANNERS, default=list(PLANNERS))
    parser.add_argument("--turning", nargs="*", type=float, default=[0.0, 0.5])
    options = parser.parse_args()
    warnings.simplefilter("ignore", maps.MapWarning)
    an.warmup()
    planners = {name: PLANNERS[name]() for name in options.planners}
    sums: dict[str, list[tuple[float, float]]] = defaultdict(list)
    columns = "".join(f"{head:>8}" for head in ("median", "95 %", "largest", "opt. %", "time"))
    print(f"{'map':<20}{'field':<19}{'turning':<8}{'planner':<15}{columns}")
    for case in cases(options.data):
        kind, place, _, field, _ = case
        if options.maps and place not in options.maps:
            continue
        for turning in options.turning:
            found: dict[str, list[tuple[float, float]]] = {name: [] for name in planners}
            for problem in problems(case, turning, options.pairs):
                best = exact.optimum(problem)
                for seed in range(options.seeds):
                    for name, planner in planners.items():
                        result = an.solve(problem, planner, seed=seed)
                        gap = 100 * (result.cost / best.cost - 1) if result.path else np.inf
                        found[name].append((gap, result.seconds_run / best.seconds))
            for name, pairs in found.items():
                print(line(f"{place:<20}{field:<19}{turning:<8g}{name:<15}", pairs), flush=True)
                sums[f"{kind + ', all':<39}{turning:<8g}{name:<15}"] += pairs
    print()
    for head, pairs in sums.items():
        print(line(head, pairs))


if __name__ == "__main__":
    main()
