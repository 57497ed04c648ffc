"""Replanners on maps that change: `python benchmarks/bench_replanners.py [METHOD ...] [--data FOLDER] [--queries N]`.

Maps of FOLDER (default: ../shared/data), corner rule `forbid`, random queries under a fixed seed. An event: a disc of
cells is closed on or near the path ahead, one of nine such discs is opened again, and the robot has gone two cells
along its path; where there is no way, discs are only opened. All replanners get the same draws; where their paths
differ, so do the events. After each, A* plans anew on the same map: its time and cost are of the same events.

Milliseconds of CPU time for each event, without what the map itself takes: median, 95th and 99th percentile, largest,
mean; A*'s mean beside it and the ratio of the means; events without a way; the largest gap in per cent.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import antnav as an
from antnav import maps
from antnav.live.methods import METHODS
from antnav.live.terrain import LiveTerrain

MAPS = {
    "AR0602SR": "bg512/AR0602SR.map",
    "random512-10": "random/random512-10-0.map",
    "32room": "rooms/32room_000.map",
    "NewYork": "cities/NewYork_0_1024.map",
}
NONE = np.empty(0, np.int32)
LASTING = 8


def query(grid: an.GridMap, rng: np.random.Generator) -> an.Problem:
    """A pair of cells that a way joins, at least half the map apart."""
    free = np.argwhere(grid.passable())
    while True:
        start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
        problem = an.Problem.from_cells(grid, start, goal)
        if problem.connected and np.abs(np.subtract(start, goal)).max() > max(grid.shape) / 2:
            return problem


class Events:
    """What happens to one map and one robot."""

    def __init__(self, terrain: LiveTerrain, radius: int, goal: int, seed: int) -> None:
        self.terrain, self.goal, self.margin = terrain, goal, radius + 2
        self.rng = np.random.default_rng(seed)
        away = np.indices((2 * radius + 1,) * 2) - radius
        self.disc = np.argwhere((away**2).sum(axis=0) <= radius * radius) - radius
        self.lying: list[NDArray[np.int32]] = []

    def next(self, path: NDArray[np.int32] | None, robot: int) -> NDArray[np.int32]:
        """Cells whose moves are others then."""
        if path is None:
            return self.terrain.alter(NONE, self.lying.pop(int(self.rng.integers(len(self.lying)))))
        terrain, rng = self.terrain, self.rng
        along, offset, oldest = rng.random(), rng.integers(-3, 4, 2), int(rng.integers(LASTING))
        centre = terrain.cells_of(path[int(along * (len(path) - 1))]) + offset
        away = np.abs(terrain.cells_of(np.array([robot, self.goal])) - centre).max(axis=1).min()
        cells = centre + self.disc
        cells = cells[((cells >= 0) & (cells < terrain.shape)).all(axis=1)]
        flat = terrain.flat_of("disc", cells) if away > self.margin else NONE
        flat = flat[terrain.passable[flat] > 0]
        freed = self.lying.pop(oldest) if len(self.lying) > LASTING else NONE
        if flat.size:
            self.lying.append(flat)
        return terrain.alter(flat, freed)


def run(problem: an.Problem, name: str, radius: int, events: int, seed: int) -> list[tuple[float, float, float, float]]:
    """Of each event: seconds of the replanner, its cost, seconds of A*, its cost; inf where there is no way."""
    terrain = LiveTerrain(problem)
    replanner, exact = METHODS[name](), METHODS["astar"]()
    robot, goal = problem.flat_ends
    path = replanner.begin(terrain, robot, goal)
    exact.begin(terrain, robot, goal)
    course = Events(terrain, radius, goal, seed)
    measured = []
    for _ in range(events):
        cells = course.next(path, robot)
        if path is not None:
            robot = int(path[min(2, len(path) - 1)])
        if robot == goal:
            break
        begin = time.process_time()
        path = replanner.changed(cells, robot)
        middle = time.process_time()
        best = exact.moved(robot)
        end = time.process_time()
        costs = [np.inf if found is None else terrain.cost_along(found) for found in (path, best)]
        measured.append((middle - begin, costs[0], end - middle, costs[1]))
    return measured


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("methods", nargs="*", default=[name for name in METHODS if name != "astar"])
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[2] / "shared" / "data")
    parser.add_argument("--maps", nargs="+", default=list(MAPS))
    parser.add_argument("--queries", type=int, default=3)
    parser.add_argument("--events", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    print(f"{'map':13}{'disc':>5} {'replanner':11}{'median':>8}{'p95':>8}{'p99':>8}{'max':>8}{'mean':>8}", end="")
    print(f"{'A*':>8}{'ratio':>7}{'no way':>7}{'gap %':>7}")
    warm = an.Problem.from_cells(an.GridMap(np.zeros((9, 9), np.uint8)), (0, 0), (8, 8))
    for name in given.methods:
        run(warm, name, 1, 2, 0)
    for name in given.maps:
        file = given.data / "movingai" / MAPS[name]
        if not file.exists():
            print(f"{name} skipped: no {file}")
            continue
        grid = maps.load_map(file)
        rng = np.random.default_rng(given.seed)
        problems = [query(grid, rng) for _ in range(given.queries)]
        for radius in (2, 6):
            for method in given.methods:
                measured = [e for i, p in enumerate(problems) for e in run(p, method, radius, given.events, i)]
                own, cost, anew, best = np.array(measured).T
                wrong = np.count_nonzero(np.isinf(cost) != np.isinf(best))
                reached = np.isfinite(cost) & np.isfinite(best)
                gap = 100 * (cost[reached] / best[reached] - 1).max(initial=0.0)
                figures = *np.percentile(1e3 * own, (50, 95, 99, 100)), 1e3 * own.mean(), 1e3 * anew.mean()
                print(f"{name:13}{radius:5} {method:11}" + "".join(f"{figure:8.3f}" for figure in figures), end="")
                print(f"{own.mean() / anew.mean():7.2f}{np.isinf(best).sum():7}{gap:7.2f}", end="")
                print(f"  {wrong} WRONG VERDICTS" if wrong else "", flush=True)


if __name__ == "__main__":
    main()
