"""Setup: planners of one's own in the tables and the document of a study."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

import antnav as an
from antnav.study import setup
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from tests.conftest import grid_of

PROBLEM = an.Problem.from_cells(grid_of("....", ".##.", "...."), (0, 0), (2, 3))


@dataclass(frozen=True)
class Swarm(an.Planner):
    """Ants of one's own, as far apart as the map's size says."""

    name: str = "swarm"
    ants: int = 7
    rho: float = np.float64(0.5)
    distance: int | None = None

    def on(self, grid: an.GridMap) -> Self:
        return self if self.distance else replace(self, distance=grid.rows)


def study(*planners: an.Planner) -> Study:
    return Study("t", [MapEntry("m", PROBLEM)], [AlgorithmEntry(one.name, one) for one in planners], [0])


def composition(planner: an.Planner) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(setup.document(study(planner)))["algorithms"][planner.name]
    return found


def test_what_depends_on_the_map_is_told_of_any_planner() -> None:
    assert composition(Swarm())["on_maps"] == {"m": {"distance": 3}}
    assert composition(Swarm(ants=0))["on_maps"] == {"m": {"distance": 3}}
    assert composition(an.npaco())["on_maps"] == {"m": {"heuristic": "target", "switch": 0.6}}
    for planner in (Swarm(distance=2), an.astar()):
        assert "on_maps" not in composition(planner)


def test_a_name_of_antnavs_is_not_enough_for_its_defaults() -> None:
    assert composition(Swarm("paco"))["changed"] == []
    assert composition(an.paco(rho=0.5))["changed"] == ["rho"]
    [table, _] = setup.tables(study(Swarm("paco")))
    assert "rho 0.5" in table.note
    assert "rho 0.5*" not in table.note


def test_planners_without_ants_have_a_table_of_their_own() -> None:
    _, table, _ = setup.tables(study(an.npaco(), an.astar(), Swarm(ants=0)))
    assert table.title == "Parameters of the planners without ants"
    assert [column.name for column in table.columns][:3] == ["algorithm", "astar", "swarm"]
