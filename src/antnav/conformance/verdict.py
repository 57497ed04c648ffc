"""How a check ends: it returns what it found, or raises one of these."""

from __future__ import annotations

from dataclasses import dataclass, field


class Broken(Exception):  # noqa: N818 - what failed is a rule, not the check
    """The check failed."""


class LeftOut(Exception):  # noqa: N818
    """The check does not apply."""


@dataclass(frozen=True)
class Measured:
    """What was found, with figures."""

    told: str
    figures: dict[str, float] = field(default_factory=dict)


Told = str | Measured
