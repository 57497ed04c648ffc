"""Tune a preset by iterated racing, as irace does: candidates meet on one instance after the other, losers leave.

    python examples/race.py --preset npaco --runs 5000 -o raced.toml
    antnav study raced.toml

An instance is a map under a seed. After the first five, Friedman's test over all instances so far says whether the
candidates differ, and those that are worse than the best by Conover's comparison leave; the runs that this saves
go to new candidates, drawn ever closer around the survivors (Lopez-Ibanez et al. 2016, doi 10.1016/j.orp.2016.09.002).
Elites keep their results, and leave only when rivals have met all of their instances.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.stats import friedmanchisquare, t
from tuning import Choices, Space, Task, final_gap, finish, parser

import antnav as an
from antnav.report.statistics import ALPHA, paired, rank_rows

FIRST_TEST = 5  #: Instances before anybody leaves.
TRIES = 1000  #: Draws until choices fit together.

Candidate = tuple[float, ...]  #: Where each parameter lies in its range, 0 to 1.


def choices_of(candidate: Candidate, space: Space) -> Choices:
    """Its parameters."""
    return {name: one.at(share) for (name, one), share in zip(space.ranges.items(), candidate, strict=True)}


def survivors(table: np.ndarray) -> np.ndarray:
    """Which candidates stay, after results of shape (instances, candidates); smaller is better."""
    blocks, count = table.shape
    if count == 2:
        test = paired(table[:, 0], table[:, 1])
        return np.array([True, True] if test.p >= ALPHA else [test.favours_first, not test.favours_first])
    ranks = rank_rows({str(index): column for index, column in enumerate(table.T)})
    if count < 2 or not np.ptp(ranks, axis=1).any() or friedmanchisquare(*ranks.T).pvalue >= ALPHA:
        return np.ones(count, bool)
    sums, freedom = ranks.sum(axis=0), (blocks - 1) * (count - 1)
    within = 2 * (blocks * (ranks**2).sum() - (sums**2).sum()) / freedom
    return sums - sums.min() <= t.ppf(1 - ALPHA / 2, freedom) * math.sqrt(max(within, 0.0))


class Racing:
    """Races over the same instances, in the same order, with the results of all candidates so far."""

    def __init__(self, task: Task, budget: int) -> None:
        self._task, self.left = task, budget
        self._random = np.random.default_rng(task.given.seed)
        self._gaps: dict[Candidate, list[float]] = {}
        self._sizes = 2 + int(math.log2(len(task.space.ranges)))  # of races, and of survivors

    def iterated(self) -> Iterator[list[Candidate]]:
        """The elites of each race, best first."""
        space = self._task.space
        elites: list[Candidate] = [tuple(one.share(space.default[name]) for name, one in space.ranges.items())]
        width = 0.5
        for number in range(1, self._sizes + 1):
            budget = self.left // (self._sizes - number + 1)
            fresh = budget // (FIRST_TEST + min(number, 5)) - len(elites)
            if fresh < 1:
                return
            new = [self._drawn(elites, width if number > 1 else math.inf) for _ in range(fresh)]
            elites = self._race(list(dict.fromkeys([*elites, *new])), budget)
            width *= fresh ** (-1 / len(space.ranges))
            yield elites

    def _drawn(self, elites: Sequence[Candidate], width: float) -> Candidate:
        """A new candidate, near an elite: the better, the more often."""
        space = self._task.space
        weights = np.arange(len(elites), 0, -1)
        for _ in range(TRIES):
            if math.isinf(width):
                drawn = self._random.random(len(elites[0])).tolist()
            else:
                parent = elites[self._random.choice(len(elites), p=weights / weights.sum())]
                drawn = [self._near(share, width) for share in parent]
            choices = choices_of(tuple(drawn), space)
            if space.allows(choices):  # what rounds to the same values is the same candidate
                return tuple(one.share(choices[name]) for name, one in space.ranges.items())
        raise SystemExit(f"error: hardly any choices of {', '.join(space.ranges)} fit together; tune fewer of them")

    def _near(self, share: float, width: float) -> float:
        """Of a normal distribution cut off at the ends of the range."""
        while not 0 <= (drawn := float(self._random.normal(share, width))) <= 1:
            pass
        return drawn

    def _race(self, alive: list[Candidate], budget: int) -> list[Candidate]:
        """Those that are left, best first."""
        instances = self._task.training
        met = {candidate: len(self._gaps.setdefault(candidate, [])) for candidate in alive}
        spent = done = 0
        while done < len(instances) and (done < FIRST_TEST or len(alive) > self._sizes or done < max(met.values())):
            new = [candidate for candidate in alive if len(self._gaps[candidate]) == done]
            if spent + len(new) > budget:
                break
            self._meet(new, done)
            spent, done = spent + len(new), done + 1
            if done >= FIRST_TEST:
                stays = survivors(self._table(alive, done))
                alive = [one for one, stay in zip(alive, stays, strict=True) if stay or met[one] > done]
        self.left -= spent
        ranks = rank_rows({str(one): self._gaps[one][:done] for one in alive}).mean(axis=0)
        return [alive[index] for index in np.argsort(ranks, kind="stable")[: self._sizes]]

    def _meet(self, candidates: Sequence[Candidate], number: int) -> None:
        instance, space = self._task.training[number], self._task.space
        jobs = [(instance, space.algorithm(choices_of(candidate, space))) for candidate in candidates]
        for candidate, gap in zip(candidates, an.spmd.run_jobs(final_gap, jobs, self._task.executor), strict=True):
            self._gaps[candidate].append(gap)

    def _table(self, candidates: Sequence[Candidate], instances: int) -> np.ndarray:
        return np.array([self._gaps[candidate][:instances] for candidate in candidates]).T

    def told(self, elites: Sequence[Candidate]) -> str:
        """What came of a race."""
        best, known = elites[0], len(self._gaps[elites[0]])
        gap = 100 * float(np.mean(self._gaps[best]))
        return (
            f"{len(elites)} elites, {self.left} runs left; the best has a mean gap of {gap:.2f} % on {known} instances"
        )


def told(given: argparse.Namespace) -> Iterator[str]:
    """Race, and judge."""
    task = Task.of(given)
    racing = Racing(task, 400 if given.quick else given.runs)
    yield f"{racing.left} runs on {len(task.training)} instances; {', '.join(task.space.ranges)} of {given.preset}"
    best = tuple[float, ...]()
    for elites in racing.iterated():
        yield racing.told(elites)
        best = elites[0]
    if not best:
        raise SystemExit(f"error: {given.runs} runs are too few for a race; give 100 or more")
    task.tell(choices_of(best, task.space))


def main(arguments: list[str] | None = None) -> int:
    """Tune a preset, and judge what was found."""
    options = parser(__doc__)
    options.add_argument("--runs", type=int, default=5000, help="budget")
    return finish(told(options.parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
