"""All checks by name, in the order in which they are carried out."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

from antnav.conformance.behaviour import documented, legal_paths, pheromone, runs, writes
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
        "pheromone": pheromone,
        "writes": writes,
        "compiled": compiled,
        "saved": saved,
        "workers": workers,
        "better than blind": better,
        "speed": speed,
    }
)
#: What takes long, and a quick look leaves out.
LONG = ("workers", "better than blind", "speed")


def carried_out(name: str, subject: Subject) -> Finding:
    """One check of one subject, here and now."""
    verdict = Verdict.PASSED
    figures: dict[str, float] = {}
    try:
        told = CHECKS[name](subject)
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
