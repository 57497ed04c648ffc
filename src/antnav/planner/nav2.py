"""nav2: results as nav2's actions tell them."""

from __future__ import annotations

from antnav.planner.plan import Status, StoppedBy
from antnav.planner.result import Result


def code_of(result: Result) -> int:
    """Error code of nav2's ComputePathToPose action: 0 found, 207 out of time, 208 no path."""
    if result.status is Status.FOUND:
        return 0
    timed_out = result.status is not Status.UNREACHABLE and result.stopped_by is not StoppedBy.SCHEDULE
    return 207 if timed_out else 208
