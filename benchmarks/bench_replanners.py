"""Replanners on maps that change: `python benchmarks/bench_replanners.py [METHOD ...] [--data FOLDER] [--tuned]`.

All replanners drive a `Mission` of their own over the same map of FOLDER (default: ../shared/data) and meet the same
events, drawn from a seed: a disc of cells of some radius is closed, in seven of ten cases on or near the plan that the
first replanner has in force, or one of at least five such discs is opened again, and the robot has gone two cells along
the first replanner's plan. Who meets an arrived robot gets another query. Queries are random under a seed. `--tuned`
takes the maps and seeds that `live/regions.py` was tuned on; the others are those that it is judged by.

Milliseconds of CPU time for each change, with all that a `Mission` does: median, 95th and 99th percentile, largest,
mean; the share of the plan that changed; the mean and the largest gap to A*'s cost of the same moment in per cent, at
once and after `--rounds` rounds of improvement, and what that took in the mean; events without a way, wrong verdicts,
and plans that `check_path` refuses on the map of their moment.
"""

from __future__ import annotations

import argparse
import time
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import antnav as an
from antnav import maps
from antnav.errors import PathError
from antnav.live.methods import METHODS

TUNED = {
    "AR0602SR": "movingai/bg512/AR0602SR.map",
    "random512-10": "movingai/random/random512-10-0.map",
    "32room": "movingai/rooms/32room_000.map",
    "NewYork": "movingai/cities/NewYork_0_1024.map",
}
JUDGED = {
    "brc202d": "movingai/dao/brc202d.map",
    "Berlin": "movingai/cities/Berlin_0_256.map",
    "Aftershock": "movingai/sc1/Aftershock.map",
    "random512-40": "movingai/random/random512-40-0.map",
    "depot": "ros/nav2_bringup/depot.yaml",
    "warehouse": "ros/nav2_bringup/warehouse.yaml",
    "caves 1024": "caves",
    "rooms 1024": "rooms",
}
LYING = 5


def problem_of(grid: an.GridMap, rng: np.random.Generator) -> an.Problem:
    """A pair of cells that a way joins, at least a third of the map apart; `allow` where `forbid` joins too little."""
    free = np.argwhere(grid.passable())
    rule = "forbid"
    for attempt in range(10_000):
        start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
        if attempt == 200:
            rule = "allow"
        if np.abs(np.subtract(start, goal)).max() > max(grid.shape) / 3:
            problem = an.Problem.from_cells(grid, start, goal, corner_rule=rule)
            if problem.connected:
                return problem
    raise SystemExit(f"{grid.name}: no two cells far apart are joined")


class Events:
    """Discs that fall and vanish, drawn from a seed."""

    def __init__(self, grid: an.GridMap, radius: int, rng: np.random.Generator) -> None:
        self.grid, self.rng = grid, rng
        self.free = grid.passable()
        away = np.indices((2 * radius + 1,) * 2) - radius
        self.disc = np.argwhere((away**2).sum(axis=0) <= radius * radius) - radius
        self.lying: list[NDArray[np.int64]] = []

    def next(
        self, plan: NDArray[np.int32] | None, ends: list[tuple[int, int]]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Cells that are blocked, and those that are freed."""
        rng, none = self.rng, np.empty((0, 2), np.int64)
        if len(self.lying) >= LYING and rng.random() < 0.5:
            freed = self.lying.pop(int(rng.integers(len(self.lying))))
            others = {tuple(cell) for disc in self.lying for cell in disc.tolist()}
            return none, np.array([cell for cell in freed.tolist() if tuple(cell) not in others]).reshape(-1, 2)
        near = rng.random() < 0.7 and plan is not None and len(plan) > 20
        if near and plan is not None:
            centre = plan[int(rng.integers(5, len(plan) - 3))] + rng.integers(-1, 2, 2)
        else:
            centre = rng.integers(0, self.grid.shape)
        cells = centre + self.disc
        cells = cells[((cells >= 0) & (cells < self.grid.shape)).all(axis=1)]
        cells = cells[self.free[tuple(cells.T)]]
        cells = cells[(np.abs(cells[:, None] - np.array(ends)).max(axis=-1) > 1).all(axis=1)]
        self.lying.append(cells)
        return cells, none


class Measured:
    """What one replanner brought."""

    def __init__(self) -> None:
        self.seconds: list[float] = []
        self.idle: list[float] = []
        self.shares: list[float] = []
        self.gaps: list[float] = []
        self.later: list[float] = []
        self.cut_off = self.wrong = self.broken = 0

    def row(self) -> str:
        ms = 1e3 * np.array(self.seconds)
        times = "".join(f"{figure:8.3f}" for figure in (*np.percentile(ms, (50, 95, 99, 100)), ms.mean()))
        gaps = "".join(
            f"{100 * np.mean(values or [0]):7.2f}{100 * max(values, default=0):7.1f}"
            for values in (self.gaps, self.later)
        )
        idle = f"{1e3 * np.mean(self.idle or [0]):8.2f}"
        return f"{times}{100 * np.mean(self.shares):8.2f}{gaps}{idle}{self.cut_off:6}{self.wrong:6}{self.broken:6}"


def run(
    grid: an.GridMap, names: list[str], radius: int, events: int, seed: int, rounds: int, into: dict[str, Measured]
) -> None:
    """Events on one map, all replanners beside each other."""
    rng = np.random.default_rng(seed)
    problem = problem_of(grid, rng)
    missions = {name: an.Mission(problem, name) for name in names}
    first, course = missions[names[0]], Events(grid, radius, rng)
    exact = an.Mission(problem, "astar")
    for _ in range(events):
        blocked, freed = course.next(first.plan.cells, [first.position, first.goal])
        ahead = first.plan.points
        at = None if ahead is None else tuple(ahead[min(2, len(ahead) - 1)].tolist())
        best = exact.change(blocked=blocked, freed=freed, at=at)
        for name in rng.permutation(names).tolist():
            mission, measured = missions[name], into[name]
            begin = time.thread_time()
            update = mission.change(blocked=blocked, freed=freed, at=at)
            measured.seconds.append(time.thread_time() - begin)
            measured.shares.append(update.changed_share)
            measured.cut_off += not best
            measured.wrong += bool(best) != bool(update)
            if not update:
                continue
            try:
                an.check_path(update.cells, mission.problem)
            except PathError as error:
                print(name, error)
                measured.broken += 1
            if best.cost > 10:
                measured.gaps.append(update.cost / best.cost - 1)
            if not METHODS[name].exact:
                begin = time.thread_time()
                update = mission.improve(rounds)
                measured.idle.append(time.thread_time() - begin)
                if best.cost > 10:
                    measured.later.append(update.cost / best.cost - 1)
        if first.plan.status == "arrived":
            another = problem_of(grid, rng)
            for mission in (*missions.values(), exact):
                mission.change(freed=[another.start_cell, another.goal_cell])
                mission.moved_to(another.start_cell)
                mission.goal = another.goal_cell


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("methods", nargs="*", default=list(METHODS))
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[2] / "shared" / "data")
    parser.add_argument("--tuned", action="store_true")
    parser.add_argument("--maps", nargs="+")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--events", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=9)
    given = parser.parse_args()
    warnings.simplefilter("ignore")  # of maps, and that discs are as wide as they are drawn
    sources = TUNED if given.tuned else JUDGED
    head = f"{'map':13}{'r':>2} {'replanner':11}"
    head += "".join(f"{name:>8}" for name in ("median", "p95", "p99", "max", "mean", "new %"))
    print(head + "  gap %    max  later    max idle ms no way wrong broken", flush=True)
    warm = maps.generate("random", 64, 64, density=0.1)
    run(warm, given.methods, 2, 12, 0, 9, {name: Measured() for name in given.methods})
    for label in given.maps or sources:
        source = sources[label]
        if "/" not in source:
            grid = maps.generate(source, 1024, 1024, seed=11)
        elif not (given.data / source).exists():
            print(f"{label} skipped: no {given.data / source}")
            continue
        else:
            grid = maps.load_map(given.data / source)
            grid = grid.inflated(0.2) if "ros" in source else grid
        for radius in (2, 6):
            measured = {name: Measured() for name in given.methods}
            for seed in range(given.seeds):
                run(
                    grid,
                    given.methods,
                    radius,
                    given.events,
                    (0 if given.tuned else 1000) + seed,
                    given.rounds,
                    measured,
                )
            for name in given.methods:
                print(f"{label:13}{radius:2} {name:11}{measured[name].row()}", flush=True)


if __name__ == "__main__":
    main()
