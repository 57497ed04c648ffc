"""Shared fixtures: the data folder beside the project, the stand-ins for the paper's maps, tiny maps."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

import antnav as an
from antnav import maps
from antnav.colony.parameters import RULES
from antnav.objectives import named
from antnav.plan.algorithms import REGISTERED
from antnav.planner.planner import KINDS

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:  # as in a background job: those who test Ctrl-C must hear it
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("antnav", deadline=None)  # tests never judge by time: the first example may compile
settings.load_profile("antnav")

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def data() -> Path:
    """Maps with ground truth; they are not part of the project."""
    if not DATA.is_dir():
        pytest.skip("the data folder ../shared/data is not here")
    return DATA


@pytest.fixture(autouse=True)
def _registered_rules_are_forgotten() -> Iterator[None]:
    """What a test registers is its own."""
    known = [REGISTERED, KINDS, named.REGISTERED, *(family.registered for family in RULES.values())]
    before = [dict(each) for each in known]
    yield
    for each, was in zip(known, before, strict=True):
        if each != was:
            each.clear()
            each.update(was)


def grid_of(*rows: str) -> an.GridMap:
    """A map from rows of '.', '#' (occupied) and '?' (unknown)."""
    return an.GridMap(np.array([[".#?".index(letter) for letter in row] for row in rows]))


@pytest.fixture(scope="session", params=["equiv20", "equiv30", "equiv40"])
def equivalent(request: pytest.FixtureRequest) -> an.Problem:
    """A stand-in for each of the paper's maps, under the paper's corner rule."""
    start, goal = maps.builtin_query(request.param)
    return an.Problem.from_cells(maps.builtin(request.param), start, goal, corner_rule="allow")
