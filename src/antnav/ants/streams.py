"""Numbers of the colonies of one run: under one seed, each number has random streams of its own."""

from __future__ import annotations

#: The first colony of an undivided run, which the others follow ...
WHOLE_MAP = 0
#: ... and the one that takes over where a division was in vain: no scout had its number.
TAKES_OVER = 2


def scout(attempt: int, side: int) -> int:
    """Colony of stage one in its attempt 0, 1, ..., from the start (side 0) or from the goal (side 1)."""
    return 4 * attempt + side


def piece(index: int) -> int:
    """Colony of stage two for piece 0, 1, ... of the way: below 1000, attempts leave room for two."""
    return 2 + index if index < 2 else 998 + index


def router(side: int) -> int:
    """Colony on the graph of regions, from the start (side 0) or from the goal (side 1)."""
    return side
