"""CSV: full precision, and nothing that a spreadsheet would run."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

from antnav.report.table import Table, Value


def table(given: Table) -> str:
    """Full precision; empty for what does not exist, inf for no path."""
    return lines([column.head for column in given.columns], given.rows)


def lines(head: Sequence[str], rows: Sequence[Sequence[Value]]) -> str:
    """Full precision; empty for None and nan; texts that a spreadsheet would take for a formula begin with '."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(_no_formula, head))
    writer.writerows([[_no_formula(value) for value in row] for row in rows])
    return text.getvalue()


def _no_formula(value: Value) -> Value:
    """An apostrophe before =, +, - or @, unless the text is a number or that sign alone."""
    if isinstance(value, float) and math.isnan(value):
        return ""
    if not isinstance(value, str) or len(value) < 2 or value.lstrip()[:1] not in tuple("=+-@"):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value
