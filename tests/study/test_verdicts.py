"""Whether a printed length is reached."""

from __future__ import annotations

import math

import pytest

from antnav.study import verdicts


@pytest.mark.parametrize(
    ("figure", "ours", "theirs", "said"),
    [
        ("best", 29.2132034, 29.2133, "reached"),
        ("best", 29.22, 29.2132, "not reached"),
        ("mean", 29.3, 29.2132, "reached"),
        ("mean", 28.0, 29.2132, "shorter than printed"),
        ("best", math.inf, 37.0, "no path"),
        ("best", math.inf, math.inf, "as printed: no path"),
        ("best", 80.0, math.inf, "path, none printed"),
    ],
)
def test_verdict(figure: str, ours: float, theirs: float, said: str) -> None:
    assert verdicts.verdict(figure, ours, theirs) == said
