"""What a rule of one's own costs beside the built-in one that says the same: `python benchmarks/bench_own_rules.py`.

Each rule below does what a built-in one does, compiled and in Python. All solve the same problem with the same seeds
in turn, so that what else the machine does meets all of them; the figure is the median of the ratios to the built-in
rule. Results are compared: figures of rules that do something else would say nothing.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import antnav as an


@an.register.pheromone(jit=True)
def ranked_compiled(ants: Any, top: int = 6) -> None:
    """The best few by rank and the best so far, compiled."""
    for rank in range(min(top - 1, ants.arrived)):
        ants.amounts[rank] = (top - 1 - rank) * ants.q / ants.costs[ants.order[rank]]
    if ants.best_steps > 0:
        ants.amounts[-1] = top * ants.q / ants.best


@an.register.pheromone
def ranked_numpy(ants: Any, top: int = 6) -> None:
    """The same with NumPy."""
    first = ants.order[: min(top - 1, ants.arrived)]
    ants.amounts[: len(first)] = np.arange(top - 1, top - 1 - len(first), -1) * ants.q / ants.costs[first]
    if ants.best_steps > 0:
        ants.amounts[-1] = top * ants.q / ants.best


@an.register.deadlock(jit=True)
def mortal_compiled(stuck: Any) -> bool:
    """An ant in a dead end dies, compiled."""
    return bool(stuck.t > 0)


@an.register.deadlock
def mortal_python(stuck: Any) -> bool:
    """The same in Python."""
    return True


@an.register.transition(jit=True)
def roulette_compiled(choice: Any) -> int:
    """By the probabilities of eq. (3.1), compiled."""
    total = 0.0
    for k in range(8):
        total += choice.weights[k]
    target, running, last = choice.draws[0] * total, 0.0, 0
    for k in range(8):
        running += choice.weights[k]
        if choice.weights[k] > 0.0:
            last = k
            if target < running:
                break
    return last


@an.register.transition
def roulette_python(choice: Any) -> int:
    """The same with NumPy."""
    running = np.cumsum(choice.weights)
    return int(np.searchsorted(running, choice.draws[0] * running[-1], side="right"))


CASES: dict[str, tuple[Callable[[], an.Algorithm], dict[str, Callable[[], an.Algorithm]]]] = {
    "pheromone": (
        lambda: an.npaco(pheromone="rank_based", elite=6),
        {
            "compiled": lambda: an.npaco(pheromone="ranked_compiled"),
            "NumPy": lambda: an.npaco(pheromone="ranked_numpy"),
        },
    ),
    "deadlock": (
        lambda: an.npaco(deadlock="death"),
        {
            "compiled": lambda: an.npaco(deadlock="mortal_compiled", punish=0),
            "Python": lambda: an.npaco(deadlock="mortal_python", punish=0),
        },
    ),
    "transition": (
        lambda: an.npaco(iterations=10),
        {
            "compiled": lambda: an.npaco(iterations=10, transition="roulette_compiled"),
            "NumPy": lambda: an.npaco(iterations=10, transition="roulette_python"),
        },
    ),
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--map", default="equiv40", choices=an.maps.builtin_names())
    parser.add_argument("--seeds", type=int, default=40)
    options = parser.parse_args()
    problem = an.Problem.from_cells(an.maps.builtin(options.map), *an.maps.builtin_query(options.map))
    for kind, (usual, own) in CASES.items():
        algorithms = {"built in": usual(), **{name: make() for name, make in own.items()}}
        seconds: dict[str, list[float]] = {name: [] for name in algorithms}
        steps: dict[str, list[int]] = {name: [] for name in algorithms}
        lengths: dict[str, list[float]] = {name: [] for name in algorithms}
        for algorithm in algorithms.values():
            an.solve(problem, algorithm)  # compiles
        for seed in range(options.seeds if kind != "transition" else max(5, options.seeds // 4)):
            for name, algorithm in algorithms.items():
                begin = time.perf_counter()
                result = an.solve(problem, algorithm, seed=seed)
                seconds[name].append(time.perf_counter() - begin)
                steps[name].append(result.steps)
                lengths[name].append(result.length)
        usual_rate = np.array(seconds["built in"]) / np.array(steps["built in"])
        for name in algorithms:
            rate = np.array(seconds[name]) / np.array(steps[name])
            same = "the same paths" if lengths[name] == lengths["built in"] else "other draws"
            print(
                f"{options.map} {kind:<10} {name:<9} {1e3 * np.median(seconds[name]):8.2f} ms a run, "
                f"{np.median(rate / usual_rate):6.3f} of the built-in rule's time a step, {same}"
            )


if __name__ == "__main__":
    main()
