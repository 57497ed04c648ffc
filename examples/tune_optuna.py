"""Tune a preset with optuna: trials are asked for and told, and bad ones end after a few iterations.

    pip install "antnav[tune]"
    python examples/tune_optuna.py --preset npaco --trials 100 -o tuned.toml
    antnav study tuned.toml

The runs of a trial, one on each problem and seed, go on side by side, a tenth of their iterations at a time; their mean
gap to the exact optimum is reported after each tenth, and a trial worse than the median of the earlier ones at that
point ends (docs/tuning.md). The preset as it comes is the first trial.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator
from itertools import islice

import numpy as np
from tuning import Choices, Instance, Space, Task, finish, parser

import antnav as an

try:
    import optuna
except ImportError as error:
    raise SystemExit('error: optuna is missing; run: pip install "antnav[tune]"') from error

TENTHS = 10


class Run:
    """A run on an instance that can be left off after any iteration."""

    def __init__(self, instance: Instance, algorithm: an.Algorithm) -> None:
        self._instance = instance
        self._steps = an.Steps(instance.problem, algorithm, seed=instance.seed)
        self._left = iter(self._steps)
        self._best = math.inf

    def advance(self, iterations: int | None) -> float:
        """The gap after so many more iterations; None: at the end, with what comes after the ants."""
        for step in islice(self._left, iterations):
            self._best = min(self._best, step.best)
        return self._instance.gap(self._best if self._steps.result is None else self._steps.result.cost)


def distributions(space: Space) -> dict[str, optuna.distributions.BaseDistribution]:
    """The ranges as optuna knows them."""
    kinds = optuna.distributions.FloatDistribution, optuna.distributions.IntDistribution
    return {name: kinds[one.whole](one.low, one.high, log=one.log) for name, one in space.ranges.items()}


def value_of(trial: optuna.Trial, task: Task) -> float | None:
    """The mean gap of a trial; None where it was pruned."""
    algorithm = task.space.algorithm(trial.params)
    runs = [Run(instance, algorithm) for instance in task.training]
    ends = np.linspace(0, algorithm.iterations, TENTHS + 1).round().astype(int)
    for tenth, more in enumerate(np.diff(ends).tolist(), start=1):
        iterations = None if tenth == TENTHS else more
        value = float(np.mean(an.spmd.run_jobs(Run.advance, runs, task.executor, iterations)))
        trial.report(value, tenth)
        if iterations is not None and trial.should_prune():
            return None
    return value


def tuned(task: Task, trials: int) -> tuple[Choices, optuna.Study]:
    """The best choices of so many trials."""
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    study = optuna.create_study(
        sampler=optuna.samplers.TPESampler(seed=task.given.seed),
        pruner=optuna.pruners.MedianPruner(n_startup_trials=5, n_warmup_steps=1),
    )
    study.enqueue_trial(task.space.default)
    for _ in range(trials):
        trial = study.ask(distributions(task.space))
        value = value_of(trial, task) if task.space.allows(trial.params) else None
        if value is None:
            study.tell(trial, state=optuna.trial.TrialState.PRUNED)
        else:
            study.tell(trial, value)
    return study.best_params, study


def told(given: argparse.Namespace) -> Iterator[str]:
    """Tune, and judge."""
    task = Task.of(given, seeds=given.seeds)
    yield f"{len(task.training)} runs a trial, on training maps; {', '.join(task.space.ranges)} of {given.preset}"
    choices, study = tuned(task, 8 if given.quick else given.trials)
    pruned = sum(trial.state is optuna.trial.TrialState.PRUNED for trial in study.trials)
    yield f"{len(study.trials)} trials, {pruned} of them pruned"
    yield f"mean gap in training: {100 * study.trials[0].value:.2f} % -> {100 * study.best_value:.2f} %"
    task.tell(choices)


def main(arguments: list[str] | None = None) -> int:
    """Tune a preset, and judge what was found."""
    options = parser(__doc__)
    options.add_argument("--trials", type=int, default=100)
    options.add_argument("--seeds", type=int, default=5, help="so many of the training file's, on each of its maps")
    return finish(told(options.parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
