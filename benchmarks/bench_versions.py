"""Versions beside each other: `python benchmarks/bench_versions.py TREE [TREE ...]`, each a checkout of antnav.

Every tree runs in processes of its own, in turn, and the fastest round counts, as other work on the machine only ever
adds; the first round compiles and does not count. Milliseconds: `npaco`, `paco` and `paco_extended` on the three
stand-ins (median of 30 seeds, each the fastest of five runs), A* on caves of 1000 cells a side, `import antnav`; and
the length of all paths, which tells whether results changed.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

SCRIPT = """
import json, time
begin = time.perf_counter()
import antnav as an
found = {"import": time.perf_counter() - begin}
import numpy as np
from antnav import maps
from antnav.search import exact
an.warmup()
total = 0.0
for name in ("npaco", "paco", "paco_extended"):
    for side in (20, 30, 40):
        ends = maps.builtin_query(f"equiv{side}")
        problem = an.Problem.from_cells(maps.builtin(f"equiv{side}"), *ends, corner_rule="allow")
        algorithm, seconds = an.PRESETS[name](), []
        for seed in range(30):
            runs = [an.solve(problem, algorithm, seed=seed) for _ in range(5)]
            seconds.append(min(run.seconds_run for run in runs))
            total += runs[0].length
        found[f"{name} {side}"] = float(np.median(seconds))
grid = maps.generate("caves", 1000, 1000, seed=1)
problem = an.Problem.from_cells(grid, *maps.ends(grid))
found["A* 1000"] = min(exact.shortest_path(problem, "astar").seconds for _ in range(5))
print(json.dumps({"found": found, "total": total}))
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trees", nargs="+", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    rounds: dict[Path, list[dict]] = {tree: [] for tree in options.trees}
    for turn in range(options.rounds + 1):
        for tree in options.trees:
            environment = os.environ | {"PYTHONPATH": str(tree / "src"), "NUMBA_CACHE_DIR": str(tree / ".numba")}
            environment |= {"PYTHONDONTWRITEBYTECODE": ""}  # bytecode is there where a package is installed
            command = [sys.executable, "-c", SCRIPT]
            run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment)
            if turn:
                rounds[tree].append(json.loads(run.stdout))
    columns = list(rounds[options.trees[0]][0]["found"])
    print("tree             " + "".join(f"{column:>18}" for column in columns) + "     all lengths")
    for tree, found in rounds.items():
        fastest = [1e3 * min(row["found"][column] for row in found) for column in columns]
        figures = "".join(f"{value:>15.2f} ms" for value in fastest)
        print(f"{tree.resolve().name:<17}{figures}{found[0]['total']:>16.4f}")


if __name__ == "__main__":
    main()
