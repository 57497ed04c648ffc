"""Shard: one of several parts of a study, each done by itself, such as in a job array."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Self, TypeVar

from antnav.errors import ParameterError, shown
from antnav.study.budget import Budget
from antnav.study.model import AnyJob, AnyStudy
from antnav.study.record import Kept
from antnav.values import whole_in

R = TypeVar("R", bound=Kept)

#: Most parts of a study.
MOST = 1_000_000
#: Parts that are named in one line.
MOST_TOLD = 20


@dataclass(frozen=True)
class Shard:
    """The part `number` of `count`, from 1 on.

    Raises
    ------
    ParameterError
        There is no such part.
    """

    number: int
    count: int

    def __post_init__(self) -> None:
        whole_in("count of shards", self.count, 1, MOST)
        whole_in("number of a shard", self.number, 1, self.count)

    @classmethod
    def of(cls, text: str) -> Self:
        """The shard of a text such as 3/10."""
        match = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text)
        if match is None:
            raise ParameterError(f"shard {shown(text)}", "it is I/N, the I-th of N parts", "give one, such as 1/10")
        return cls(int(match[1]), int(match[2]))

    @property
    def file_name(self) -> str:
        """Of the store of its runs."""
        return f"runs-{self.number}-of-{self.count}.sqlite"

    def jobs(self, study: AnyStudy[R]) -> list[AnyJob[R]]:
        """The runs of this part, in the order of `study.jobs()`.

        Runs are dealt out like cards, and maps and algorithms rotate from seed to seed, so that a part has about as
        many runs of each. Runs of one budget stay together, and more seeds leave the runs of others where they are.
        """
        jobs = study.jobs()
        maps, algorithms = len(study.maps), len(study.algorithms)
        together = study.equal_budget in (Budget.STEPS, Budget.SECONDS)
        parts = dict[str, int]()
        mine = []
        for index, job in enumerate(jobs):
            group, algorithm = divmod(index, algorithms)
            seed, place = divmod(group, maps)
            row = seed * maps + (place + seed) % maps
            part = row if together else row * algorithms + (algorithm + place + seed) % algorithms
            if not together:  # names for one thing
                part = parts.setdefault(job.key, part)
            if part % self.count == self.number - 1:
                mine.append(job)
        return mine


def jobs_of(study: AnyStudy[Any], shard: Shard | None) -> list[AnyJob[Any]]:
    """All runs of a study, or those of a part."""
    return study.jobs() if shard is None else shard.jobs(study)


def absent(names: Iterable[str]) -> str:
    """Which parts have no store among files of these names, in one line; "" where none lacks, or nobody can say."""
    found = defaultdict[int, set[int]](set)
    for name in names:
        if match := re.fullmatch(r"runs-(\d{1,7})-of-(\d{1,7})\.sqlite", name):
            found[int(match[2])].add(int(match[1]))
    told = []
    for count, numbers in found.items():
        lacking = [str(number) for number in range(1, min(count, MOST) + 1) if number not in numbers]
        if lacking:
            more = f" and {len(lacking) - MOST_TOLD} more" if len(lacking) > MOST_TOLD else ""
            parts, verb = ("parts", "are") if len(lacking) > 1 else ("part", "is")
            told.append(f"{parts} {', '.join(lacking[:MOST_TOLD])}{more} of {count} {verb} missing")
    return "; ".join(told)
