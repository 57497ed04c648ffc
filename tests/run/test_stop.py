"""Stopping criteria: fractions by hand, combination, reuse."""

from __future__ import annotations

import math
import pickle

import pytest

from antnav.errors import ParameterError
from antnav.run import stop
from antnav.run.stop import Iterations, Progress, Seconds, Stagnation, TargetLength

FRESH = Progress(iterations=0, seconds=0.0, best=math.inf, stagnant=0)
HALF = Progress(iterations=5, seconds=1.0, best=40.0, stagnant=2)


@pytest.mark.parametrize(
    ("criterion", "fraction"),
    [
        (Iterations(10), 0.5),
        (Seconds(2.0), 0.5),
        (Stagnation(4), 0.5),
        (TargetLength(20.0), 0.5),
        (TargetLength(40.0), 1.0),
    ],
)
def test_fractions(criterion, fraction: float) -> None:
    assert criterion.fraction(FRESH) == 0.0
    assert criterion.fraction(HALF) == fraction
    assert criterion.reached(HALF) == (fraction == 1.0)


def test_overshoot_is_one() -> None:
    late = Progress(iterations=50, seconds=9.0, best=1.0, stagnant=50)
    for criterion in (Iterations(10), Seconds(2.0), Stagnation(4), TargetLength(20.0)):
        assert criterion.fraction(late) == 1.0


def test_any_and_all() -> None:
    either = Iterations(10) | Seconds(1.0)
    both = Iterations(10) & Seconds(1.0)
    assert either.reached(HALF)
    assert not both.reached(HALF)
    assert both.fraction(HALF) == 0.5
    assert (both | TargetLength(100)).reached(HALF)


@pytest.mark.parametrize("make", [Iterations, Seconds, Stagnation, TargetLength])
@pytest.mark.parametrize("value", [0, -1, math.nan, math.inf, "soon"])
def test_limits_are_positive_numbers(make, value) -> None:
    with pytest.raises(ParameterError):
        make(value)


@pytest.mark.parametrize(("of_day", "under_way"), [(7e8, 0.0), (7e8 + 4, 4.0), (7e8 - 60, 0.0)])  # the last one lags
def test_a_clock_goes_on_in_another_process_and_counts_the_way_there(
    monkeypatch: pytest.MonkeyPatch, of_day: float, under_way: float
) -> None:
    now, today = 1000.0, 7e8
    monkeypatch.setattr(stop.time, "perf_counter", lambda: now)
    monkeypatch.setattr(stop.time, "time", lambda: today)
    clock = stop.Clock()
    now += 3
    assert clock.seconds() == 3
    sent = pickle.dumps(clock)
    now, today = 5.0, of_day  # another machine, just started
    received = pickle.loads(sent)
    assert received.seconds() == 3 + under_way
    now += 2
    assert received.seconds() == 5 + under_way
