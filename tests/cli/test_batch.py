"""`antnav batch`: rows in, rows out, in their order; a bad row costs no other."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import antnav as an
from antnav import maps

PAIRS = """id,start_row,start_col,goal_row,goal_col
a,21,0,1,25
b,1,2,3
c,5,5,five,5

d,1,25,21,0
e,99,0,0,0
"""
RULE = ("--corner-rule", "allow")


def test_rows_come_out_as_they_went_in_and_bad_ones_are_told(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    code, out, err = cli("batch", "equiv30", "pairs.csv", "-o", "paths.jsonl", "--algorithm", "astar", *RULE)
    assert code == 3
    assert "5, 2 with a path; 3 bad rows" in out
    told = [line.split(": ", 2)[2] for line in err.splitlines()]
    assert [line.split(":")[0] for line in told] == [f"pairs.csv, line {number}" for number in (3, 4, 7)]
    rows = [json.loads(line) for line in (tmp_path / "paths.jsonl").read_text().splitlines()]
    assert [(row["line"], row["id"], row["status"]) for row in rows] == [
        (2, "a", "found"),
        (3, None, "error"),
        (4, "c", "error"),
        (6, "d", "found"),
        (7, "e", "error"),
    ]
    grid = maps.builtin("equiv30")
    result = an.solve(an.Problem.from_cells(grid, (21, 0), (1, 25), corner_rule="allow"), an.astar())
    assert rows[0]["cells"] == result.path.cells.tolist()
    assert rows[0]["path"] == result.path.points.tolist()
    assert (rows[0]["length"], rows[0]["optimum"]) == (result.length, None)


def test_the_same_bytes_whatever_the_workers(cli, tmp_path: Path) -> None:
    tmp_path.joinpath("pairs.csv").write_text(PAIRS)
    ants = (*RULE, "--ants", 4, "--iterations", 20, "--optimum", "-q")
    for workers in (1, 2):
        assert cli("batch", "equiv30", "pairs.csv", "-o", f"{workers}.csv", "--workers", workers, *ants)[0] == 3
    assert (tmp_path / "1.csv").read_bytes() == (tmp_path / "2.csv").read_bytes()
    rows = list(csv.DictReader((tmp_path / "1.csv").open()))
    assert float(rows[0]["gap"]) == float(rows[0]["length"]) / float(rows[0]["optimum"]) - 1
    assert rows[0]["path"].startswith("LINESTRING (0.5 8.5, ")
