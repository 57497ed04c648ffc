"""Records that no run has made, so that tests know what tables and figures must show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import antnav as an
from antnav.maps import builtin, builtin_query
from antnav.planner.facts import Basis, Certainty, Clause
from antnav.report.table import Table, Value
from antnav.study.model import Sweep
from antnav.study.paper import SWAPPED
from antnav.study.record import Record

REBUILT, PRINTED = Clause(Basis.RECONSTRUCTION, "somebody"), Clause(Basis.PAPER)
OPTIMUM = 8 + 15 * math.sqrt(2)


def made_up(
    algorithm: str,
    seed: int,
    length: float | None,
    *,
    label: str = "equiv20",
    optimum: float | None = OPTIMUM,
    **fields,
) -> Record:
    """A run of `length` cells; its curve falls to that length in five iterations."""
    known = length is not None
    best = tuple((length or 0) + 4 - i for i in range(5)) if known else (None,) * 5
    given = {
        "key": f"{label} {algorithm} {seed}",
        "map": label,
        "algorithm": algorithm,
        "seed": seed,
        "status": "found" if known else "no_ant_arrived",
        "length": length,
        "cost": length if known else None,
        "optimum": optimum,
        "gap": length / optimum - 1 if known and optimum else None,
        "turns": 3 if known else None,
        "clearance": 0.5 if known else None,
        "iterations": 5,
        "walks": 250,
        "steps": 1000 + seed,
        "critical_steps": 600 + seed,
        "seconds": 0.25 if algorithm == "paco" else 0.5,
        "cpu_seconds": 0.5,
        "auxiliary_cell": ((9, 8) if seed else (9, 9)) if algorithm == "paco" else None,
        "path": tuple((i, i) for i in range(20)) if known else None,
        "best": best,
        "lost": (9, 5, 3, 1, 0),
        "certainty": Certainty((REBUILT if algorithm in ("dai", "luo") else PRINTED,)),
        "notes": (),
        "environment": {"python": "3.12.1", "antnav": "0.1.0", "machine": "a machine"},
    }
    given |= fields
    return Record(**given | {"certainty": Certainty.of(given["certainty"])})


def paper_like(seeds: Sequence[int] = range(5), labels: Sequence[str] = ("equiv20", "equiv30")) -> list[Record]:
    """The algorithms of the reproduction: traditional finds nothing on the second map."""
    lengths = {"paco": 0.0, "npaco": 0.1, "traditional": 9.0, "dai": 1.0, "luo": 0.5, SWAPPED: 0.3}
    return [
        made_up(
            name, seed, None if name == "traditional" and label == labels[-1] else OPTIMUM + seed * more, label=label
        )
        for label in labels
        for name, more in lengths.items()
        for seed in seeds
    ]


def problems(labels: Sequence[str] = ("equiv20", "equiv30")) -> dict[str, an.Problem]:
    """The maps that the labels name."""
    return {
        label: an.Problem.from_cells(builtin(label), *builtin_query(label), corner_rule="allow") for label in labels
    }


def sweep_of(name: str, **values: Sequence[float | str]) -> Sweep:
    """The sweep over all combinations of these values, with the labels of `load_study`."""
    points = [dict(zip(values, chosen, strict=True)) for chosen in product(*values.values())]
    return Sweep(name, {" ".join([name, *(f"{key}={value}" for key, value in p.items())]): p for p in points})


def rows_of(table: Table | None) -> list[dict[str, Value]]:
    """The rows of a table by the heads of its columns."""
    assert table is not None
    return [dict(zip([column.head for column in table.columns], row, strict=True)) for row in table.rows]
