"""Ants without exact help on drawn maps: how often they find the optimum, and what that costs in processor time.

Problem number i is drawn from `numpy.random.default_rng(i)`, so problems are ranges of numbers. What `two_ended` is was
chosen on those from `TUNING` on; figures in the docs are of those from `JUDGING` on, which nobody looked at before, or
from `AFRESH` on for what was chosen after these were known.

    python benchmarks/bench_pure_ants.py [--numbers judging] [--problems 1000] [--seeds 5] [--large] [ALGORITHM ...]
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time
from collections.abc import Iterator

import numpy as np

import antnav as an
from antnav import maps
from antnav.search import exact

#: First numbers of the problems that presets were chosen on, and of those that judge them: 100,000 of each.
TUNING, JUDGING, AFRESH = 0, 100_000, 200_000
#: Kinds of maps, by turns: options of `maps.generate`, of which a pair is a range to draw from.
KINDS = (
    ("random", {"density": (0.15, 0.4)}),
    ("random", {"density": (0.15, 0.4), "block": 2}),
    ("rooms", {"room": 6, "door": 1}),
    ("rooms", {}),
    ("maze", {"passage": 1, "loops": (0.0, 0.5)}),
    ("maze", {"passage": 3, "loops": (0.0, 0.5)}),
    ("caves", {"density": (0.38, 0.46)}),
    ("u_traps", {}),
    ("warehouse", {}),
)
RULES = ("allow", "forbid")
SMALL, LARGE = (20, 50), (60, 100)


def problem(number: int, rule: str, sides: tuple[int, int] = SMALL) -> an.Problem:
    """Every other one from end to end of its map, else between two drawn cells at least half a side apart."""
    rng = np.random.default_rng(number)
    kind, ranges = KINDS[number % len(KINDS)]
    rows, cols = (int(side) for side in rng.integers(*sides, size=2, endpoint=True))
    options = {name: rng.uniform(*value) if isinstance(value, tuple) else value for name, value in ranges.items()}
    grid = maps.generate(kind, rows, cols, seed=number, **options)
    ends = maps.ends(grid)
    found = an.Problem.from_cells(grid, *ends, corner_rule=rule)
    if number // len(KINDS) % 2:
        # of the rule that allows less, so that both rules have the same ends
        least = an.Problem.from_cells(grid, *ends, corner_rule="forbid")
        cells = least.graph.cells
        for _ in range(100):
            start, goal = cells[rng.integers(len(cells), size=2)]
            if np.hypot(*(start - goal)) >= max(rows, cols) / 2:
                return an.Problem.from_cells(grid, tuple(map(int, start)), tuple(map(int, goal)), corner_rule=rule)
    return found


def problems(first: int, count: int, sides: tuple[int, int] = SMALL) -> Iterator[tuple[int, str, an.Problem]]:
    """Problems of consecutive numbers, under each corner rule."""
    for number in range(first, first + count):
        for rule in RULES:
            yield number, rule, problem(number, rule, sides)


class Tally:
    """What an algorithm brought."""

    def __init__(self) -> None:
        self.gaps: list[float] = []
        self.milliseconds: list[float] = []  #: of processor time, on maps of about the middle side
        self.missed: list[str] = []

    def row(self) -> str:
        arrived = [gap for gap in self.gaps if math.isfinite(gap)]
        optimal, within = (100 * sum(gap <= most for gap in self.gaps) / len(self.gaps) for most in (1e-9, 0.01))
        taken = statistics.median(self.milliseconds) if self.milliseconds else math.nan
        means = f"{100 * statistics.mean(arrived):>10.3f}{100 * max(self.gaps):>9.2f}" if arrived else " " * 19
        return f"{len(self.gaps):>7}{optimal:>11.2f}{within:>12.2f}{means}{taken:>9.1f}"


def algorithm(text: str) -> an.Algorithm:
    """A preset, and choices: `two_ended,colonies=4,local_search=weave`. No heuristic knows exact distances."""
    name, *choices = text.split(",")
    given = dict(choice.split("=") for choice in choices)
    pure = {} if name == "two_ended" else {"heuristic": "target"}  # "auto" is `detour` beyond 40 cells
    return an.preset(name, **pure, **{key: _value(value) for key, value in given.items()})


def _value(text: str) -> object:
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("algorithms", nargs="*", default=["two_ended", "npaco", "paco", "gao"])
    ranges = {"tuning": TUNING, "judging": JUDGING, "afresh": AFRESH}
    parser.add_argument("--numbers", choices=ranges, default="judging")
    parser.add_argument("--problems", type=int, default=1000)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--large", action="store_true", help="sides of 60 to 100 cells instead of 20 to 50")
    options = parser.parse_args()
    an.warmup()
    first = ranges[options.numbers]
    sides, middle = (LARGE, 80) if options.large else (SMALL, 40)
    algorithms = {name: algorithm(name) for name in options.algorithms}
    tallies = {name: Tally() for name in options.algorithms}
    for number, rule, one in problems(first, options.problems, sides):
        optimum = exact.shortest_path(one).path
        assert optimum is not None
        for name, tally in tallies.items():
            for seed in range(options.seeds):
                begin = time.thread_time()
                result = an.solve(one, algorithms[name], seed=seed, executor=an.spmd.Serial())
                seconds = time.thread_time() - begin
                gap = result.length / optimum.length - 1 if result.path else math.inf
                tally.gaps.append(gap)
                if abs(max(one.grid.shape) - middle) <= middle / 10:
                    tally.milliseconds.append(1000 * seconds)
                if gap > 1e-9:
                    tally.missed.append(f"{number} {rule} seed {seed}: {100 * gap:.2f} %")
    columns = f"{'runs':>7}{'optimal %':>11}{'within 1 %':>12}{'mean %':>10}{'worst %':>9}{f'ms at {middle}':>9}"
    print(f"{'algorithm':<24}{columns}")
    for name, tally in tallies.items():
        print(f"{name:<24}{tally.row()}")
    for name, tally in tallies.items():
        if len(tally.missed) <= 60:
            print(f"\n{name} missed", *tally.missed, sep="\n  ")


if __name__ == "__main__":
    main()
