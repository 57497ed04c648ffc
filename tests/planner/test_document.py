"""Documents: what may be missing, what must agree, and how a disagreement is told."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav.errors import ResultFormatError
from antnav.planner.planner import KINDS

#: What follows from the rest of a file.
DERIVED = ["length", "length_m", "gap", "turns", "turning_angle", "clearance_m", "wall_distance_m", "path_m"]


@pytest.fixture(scope="module")
def written() -> dict[str, Any]:
    problem = an.Problem.from_cells(an.GridMap(np.zeros((9, 9), np.uint8)), (0, 0), (8, 5))
    document: dict[str, Any] = json.loads(json.dumps(an.solve(problem, an.astar()).to_dict()))
    return document


def load(folder: Path, document: dict[str, Any]) -> an.Result:
    (folder / "plan.json").write_text(json.dumps(document))
    return an.Result.load(folder / "plan.json")


@pytest.mark.parametrize("name", DERIVED)
def test_what_follows_from_the_rest_may_be_missing(written: dict[str, Any], tmp_path: Path, name: str) -> None:
    short = {key: value for key, value in written.items() if key != name}
    assert len(short) < len(written)
    assert load(tmp_path, short).to_dict() == load(tmp_path, written).to_dict()


def test_points_are_compared_one_by_one(written: dict[str, Any], tmp_path: Path) -> None:
    points = written["path_m"]
    for wrong in (points[:-1], [*points[:-1], [points[-1][0] + 1e-6, points[-1][1]]], []):
        with pytest.raises(ResultFormatError, match=r"path_m .* the rest of the file makes it"):
            load(tmp_path, written | {"path_m": wrong})
    rounded = [[x + 1e-12, y] for x, y in points]  # machines may differ in the last digits
    assert load(tmp_path, written | {"path_m": rounded}).path is not None


def test_long_values_are_told_in_short(written: dict[str, Any], tmp_path: Path) -> None:
    wrong = [(1.5, 2.5)] * 5
    text = str(wrong)
    with pytest.raises(ResultFormatError) as told:
        load(tmp_path, written | {"path_m": wrong})
    assert len(text) == 60
    assert f"path_m {text}:" in str(told.value)
    with pytest.raises(ResultFormatError) as told:
        load(tmp_path, written | {"path_m": [*wrong, (1.5, 2.5)]})
    assert f"path_m {text[:57]}...:" in str(told.value)


@pytest.mark.parametrize(("part", "message"), [({"rows": 0}, "0 x 9 cells"), ({"cols": 0}, "9 x 0 cells")])
def test_a_map_without_cells_is_refused(written: dict[str, Any], tmp_path: Path, part: dict, message: str) -> None:
    problem = written["problem"] | {"map": written["problem"]["map"] | part}
    with pytest.raises(ResultFormatError, match=message):
        load(tmp_path, written | {"problem": problem})


@pytest.mark.parametrize("seed", [-1, 2**64])
def test_a_seed_out_of_range_is_refused(written: dict[str, Any], tmp_path: Path, seed: int) -> None:
    with pytest.raises(ResultFormatError, match="seed"):
        load(tmp_path, written | {"seed": seed})


@pytest.mark.parametrize("algorithm", [{"kind": "exact"}, {"kind": "exact", "method": 3}, {"kind": "half known"}])
def test_a_planner_without_what_makes_it_is_told(
    written: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, algorithm: dict[str, Any]
) -> None:
    monkeypatch.setitem(KINDS, "half known", lambda document: an.algorithm(document["preset"]))
    with pytest.raises(ResultFormatError, match="the algorithm: "):
        load(tmp_path, written | {"algorithm": algorithm})
