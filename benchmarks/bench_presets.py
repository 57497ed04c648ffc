"""All presets in two versions, in one run: `python benchmarks/bench_presets.py OLD_TREE NEW_TREE`.

Each tree runs in processes of its own, in turn. Of each preset, stand-in and seed the fastest round counts, then
the median of the seeds, in wall and CPU milliseconds of `solve`. Lengths tell whether results changed. Presets that one
tree lacks are left out of its column.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

SCRIPT = """
import json, sys, time
import numpy as np
import antnav as an
from antnav import maps
seeds, found = int(sys.argv[1]), {}
for name, preset in an.PRESETS.items():
    for place in ("equiv20", "equiv40"):
        ends = maps.builtin_query(place)
        problem = an.Problem.from_cells(maps.builtin(place), *ends, corner_rule="allow")
        algorithm, wall, cpu, lengths = preset(), [], [], []
        an.solve(problem, algorithm)
        for seed in range(seeds):
            begin, used = time.perf_counter(), time.process_time()
            result = an.solve(problem, algorithm, seed=seed)
            wall.append(time.perf_counter() - begin)
            cpu.append(time.process_time() - used)
            lengths.append(result.length)
        arrived = [length for length in lengths if np.isfinite(length)]
        optimal = sum(length < result.optimum + 1e-6 for length in lengths)
        found[f"{name} {place}"] = [wall, cpu, sum(arrived), optimal]
print(json.dumps(found))
"""


def main() -> None:
    """Print a row a preset and map."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trees", nargs=2, type=Path)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seeds", type=int, default=10)
    options = parser.parse_args()
    rounds: dict[Path, list[dict]] = {tree: [] for tree in options.trees}
    for turn in range(options.rounds + 1):
        for tree in options.trees:
            environment = os.environ | {"PYTHONPATH": str(tree / "src"), "NUMBA_CACHE_DIR": str(tree / ".numba")}
            environment |= {"PYTHONDONTWRITEBYTECODE": ""}
            command = [sys.executable, "-c", SCRIPT, str(options.seeds)]
            run = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment)
            if turn:  # the first compiles
                rounds[tree].append(json.loads(run.stdout))
    old, new = (rounds[tree] for tree in options.trees)
    print("| preset | map | wall ms, before | now | CPU ms, before | now | optimal, before | now | lengths |")
    print("|---|---|---:|---:|---:|---:|---:|---:|---|")
    for key in new[0]:
        cells, lengths = list[list[str]](), list[float]()
        for found in (old, new):
            if key not in found[0]:
                cells.append(["", "", ""])
                continue
            times = [np.median(np.min([one[key][kind] for one in found], axis=0)) * 1e3 for kind in (0, 1)]
            cells.append([*(f"{time:.2f}" for time in times), f"{found[0][key][3]} of {options.seeds}"])
            lengths.append(found[0][key][2])
        same = "new" if len(lengths) == 1 else "the same" if lengths[0] == lengths[1] else "others"
        name, place = key.split()
        pairs = [f"{one} | {other}" for one, other in zip(*cells, strict=True)]
        print(f"| `{name}` | {place} | {' | '.join(pairs)} | {same} |")


if __name__ == "__main__":
    main()
