"""What tests register is forgotten after each of them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from antnav.colony.parameters import RULES
from antnav.objectives import named
from antnav.plan.algorithms import REGISTERED
from antnav.planner.planner import KINDS


@pytest.fixture(autouse=True)
def _forgotten() -> Iterator[None]:
    known = [REGISTERED, KINDS, named.REGISTERED, *(family.registered for family in RULES.values())]
    before = [dict(each) for each in known]
    yield
    for each, was in zip(known, before, strict=True):
        each.clear()
        each.update(was)
