"""Costs on the command line and in study files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import costs
from antnav.costs.named import collected, named
from antnav.errors import ParameterError
from antnav.plot import data
from antnav.study.toml import load_study
from tests.cli.conftest import Run
from tests.conftest import grid_of

HALL = grid_of("#########", "#.......#", "#.......#", "#.......#", "#########")


def test_a_text_stands_for_a_field() -> None:
    assert named("clearance:1.5", HALL).digest == costs.clearance(HALL, 1.5).digest
    assert named("clearance:1.5:3", HALL).digest == costs.clearance(HALL, 1.5, 3.0).digest
    assert named("inflation:2:1:0.5:2", HALL).digest == costs.inflation(HALL, 2.0, 1.0, 0.5, 2.0).digest
    both = collected(HALL, ["clearance:1.5", "clearance:1.5"])
    assert both is not None
    np.testing.assert_array_equal(both.values, 2 * costs.clearance(HALL, 1.5).values)
    assert collected(HALL) is None


@pytest.mark.parametrize("text", ["", "walls:1", "clearance", "clearance:x", "clearance:1:2:3", "clearance:-1", 3])
def test_what_stands_for_none_is_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        named(text, HALL)


def test_the_command_line_keeps_off_walls_and_zones(cli: Run, tmp_path: Path) -> None:
    an.save_map(HALL, tmp_path / "hall.yaml")
    mask = np.zeros(HALL.shape, np.uint8)
    mask[2, 4] = 1
    an.save_map(an.GridMap(mask), tmp_path / "mask.yaml")
    ends = ["--cells", "--start", "1,1", "--goal", "1,7"]
    told = {}
    for name, options in {
        "plain": [],
        "clear": ["--cost", "clearance:1.6:9"],
        "kept out": ["--cost", "clearance:1.6:9", "--keepout", "mask.yaml", "--turning", "0.1"],
    }.items():
        code, out, err = cli("plan", "hall.yaml", *ends, *options, "--json", "--check", "--algorithm", "astar")
        assert (code, err) == (0, "")
        told[name] = json.loads(out)
    assert told["plain"]["cost"] == told["plain"]["length"] == 6.0
    assert [2, 4] in told["clear"]["path"]
    assert [2, 4] not in told["kept out"]["path"]
    assert told["kept out"]["cost"] > told["clear"]["cost"] > 6.0
    assert all(document["gap"] == 0 for document in told.values())
    code, out, _ = cli(
        "plan", "hall.yaml", *ends, "--cost", "clearance:1.6:9", "--algorithm", "npaco", "-o", "hall.png"
    )
    assert code == 0
    assert "cells: the length, clearance" in out


def test_the_command_line_goes_around_a_hill(cli: Run, tmp_path: Path) -> None:
    an.save_map(HALL, tmp_path / "hall.yaml")
    heights = np.zeros(HALL.shape)
    heights[1:3, 4] = 2.0
    np.save(tmp_path / "heights.npy", heights)
    plan = ("plan", "hall.yaml", "--cells", "--start", "1,1", "--goal", "1,7", "--json", "--check", "--algorithm")
    for algorithm in ("astar", "paco_ls"):
        code, out, err = cli(*plan, algorithm, "--cost", "slope:heights.npy:5", "--cost", "slope:heights.npy:1:0.5")
        assert (code, err) == (0, "")
        document = json.loads(out)
        assert [3, 4] in document["path"]
        assert document["cost"] == pytest.approx(document["length"])
        assert (document["problem"]["cost"]["up"], document["problem"]["cost"]["down"]) == (6.0, 0.5)
    np.save(tmp_path / "small.npy", heights[1:])
    for text, words in {
        "slope": "slope:FILE:UP:DOWN",
        "slope:heights.npy": "the last number optional",
        "slope:heights.npy:0": "one of them is above 0",
        "slope:absent.npy:1": "absent.npy",
        "slope:small.npy:1": "4 x 9 cells: the map has 5 x 9",
    }.items():
        code, _, err = cli(*plan, "astar", "--cost", text)
        assert code == 2
        assert words in err


def test_mistakes_are_one_line(cli: Run, tmp_path: Path) -> None:
    for options in (["--cost", "walls"], ["--keepout", "absent.yaml"], ["--turning", "-1"]):
        code, out, err = cli("plan", "equiv20", *options)
        assert (code, out) == (2, "")
        assert err.startswith("antnav: error: ")
        assert err.count("\n") == 1


def test_masks_that_do_nothing_and_bad_numbers_are_refused(cli: Run, tmp_path: Path) -> None:
    an.save_map(HALL, tmp_path / "hall.yaml")
    an.save_map(an.GridMap(np.zeros(HALL.shape, np.uint8)), tmp_path / "empty.yaml")
    plan = ("plan", "hall.yaml", "--cells", "--start", "1,1", "--goal", "1,7")
    for options, words in {
        ("--keepout", "empty.yaml"): "the mask closes no cell",
        ("--speed", "empty.yaml"): "the mask slows no cell",
        ("--cost", "clearance:-1"): "cost 'clearance:-1', radius -1",
    }.items():
        code, _, err = cli(*plan, *options)
        assert code == 2
        assert words in err


def test_a_study_file_has_costs(tmp_path: Path) -> None:
    an.save_map(HALL, tmp_path / "mask.yaml")
    heights = np.random.default_rng(1).random((20, 20))
    np.savetxt(tmp_path / "heights.csv", heights, delimiter=",")
    (tmp_path / "study.toml").write_text(
        'title = "t"\nseeds = 1\n[[maps]]\nbuiltin = "equiv20"\nturning = 0.5\n'
        'cost = ["clearance:2", "slope:heights.csv:8:1"]\n'
        '[[maps]]\nbuiltin = "equiv20"\nlabel = "plain"\n[[algorithms]]\npreset = "astar"\n'
    )
    priced, plain = load_study(tmp_path / "study.toml").maps
    assert priced.problem.turning == 0.5
    field = costs.clearance(priced.problem.grid, 2.0) + costs.slope(heights, up=8.0, down=1.0)
    assert priced.problem.cost.digest == field.digest
    assert plain.problem.objective.plain


def test_costs_are_a_layer_of_the_picture() -> None:
    field = costs.clearance(HALL, 1.6, 9.0)
    result = an.solve(an.Problem.from_cells(HALL, (1, 1), (1, 7), cost=field), an.astar())
    layer = data.costs(result.problem)
    assert layer is not None
    assert layer.label == "clearance, 0 to 6.19 per metre"
    assert layer.shade[0, 0] == 0.0  # a wall stays a wall
    assert layer.shade.max() == 1.0
    assert data.costs(an.Problem.from_cells(HALL, (1, 1), (1, 7))) is None
    assert data.convergence(result).quantity == "cost"
