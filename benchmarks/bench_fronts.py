"""Exact fronts: `python benchmarks/bench_fronts.py [SECONDS [ROUNDS]]`; CPU milliseconds, paths and labels.

From the first free cell of a map's largest part to its last, by row + column. Costs are whole numbers: length in
thousandths of a cell; turns; risk, the field of `costs.clearance` within five cells of a wall, and field, drawn evenly
from 0 to 1 for each cell under a fixed seed, both times length. Maps of `../shared/data` where they are there, and
random ones with a fifth of the cells occupied. The best of ROUNDS (default 3) over all; a search is cut after SECONDS
of CPU time (default 60), and its row says so.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

import antnav as an
from antnav import costs, maps
from antnav.search.labels import Labels, front

DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "movingai"
REAL = ("dao/arena", "dao/den312d", "da2/ht_chantry", "cities/Berlin_0_256", "dao/brc202d")
TASKS = [(name, costs) for costs in ("length+risk", "length+turns+risk") for name in REAL] + [
    ("random 256", "length+risk"),
    ("random 256", "length+field"),
    ("open 256", "length+field"),
    ("random 128", "length+risk+field"),
    ("random 256", "length+turns+risk"),
    ("random 64", "length+turns+risk+field"),
]
SEED = 1


def problem_on(grid: an.GridMap) -> an.Problem:
    """The problem from corner to corner of the largest part."""
    parts, _ = ndimage.label(np.asarray(grid.cells) == 0)
    cells = np.argwhere(parts == np.argmax(np.bincount(parts.ravel())[1:]) + 1)
    order = cells.sum(axis=1)
    first, last = cells[order.argmin()].tolist(), cells[order.argmax()].tolist()
    return an.Problem.from_cells(grid, tuple(first), tuple(last))


def load(name: str) -> an.GridMap | None:
    """A map by its name, None where its file is not here."""
    kind, _, side = name.partition(" ")
    if side:
        share = {"random": 0.2, "open": 0.0}[kind]
        cells = np.random.default_rng(SEED).random((int(side), int(side))) < share
        cells[0, 0] = cells[-1, -1] = False
        return an.GridMap(cells)
    file = DATA / f"{name}.map"
    return maps.load_map(file) if file.exists() else None


def instance(problem: an.Problem, names: list[str]) -> tuple[NDArray[np.int32], ...]:
    """Neighbours, costs and turns, as `front` takes them."""
    neighbours, lengths = problem.graph.graph.neighbours, problem.graph.graph.lengths
    cells, (n, _) = tuple(problem.graph.cells.T), neighbours.shape
    length = np.rint(1000 * np.minimum(lengths, 1.414))
    fields = {
        "risk": costs.clearance(problem.grid, 5 * problem.grid.resolution).values[cells],
        "field": np.random.default_rng(SEED).random(n),
    }
    other = np.minimum(neighbours, n - 1)
    table = {name: length * (field[:, None] + field[other]) / 2 for name, field in fields.items()}
    table |= {"length": length, "turns": np.zeros((n, 8))}
    turns = np.zeros((9, 8, len(names) if "turns" in names else 0), np.int32)
    if "turns" in names:
        turns[1:, :, names.index("turns")] = 1 - np.eye(8)
    return neighbours, np.stack([np.rint(table[name]) for name in names], axis=-1).astype(np.int32), turns


def run(problem: an.Problem, given: tuple[NDArray[np.int32], ...], seconds: float) -> tuple[float, Labels]:
    """Time of one search in seconds, and what it found."""
    ends = [problem.graph.node(cell) for cell in (problem.start_cell, problem.goal_cell)]
    begin = time.process_time()
    found = front(*given, *ends, check=lambda: time.process_time() - begin > seconds)
    return time.process_time() - begin, found


def main() -> None:
    seconds, rounds = (float(given) for given in (sys.argv[1:] + ["60", "3"][len(sys.argv) - 1 :]))
    grids = {name: grid for name, _ in TASKS if (grid := load(name)) is not None}
    problems = {name: problem_on(grid) for name, grid in grids.items()}
    small = an.Problem.from_cells(an.GridMap(np.zeros((4, 4), bool)), (0, 0), (3, 3))
    for names in ("length+risk", "length+turns+risk"):
        run(small, instance(small, names.split("+")), seconds)  # compiles
    best: dict[tuple[str, str], tuple[float, Labels]] = {}
    for _ in range(int(rounds)):
        for name, names in TASKS:
            if name in problems:
                taken = run(problems[name], instance(problems[name], names.split("+")), seconds)
                best[name, names] = min(best.get((name, names), taken), taken, key=lambda pair: pair[0])
    print(f"{'map':<22}{'nodes':>8}  {'costs':<25}{'ms':>9}{'paths':>8}{'labels':>10}{'ns each':>9}")
    for (name, names), (taken, found) in best.items():
        row = f"{name:<22}{len(problems[name].graph):8d}  {names:<25}{1000 * taken:9.1f}{len(found.paths):8d}"
        print(f"{row}{found.popped:10d}{1e9 * taken / max(found.popped, 1):9.0f}{'' if found.complete else '  cut'}")


if __name__ == "__main__":
    main()
