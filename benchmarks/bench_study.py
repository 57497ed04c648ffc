"""What engines cost a study of short runs: its rate beside that of two processes that do nothing but such runs.

`python benchmarks/bench_study.py [RUNS [ROUNDS]]`. Rounds of both take turns, so that a machine that slows down slows
down both. The share of CPU seconds, those of scheduler and store included, tells less of what else runs.
"""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

import psutil

import antnav as an
from antnav.run.spmd import Processes, Serial
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.runner import run_study
from antnav.study.store import Store


def study_of(runs: int, first: int = 0) -> Study:
    """Runs of about 4 ms: npaco on equiv20."""
    ends = an.maps.builtin_query("equiv20")
    problem = an.Problem.from_cells(an.maps.builtin("equiv20"), *ends, corner_rule="allow")
    return Study(
        "bench",
        [MapEntry("map", problem)],
        [AlgorithmEntry("npaco", an.npaco(iterations=20))],
        range(first, first + runs),
    )


def bare(runs: int, first: int) -> int:
    """Runs without a study: no store, nobody to tell."""
    never = threading.Event()
    for job in study_of(runs, first).jobs():
        job.run(Serial(), never)
    return runs


def cost_of_two(executor: Executor, runs: int) -> tuple[float, float]:
    """Seconds that two workers take who need nobody, and CPU seconds of all processes."""
    with counted() as spent:
        for future in [executor.submit(bare, runs // 2, place * runs) for place in (0, 1)]:
            future.result()
    return spent[0], spent[1]


def cost_of_study(executor: Executor, runs: int) -> tuple[float, float]:
    """The same of a study, stored."""
    with tempfile.TemporaryDirectory() as folder, Store(Path(folder, "runs.sqlite")) as store, counted() as spent:
        run_study(study_of(runs), store, executor=executor, workers=2)
    return spent[0], spent[1]


@contextmanager
def counted() -> Iterator[list[float]]:
    """Seconds, and CPU seconds of this process and of those that it has started."""
    everybody = [psutil.Process(), *psutil.Process().children(recursive=True)]

    def cpu() -> float:
        return sum(times.user + times.system for times in (each.cpu_times() for each in everybody))

    spent: list[float] = []
    begin, before = time.perf_counter(), cpu()
    yield spent
    spent += [time.perf_counter() - begin, cpu() - before]


@contextmanager
def processes() -> Iterator[Executor]:
    """A pool of two."""
    pool = Processes(2)
    try:
        yield pool
    finally:
        pool.kill()


@contextmanager
def dask() -> Iterator[Executor]:
    """A local cluster of two processes."""
    import distributed

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client.get_executor()


def main() -> None:
    """Print a row an engine."""
    runs, rounds = (int(text) for text in (*sys.argv[1:], "10000", "5")[:2])
    print(f"{runs} runs a round, {rounds} rounds, medians; load {os.getloadavg()[0]:.1f}")
    print(
        "| engine | alone, runs/s | study, runs/s | share | alone, CPU ms a run | study, CPU ms a run | share of CPU |"
    )
    study_of(1).warmup()
    for name, engine in (("processes", processes), ("dask", dask)):
        with engine() as executor:
            cost_of_study(executor, 100)
            pairs = [(cost_of_two(executor, runs), cost_of_study(executor, runs)) for _ in range(rounds)]
        (alone, alone_cpu), (own, own_cpu) = (
            [statistics.median(figures) for figures in zip(*side, strict=True)] for side in zip(*pairs, strict=True)
        )
        share, share_cpu = (
            statistics.median(best[which] / reached[which] for best, reached in pairs) for which in (0, 1)
        )
        print(
            f"| {name} | {runs / alone:.0f} | {runs / own:.0f} | {share:.3f} "
            f"| {1e3 * alone_cpu / runs:.3f} | {1e3 * own_cpu / runs:.3f} | {share_cpu:.3f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
