"""comparison: replays of one scenario side by side, a row each."""

from __future__ import annotations

import math
from collections.abc import Sequence

from antnav.scenarios.model import RATES, Replay

HEADS = (
    *("algorithm", "ticks", "replans", "median, ms", "95 %, ms", "99 %, ms", "largest, ms", "mean, ms", "total, s"),
    *("way / optimum", "way / astar", "waits", "plan changes", "changed, %"),
    f"missed, {'/'.join(map(str, RATES))} Hz",
    "failures",
)


def rows(replays: Sequence[Replay]) -> list[list[str]]:
    """A row for each replay, in the columns of `HEADS`; lengths are set against A* anew where that is among them."""
    yardstick = next((one.travelled for one in replays if one.algorithm == "astar" and one.arrived), math.nan)
    return [_row(one, yardstick) for one in replays]


def _row(one: Replay, yardstick: float) -> list[str]:
    times = [one.percentile(share) for share in (0.5, 0.95, 0.99, 1.0)]
    beside = one.travelled / yardstick if one.arrived and yardstick > 0 else math.nan
    return [
        one.algorithm,
        f"{len(one) - 1}" if one.arrived else f"> {len(one)}",
        f"{len(one.times)}",
        *(_short(1e3 * seconds) for seconds in (*times, one.mean)),
        _short(one.seconds_total),
        _number(one.detour, 4),
        _number(beside, 4),
        f"{one.waits}",
        f"{one.plan_changes}",
        _number(100 * one.changed_share, 1),
        "/".join(f"{one.missed(rate)}" for rate in RATES),
        f"{len(one.failures)}" if one.verified else "-",
    ]


def _number(value: float, digits: int) -> str:
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def _short(value: float) -> str:
    """Three digits that count."""
    return "-" if math.isnan(value) else f"{value:#.3g}".rstrip(".")
