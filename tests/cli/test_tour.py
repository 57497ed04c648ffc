"""`antnav tour`: exit codes, the table, JSON, files and stops from files."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run

MAP = "0000000000\n0000110000\n0000110000\n0000000000\n0000000000\n"
ENDS = ("--cells", "--start", "2,0", "--stop", "0,9", "--stop", "4,9", "--stop", "4,0")


@pytest.fixture
def block(tmp_path: Path) -> str:
    path = tmp_path / "block.txt"
    path.write_text(MAP)
    return str(path)


def test_a_tour_is_told(cli: Run, block: str) -> None:
    code, out, err = cli("tour", block, *ENDS, "--return", "--check")
    assert (code, err) == (0, "")
    rows = dict(line.split(None, 1) for line in out.splitlines())
    assert list(rows) == ["status", "order", "length", "gap", "clearance", "method", "legs", "seconds", "checked"]
    assert rows["status"] == "found, 3 stops, and back"
    assert rows["order"] in ("1, 2, 3", "3, 2, 1")
    assert rows["gap"] == "0.00 %: no order is better (proven)"


def test_files_json_and_trajectory(cli: Run, block: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    outputs = [option for name in ("tour.json", "tour.csv", "tour.png") for option in ("-o", name)]
    drive = ("--trajectory", "drive.csv", "--robot-radius", "0.3", "--margin", "0.1", "--spacing", "0.2")
    code, out, _ = cli("tour", block, *ENDS, *outputs, *drive, "--order", "given", "--json", "--seed", "5")
    told = json.loads(out)
    assert code == 0
    assert (told["order"], told["radius"], told["margin"], told["seed"]) == ([1, 2, 3], 0.3, 0.1, 5)
    assert json.loads((tmp_path / "tour.json").read_text())["legs"] == told["legs"]
    with (tmp_path / "tour.csv").open() as stream:
        assert [row["stop"] for row in csv.DictReader(stream)] == ["0", "1", "2", "3"]
    with (tmp_path / "drive.csv").open() as stream:
        assert len(list(csv.DictReader(stream))) == len(told["trajectory"]["poses"])
    assert told["trajectory"]["wall_distance_m"] >= 0.4 - 1e-9
    assert (tmp_path / "tour.png").stat().st_size > 1000


def test_stops_from_files_come_after_the_others(cli: Run, block: str, tmp_path: Path) -> None:
    (tmp_path / "metres.csv").write_text("id;X;y\na;9.5;4.5\n\nb;9.5;0.5\n")
    code, out, _ = cli("tour", block, "--start", "0.5,2.5", "--stop", "0.5,0.5", "--stops", "metres.csv", "--json")
    assert code == 0
    assert json.loads(out)["places"] == [[0.5, 2.5], [0.5, 0.5], [9.5, 4.5], [9.5, 0.5]]
    (tmp_path / "cells.csv").write_text("\ufeffrow,col\n0,9\n4,9\n")
    code, out, _ = cli("tour", block, "--start", "0.5,2.5", "--stops", "cells.csv", "--json", "--method", "ants")
    assert json.loads(out)["places"] == [[0.5, 2.5], [9.5, 4.5], [9.5, 0.5]]


def test_who_cannot_reach_a_stop_hears_which(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "wall.txt").write_text("00100\n00100\n")
    code, out, _ = cli(
        "tour", "wall.txt", "--cells", "--start", "0,0", "--stop", "1,1", "--stop", "0,4", "-o", "tour.csv"
    )
    assert code == 1
    assert "unreachable, 2 stops" in out
    assert "no path leads from the start to stop 2 at (4.5, 1.5) m" in out
    assert (tmp_path / "tour.csv").read_text() == "stop,x,y,length_m,total_m\n"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--stop", "1,1"), "no --start: a tour begins somewhere; give --start X,Y in metres"),
        (("--start", "1,1"), "stops: none: a tour has 1 to 1000"),
        (("--start", "1,1", "--stop", "4.5,2.5"), "stop 1 (4.5, 2.5) m = cell (2, 4): an obstacle is there"),
        (("--start", "1,1", "--stop", "1"), "--stop '1': a point is X,Y in metres"),
        (("--start", "1,1", "--stop", "1,1", "--order", "worst"), "--order 'worst': it is best, or as given"),
        (("--start", "1,1", "--stop", "1,1", "--method", "simplex"), "--method 'simplex': the methods are auto, exact"),
        (("--start", "1,1", "--stop", "1,1", "--margin", "-1"), "--margin -1"),
        (("--start", "1,1", "--stop", "1,1", "--spacing", "1"), "they are of --trajectory"),
        (("--start", "1,1", "--stops", "none.csv"), "stops none.csv: No such file"),
        (("--start", "1,1", "--stops", "heads.csv"), "stops heads.csv: its columns are x and y in metres, or row and"),
        (("--start", "1,1", "--stops", "bad.csv"), "stops bad.csv, line 3 'a,2': a stop is two numbers; mend the line"),
        (("--start", "1,1", "--stops", "short.csv"), "stops short.csv, line 2 '1': a stop is two whole numbers"),
        (("--start", "1,1", "--stops", "far.csv"), "--stops 9,9: the map has rows 0..4"),
        (("--start", "1,1", "--stop", "1,1", "-o", "tour.txt"), "its ending must be one of .json"),
    ],
)
def test_bad_input(cli: Run, block: str, tmp_path: Path, options: tuple[str, ...], told: str) -> None:
    (tmp_path / "heads.csv").write_text("1,2\n3,4\n")
    (tmp_path / "bad.csv").write_text("x,y\n1,2\na,2\n")
    (tmp_path / "short.csv").write_text("row,col\n1\n")
    (tmp_path / "far.csv").write_text("row,col\n9,9\n")
    code, out, err = cli("tour", block, *options)
    assert (code, out) == (2, "")
    assert told in err
    assert len(err.splitlines()) == 1
