"""PACO against NPACO on two workers, seed by seed in turn: `python benchmarks/bench_paco.py`.

Reported, as medians over seeds: wall and CPU time, ant steps of each colony, the critical path (the longer colony of
each stage), the wall time over what the steps of that path cost at NPACO's price a step ("at npaco's"), and over what
they cost the colonies themselves in CPU time ("at own"): half a problem has fewer steps in an iteration to share its
fixed costs.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Sequence

import antnav as an
from antnav import maps

VARIANTS = {
    "npaco": an.npaco(),
    "paco": an.paco(axis="row"),
    "paco, half": an.paco(axis="row", search="half"),
    "paco, inherit": an.paco(axis="row", inherit=True),
    "paco, forward": an.paco(axis="row", deposit="forward"),
    "npaco, forward": an.npaco(deposit="forward"),
    "paco_extended": an.paco_extended(axis="row"),
}


def median(values: Sequence[float]) -> float:
    return statistics.median(values)


def critical_cpu(result: an.Result) -> float:
    """CPU seconds of the longer colony of each stage."""
    return sum(max(colony.cpu_seconds for colony in stage.colonies) for stage in result.stages)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--rounds", type=int, default=5, help="runs of each seed, of which the fastest counts")
    options = parser.parse_args()
    an.warmup()
    head = ("algorithm", "mean", "optimal", "wall ms", "CPU ms", "stage one", "stage two")
    head += ("critical", "of npaco", "at npaco's", "at own", "saved")
    print(("{:<16}" + "{:>11}" * 3 + "{:>9}" + "{:>17}" * 2 + "{:>10}" * 2 + "{:>11}{:>8}{:>8}").format(*head))
    for name in ("equiv20", "equiv30", "equiv40"):
        problem = an.Problem.from_cells(maps.builtin(name), *maps.builtin_query(name), corner_rule="allow")
        an.solve(problem, an.paco(axis="row"))
        runs: dict[str, list[an.Result]] = {variant: [] for variant in VARIANTS}
        for seed in range(options.seeds):
            best: dict[str, an.Result] = {}
            for _ in range(options.rounds):
                for variant, algorithm in VARIANTS.items():
                    result = an.solve(problem, algorithm, seed=seed)
                    if variant not in best or result.seconds_run < best[variant].seconds_run:
                        best[variant] = result
            for variant, result in best.items():
                runs[variant].append(result)
        price = median([result.seconds_run / result.steps for result in runs["npaco"]])
        undivided = median([result.seconds_run for result in runs["npaco"]])
        print(f"{name}: NPACO pays {price * 1e9:.1f} ns a step, all told")
        for variant, results in runs.items():
            critical = median([result.critical_steps for result in results])
            wall = median([result.seconds_run for result in results])
            stages = [
                " | ".join(
                    f"{median([r.stages[s].colonies[c].steps for r in results]):.0f}"
                    for c in range(len(results[0].stages[s].colonies))
                )
                if s < len(results[0].stages)
                else "-"
                for s in (0, 1)
            ]
            beside = median([result.seconds_run / (result.critical_steps * price) for result in results])
            own = median([result.seconds_run / critical_cpu(result) for result in results])
            cpu = median([r.cpu_seconds for r in results])
            share = critical / median([r.steps for r in runs["npaco"]])
            print(
                f"{variant:<16}{statistics.mean(r.length for r in results):>11.4f}"
                f"{sum(r.gap < 1e-9 for r in results):>8}/{len(results)}{1e3 * wall:>11.2f}{1e3 * cpu:>9.2f}"
                f"{stages[0]:>17}{stages[1]:>17}{critical:>10.0f}"
                f"{share:>9.0%}{beside:>11.2f}{own:>8.2f}{1 - wall / undivided:>8.0%}"
            )


if __name__ == "__main__":
    main()
