"""Objectives: prices by hand, what own ones may give, texts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import antnav as an
from antnav import costs, objectives
from antnav.errors import ParameterError
from antnav.fronts.instance import Instance
from antnav.objectives.named import collected, named
from tests.conftest import grid_of

GRID = an.GridMap(grid_of("....", ".#..", "....").cells, resolution=0.5)
PROBLEM = an.Problem.from_cells(GRID, (0, 0), (2, 3))
FIELD = costs.array(np.arange(12.0).reshape(3, 4))
#: East, east, south-east, south, east: one turn by 45 degrees, one back, ...
CELLS = [(0, 0), (0, 1), (0, 2), (1, 3), (2, 3)]


def value(objective: objectives.Objective, cells: list[tuple[int, int]] = CELLS) -> float:
    """Value of a path, the other objective being there because two are needed."""
    instance = Instance.of(PROBLEM, [objective, Other()])
    nodes = np.array([instance.graph.node(cell) for cell in cells], np.int32)
    return float(instance.values([nodes])[0, 0])


@dataclass(frozen=True)
class Other(objectives.Objective):
    name: str = "other"


def test_length_is_in_metres() -> None:
    assert value(objectives.Length()) == pytest.approx(0.5 * (3 + math.sqrt(2)))


def test_risk_is_the_field_along_the_way_in_metres() -> None:
    by_hand = 0.5 * ((0 + 1) / 2 + (1 + 2) / 2 + math.sqrt(2) * (2 + 7) / 2 + (7 + 11) / 2)
    assert value(objectives.Risk(FIELD)) == pytest.approx(by_hand)


def test_time_is_length_over_speed_and_what_zones_add() -> None:
    length = 0.5 * (3 + math.sqrt(2))
    assert value(objectives.Time(2.0)) == pytest.approx(length / 2)
    assert value(objectives.Time(2.0, FIELD)) == pytest.approx((length + value(objectives.Risk(FIELD))) / 2)


def test_energy_is_the_length_and_what_a_field_adds() -> None:
    expected = value(objectives.Length()) + value(objectives.Risk(FIELD))
    assert value(objectives.Energy(FIELD)) == pytest.approx(expected)


def test_energy_is_another_up_than_down() -> None:
    """Heights by hand: up 1 m, down 3 m, level, up 2 m."""
    heights = np.zeros((3, 4))
    heights[0, 1], heights[0, 2], heights[1, 3], heights[2, 3] = 1.0, -2.0, -2.0, 0.0
    energy = objectives.Energy(costs.slope(heights, up=4.0, down=0.5))
    assert value(energy) == pytest.approx(value(objectives.Length()) + 4.0 * 3 + 0.5 * 3)
    back = an.Problem.from_cells(GRID, (2, 3), (0, 0))
    instance = Instance.of(back, [energy, Other()])
    nodes = np.array([instance.graph.node(cell) for cell in CELLS[::-1]], np.int32)
    assert instance.values([nodes])[0, 0] == pytest.approx(value(objectives.Length()) + 4.0 * 3 + 0.5 * 3)
    downhill = objectives.Energy(costs.slope(heights - np.arange(4.0), up=4.0))
    assert value(downhill) < value(objectives.Energy(costs.slope(heights + np.arange(4.0), up=4.0)))
    with pytest.raises(ParameterError, match="give them to Energy"):
        objectives.Risk(costs.slope(heights))
    with pytest.raises(ParameterError, match="a problem with costs"):
        an.pareto(an.Problem.from_cells(GRID, (0, 0), (2, 3), cost=costs.slope(heights)), [objectives.Length(), energy])


def test_turns_are_those_of_the_path() -> None:
    path = an.Path(CELLS, GRID)
    assert value(objectives.Turns()) == path.turns == 2
    assert value(objectives.TurningAngle()) == pytest.approx(path.turning_angle)
    assert value(objectives.TurningAngle()) == pytest.approx(math.pi / 2)


def test_a_path_of_one_cell_is_worth_nothing() -> None:
    for objective in (objectives.Length(), objectives.Risk(FIELD), objectives.Turns()):
        assert value(objective, [(0, 0)]) == 0.0


@dataclass(frozen=True)
class Uphill(objectives.Objective):
    """Rows climbed; down costs nothing."""

    name: str = "climb"

    def edges(self, terrain: an.Terrain, graph: Any) -> NDArray[np.float64]:
        rows = np.append(graph.cells[:, 0], 0)
        return np.maximum(rows[:-1, None] - rows[graph.graph.neighbours], 0).astype(float)


def test_an_objective_of_ones_own_may_cost_more_there_than_back() -> None:
    assert value(Uphill()) == 0.0
    assert value(Uphill(), CELLS[::-1]) == 2.0


@dataclass(frozen=True)
class Given(objectives.Objective):
    """What a test gives, for moves and for turns."""

    moves: Any = None
    pairs: Any = None
    name: str = "given"
    step: float | None = None

    def edges(self, terrain: an.Terrain, graph: Any) -> Any:
        return self.moves

    def turns(self) -> Any:
        return self.pairs


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"moves": np.zeros(8)}, "shape"),
        ({"moves": np.full((11, 8), -1.0)}, "a move costs 0 to"),
        ({"moves": np.full((11, 8), np.nan)}, "a move costs 0 to"),
        ({"moves": np.full((11, 8), 1e300)}, "a move costs 0 to"),
        ({"moves": "many"}, "they are numbers"),
        ({"pairs": np.full((9, 8), -1.0)}, "a turn costs 0 to"),
        ({"pairs": np.zeros((8, 8))}, "shape"),
        ({"moves": np.ones((11, 8)), "step": 0.0}, "step"),
        ({"moves": np.ones((11, 8)), "step": 1e-9}, "step"),
        ({"moves": np.ones((11, 8)), "step": "small"}, "step"),
    ],
)
def test_prices_that_are_none_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        value(Given(**given))


def test_fields_must_fit_the_map() -> None:
    for objective in (objectives.Risk, objectives.Energy):
        with pytest.raises(ParameterError, match="3 x 4"):
            value(objective(costs.array(np.ones((2, 2)))))


def test_a_text_stands_for_an_objective(tmp_path: Path) -> None:
    assert named("length", GRID) == objectives.Length()
    assert named("turns", GRID) == objectives.Turns()
    np.save(tmp_path / "heights.npy", np.eye(3, 4))
    energy = named(f"energy:{tmp_path / 'heights.npy'}:7:2", GRID)
    assert isinstance(energy, objectives.Energy)
    assert energy.slopes.digest == costs.slope(np.eye(3, 4), up=7.0, down=2.0).digest
    assert named("angle", GRID) == objectives.TurningAngle()
    risk = named("risk:clearance:1:2", GRID)
    assert isinstance(risk, objectives.Risk)
    assert risk.field.digest == costs.clearance(GRID, 1.0, 2.0).digest
    for text in ("", "speed", "risk", "length:2", "time", "risk:walls:1", 7):
        with pytest.raises(ParameterError):
            named(text, GRID)  # type: ignore[arg-type]


def test_two_risks_of_a_query_have_two_names() -> None:
    found = collected(["length", "risk:clearance:1", "risk:clearance:2", "turns"], GRID)
    assert [objective.name for objective in found] == ["length", "risk clearance:1", "risk clearance:2", "turns"]


def test_values_of_another_shape_are_refused() -> None:
    graph = PROBLEM.graph
    for shape in ((5, 4), (3, 8), (3,)):
        with pytest.raises(ParameterError, match="3 x 4"):
            objectives.over_cells(np.ones(shape), graph)
