"""For pytest: the conformance checks of your own rules, each a test.

A module to be imported, and no plugin: a plugin is loaded into every run of pytest in the environment.
"""

from __future__ import annotations

import atexit
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from antnav.conformance.checks import LONG, checks_of
from antnav.conformance.model import Verdict
from antnav.conformance.running import LIMIT, Court
from antnav.conformance.subject import Subject, subjects_of
from antnav.conformance.twins import assert_twin

if TYPE_CHECKING:
    import pytest

__all__ = ["assert_twin", "checks"]


def checks(what: Any, *names: str, quick: bool = False, time_limit: float = LIMIT) -> pytest.MarkDecorator:
    """Make a test of each check: parametrize a function with `check`, which it calls.

    Parameters
    ----------
    what, *names, quick, time_limit
        As of `antnav.check_rules`.

    Raises
    ------
    ParameterError
        As of `antnav.check_rules`.

    Examples
    --------
    In a test file beside mine.py::

        import mine
        from antnav.testing import checks


        @checks(mine)
        def test_conformance(check):
            check()
    """
    import pytest

    cases = [
        pytest.param(partial(_carry_out, name, subject, time_limit), id=f"{subject.name}-{name.replace(' ', '-')}")
        for subject in subjects_of(what, names)
        for name in checks_of(subject)
        if not (quick and name in LONG)
    ]
    return pytest.mark.parametrize("check", cases)


def _carry_out(name: str, subject: Subject, seconds: float) -> None:
    __tracebackhide__ = True
    import pytest

    finding = _court(seconds).check(name, subject)
    if finding.verdict is Verdict.FAILED:
        pytest.fail(f"{finding.kind} {finding.name}, {name}: {finding.told}", pytrace=False)
    if finding.verdict is Verdict.SKIPPED:
        pytest.skip(finding.told)


@cache
def _court(seconds: float) -> Court:
    """The process for all tests of this one."""
    court = Court(seconds)
    atexit.register(court.end)
    return court
