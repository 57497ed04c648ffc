"""merged: the runs of several stores in one."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from antnav.errors import ParameterError
from antnav.study.dynamic_record import DynamicRecord
from antnav.study.front_record import FrontRecord
from antnav.study.record import Kept, Mark, Record, without_times
from antnav.study.store import Store

R = TypeVar("R", bound=Kept)

#: What a store may hold.
KINDS: tuple[type[Any], ...] = (Record, FrontRecord, DynamicRecord)
#: Records that are in memory at a time.
GROUP = 1000


class ConflictError(ParameterError):
    """Two stores tell different things of one run."""


def merged(sources: Sequence[str | os.PathLike[str]], target: str | os.PathLike[str]) -> tuple[int, int]:
    """Add the runs of stores to another one: all of them, or none.

    Parameters
    ----------
    sources : sequence of path-like
        Are read only.
    target : path-like
        Is made where it is missing; what it has stays.

    Returns
    -------
    added, known : int
        Runs that are new in the target, and those that it, or an earlier source, had.

    Raises
    ------
    ConflictError
        A run came out differently, apart from times, environment and marks of load; those that a limit of time may have
        ended are not compared.
    StoreError, StoreLockedError
        A source is missing, no store of this version, or in use.
    OutputError
        The target cannot be written.
    """
    path = Path(target)
    new = not path.exists()
    for source in sources:
        if not new and Path(source).exists() and path.samefile(source):
            raise ParameterError(f"store {source}", "it is the one that the others are added to", "leave it out")
    added = known = 0
    try:
        with Store(path) as store, store.transaction():
            for source in sources:
                with Store(source, new=False) as given:
                    for kind in KINDS:
                        if given.holds(kind):
                            more, again = _add(given.beside(kind), store.beside(kind))
                            added, known = added + more, known + again
    except BaseException:
        if new:
            path.unlink(missing_ok=True)
        raise
    return added, known


def _add(source: Store[R], target: Store[R]) -> tuple[int, int]:
    """Add one store's records of a kind; how many were new, and known."""
    keys, records = target.keys(), source.each()
    added = known = 0
    while group := list(islice(records, GROUP)):
        fresh = [record for record in group if record.key not in keys]
        for record in group:
            if record.key in keys:
                kept = target.record(record.key)
                assert kept is not None
                _check(kept, record, source.path)
        target.add_all(fresh)
        added, known = added + len(fresh), known + len(group) - len(fresh)
    return added, known


def _check(kept: R, record: R, path: Path) -> None:
    """See that two records tell the same; they may stem from jobs of other names."""
    limited = {Mark.LIMITED, Mark.SPENT} & {*kept.marks, *record.marks}
    names = {"map": kept.map, "algorithm": kept.algorithm, "seed": kept.seed, "certainty": kept.certainty}
    if not limited and without_times(kept) != replace(without_times(record), **names):
        rule = f"{path} tells another outcome of it ({record.algorithm} on {record.map} under seed {record.seed})"
        raise ConflictError(f"run {record.key}", rule, "find out which store is wrong, and leave it out")
