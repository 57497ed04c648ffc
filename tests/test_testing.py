"""antnav.testing in a user's own tests: one test a check, with what failed and nothing of ours in the traceback."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

RULES = '''
import antnav as an


@an.register.initial
def even(ground):
    """The same everywhere."""
    return 1.0


@an.register.initial
def bare(ground):
    return 1.0
'''
TESTS = """
from antnav.testing import checks

import rules


@checks(rules, quick=True)
def test_conformance(check):
    check()
"""


def test_each_check_is_a_test(tmp_path: Path) -> None:
    (tmp_path / "rules.py").write_text(RULES)
    (tmp_path / "test_rules.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider", "-p", "no:xdist", "-rs"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=300)
    assert ended.returncode == 1
    assert "test_conformance[even-legal-paths] PASSED" in ended.stdout
    assert "test_conformance[bare-documented] FAILED" in ended.stdout
    assert "test_conformance[even-compiled] SKIPPED" in ended.stdout
    assert "initial bare, documented: it has no docstring" in ended.stdout
    assert "Traceback" not in ended.stdout
    assert "conformance/" not in ended.stdout
    assert "1 failed, 15 passed, 2 skipped" in ended.stdout


def test_pytest_loads_nothing_of_antnav_by_itself() -> None:
    assert not [point for point in entry_points(group="pytest11") if point.value.startswith("antnav")]
