"""Scenarios, replayed by every replanner: `python benchmarks/bench_replays.py [--data FOLDER] [--seeds N]`.

Unknown terrain within ten cells' sight, crowds, doors, falling obstacles, jams, on maps of FOLDER (default:
../shared/data) and built-in ones; random queries under a seed; the robot makes one move a tick, one round of
improvement follows each change. A row for each scenario and replanner, all maps and seeds together: CPU ms a replan,
median, 99th percentile, largest; ms of planning for a whole drive, with the first plan, and of improvement; length
driven over what A* anew drove, cost paid likewise, mean and largest; mean share of the plan that changed in a replan;
drives that did not arrive, failures.
"""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps
from antnav.live.methods import METHODS

SCENARIOS = ("unknown", "people:60", "doors:6+obstacles:10", "traffic:40:6")
MAPS = {
    "brc202d": ("movingai/dao/brc202d.map", 0.0),
    "Berlin": ("movingai/cities/Berlin_0_256.map", 0.0),
    "ht_chantry": ("movingai/da2/ht_chantry.map", 0.0),
    "depot": ("ros/nav2_bringup/depot.yaml", 0.2),
    "warehouse, built in": ("warehouse", 0.25),
}


def problem_of(grid: an.GridMap, radius: float, rng: np.random.Generator) -> an.Problem:
    """A pair of cells, a third of the map apart, that a way joins for a robot of that radius."""
    free = np.argwhere(grid.inflated(radius).passable())
    while True:
        start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
        if np.abs(np.subtract(start, goal)).max() > max(grid.shape) / 3:
            wide = an.Problem.from_cells(grid.inflated(radius), start, goal)
            if wide.connected:
                return an.Problem.from_cells(grid, start, goal)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[2] / "shared" / "data")
    parser.add_argument("--seeds", type=int, default=2)
    given = parser.parse_args()
    warnings.simplefilter("ignore", maps.MapWarning)
    head = f"{'scenario':21} {'replanner':11}" + "".join(f"{name:>8}" for name in ("median", "p99", "max", "drive"))
    print(head + "    idle  way/A*    max paid/A*    max  new %  not there  failures", flush=True)
    for text in SCENARIOS:
        rows: dict[str, list[an.Replay]] = {name: [] for name in METHODS}
        for source, radius in MAPS.values():
            if "/" in source and not (given.data / source).exists():
                print(f"{source} skipped: not in {given.data}")
                continue
            grid = maps.load_map(given.data / source) if "/" in source else maps.builtin(source)
            for seed in range(given.seeds):
                problem = problem_of(grid, radius, np.random.default_rng(500 + seed))
                scenario = an.scenarios.named(text, problem, seed=seed, radius=radius)
                for name in METHODS:
                    rows[name].append(an.replay(problem, scenario, name))
        for name, replays in rows.items():
            ms = 1e3 * np.concatenate([[tick.seconds for tick in r.ticks if tick.noticed] or [0.0] for r in replays])
            drive = 1e3 * np.mean([r.seconds_first + sum(tick.seconds for tick in r.ticks) for r in replays])
            idle = 1e3 * np.mean([sum(tick.idle_seconds for tick in r.ticks) for r in replays])
            ways, paid = (
                [
                    sum(getattr(t, what) for t in r.ticks) / sum(getattr(t, what) for t in a.ticks)
                    for r, a in zip(replays, rows["astar"], strict=True)
                    if r.arrived and a.arrived
                ]
                for what in ("length", "paid")
            )
            share = 100 * np.mean([tick.changed_share for r in replays for tick in r.ticks if tick.noticed])
            print(f"{text:21} {name:11}" + "".join(f"{x:8.3f}" for x in np.percentile(ms, (50, 99, 100))), end="")
            print(
                f"{drive:8.0f}{idle:8.0f}{np.mean(ways):8.3f}{max(ways):7.3f}{np.mean(paid):8.3f}{max(paid):7.3f}",
                end="",
            )
            print(
                f"{share:7.1f}{sum(not r.arrived for r in replays):11}{sum(len(r.failures) for r in replays):10}",
                flush=True,
            )


if __name__ == "__main__":
    main()
