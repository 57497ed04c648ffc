"""FrontRecord: what a study of fronts keeps of one run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from antnav.fronts.front import Front
from antnav.planner.facts import Certainty
from antnav.report.environment import machine_name
from antnav.study.record import Mark


@dataclass(frozen=True, kw_only=True)
class FrontRecord:
    """One run, as it is stored and as tables and figures see it: values, not paths.

    Attributes
    ----------
    key : str
        Hexadecimal digest of everything that decides the outcome: code, map, ends, rules, prices, method, seed.
    map, algorithm : str
        Labels of the study.
    seed : int
    status : str
        A `Status`.
    complete : bool
        Whether these are all, see `Front`.
    objectives : tuple of str
        Name and unit of each.
    counted : tuple of float
        The whole step that searches counted in, of each objective.
    values : tuple of tuple of float
        A row for each path, in the objectives' units.
    work : dict of str to int
        What was done, by name.
    seconds : float
        Wall seconds. Only these, what a time limit cut, and the environment differ between two runs of one key.
    certainty : Certainty
    notes : tuple of str
    marks : tuple of Mark
    environment : dict of str to str
        Versions of Python and libraries, and the machine.
    """

    table: ClassVar[str] = "fronts"

    key: str
    map: str
    algorithm: str
    seed: int
    status: str
    complete: bool
    objectives: tuple[str, ...]
    counted: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    work: dict[str, int]
    seconds: float
    certainty: Certainty
    notes: tuple[str, ...]
    marks: tuple[Mark, ...] = ()
    environment: dict[str, str]

    @classmethod
    def of(cls, front: Front, *, key: str, map_label: str, algorithm_label: str) -> FrontRecord:
        """The record of a front, found on this machine, under a study's labels."""
        return cls(
            key=key,
            map=map_label,
            algorithm=algorithm_label,
            seed=front.seed,
            status=str(front.status),
            complete=front.complete,
            objectives=tuple(each.label for each in front.objectives),
            counted=tuple(each.step for each in front.objectives),
            values=tuple(tuple(row) for row in front.values.tolist()),
            work=front.work,
            seconds=front.seconds_run,
            certainty=Certainty.of(front.certainty),
            notes=front.notes,
            environment=front.versions | {"machine": machine_name()},
        )
