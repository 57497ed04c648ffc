"""What a check found, and all of it as a table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from antnav.markup import table_html


class Verdict(StrEnum):
    """What a check says.

    - passed: it holds, as far as was tried
    - failed: here is a case in which it does not
    - skipped: it does not apply, or could not be tried, for the reason given
    """

    PASSED = "passed"
    FAILED = "failed"
    SKIPPED = "skipped"


@dataclass(frozen=True)
class Finding:
    """One check of one rule.

    Attributes
    ----------
    kind, name : str
        Of the rule, such as "pheromone" and "share".
    check : str
    verdict : Verdict
    told : str
        What was found, in a line.
    figures : mapping of str to number
        What was measured.
    """

    kind: str
    name: str
    check: str
    verdict: Verdict
    told: str
    figures: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Conformance:
    """All findings of a check.

    Attributes
    ----------
    findings : tuple of Finding
        In the order in which they were found: rule by rule.
    """

    findings: tuple[Finding, ...]

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    @property
    def failures(self) -> list[Finding]:
        """The checks that failed."""
        return [one for one in self.findings if one.verdict is Verdict.FAILED]

    @property
    def summary(self) -> str:
        """How many passed, failed and were skipped."""
        counts = Counter(one.verdict for one in self.findings)
        return ", ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict)

    @property
    def table(self) -> list[tuple[str, str, str, str]]:
        """A head, and a row a check: rule, check, verdict, what was found."""
        rows = [(f"{one.kind} {one.name}", one.check, str(one.verdict), one.told) for one in self.findings]
        return [("rule", "check", "verdict", "found"), *rows]

    def document(self) -> dict[str, Any]:
        """As JSON types."""
        return {
            "passed": self.passed,
            "findings": [
                {
                    "kind": one.kind,
                    "name": one.name,
                    "check": one.check,
                    "verdict": str(one.verdict),
                    "told": one.told,
                    "figures": dict(one.figures),
                }
                for one in self.findings
            ],
        }

    def __repr__(self) -> str:
        rules = dict.fromkeys(one.name for one in self.findings)
        lines = [f"{one.name}, {one.check}: {one.told}" for one in self.failures]
        return "\n".join([f"Conformance({', '.join(rules)}: {self.summary})", *lines])

    def _repr_html_(self) -> str:
        head, *rows = self.table
        return table_html(self.summary, head, rows, len(rows))
