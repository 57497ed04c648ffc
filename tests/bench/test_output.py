"""The files that a benchmark leaves."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from antnav.bench.output import Mark, Picture, draw_picture, write
from antnav.errors import OutputError
from antnav.report.table import Column, Table

pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")

PICTURE = Picture(
    {
        "one": {"a": Mark(0.0, 3.0, 1.0), "b": Mark(math.inf, math.inf, 2.0)},
        "$two": {"a": Mark(math.nan, math.nan, math.nan), "c_d": Mark(40.0, math.inf, 1e4)},
    },
    "gap",
    "time",
)
TABLE = Table("summary", "Title", (Column("peer"), Column("gap %", ".2f")), (("x|y", 1.0),), "A note.")
RAW = Table("runs", "Raw", (Column("peer"),), (("x",),))


def test_files(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    write(out, RAW, TABLE, PICTURE)
    assert {path.name for path in out.iterdir()} == {
        "runs.csv",
        "summary.csv",
        "summary.md",
        "figure.svg",
        "figure.png",
    }
    assert (out / "runs.csv").read_text() == "peer\nx\n"
    text = (out / "summary.md").read_text()
    assert "| x\\|y | 1.00 |" in text
    assert "A note." in text
    before = (out / "figure.svg").read_bytes()
    write(out, RAW, TABLE, PICTURE)
    assert (out / "figure.svg").read_bytes() == before


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError):
        write(tmp_path / "file" / "out", RAW, TABLE, PICTURE)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_rows_and_what_has_no_path() -> None:
    left, right = draw_picture(PICTURE).axes
    assert [label.get_text() for label in left.get_yticklabels()] == ["a", "b", "c_d"]
    assert sum(line.get_marker() == "x" for line in left.get_lines()) == 1
    assert right.get_xscale() == "log"
    assert [text.get_text() for text in right.get_legend().get_texts()] == ["one", "$two"]
