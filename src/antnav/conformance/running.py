"""check_rules: all checks, each in a process that is ended where it takes too long."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from functools import lru_cache
from types import TracebackType
from typing import Any, Self

from antnav.ants.presets import npaco
from antnav.conformance.checks import LONG, carried_out, checks_of
from antnav.conformance.model import Conformance, Finding, Verdict
from antnav.conformance.subject import Subject, subjects_of
from antnav.errors import ParameterError, shown
from antnav.plan.warmup import warmup
from antnav.plugins.loading import said
from antnav.plugins.source import Source
from antnav.run.spmd import Processes, run_jobs
from antnav.values import finite_number

#: Seconds that a check may take.
LIMIT = 60.0


class Court:
    """A process in which checks are carried out, another one after it had to be ended.

    Parameters
    ----------
    seconds : float
        That a check may take.
    """

    def __init__(self, seconds: float = LIMIT) -> None:
        self._seconds = seconds
        self._pool = Processes(1)
        self._ready = False
        self._given_up: dict[Source, str] = {}

    def check(self, name: str, subject: Subject) -> Finding:
        """Carry out one check; skipped where the subject does not even run."""
        if why := self._given_up.get(subject.source):
            return Finding(subject.kind, subject.name, name, Verdict.SKIPPED, why)
        finding = self._tried(name, subject)
        if name == "runs" and finding.verdict is Verdict.FAILED:
            self._given_up.setdefault(subject.source, "it does not run")
        return finding

    def _tried(self, name: str, subject: Subject) -> Finding:
        if not self._ready:
            run_jobs(_ready, [0], self._pool)
            self._ready = True
        try:
            packed = subject.packed()
        except Exception as error:
            told = f"it cannot be sent to another process: {said(error)}"
            return Finding(subject.kind, subject.name, name, Verdict.FAILED, told)
        try:
            return self._pool.submit(_carried_out, name, packed).result(self._seconds)
        except TimeoutError:
            told = f"it was not done after {self._seconds:g} s, and was ended: does it loop for ever?"
        except BrokenExecutor:
            told = "its process died: does it write beyond the ends of its arrays?"
        self.end()
        self._given_up[subject.source] = f"it did not end in {name}"
        return Finding(subject.kind, subject.name, name, Verdict.FAILED, told)

    def end(self) -> None:
        """End the process, whatever it does."""
        self._pool.kill()
        self._ready = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.end()


def check_rules(
    what: Any,
    *names: str,
    quick: bool = False,
    time_limit: float = LIMIT,
    told: Callable[[Finding], None] | None = None,
) -> Conformance:
    """Check rules, planners and algorithms of your own: what every one of them must do.

    Parameters
    ----------
    what : str, path, module, or what a decorator of `antnav.register` returned
        Where they are defined.
    *names : str
        Of those to be checked; default: all that are registered there.
    quick : bool
        Leave out what takes long: worker processes, the comparison with blind ants, and times.
    time_limit : float
        Seconds that each check may take.
    told : callable, optional
        Called with each `Finding` as it comes.

    Returns
    -------
    Conformance

    Raises
    ------
    ParameterError
        A file that cannot be loaded, nothing that is registered there, or no such name.
    WorkerLostError
        No process can be started.
    """
    if not finite_number(time_limit) > 0:
        raise ParameterError(f"time_limit {shown(time_limit)}", "it is a number of seconds above 0", "give one")
    if not (told is None or callable(told)):
        raise ParameterError(f"told {shown(told)}", "it is called with each finding", "give a function, or None")
    findings = []
    with Court(float(time_limit)) as court:
        for subject in subjects_of(what, names):
            for name in checks_of(subject):
                left_out = quick and name in LONG
                findings.append(_left_out(name, subject) if left_out else court.check(name, subject))
                if told:
                    told(findings[-1])
    return Conformance(tuple(findings))


def _left_out(name: str, subject: Subject) -> Finding:
    told = "takes long, and is left out of a quick look"
    return Finding(subject.kind, subject.name, name, Verdict.SKIPPED, told)


def _ready(_: int) -> None:
    """Compile or load the kernels, which is not the rule's fault."""
    warmup(npaco(), turns=True)


def _carried_out(name: str, packed: bytes) -> Finding:
    with contextlib.redirect_stdout(sys.stderr), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return carried_out(name, _unpacked(packed))


@lru_cache(4)
def _unpacked(packed: bytes) -> Subject:
    return Subject.unpacked(packed)
