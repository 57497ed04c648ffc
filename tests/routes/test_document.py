"""Files of alternatives: a round trip, and what cannot be true is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import costs
from antnav.errors import OutputError, ParameterError, ResultFormatError
from tests.conftest import grid_of

GRID = grid_of("..........", "....##....", "....##....", "..........", "..........")


def found_on(**choices) -> an.Alternatives:
    cost = costs.array(np.arange(50.0).reshape(5, 10) / 50) if choices.pop("priced", False) else None
    problem = an.Problem.from_cells(GRID, (2, 0), (2, 9), cost=cost, turning=0.1 if cost else 0.0)
    return an.alternatives(problem, 3, **choices)


@pytest.mark.parametrize(
    "choices", [{}, {"priced": True}, {"algorithm": an.npaco(ants=9, iterations=9), "seed": 4}, {"tolerance": 0.0}]
)
def test_round_trip(choices: dict, tmp_path: Path) -> None:
    found = found_on(**choices)
    assert len(found) == 2
    found.save(tmp_path / "routes.json")
    again = an.Alternatives.load(tmp_path / "routes.json")
    assert again.to_dict() == found.to_dict()
    assert again.summary() == found.summary()
    again.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "routes.json").read_bytes()


def test_without_a_route(tmp_path: Path) -> None:
    found = an.alternatives(an.Problem.from_cells(grid_of("..#..", "..#.."), (0, 0), (0, 4)))
    found.save(tmp_path / "routes.json")
    document = json.loads((tmp_path / "routes.json").read_text())
    assert (document["status"], document["routes"], document["optimum"]) == ("unreachable", [], None)
    assert len(an.Alternatives.load(tmp_path / "routes.json")) == 0


def test_what_readers_find(tmp_path: Path) -> None:
    found = found_on()
    document = found.to_dict(map_cells=False)
    assert document["schema"] == "antnav/alternatives"
    assert [route["cost"] for route in document["routes"]] == [route.cost for route in found]
    assert list(document["routes"][0]["path"][0]) == [2, 0]
    assert "cells" not in document["problem"]["map"]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda file: file.update(schema="antnav/result"), "antnav/alternatives"),
        (lambda file: file.update(version=2), "version 2"),
        (lambda file: file.update(k=0), "k"),
        (lambda file: file.update(seed=-1), "seed"),
        (lambda file: file.update(status="unreachable"), "routes"),
        (lambda file: file.update(optimum=None), "optimum"),
        (lambda file: file.update(optimum=99.0), "optimum"),
        (lambda file: file.update(algorithm={"kind": "exact", "method": "magic"}), "magic"),
        (lambda file: file["routes"].reverse(), "routes"),
        (lambda file: file["routes"][1].update(difference=0.1), "routes"),
        (lambda file: file["routes"][1].update(obstacles=0), "routes"),
        (lambda file: file["routes"][1]["path"].pop(3), "not neighbours"),
        (lambda file: file["routes"].append(file["routes"][1]), "routes"),
        (lambda file: file["problem"]["map"].pop("cells"), "map"),
    ],
)
def test_what_cannot_be_true_is_refused(change, told: str, tmp_path: Path) -> None:
    file = found_on().to_dict()
    change(file)
    (tmp_path / "routes.json").write_text(json.dumps(file))
    with pytest.raises(ResultFormatError, match=told):
        an.Alternatives.load(tmp_path / "routes.json")


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b"\xff", b"{" * 99999])
def test_what_is_no_file_of_alternatives(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "routes.json").write_bytes(content)
    with pytest.raises(ResultFormatError):
        an.Alternatives.load(tmp_path / "routes.json")


def test_no_file_and_no_place(tmp_path: Path) -> None:
    with pytest.raises(ResultFormatError, match="No such file"):
        an.Alternatives.load(tmp_path / "none.json")
    with pytest.raises(ParameterError, match=r"\.json"):
        found_on().save(tmp_path / "routes.csv")
    with pytest.raises(OutputError):
        found_on().save(tmp_path / "none" / "routes.json")
