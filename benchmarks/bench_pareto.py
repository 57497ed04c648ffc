"""Methods that find fronts, side by side at equal time: `python benchmarks/bench_pareto.py --seconds 2`.

Generated maps and, where --data has them, Berlin and nav2's depot; start and goal far apart, corner rule forbid. The
objectives are the first k of length, a random field, turns, a second random field, closeness to walls. Methods take
turns at every seed. Time is the process's CPU time with one worker, so that a shared machine does not matter; --wall
takes wall time and two workers instead. The sweep gets as many searches as fit. A front is compared with the exact one
where that is complete, else with the union of all fronts of the map; the exact method prints its own time.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, field
from pathlib import Path

import moocore
import numpy as np

import antnav as an
from antnav import costs, fronts, maps, objectives
from antnav.fronts import indicators
from antnav.fronts.pareto import warmup
from antnav.run.stop import Progress, Seconds, Stop

MAPS = ("random:64", "caves:64", "random:128", "caves:128", "random:256", "caves:256", "berlin", "depot")
FILES = {"berlin": "movingai/cities/Berlin_0_256.map", "depot": "ros/nav2_bringup/depot.yaml"}
METHODS = ("exact", "sweep", "ants", "p-aco", "nsga2")


@dataclass(frozen=True)
class CpuSeconds(Stop):
    """Stop after so much CPU time of the process."""

    limit: float
    began: float = field(default_factory=time.process_time)

    def fraction(self, progress: Progress) -> float:
        """Share of the time spent."""
        return min(1.0, self.spent() / self.limit)

    def spent(self) -> float:
        """CPU seconds so far."""
        return time.process_time() - self.began


def random_field(grid: an.GridMap, seed: int) -> costs.CostField:
    """0 to 5 per metre: noise, each cell the mean of the nine about it."""
    noise = np.pad(np.random.default_rng(seed).random(grid.shape), 1, mode="edge")
    rows, cols = grid.shape
    smooth = sum(noise[i : i + rows, j : j + cols] for i in range(3) for j in range(3))
    return costs.array(5 * (smooth - smooth.min()) / np.ptp(smooth))


def asked(grid: an.GridMap, k: int) -> list[objectives.Objective]:
    """The first k objectives."""
    near_walls = costs.clearance(grid, 4 * grid.resolution)
    return [
        objectives.Length(),
        objectives.Risk(random_field(grid, 1), name="first field"),
        objectives.Turns(),
        objectives.Risk(random_field(grid, 2), name="second field"),
        objectives.Risk(near_walls, name="walls"),
    ][:k]


def loaded(name: str, data: Path) -> an.GridMap | None:
    """A map by its name, None where its file is not there."""
    if name in FILES:
        file = data / FILES[name]
        if not file.exists():
            return None
        grid = maps.load_map(file)
        return grid.inflated(0.25) if name == "depot" else grid
    kind, side = name.split(":")
    return maps.generate(kind, int(side), int(side), seed=1)


def timed(
    problem: an.Problem,
    goals: list[objectives.Objective],
    method: fronts.Method,
    seed: int,
    options: argparse.Namespace,
) -> tuple[fronts.Front, float]:
    """A front, and the seconds that it took."""
    clock = time.perf_counter if options.wall else time.process_time
    began = clock()
    front = an.pareto(
        problem,
        goals,
        algorithm=method,
        seed=seed,
        stop=Seconds(options.seconds) if options.wall else CpuSeconds(options.seconds),
        executor=None if options.wall else an.spmd.Serial(),
    )
    return front, clock() - began


def made(
    name: str, problem: an.Problem, goals: list[objectives.Objective], options: argparse.Namespace
) -> fronts.Method:
    """A method with a schedule that outlasts the time."""
    if name == "exact":
        return fronts.Exact()
    if name == "sweep":
        _, seconds = timed(problem, goals, fronts.Sweep(30), 0, options)
        return fronts.Sweep(int(min(100_000, max(10, 30 * options.seconds / seconds))))
    if name == "p-aco":
        return fronts.PAco(iterations=10**6)
    if name == "nsga2":
        return fronts.Nsga2(generations=10_000)
    return fronts.Colonies(rounds=10**6)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--maps", nargs="+", default=MAPS, metavar="NAME")
    parser.add_argument("--methods", nargs="+", default=METHODS, choices=METHODS)
    parser.add_argument("--objectives", type=int, default=4, choices=range(2, 6))
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--data", type=Path, default=Path("../shared/data"))
    parser.add_argument("--wall", action="store_true")
    options = parser.parse_args()
    warmup()
    print(f"{options.objectives} objectives, {options.seconds:g} s {'wall' if options.wall else 'CPU'}")
    print("map         method   seconds   paths  hypervolume: median, least  epsilon    IGD+")
    for name in options.maps:
        grid = loaded(name, options.data)
        if grid is None:
            continue
        problem = an.Problem.from_cells(grid, *maps.ends(grid))
        goals = asked(problem.grid, options.objectives)
        methods = {method: made(method, problem, goals, options) for method in options.methods}
        runs: dict[str, list[tuple[fronts.Front, float]]] = {method: [] for method in methods}
        for seed in range(options.seeds):
            for method, algorithm in methods.items():
                if seed == 0 or method not in ("exact", "sweep"):  # these know no chance
                    runs[method].append(timed(problem, goals, algorithm, seed, options))
        found = [front for several in runs.values() for front, _ in several]
        complete = [front.values for front in found if front.complete]
        truth = complete[0] if complete else moocore.filter_dominated(np.concatenate([front.values for front in found]))
        print(f"{name}: {len(grid.cells)} rows, {'exact' if complete else 'union'} of {len(truth)}")
        for method, several in runs.items():
            marks = [indicators.compare(front.values, truth) for front, _ in several]
            shares, epsilon, far = ([mark[key] for mark in marks] for key in ("hypervolume", "epsilon", "igd_plus"))
            seconds = np.median([spent for _, spent in several])
            paths = np.median([len(front) for front, _ in several])
            print(
                f"{name:<12}{method:<8}{seconds:>8.2f}{paths:>8.0f}{np.median(shares):>20.4f}{min(shares):>8.4f}"
                f"{np.median(epsilon):>9.4f}{np.median(far):>9.5f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
