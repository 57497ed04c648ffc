"""Tables, and the four ways to write them."""

from __future__ import annotations

import csv
import io

import pytest

from antnav.report import to_csv, to_html, to_latex, to_markdown
from antnav.report.table import Column, Table
from antnav.report.text import plain

TABLE = Table("t", "A & B", (Column("a_b|c"), Column("x", ".2f")), (("50 % <b>|", 1.23456), ("-", None)), "100 %")
LABELS = Table("t", "T", (Column("x"), Column("y")), (("[a]\nb", "[c]"), ("*d", "\r\n")))


def test_markdown() -> None:
    assert to_markdown.table(TABLE).splitlines() == [
        "| a_b\\|c | x |",
        "| --- | ---: |",
        "| 50 % &lt;b>\\| | 1.23 |",
        "| - | - |",
    ]


def test_labels_of_several_lines_stay_in_their_row() -> None:
    assert to_markdown.table(LABELS).splitlines()[2:] == ["| [a] b | [c] |", "| *d |  |"]
    assert list(csv.reader(io.StringIO(to_csv.table(LABELS)))) == [["x", "y"], ["[a]\nb", "[c]"], ["*d", "\r\n"]]


def test_latex_does_not_take_a_label_for_an_option() -> None:
    lines = to_latex.table(LABELS).splitlines()
    start = lines.index("\\midrule") + 1
    assert lines[start : start + 2] == ["{}[a] b & [c] \\\\", "{}*d &  \\\\"]


def test_csv_keeps_full_precision() -> None:
    assert list(csv.reader(io.StringIO(to_csv.table(TABLE)))) == [["a_b|c", "x"], ["50 % <b>|", "1.23456"], ["-", ""]]


def test_latex_is_escaped_and_has_booktabs() -> None:
    text = to_latex.table(TABLE)
    assert "\\begin{tabular}{lr}" in text
    assert "a\\_b|c & x \\\\" in text
    assert "50 \\% <b>| & 1.23 \\\\" in text
    assert "A \\& B. 100 \\%" in text
    assert [text.count(rule) for rule in ("\\toprule", "\\midrule", "\\bottomrule")] == [1, 1, 1]


def test_signs_between_values_stay_in_markdown_and_tags_do_not() -> None:
    assert plain("t <= b T, t > 3, t >= 4, a -> b, 5 < 6") == "t <= b T, t > 3, t >= 4, a -> b, 5 < 6"
    assert plain("<b>x</b><!-- -->") == "&lt;b>x&lt;/b>&lt;!-- -->"
    assert plain("> quoted") == "&gt; quoted"


@pytest.mark.parametrize("sign", "=+-@")
def test_no_cell_of_a_csv_file_is_a_formula(sign: str) -> None:
    bad = (f"{sign}cmd|' /C calc'!A0", f" {sign}A1", f"\t{sign}A1", f"{sign}1+1")
    table = Table("t", "T", (Column(f"{sign}head"), Column("y")), tuple((text, 1) for text in bad))
    head, *rows = csv.reader(io.StringIO(to_csv.table(table)))
    assert head == [f"'{sign}head", "y"]
    assert [row[0] for row in rows] == [f"'{text}" for text in bad]


def test_numbers_and_signs_alone_stay_in_csv_files() -> None:
    good = ("-", "+", "-3.5", "+1e5", "a=b", "", "-inf")
    table = Table("t", "T", (Column("x"), Column("y")), tuple((text, -2.5) for text in good))
    assert [row[0] for row in csv.reader(io.StringIO(to_csv.table(table)))][1:] == list(good)
    assert "-2.5" in to_csv.table(table)


def test_html_is_escaped() -> None:
    assert "50 % &lt;b&gt;|" in to_html.table(TABLE)
    assert "<caption>A &amp; B</caption>" in to_html.table(TABLE)


def test_short_heads_and_footnotes_in_print_the_whole_in_csv() -> None:
    columns = (
        Column("algorithm"),
        Column("certainty", footnote=True),
        Column("best of all", ".1f", short="best"),
    )
    table = Table("t", "T", columns, (("a", "sure", 1.0), ("b", "sure", 2.0), ("c", "unsure", 3.0)), "Note.")
    for text in (to_latex.table(table), to_html.table(table)):
        assert "Note. Certainty of a, b: sure. Certainty of c: unsure." in text
        assert "best of all" not in text
        assert "sure &" not in text
    assert to_csv.table(table).splitlines()[0] == "algorithm,certainty,best of all"
    assert "| sure |" in to_markdown.table(table)


def test_latex_puts_wide_tables_in_parts_and_counts_by_itself() -> None:
    columns = (Column("map"), Column("who"), *(Column(f"value {i}", ".4f") for i in range(16)))
    text = to_latex.table(Table("t", "Table 2. Results", columns, (("m", "x", *(1.0 * i for i in range(16))),)))
    heads = [line for line in text.splitlines() if line.startswith("map & who & ")]
    assert len(heads) == text.count("\\begin{tabular}") == 2
    assert [f"value\\\\{i}}}" in "".join(heads) for i in range(16)] == [True] * 16
    assert "\\caption{Results (the paper's Table 2).}" in text
    assert "resizebox" not in text
    assert "{lp" not in to_latex.table(TABLE)
    assert "p{172pt}" in to_latex.table(Table("t", "T", (columns[0], columns[1]), (("m", 50 * "x"),)))


def test_long_tables_break_between_pages_in_latex() -> None:
    columns = (Column("no.", "d"), Column("claim"), Column("ours"))
    text = to_latex.table(Table("t", "T", columns, tuple((i, "c" * 50, "o" * 50) for i in range(40))))
    assert text.count("\\begin{longtable}") == text.count("\\endhead") == text.count("\\end{longtable}") == 2
    assert text.count("\\caption{T.}\\label{tab:t}\\\\") == 1
    assert "table*" not in text
    assert [line.split(" & ")[0] for line in text.splitlines() if line.endswith("\\\\") and " & " in line].count(
        "7"
    ) == 2


def test_footnotes_say_once_what_all_rows_share() -> None:
    columns = (Column("who"), Column("certainty", footnote=True), Column("x", "d"))
    text = to_html.table(Table("t", "T", columns, (("a", "paper; ours", 1), ("b", "paper; modified; ours", 2))))
    assert "Certainty of all: paper; ours. Certainty of b: modified.<" in text
