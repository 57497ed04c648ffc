"""What tune_optuna.py and race.py share: what is tuned, on what, and how the winner is judged.

Both are given two study files (docs/studies.md): the maps and seeds of one are for choosing, those of the other for
judging, and nothing of the second is seen before the choice is made.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import antnav as an
from antnav.cli.query import choices_of
from antnav.colony.parameters import Decomposition
from antnav.colony.parts import parameters_of
from antnav.errors import ParameterError
from antnav.files import write_whole
from antnav.plugins.loading import load_all
from antnav.report.statistics import TIE, interval, paired
from antnav.study.toml import load_study

HERE = Path(__file__).parent
#: What counts as no path at all: an ant that needs twice the shortest way is as good as lost, and means stay finite.
LOST = 1.0
#: Ranges whose ends differ by this factor are searched by orders of magnitude.
DECADES = 20

Choices = dict[str, float]  #: Parameters of a preset by their names.


class Range(NamedTuple):
    """Where a parameter is looked for."""

    low: float
    high: float
    whole: bool

    @property
    def log(self) -> bool:
        """Whether 0.02 to 0.04 is as long a way as 0.2 to 0.4."""
        return self.low > 0 and self.high / self.low >= DECADES

    def at(self, share: float) -> float:
        """The value so far along the range, with no more digits than are printed."""
        if self.log:
            return self.rounded(self.low * (self.high / self.low) ** share)
        return self.rounded(self.low + (self.high - self.low) * share)

    def share(self, value: float) -> float:
        """Where a value lies, 0 to 1: the way back."""
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def rounded(self, value: float) -> float:
        """The value as it is run and printed alike."""
        return round(value) if self.whole else float(f"{value:.3g}")


class Space:
    """Parameters of a preset, or of an algorithm of your own, in the ranges that antnav calls sane.

    What is fixed is what all candidates have beside that, such as a pheromone rule of your own.

    The budget stays: more ants get fewer iterations. Otherwise tuning would find that more work is better.
    """

    def __init__(self, preset: str, names: Sequence[str] = (), fixed: Mapping[str, Any] | None = None) -> None:
        self.preset, self.fixed = preset, dict(fixed or {})
        default = self._made({})
        if not isinstance(default, an.Algorithm):
            raise SystemExit(f"error: {preset}: it has no ants to be tuned")
        self._default = default
        if twice := self.fixed.keys() & set(names):
            raise SystemExit(f"error: {', '.join(sorted(twice))}: either fixed by --set or tuned")
        known = parameters_of(an.Algorithm) | parameters_of(Decomposition)
        own = [name for part in self._default.parts.values() for name in part.parameters]
        for part in self._default.parts.values():
            known = known | part.parameters
        values = self._default.choices()
        stages = ["stage_one"] if self._default.decomposition else []
        names = names or [name for name in ["ants", "alpha", "beta", "rho", *own, *stages] if name not in self.fixed]
        self.default: Choices = {}
        self.ranges: dict[str, Range] = {}
        for name in names:
            if name == "iterations":
                raise SystemExit("error: iterations: they follow from the budget and the ants")
            if name not in known or name not in values:
                raise SystemExit(
                    f"error: {name}: {preset} has no parameter of that name; see: antnav algorithms {preset}"
                )
            low, high = known[name].sane or (math.nan, math.nan)
            if math.isfinite(low) and values[name] is not None and low <= values[name] <= high:
                self.default[name] = values[name]
                self.ranges[name] = Range(low, high, isinstance(known[name].default, int))
        if not self.ranges:
            raise SystemExit(f"error: {', '.join(names)}: antnav knows no sane range around these values of {preset}")
        self.algorithm(self.default)  # an algorithm of your own may not take them all

    def algorithm(self, choices: Mapping[str, float]) -> an.Algorithm:
        """The preset with these choices, and not more walks than it has by itself."""
        return self._made(self.full(choices))

    def _made(self, choices: Mapping[str, Any]) -> Any:
        return an.algorithm(self.preset, **{**self.fixed, **choices})

    def allows(self, choices: Mapping[str, float]) -> bool:
        """Whether they fit together, such as a first stage and what the budget leaves for the second."""
        try:
            self.algorithm(choices)
        except ParameterError:
            return False
        return True

    def full(self, choices: Mapping[str, float]) -> Choices:
        """The choices, rounded, with the iterations that the budget leaves."""
        rounded = {name: self.ranges[name].rounded(value) for name, value in choices.items()}
        budget = self._default.walks
        near = self._made(rounded).with_walks(budget)
        iterations = near.iterations - (near.walks > budget)
        return rounded if iterations == self._default.iterations else rounded | {"iterations": iterations}


@dataclass(frozen=True, eq=False)
class Instance:
    """A problem under a seed: what one run is about."""

    map: str
    problem: an.Problem
    seed: int

    def gap(self, cost: float) -> float:
        """How far above the optimum a cost is: 0.01 for 1 %, at most `LOST`."""
        return min(cost / an.exact.optimum(self.problem).cost - 1, LOST)


def instances(file: Path, *, maps: int | None = None, seeds: int | None = None) -> list[Instance]:
    """Every map of a study file under its first seed, then under its second, and so on."""
    study = load_study(file)
    for entry in study.maps:
        if not 0 < an.exact.optimum(entry.problem).cost < math.inf:
            raise SystemExit(f"error: {file}, map {entry.label}: there is no way to be found")
    return [Instance(entry.label, entry.problem, seed) for seed in study.seeds[:seeds] for entry in study.maps[:maps]]


def final_gap(job: tuple[Instance, an.Algorithm]) -> float:
    """Of one whole run, in one thread."""
    instance, algorithm = job
    return instance.gap(an.solve(instance.problem, algorithm, seed=instance.seed, executor=an.spmd.Serial()).cost)


def final_gaps(algorithm: an.Algorithm, where: Sequence[Instance], executor: Executor) -> np.ndarray:
    """Of a run on each instance."""
    return np.array(an.spmd.run_jobs(final_gap, [(instance, algorithm) for instance in where], executor))


def judged(space: Space, choices: Choices, where: Sequence[Instance], executor: Executor) -> str:
    """The preset as it comes and as it was tuned, on the maps that had no say.

    Seeds on one map share its difficulty, so that a map counts once: its mean over seeds.
    """
    maps = list(dict.fromkeys(instance.map for instance in where))
    of = np.array([maps.index(instance.map) for instance in where])
    gaps = [final_gaps(space.algorithm(one), where, executor) for one in (space.default, choices)]
    before, after = (np.array([gap[of == index].mean() for index in range(len(maps))]) for gap in gaps)
    lines = [f"judged on {len(maps)} other maps x {len(where) // len(maps)} seeds:"]
    for name, gap, means in (("default", gaps[0], before), ("tuned", gaps[1], after)):
        low, high = interval(means)
        lines.append(
            f"  {name:8} {space.preset}: mean gap {_percent(means.mean())} ({_percent(low)} to {_percent(high)}), "
            f"optimal in {100 * np.mean(gap < TIE):.1f} % of runs, lost {100 * np.mean(gap >= LOST):.1f} %"
        )
    low, high = interval(after - before)
    test = paired(after, before)
    lines.append(
        f"  tuned - default: {100 * np.mean(after - before):+.2f} points "
        f"({100 * low:+.2f} to {100 * high:+.2f}); "
        f"better on {test.shorter} maps, worse on {test.longer} (Wilcoxon p = {test.p:.2g})"
    )
    return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100 * share:.2f} %"


def parser(description: str | None) -> argparse.ArgumentParser:
    """The options that both have."""
    made = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--plugin", action="append", default=[], type=Path, metavar="FILE.py", help="registers your own")
    made.add_argument("--preset", default="npaco", metavar="NAME", help="or an algorithm of your own")
    made.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="fixed: pheromone=near_best")
    made.add_argument("--parameters", default="", metavar="A,B", help="what is tuned; default: what moves ants")
    made.add_argument("--training", type=Path, default=HERE / "tuning_training.toml", metavar="STUDY.toml")
    made.add_argument("--judging", type=Path, default=HERE / "tuning_judging.toml", metavar="STUDY.toml")
    made.add_argument("-o", "--output", type=Path, metavar="FILE.toml", help="the judging study with the winner in it")
    made.add_argument("--seed", type=int, default=0, help="of the search; the same seed finds the same")
    made.add_argument("--workers", type=int, default=2, help="threads; they change nothing but the time")
    made.add_argument("--quick", action="store_true", help="few runs, to see that it works")
    return made


@dataclass(frozen=True, eq=False)
class Task:
    """What the options ask for."""

    space: Space
    training: Sequence[Instance]
    judging: Sequence[Instance]
    executor: Executor
    given: argparse.Namespace

    @classmethod
    def of(cls, given: argparse.Namespace, seeds: int | None = None) -> Task:
        """Read the files; of that for training so many seeds, or all."""
        load_all(given.plugin)
        few = {"maps": 4, "seeds": 3} if given.quick else {}
        space = Space(given.preset, [name for name in given.parameters.split(",") if name], choices_of(given.set))
        if given.output and None in space.fixed.values():
            raise SystemExit("error: --set NAME=none: study files cannot say that; leave out -o")
        executor = an.spmd.executor_for(given.workers)
        return cls(
            space, instances(given.training, **{"seeds": seeds} | few), instances(given.judging, **few), executor, given
        )

    def tell(self, choices: Choices) -> None:
        """Print and save the winner."""
        full, preset = self.space.full(choices), self.space.preset
        fixed = {name: value for name, value in self.space.fixed.items() if name not in full}
        said = ", ".join(
            [*(f"{key}={value!r}" for key, value in fixed.items()), *(f"{k}={v:g}" for k, v in full.items())]
        )
        print(f"an.{preset}({said})" if preset in an.PRESETS else f"an.algorithm({preset!r}, {said})")
        print(judged(self.space, choices, self.judging, self.executor))
        if self.given.output:
            entry = [f"preset = {json.dumps(preset)}", f"label = {json.dumps(f'{preset}, tuned')}"]
            entry += [f"{key} = {json.dumps(value)}" for key, value in fixed.items()]
            entry += [f"{key} = {value:g}" for key, value in full.items()]
            text = self.given.judging.read_text(encoding="utf-8")
            content = "\n".join([*self._plugins(text), text.rstrip(), "", "[[algorithms]]", *entry, ""])
            write_whole(self.given.output, content.encode())
            print(f"antnav study {self.given.output}")

    def _plugins(self, study: str) -> list[str]:
        """The line of a study file that loads the plugins; none where it has such a line."""
        if not self.given.plugin or "plugins" in tomllib.loads(study):
            return []
        folder = self.given.output.absolute().parent
        files = [Path(os.path.relpath(file, folder)).as_posix() for file in self.given.plugin]
        return [f"plugins = {json.dumps(files)}"]


def finish(main: Iterator[str]) -> int:
    """Print what is told on the way; errors in one line."""
    try:
        for line in main:
            print(line, flush=True)
    except an.AntnavError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return 0
