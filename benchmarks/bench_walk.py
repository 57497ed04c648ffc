"""One ant step, compiled Python against the same walk in C: `python benchmarks/bench_walk.py`.

Both get the same arrays and seeds, must give the same paths to the last cell, and are timed in turn in one process.
"""

from __future__ import annotations

import argparse
import ctypes
import platform
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import antnav as an
from antnav import maps
from antnav.colony.colony import Colony
from antnav.kernels import ant_kernels

HERE = Path(__file__).parent


def c_walk(folder: str, compiler: str) -> Callable[..., int]:
    """Compile walk_twin.c there and then."""
    library = Path(folder) / "walk_twin.so"
    command = [compiler, "-O3", "-march=native", "-std=c11", "-ffp-contract=off", "-shared", "-fPIC"]
    subprocess.run([*command, str(HERE / "walk_twin.c"), "-o", str(library)], check=True)
    function = ctypes.CDLL(str(library)).walk
    function.restype = ctypes.c_int64
    return function


def call(function: Callable[..., int], colony: Colony, t: int) -> int:
    """Call the C walk on a colony's own arrays."""
    graph, choices, state = colony._graph, colony._choices, colony._state
    arrays = (graph.neighbours, graph.reverse, state.weight, state.visited, state.path, state.slots)
    more = (state.steps_on_path, state.status, state.met_dead_end, state.dead_count, state.dead_last, state.dead_pairs)
    retract = t <= choices.retract_until
    numbers = (choices.start, choices.goal, choices.ants, int(retract), colony.task.seed, colony.task.colony, t)
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (*arrays, *more)]
    return function(ctypes.c_int64(len(graph.neighbours)), *pointers, *(ctypes.c_int64(n) for n in numbers))


def compare(name: str, function: Callable[..., int], rounds: int) -> tuple[float, float, int]:
    """(ns a step in Python, ns a step in C, steps) for the walks of 50 iterations of NPACO, m = 50, medians."""
    problem = an.Problem.from_cells(maps.builtin(name), *maps.builtin_query(name), corner_rule="allow")
    colony = Colony(problem, an.npaco(), seed=7)
    times: dict[str, list[float]] = {"python": [], "c": []}
    steps = {"python": 0, "c": 0}
    for _ in range(rounds):
        colony = Colony(problem, an.npaco(), seed=7)
        spent = {"python": 0.0, "c": 0.0}
        moved = {"python": 0, "c": 0}
        for t in range(1, 51):
            ant_kernels.begin(colony._choices, colony._state, t)
            paths, clean = {}, colony._state.visited.copy()
            for who in ("c", "python") if t % 2 else ("python", "c"):
                for array in (colony._state.dead_count, colony._state.dead_last, colony._state.dead_pairs):
                    array[:] = 0
                begin = time.perf_counter()
                if who == "c":
                    moves = call(function, colony, t)
                    colony._state.visited[:] = clean  # the kernel leaves it as it was, the twin does not
                else:
                    moves = ant_kernels.walk(colony._graph, colony._choices, colony._state, np.uint64(7), 0, t, None)
                spent[who] += time.perf_counter() - begin
                moved[who] += moves
                paths[who] = [path.tolist() for path in _arrived(colony)]
            assert paths["python"] == paths["c"], "the twins walked different ways"
            colony.step()
        for who, values in times.items():
            values.append(spent[who] / moved[who])
            steps[who] = moved[who]
    assert steps["python"] == steps["c"]
    return *(statistics.median(times[who]) * 1e9 for who in ("python", "c")), steps["c"]


def _arrived(colony: Colony) -> list[np.ndarray]:
    state = colony._state
    return [
        state.path[ant, : state.steps_on_path[ant] + 1] for ant in np.flatnonzero(state.status == ant_kernels.ARRIVED)
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=21)
    parser.add_argument("--compiler", default="cc")
    options = parser.parse_args()
    an.warmup()
    print(f"{platform.machine()}, {options.compiler} -O3 -march=native, {options.rounds} rounds, medians")
    print(f"{'map':<8} {'steps':>8} {'Numba':>10} {'C':>10} {'ratio':>6}")
    with tempfile.TemporaryDirectory() as folder:
        function = c_walk(folder, options.compiler)
        for name in ("equiv20", "equiv30", "equiv40"):
            mine, twin, steps = compare(name, function, options.rounds)
            print(f"{name:<8} {steps:>8} {mine:>7.1f} ns {twin:>7.1f} ns {mine / twin:>6.2f}")


if __name__ == "__main__":
    main()
