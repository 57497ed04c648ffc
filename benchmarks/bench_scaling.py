"""How cost and gap grow with the side of the map: `python benchmarks/bench_scaling.py [-o FOLDER]`.

Generated maps, corner rule forbid, queries between random cells at least 0.6 sides apart; the algorithms take turns at
every query. `paco_large` has its abstraction prepared; what that takes is a column of its own. The slope is that of the
least-squares line through log(time) over log(side). Each side runs in a process of its own, whose peak memory is told.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps
from antnav.search import exact

#: Largest side on which each algorithm runs.
LARGEST = {
    "npaco": 1024,
    "paco": 1024,
    "paco_ls": 1024,
    "paco_levels": 1024,
    "paco_large": 4096,
    "jps": 4096,
    "astar": 4096,
}
EXACT = ("jps", "astar")
LABELS = {"astar": "A* (own)"}


def measure(path: Path, count: int) -> dict:
    """Every algorithm on `count` queries of one map: CPU seconds of all threads together and gaps, in turn."""
    grid = an.load_map(path)
    side = grid.rows
    an.warmup()
    begin = time.process_time()
    an.prepare(grid)
    prepared = time.process_time() - begin
    component = an.Terrain.of(grid).components.reshape(side + 2, side + 2)[1:-1, 1:-1]
    cells = np.argwhere(component == np.bincount(component.ravel())[1:].argmax() + 1)
    rng = np.random.default_rng(side)
    names = [name for name, largest in LARGEST.items() if side <= largest]
    rows: list[dict] = []
    for query in range(-1, count):  # the first one only warms up
        start, goal = cells[rng.integers(len(cells), size=2)]
        while np.abs(start - goal).max() < 0.6 * side:
            start, goal = cells[rng.integers(len(cells), size=2)]
        optimum = math.nan
        for name in reversed(names):
            problem = an.Problem.from_cells(grid, tuple(start), tuple(goal))
            begin = time.process_time()
            if name in EXACT:
                length = optimum = exact.shortest_path(problem, name).length
            else:
                length = an.solve(problem, an.preset(name), seed=query % 2**32).length
            seconds = time.process_time() - begin
            if query >= 0:
                row = {"side": side, "algorithm": name, "query": query, "seconds": seconds, "length": length}
                rows.append(row | {"gap": length / optimum - 1})
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"rows": rows, "prepared": prepared, "peak": peak}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sides", nargs="*", type=int, default=[64, 128, 256, 512, 1024, 2048, 4096])
    parser.add_argument("--kind", default="caves")
    parser.add_argument("--queries", type=int, default=20)
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("-o", "--out", type=Path)
    options = parser.parse_args()
    if options.measure:
        print(json.dumps(measure(options.measure, options.queries)))
        return
    rows: list[dict] = []
    print(f"{options.kind}, {options.queries} queries a side; median CPU ms (median gap %, 95th percentile)")
    with tempfile.TemporaryDirectory() as folder:
        for side in options.sides:
            path = Path(folder) / f"{side}.npy"
            an.save_map(maps.generate(options.kind, side, side, seed=1), path)
            command = [sys.executable, __file__, "--measure", str(path), "--queries", str(options.queries)]
            run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=os.environ)
            found = json.loads(run.stdout)
            rows += found["rows"]
            cells = []
            for name in LARGEST:
                mine = [row for row in found["rows"] if row["algorithm"] == name]
                if mine:
                    gaps = [100 * row["gap"] for row in mine]
                    ms = 1e3 * np.median([row["seconds"] for row in mine])
                    cells.append(f"{name} {ms:.2f} ({np.median(gaps):.2f}, {np.percentile(gaps, 95):.2f})")
            memory = f"prepared in {1e3 * found['prepared']:.1f} ms, peak {found['peak']:.0f} MB"
            print(f"{side:>5}: {'; '.join(cells)}; {memory}", flush=True)
    print("slopes: " + ", ".join(f"{LABELS.get(name, name)} {slope(rows, name):.2f}" for name in LARGEST))
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
        with (options.out / "scaling.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        draw(rows, options.out / "scaling.png", options.kind)


def medians(rows: list[dict], name: str, column: str) -> tuple[list[int], list[float]]:
    sides = sorted({row["side"] for row in rows if row["algorithm"] == name})
    return sides, [
        float(np.median([row[column] for row in rows if (row["algorithm"], row["side"]) == (name, side)]))
        for side in sides
    ]


def slope(rows: list[dict], name: str) -> float:
    """Exponent p of time = c side^p; nan for fewer than two sides."""
    sides, seconds = medians(rows, name, "seconds")
    return float(np.polyfit(np.log(sides), np.log(seconds), 1)[0]) if len(sides) > 1 else math.nan


def draw(rows: list[dict], path: Path, kind: str) -> None:
    """Time and gap over the side, one line an algorithm."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    for name, marker in zip(LARGEST, "ovs^DP*", strict=True):
        sides, seconds = medians(rows, name, "seconds")
        label = f"{LABELS.get(name, name)}, slope {slope(rows, name):.2f}"
        left.loglog(sides, 1e3 * np.array(seconds), marker=marker, label=label)
        if name not in EXACT:
            right.semilogx(sides, 100 * np.array(medians(rows, name, "gap")[1]), marker=marker, label=name)
    left.set(xlabel="side of the map in cells", ylabel="median CPU time of a query in ms", title=f"Time, {kind}")
    right.set(xlabel="side of the map in cells", ylabel="median gap to the optimum in %", title="Gap")
    right.axhline(1, color="grey", linewidth=0.8, linestyle=":")
    for ax in (left, right):
        ax.set_xticks(sorted({row["side"] for row in rows}), [str(side) for side in sorted({r["side"] for r in rows})])
        ax.minorticks_off()
        ax.grid(visible=True, alpha=0.3)
    left.legend(fontsize=8)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
