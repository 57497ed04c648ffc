"""When to stop: criteria without state, combined with | and &."""

from __future__ import annotations

import time

import msgspec

from antnav.errors import ParameterError, check_type, shown
from antnav.values import finite_number


class Progress(msgspec.Struct, frozen=True):
    """How far a run has come.

    Attributes
    ----------
    iterations : int
        Iterations done.
    seconds : float
        Wall time since the solver began.
    best : float
        Cost of the best path from start to goal, which is length where the problem has no costs; inf before the first,
        and in the halves of a divided problem, which do not know the whole.
    stagnant : int
        Iterations since the colony's own best path last improved; 0 before the first arrival.
    """

    iterations: int
    seconds: float
    best: float
    stagnant: int


class Clock:
    """Seconds since a solver began, by the clock that nobody sets.

    Such clocks agree within a process only. Sent to another one, a clock goes on from where it stood when it was sent,
    and the way there counts, with the time in a queue: by the clock of the day, as far as both machines agree on it.

    Parameters
    ----------
    seconds : float
        What it shows.
    sent : float, optional
        The time of day at which it showed that; default: now.
    """

    def __init__(self, seconds: float = 0.0, sent: float | None = None) -> None:
        under_way = 0.0 if sent is None else max(0.0, time.time() - sent)
        self._begin = time.perf_counter() - seconds - under_way

    def seconds(self) -> float:
        """Seconds so far."""
        return time.perf_counter() - self._begin

    def __reduce__(self) -> tuple[type[Clock], tuple[float, float]]:
        return type(self), (self.seconds(), time.time())


class Stop:
    """A stopping criterion. A criterion keeps nothing between calls, so it can serve any number of runs."""

    def fraction(self, progress: Progress) -> float:
        """How near the end is, in [0, 1]; 1 means stop."""
        raise NotImplementedError

    def reached(self, progress: Progress) -> bool:
        """Whether to stop now."""
        return self.fraction(progress) >= 1.0

    def __or__(self, other: Stop) -> Stop:
        return AnyOf((self, other))

    def __and__(self, other: Stop) -> Stop:
        return AllOf((self, other))


class Iterations(Stop, msgspec.Struct, frozen=True):
    """Stop after a number of iterations one after the other, in all stages, those without an arrival among them.

    The schedule T of the algorithm stays as it is.
    """

    count: int

    def __post_init__(self) -> None:
        _positive("iterations", self.count)

    def fraction(self, progress: Progress) -> float:
        """Share of the iterations done."""
        return min(1.0, progress.iterations / self.count)


class Seconds(Stop, msgspec.Struct, frozen=True):
    """Stop after a wall time in seconds, looked at after every iteration. The result then depends on the machine."""

    limit: float

    def __post_init__(self) -> None:
        _positive("seconds", self.limit)

    def fraction(self, progress: Progress) -> float:
        """Share of the time spent."""
        return min(1.0, progress.seconds / self.limit)


class Stagnation(Stop, msgspec.Struct, frozen=True):
    """Stop when the best path of a colony has not improved for a number of iterations."""

    count: int

    def __post_init__(self) -> None:
        _positive("stagnation", self.count)

    def fraction(self, progress: Progress) -> float:
        """Share of the patience used up."""
        return min(1.0, progress.stagnant / self.count)


class TargetLength(Stop, msgspec.Struct, frozen=True):
    """Stop when a path from start to goal costs at most this, which is length in cells where the problem has no costs.

    The parts of a divided problem cannot know the cost of the whole, so in PACO only stage one looks at it, and with
    `coarse` nobody before the path lies on cells. Windows look at it between passes.
    """

    length: float

    def __post_init__(self) -> None:
        _positive("target length", self.length)

    def fraction(self, progress: Progress) -> float:
        """Target over best, 1 once reached."""
        return 1.0 if progress.best <= self.length * (1 + 1e-12) else min(0.99, self.length / progress.best)


class AnyOf(Stop, msgspec.Struct, frozen=True):
    """Stop when one of several criteria says so."""

    criteria: tuple[Stop, ...]

    def __post_init__(self) -> None:
        _check_several(self.criteria)

    def fraction(self, progress: Progress) -> float:
        """That of the criterion nearest to its end."""
        return max(criterion.fraction(progress) for criterion in self.criteria)


class AllOf(Stop, msgspec.Struct, frozen=True):
    """Stop when all of several criteria say so."""

    criteria: tuple[Stop, ...]

    def __post_init__(self) -> None:
        _check_several(self.criteria)

    def fraction(self, progress: Progress) -> float:
        """That of the criterion farthest from its end."""
        return min(criterion.fraction(progress) for criterion in self.criteria)


def _check_several(criteria: object) -> None:
    if not isinstance(criteria, tuple) or not criteria:
        raise ParameterError(f"criteria {shown(criteria)}", "they are a tuple of one or more", "give such a tuple")
    for criterion in criteria:
        check_type("criterion", criterion, Stop, "give one, such as Seconds(0.5)")


def _positive(name: str, value: float) -> None:
    if not finite_number(value) > 0:
        raise ParameterError(f"{name} {shown(value)}", f"{name} is a finite number above 0", "give one, such as 10")
