"""Checks in a process of their own: what hangs, dies or cannot travel is told, and the rest goes on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from types import ModuleType

import pytest

import antnav as an
from antnav.conformance import Conformance, Finding, Verdict, check_rules
from antnav.conformance.checks import CHECKS, LONG
from antnav.conformance.running import Court
from antnav.conformance.subject import subjects_of
from antnav.errors import ParameterError

FILE = '''
import antnav as an


@an.register.heuristic
def homing(ground, reach=an.parameter(2.0, least=0, most=9)):
    """1 / (reach + the straight distance to the goal)."""
    print("asked")
    rows, cols = (ground.cells - ground.cells[ground.goal]).T
    return 1 / (reach + (rows**2 + cols**2) ** 0.5 + 0.1)


@an.register.pheromone
def hanging(ants):
    """Never ends."""
    while True:
        pass


@an.register.algorithm
def mine(**choices):
    """npaco with homing."""
    return an.npaco(heuristic="homing", **choices)
'''


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    file = tmp_path / "mine.py"
    file.write_text(FILE)
    return file


def test_what_never_ends_is_ended_and_the_others_are_checked(mine: Path) -> None:
    heard: list[Finding] = []
    found = check_rules(mine, quick=True, time_limit=3.0, told=heard.append)
    assert heard == list(found.findings)
    assert not found.passed
    (failure,) = found.failures
    assert (failure.name, failure.check) == ("hanging", "runs")
    assert failure.told == "it was not done after 3 s, and was ended: does it loop for ever?"
    verdicts = {(one.name, one.check): one for one in found.findings}
    assert len(verdicts) == 3 * len(CHECKS)
    assert verdicts["hanging", "documented"].verdict is Verdict.PASSED
    assert verdicts["hanging", "bounds"].told == "it did not end in runs"
    assert verdicts["homing", "legal paths"].verdict is Verdict.PASSED
    assert verdicts["mine", "saved"].verdict is Verdict.PASSED
    assert {verdicts["homing", check].verdict for check in LONG} == {Verdict.SKIPPED}


def test_only_what_is_named(mine: Path) -> None:
    assert [one.name for one in subjects_of(mine, ["mine"])] == ["mine"]
    with pytest.raises(ParameterError, match="rule 'yours': there are homing, hanging, mine"):
        check_rules(mine, "yours")


@pytest.mark.parametrize("limit", [0, -1, float("nan"), "long", None])
def test_a_time_limit_that_is_none(mine: Path, limit: object) -> None:
    with pytest.raises(ParameterError, match="time_limit"):
        check_rules(mine, time_limit=limit)  # type: ignore[arg-type]


def test_findings_that_nobody_can_be_told(mine: Path) -> None:
    with pytest.raises(ParameterError, match="told 3"):
        check_rules(mine, told=3)  # type: ignore[arg-type]


def test_a_rule_that_ends_its_process() -> None:
    def killing(ants):
        """Ends its process."""
        os.kill(os.getpid(), signal.SIGKILL)

    with Court() as court:
        (subject,) = subjects_of(an.register.pheromone(killing))
        assert court.check("runs", subject).told == "its process died: does it write beyond the ends of its arrays?"
        assert court.check("bounds", subject).verdict is Verdict.SKIPPED


def test_a_rule_that_cannot_be_sent() -> None:
    lock = threading.Lock()

    def locked(ants):
        """Holds a lock."""
        with lock:
            ants.amounts[0] = 1

    with Court() as court:
        (subject,) = subjects_of(an.register.pheromone(locked))
        assert "cannot be sent to another process: TypeError" in court.check("runs", subject).told


def test_a_rule_that_does_not_run_is_checked_no_further() -> None:
    def broken(ants):
        """Raises."""
        raise KeyError("nothing")

    found = check_rules(an.register.pheromone(broken))
    verdicts = {one.check: one for one in found.findings}
    assert [one.check for one in found.failures] == ["runs"]
    assert "KeyError" in verdicts["runs"].told
    assert verdicts["speed"].told == "it does not run"


def test_rules_of_a_module_and_of_one_without_a_file(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(mine.parent)
    monkeypatch.delitem(sys.modules, "mine", raising=False)
    import mine as module  # type: ignore[import-not-found]

    assert [one.name for one in subjects_of(module)] == ["homing", "hanging", "mine"]
    cell = ModuleType("__cell__")
    monkeypatch.setitem(sys.modules, "__cell__", cell)
    exec(FILE.replace("homing", "driving").replace("hanging", "idling").replace("mine", "ours"), vars(cell))
    assert [one.name for one in subjects_of(cell)] == ["driving", "idling", "ours"]


def test_a_script_that_checks_its_own_rule(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        FILE + "\nif __name__ == '__main__':\n    print(an.check_rules(homing, quick=True))\n", encoding="utf-8"
    )
    ended = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True, timeout=300)
    assert ended.stdout == "Conformance(homing: 8 passed, 0 failed, 4 skipped)\n"


def test_what_a_conformance_tells() -> None:
    found = Conformance(
        (
            Finding("pheromone", "share", "runs", Verdict.PASSED, "to its end", {"gap": 0.5}),
            Finding("pheromone", "share", "bounds", Verdict.FAILED, "tau of <inf>"),
        )
    )
    assert not found.passed
    assert found.summary == "1 passed, 1 failed, 0 skipped"
    assert repr(found) == "Conformance(share: 1 passed, 1 failed, 0 skipped)\nshare, bounds: tau of <inf>"
    assert "tau of &lt;inf&gt;" in found._repr_html_()
    assert found.document()["findings"][0] == {
        "kind": "pheromone",
        "name": "share",
        "check": "runs",
        "verdict": "passed",
        "told": "to its end",
        "figures": {"gap": 0.5},
    }


def test_a_path_is_told_as_text(tmp_path: Path) -> None:
    file = tmp_path / "e.py"
    file.write_text("")
    with pytest.raises(ParameterError, match=r"^rules of '.*e\.py': it registers nothing"):
        an.check_rules(file)
