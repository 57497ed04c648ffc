"""Replay: what became of a robot in a scenario, tick by tick, and what is measured on that."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError
from antnav.files import as_path, write_whole
from antnav.live.update import MissionStatus
from antnav.planner.document import finite
from antnav.scenarios.known import Noticed
from antnav.scenarios.scenario import Event, Scenario
from antnav.values import read_only
from antnav.world.problem import CellIndex, Problem

#: Rates in Hz whose period a replan may miss.
RATES = (10, 100, 1000)


class Tick(NamedTuple):
    """One tick: something happens, the robot replans where that is news, and drives.

    Attributes
    ----------
    tick : int
    row, col : int
        The robot's cell when the tick begins.
    status : MissionStatus
        Of the plan in force.
    cost : float
        Of the plan, in cells; inf without one.
    changed_share : float
        Share of the plan's cells that the plan of the tick before did not have; 0 without a plan.
    noticed : int
        Cells whose state or price was news.
    left_out : int
        1 where something stood on the robot's cell.
    moves : int
        From cell to cell, in this tick.
    length, paid : float
        Of these moves, in cells: their length, and what they cost at the prices of the moment.
    failure : str
        What was wrong with the plan or its verdict, see `replay`; or a collision.
    seconds : float
        CPU time of the thread for the replan, or for taking note that the robot has moved.
    idle_seconds : float
        The same for the rounds of improvement.
    """

    tick: int
    row: int
    col: int
    status: MissionStatus
    cost: float
    changed_share: float
    noticed: int
    left_out: int
    moves: int
    length: float
    paid: float
    failure: str
    seconds: float
    idle_seconds: float


#: Columns that differ from run to run.
TIMES = ("seconds", "idle_seconds")


class Frame(NamedTuple):
    """What a film shows of a tick.

    Attributes
    ----------
    tick : int
    position : (row, col)
        The robot's cell when the tick begins.
    status : MissionStatus
    plan : ndarray of int32, shape (k, 2), or None
        The plan in force, the robot's cell first.
    happened : Event or None
        What the scenario changes at this tick.
    noticed : Noticed
        What of it, and of earlier changes, the robot learns.
    """

    tick: int
    position: CellIndex
    status: MissionStatus
    plan: NDArray[np.int32] | None
    happened: Event | None
    noticed: Noticed


@dataclass(frozen=True, eq=False)
class Replay:
    """What became of a robot in a scenario. Everything but times is the same for the same scenario and choices.

    Attributes
    ----------
    scenario : Scenario
    problem : Problem
        The map at rest, start and goal.
    algorithm : str
        The replanner's name.
    improve : int
        Rounds of improvement after each change.
    verified : bool
        Whether every plan and every verdict was checked.
    ticks : tuple of Tick
    optimum : float
        Length in cells of the exact shortest path on the map at rest, all of it known: what a robot needs where nothing
        happens. Inf where there is none.
    seconds_first : float
        CPU time of the first plan.
    """

    scenario: Scenario
    problem: Problem = field(repr=False)
    algorithm: str
    improve: int
    verified: bool
    ticks: tuple[Tick, ...] = field(repr=False)
    plans: tuple[NDArray[np.int32] | None, ...] = field(repr=False)
    news: tuple[Noticed, ...] = field(repr=False)
    optimum: float
    seconds_first: float

    def __len__(self) -> int:
        return len(self.ticks)

    def __repr__(self) -> str:
        end = "arrived" if self.arrived else "not arrived"
        return (
            f"Replay({self.scenario.name!r} with {self.algorithm}: {end}, {len(self)} ticks, {len(self.times)} replans)"
        )

    @property
    def frames(self) -> Iterator[Frame]:
        """Tick by tick, what a film shows."""
        happened = {event.tick: event for event in self.scenario.events}
        for tick, plan, noticed in zip(self.ticks, self.plans, self.news, strict=True):
            yield Frame(tick.tick, (tick.row, tick.col), tick.status, plan, happened.get(tick.tick), noticed)

    @property
    def arrived(self) -> bool:
        """Whether the robot got to its goal."""
        return bool(self.ticks) and self.ticks[-1].status is MissionStatus.ARRIVED

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """CPU seconds of each replan: of each tick with news for the robot."""
        return read_only(np.array([tick.seconds for tick in self.ticks if tick.noticed]))

    def percentile(self, share: float) -> float:
        """Time in CPU seconds that this share of replans, 0 to 1, stays within; nan without any."""
        return float(np.quantile(self.times, share)) if len(self.times) else math.nan

    @property
    def mean(self) -> float:
        """Mean CPU seconds of a replan; nan without any."""
        return float(self.times.mean()) if len(self.times) else math.nan

    def missed(self, rate: float) -> int:
        """Replans that took longer than the period of a rate in Hz."""
        return int((self.times > 1.0 / rate).sum())

    @property
    def seconds_total(self) -> float:
        """CPU seconds of all: first plan, replans, moves, improvement."""
        return self.seconds_first + math.fsum(tick.seconds + tick.idle_seconds for tick in self.ticks)

    @property
    def travelled(self) -> float:
        """Length that the robot drove, in cells."""
        return math.fsum(tick.length for tick in self.ticks)

    @property
    def paid(self) -> float:
        """What its moves cost at the prices of their moments, in cells; the length where nothing costs."""
        return math.fsum(tick.paid for tick in self.ticks)

    @property
    def detour(self) -> float:
        """Travelled length over the optimum at rest; nan where the robot did not arrive.

        The optimum at rest knows of no event: in scenarios that only close cells, no robot can do better, and one that
        knew all moments in advance may need more.
        """
        return self.travelled / self.optimum if self.arrived and 0 < self.optimum < math.inf else math.nan

    @property
    def waits(self) -> int:
        """Ticks at which the robot did not move."""
        return sum(tick.moves == 0 and tick.status is not MissionStatus.ARRIVED for tick in self.ticks)

    @property
    def plan_changes(self) -> int:
        """Ticks whose plan leads over cells that the one before did not."""
        return sum(tick.changed_share > 0 for tick in self.ticks)

    @property
    def changed_share(self) -> float:
        """Mean share of the plan that changes in a replan that leaves a plan; nan without any."""
        shares = [tick.changed_share for tick in self.ticks if tick.noticed and tick.status is MissionStatus.PLANNED]
        return math.fsum(shares) / len(shares) if shares else math.nan

    @property
    def left_out(self) -> int:
        """Ticks at which something stood on the robot's cell."""
        return sum(tick.left_out for tick in self.ticks)

    @property
    def failures(self) -> tuple[str, ...]:
        """Plans that were broken, verdicts that were wrong, collisions, with their ticks."""
        return tuple(f"tick {tick.tick}: {tick.failure}" for tick in self.ticks if tick.failure)

    @property
    def table(self) -> list[tuple[str, str]]:
        """The summary as pairs of name and text."""
        end = f"arrived after {len(self) - 1} ticks" if self.arrived else f"not arrived in {len(self)} ticks"
        checked = f"{len(self.failures)}" if self.verified else "plans were not checked"
        ms = ", ".join(f"{name} {1e3 * value:.4g}" for name, value in self._milliseconds)
        return [
            ("status", end),
            ("scenario", f"{self.scenario.name}, seed {self.scenario.seed}"),
            ("algorithm", f"{self.algorithm}, {self.improve} rounds of improvement after a change"),
            ("replans", f"{len(self.times)}; CPU ms: {ms}"),
            ("missed", ", ".join(f"{self.missed(rate)} at {rate} Hz" for rate in RATES)),
            ("travelled", f"{self.travelled:.2f} cells, {self.detour:.4f} of the optimum at rest"),
            ("plan changes", f"{self.plan_changes}, {100 * self.changed_share:.1f} % of the plan in the mean"),
            ("waits", f"{self.waits} ticks, {self.left_out} with something on the robot's cell"),
            ("failures", checked),
        ]

    @property
    def _milliseconds(self) -> list[tuple[str, float]]:
        shares = (("median", 0.5), ("95 %", 0.95), ("99 %", 0.99), ("largest", 1.0))
        return [*((name, self.percentile(share)) for name, share in shares), ("mean", self.mean)]

    def summary(self) -> str:
        """A short table: how it ended, times, length, changes, failures."""
        return "\n".join(f"{name:<14} {text}" for name, text in self.table)

    def to_dict(self) -> dict[str, Any]:
        """What is measured, as JSON types; seconds in CPU time, None where there is nothing to measure."""
        told = {
            "algorithm": self.algorithm,
            "scenario": self.scenario.name,
            "seed": self.scenario.seed,
            "arrived": self.arrived,
            "ticks": len(self),
            "replans": len(self.times),
            "seconds_median": self.percentile(0.5),
            "seconds_95": self.percentile(0.95),
            "seconds_99": self.percentile(0.99),
            "seconds_largest": self.percentile(1.0),
            "seconds_mean": self.mean,
            "seconds_first": self.seconds_first,
            "seconds_total": self.seconds_total,
            **{f"missed_{rate}_hz": self.missed(rate) for rate in RATES},
            "travelled": self.travelled,
            "paid": self.paid,
            "optimum": self.optimum,
            "detour": self.detour,
            "waits": self.waits,
            "left_out": self.left_out,
            "plan_changes": self.plan_changes,
            "changed_share": self.changed_share,
            "failures": list(self.failures) if self.verified else None,
        }
        return {name: finite(value) if isinstance(value, float) else value for name, value in told.items()}

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the ticks as .csv, whole or not at all; `scenario.save` writes what makes them again."""
        save_ticks([self], path)


def save_ticks(replays: Sequence[Replay], path: str | os.PathLike[str]) -> None:
    """Write the ticks of several replays as one .csv, whole or not at all.

    Raises
    ------
    ParameterError
        The file's ending is another one.
    OutputError
        It cannot be written.
    """
    name = as_path(path).name
    if not name.lower().endswith(".csv"):
        raise ParameterError(f"file name {name}", "ticks of a replay are saved as .csv", "choose that")
    write_whole(path, csv_of(replays).encode())


def csv_of(replays: Sequence[Replay], *, times: bool = True) -> str:
    """Ticks of replays, one line each; without `times`, the same bytes for the same scenario and choices."""
    names = [name for name in Tick._fields if times or name not in TIMES]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["algorithm", *names])
    for replay in replays:
        writer.writerows([replay.algorithm, *(getattr(tick, name) for name in names)] for tick in replay.ticks)
    return text.getvalue()
