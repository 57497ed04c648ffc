"""The paper's figures, letter by letter."""

from __future__ import annotations

import pytest

from antnav.study import groups, published


@pytest.mark.parametrize(
    ("label", "side"),
    [
        ("equiv20", 20),
        ("equiv40", 40),
        ("map 30x30", 30),
        ("40", 40),
        ("warehouse", None),
        ("m120", None),
        ("30x40", None),
    ],
)
def test_side_of(label: str, side: int | None) -> None:
    assert published.side_of(label) == side


def test_printed_lengths_letter_by_letter() -> None:
    """Tables 2-4 once more: best and mean by side and algorithm."""
    printed = {
        "paco": ("29.2132 29.2132", "37.3848 37.9173", "51.1127 52.5414"),
        "npaco": ("29.2132 29.2132", "37.3848 37.3848", "51.1127 51.7023"),
        "dai": ("29.2133 29.3807", "37.3849 38.1262", "51.1128 51.8471"),
        "traditional": ("37.4143 38.6335", "38.2133 38.6325", None),
    }
    for algorithm, rows in printed.items():
        for side, row in zip(published.SIDES, rows, strict=True):
            found = published.PRINTED[side, algorithm]
            assert (found and f"{found.best:.4f} {found.mean:.4f}") == row
    assert {side: cell for side, (cell, _) in published.AUXILIARY.items()} == {20: (9, 8), 30: (11, 20), 40: (19, 11)}


def test_printed_time_savings_follow_from_the_printed_times() -> None:
    for side, saved in published.TIME_SAVED.items():
        paco, npaco = published.PRINTED[side, "paco"], published.PRINTED[side, "npaco"]
        assert paco is not None
        assert npaco is not None
        assert groups.percent_saved(paco.seconds, npaco.seconds) == pytest.approx(saved, abs=0.01)
