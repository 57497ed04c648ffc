"""All checks by name, in the order in which they are carried out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from antnav.conformance import goals
from antnav.conformance.behaviour import bounds, documented, legal_paths, runs, writes
from antnav.conformance.comparing import better, speed
from antnav.conformance.model import Finding, Verdict
from antnav.conformance.sameness import compiled, deterministic, saved, steps, workers
from antnav.conformance.subject import Subject
from antnav.conformance.verdict import Broken, LeftOut, Measured, Told
from antnav.errors import AntnavError
from antnav.plugins.loading import said

#: What is checked, by name. Where the second one fails, those after it are skipped.
CHECKS = MappingProxyType[str, Callable[[Subject], Told]](
    {
        "documented": documented,
        "runs": runs,
        "deterministic": deterministic,
        "steps": steps,
        "legal paths": legal_paths,
        "bounds": bounds,
        "writes": writes,
        "compiled": compiled,
        "saved": saved,
        "workers": workers,
        "better than blind": better,
        "speed": speed,
    }
)
#: Of objectives.
OF_OBJECTIVES = MappingProxyType[str, Callable[[Subject], Told]](
    {
        "documented": documented,
        "runs": goals.priced,
        "deterministic": goals.same_prices,
        "fronts": goals.fronts,
        "writes": goals.nothing_written,
        "workers": goals.sent,
    }
)
#: What takes long, and a quick look leaves out.
LONG = ("workers", "better than blind", "speed")


def checks_of(subject: Subject) -> Mapping[str, Callable[[Subject], Told]]:
    """The checks for a kind."""
    return OF_OBJECTIVES if subject.kind == "objective" else CHECKS


def carried_out(name: str, subject: Subject) -> Finding:
    """One check of one subject, here and now."""
    verdict = Verdict.PASSED
    figures: dict[str, float] = {}
    try:
        told = checks_of(subject)[name](subject)
        told, figures = (told.told, told.figures) if isinstance(told, Measured) else (told, {})
    except Broken as error:
        verdict, told = Verdict.FAILED, str(error)
    except LeftOut as error:
        verdict, told = Verdict.SKIPPED, str(error)
    except AntnavError as error:
        verdict, told = Verdict.FAILED, str(error)
    except Exception as error:
        verdict, told = Verdict.FAILED, f"it raised {said(error)}"
    return Finding(subject.kind, subject.name, name, verdict, told, figures)
