"""A thousand short runs, as tuning makes them: what each way of running them costs beside the kernel itself.

    python benchmarks/bench_tuning.py [--runs 200] [--rounds 5] [--workers 2]

`npaco` on the 40 x 40 stand-in under consecutive seeds. Ways follow each other in every round, pools are started
before; the ratio is to the milliseconds that the kernel takes in one thread in the same round: 1 / workers is best.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import antnav as an
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.runner import run_study
from antnav.study.store import Store

CHUNK = 25  #: Runs that are sent to a process at a time.
ALGORITHM = an.npaco()


def problem() -> an.Problem:
    """The stand-in under the paper's corner rule."""
    ends = an.maps.builtin_query("equiv40")
    return an.Problem.from_cells(an.maps.builtin("equiv40"), *ends, corner_rule="allow")


PROBLEM = problem()  #: Of this process.


def cost(seed: int) -> float:
    """Of one run, in one thread."""
    return an.solve(PROBLEM, ALGORITHM, seed=seed, executor=an.spmd.Serial()).cost


def costs(seeds: Sequence[int]) -> list[float]:
    """Of some runs, so that a process has no message for each."""
    return [cost(seed) for seed in seeds]


def kernel(seeds: Sequence[int]) -> float:
    """Seconds in the kernel alone."""
    seconds = 0.0
    for seed in seeds:
        colony = an.Colony(PROBLEM, ALGORITHM, seed=seed)
        begin = time.perf_counter()
        colony.step(ALGORITHM.iterations)
        seconds += time.perf_counter() - begin
    return seconds


def in_study(seeds: Sequence[int], workers: int) -> None:
    """As a study whose store is a file."""
    entries = [MapEntry("equiv40", PROBLEM)], [AlgorithmEntry("npaco", ALGORITHM)]
    with tempfile.TemporaryDirectory() as folder, Store(Path(folder, "store.sqlite")) as store:
        run_study(Study("bench", *entries, seeds), store, workers=workers)


def main() -> None:
    """Print a row a way."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    threads, processes = ThreadPoolExecutor(given.workers), an.spmd.Processes(given.workers)
    run_jobs, many = an.spmd.run_jobs, given.workers
    ways: dict[str, Callable[[Sequence[int]], object]] = {
        "a loop of solve": lambda seeds: [an.solve(PROBLEM, ALGORITHM, seed=seed) for seed in seeds],
        "a loop of solve, executor=Serial()": costs,
        f"run_jobs, {many} threads": lambda seeds: run_jobs(cost, seeds, threads),
        f"run_jobs, {many} processes, a run a job": lambda seeds: run_jobs(cost, seeds, processes),
        f"run_jobs, {many} processes, {CHUNK} runs a job": lambda seeds: run_jobs(
            costs, [seeds[first : first + CHUNK] for first in range(0, len(seeds), CHUNK)], processes
        ),
        f"solve_many, {many} processes (one seed)": lambda seeds: list(
            an.solve_many([PROBLEM] * len(seeds), ALGORITHM, executor=processes, workers=many)
        ),
        "run_study, 1 worker": lambda seeds: in_study(seeds, 1),
        f"run_study, {many} workers": lambda seeds: in_study(seeds, many),
    }
    for way in ways.values():
        way(range(2 * CHUNK))
    kernels, taken = list[float](), {name: list[float]() for name in ways}
    for number in range(given.rounds):
        seeds = range(number * given.runs, (number + 1) * given.runs)
        kernels.append(kernel(seeds))
        for name, way in ways.items():
            begin = time.perf_counter()
            way(seeds)
            taken[name].append(time.perf_counter() - begin)
    processes.shutdown()
    print(f"the kernel alone: {1000 * min(kernels) / given.runs:.2f} ms a run, at least")
    print(f"{'way':<48}{'s for 1000':>11}{'median':>9}{'to the kernel':>15}{'median':>9}")
    for name, seconds in taken.items():
        ratios = [one / other for one, other in zip(seconds, kernels, strict=True)]
        per = 1000 / given.runs
        print(
            f"{name:<48}{per * min(seconds):>11.2f}{per * statistics.median(seconds):>9.2f}"
            f"{min(ratios):>15.2f}{statistics.median(ratios):>9.2f}"
        )


if __name__ == "__main__":
    main()
