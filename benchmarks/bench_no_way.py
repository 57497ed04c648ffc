"""How soon a replanner knows that there is no way: `python benchmarks/bench_no_way.py [DATA]`.

Rings of walls of half side 3, 8 and 20 cells are closed around the goal, then around the robot, and opened again, for
six random queries a map. CPU milliseconds of the changes that cut the robot off: number, median, 95 %, largest.
"""

from __future__ import annotations

import sys
import time
import warnings
from itertools import product
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps

SOURCES = ("movingai/cities/NewYork_0_1024.map", "movingai/rooms/32room_000.map", "rooms")
NAMES = ("regions", "dstar_lite", "mpgaa_star", "astar")


def ring(grid: an.GridMap, cell: tuple[int, int], side: int) -> list[tuple[int, int]]:
    """Free cells around a cell."""
    around = product(range(-side, side + 1), repeat=2)
    cells = [(cell[0] + row, cell[1] + col) for row, col in around if max(abs(row), abs(col)) == side]
    return [cell for cell in cells if grid.contains(cell) and grid.cells[cell] == an.Cell.FREE]


def main() -> None:
    data = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2] / "shared" / "data"
    warnings.simplefilter("ignore", maps.MapWarning)
    for source in SOURCES:
        grid = maps.load_map(data / source) if "/" in source else maps.generate("rooms", 1024, 1024, seed=11)
        free, rng = np.argwhere(grid.passable()), np.random.default_rng(7)
        times: dict[str, list[float]] = {name: [] for name in NAMES}
        done = 0
        while done < 6:
            start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
            problem = an.Problem.from_cells(grid, start, goal)
            if not problem.connected or np.abs(np.subtract(start, goal)).max() <= 300:
                continue
            done += 1
            missions = {name: an.Mission(problem, name) for name in NAMES}
            for end, side in product((goal, start), (3, 8, 20)):
                walls = ring(grid, end, side)
                for name, mission in missions.items():
                    begin = time.thread_time()
                    update = mission.change(blocked=walls)
                    if update.status == "unreachable":
                        times[name].append(1e3 * (time.thread_time() - begin))
                    mission.change(freed=walls)
                    mission.improve()
        for name, ms in times.items():
            figures = np.percentile(ms, (50, 95, 100)) if ms else [np.nan] * 3
            print(f"{source:36} {name:11}{len(ms):4}" + "".join(f"{figure:9.2f}" for figure in figures), flush=True)


if __name__ == "__main__":
    main()
