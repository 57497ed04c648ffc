"""Results of every kind to be drawn; figures are closed after each test."""

from __future__ import annotations

import math
import sys
from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav.kernels.ant_kernels import History
from antnav.planner.plan import Status
from antnav.planner.result import Result
from tests.plot.samples import plan, two_rooms


@pytest.fixture(autouse=True)
def close_figures():
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture(scope="session")
def divided() -> Result:
    return plan(two_rooms(resolution=0.5, origin=(-2.0, 3.0, 0.0)))


@pytest.fixture(scope="session")
def undivided() -> Result:
    return plan(two_rooms(), an.npaco(ants=10, iterations=12))


@pytest.fixture(scope="session")
def unreachable() -> Result:
    return plan(two_rooms(door=False))


@pytest.fixture(scope="session")
def same_cell() -> Result:
    return plan(two_rooms(), goal=(1, 1))


@pytest.fixture(scope="session")
def nobody_arrived(undivided: Result) -> Result:
    none = np.full(3, math.inf)
    zero = np.zeros(3, np.int64)
    history = History(none, none, none * math.nan, zero, zero + 10, zero + 50, none * math.nan)
    return replace(undivided, status=Status.NO_ANT_ARRIVED, path=None, history=history)
