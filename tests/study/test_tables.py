"""Tables, and the four ways to write them."""

from __future__ import annotations

import csv
import io

from antnav.study import tables

TABLE = tables.Table(
    "t", "A & B", (tables.Column("a_b|c"), tables.Column("x", ".2f")), (("50 % <b>|", 1.23456), ("-", None)), "100 %"
)
LABELS = tables.Table("t", "T", (tables.Column("x"), tables.Column("y")), (("[a]\nb", "[c]"), ("*d", "\r\n")))


def test_markdown() -> None:
    assert TABLE.markdown().splitlines() == [
        "| a_b\\|c | x |",
        "| --- | ---: |",
        "| 50 % &lt;b&gt;\\| | 1.23 |",
        "| - | - |",
    ]


def test_labels_of_several_lines_stay_in_their_row() -> None:
    assert LABELS.markdown().splitlines()[2:] == ["| [a] b | [c] |", "| *d |  |"]
    assert list(csv.reader(io.StringIO(LABELS.csv()))) == [["x", "y"], ["[a]\nb", "[c]"], ["*d", "\r\n"]]


def test_latex_does_not_take_a_label_for_an_option() -> None:
    lines = LABELS.latex().splitlines()
    start = lines.index("\\midrule") + 1
    assert lines[start : start + 2] == ["{}[a] b & [c] \\\\", "{}*d &  \\\\"]


def test_csv_keeps_full_precision() -> None:
    assert list(csv.reader(io.StringIO(TABLE.csv()))) == [["a_b|c", "x"], ["50 % <b>|", "1.23456"], ["-", ""]]


def test_latex_is_escaped_and_has_booktabs() -> None:
    text = TABLE.latex()
    assert "\\begin{tabular}{lr}" in text
    assert "a\\_b|c & x \\\\" in text
    assert "50 \\% <b>| & 1.23 \\\\" in text
    assert "A \\& B. 100 \\%" in text
    assert [text.count(rule) for rule in ("\\toprule", "\\midrule", "\\bottomrule")] == [1, 1, 1]


def test_html_is_escaped() -> None:
    assert "50 % &lt;b&gt;|" in TABLE.html()
    assert "<caption>A &amp; B</caption>" in TABLE.html()
