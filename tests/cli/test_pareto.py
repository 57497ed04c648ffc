"""`antnav pareto`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.fronts.pareto import warmup
from tests.cli.conftest import Run
from tests.conftest import grid_of

HALL = grid_of("........", "...##...", "...##...", "........", "........")
ENDS = ("--cells", "--start", "0,0", "--goal", "0,7")


@pytest.fixture(autouse=True)
def _hall(tmp_path: Path) -> None:
    for method in ("auto", "sweep"):
        warmup(method)  # or the first command says that it compiles
    an.save_map(HALL, tmp_path / "hall.yaml")


def test_a_front_is_printed_and_saved(cli: Run, tmp_path: Path) -> None:
    asked = ("--objective", "length", "--objective", "risk:clearance:2:3")
    code, out, err = cli("pareto", "hall.yaml", *ENDS, *asked, "-o", "front.json", "-o", "front.csv", "-o", "front.png")
    assert (code, err) == (0, "")
    front = an.Front.load(tmp_path / "front.json")
    assert f"{len(front)} paths, complete" in out
    assert "knee" in out
    assert (tmp_path / "front.png").stat().st_size > 10_000
    assert len((tmp_path / "front.csv").read_text().splitlines()) == len(front) + 1
    code, out, _ = cli("pareto", "hall.yaml", *ENDS, *asked, "--json", "--method", "sweep")
    told = json.loads(out)
    assert (code, told["complete"]) == (0, False)
    assert {tuple(row) for row in told["values"]} <= {tuple(row) for row in front.values.tolist()}


def test_masks_close_cells_and_slow_down(cli: Run, tmp_path: Path) -> None:
    mask = np.zeros(HALL.shape, np.uint8)
    mask[0, 3] = 1
    an.save_map(an.GridMap(mask), tmp_path / "mask.yaml")
    asked = ("--objective", "length", "--objective", "turns")
    code, out, _ = cli("pareto", "hall.yaml", *ENDS, *asked, "--keepout", "mask.yaml", "--json")
    assert code == 0
    assert all([0, 3] not in path for path in json.loads(out)["paths"])


def test_mistakes_are_one_line(cli: Run) -> None:
    for options in (
        ("--objective", "length"),
        ("--objective", "length", "--objective", "speed"),
        ("--objective", "length", "--objective", "length"),
        ("--objective", "length", "--objective", "turns", "--method", "magic"),
        ("--objective", "length", "--objective", "turns", "-o", "front.txt"),
    ):
        code, out, err = cli("pareto", "hall.yaml", *ENDS, *options)
        assert (code, out) == (2, ""), options
        assert err.startswith("antnav: error: ")
        assert err.count("\n") == 1


def test_no_way_is_told_by_the_exit_code(cli: Run, tmp_path: Path) -> None:
    an.save_map(grid_of(".#.", ".#.", ".#."), tmp_path / "walled.yaml")
    ends = ("--cells", "--start", "0,0", "--goal", "0,2")
    code, out, _ = cli("pareto", "walled.yaml", *ends, "--objective", "length", "--objective", "turns")
    assert code == 1
    assert "unreachable" in out
