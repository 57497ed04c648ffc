"""The tables of a report: values from made-up records."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import fields, replace

import pytest

import antnav as an
from antnav.planner.facts import Certainty
from antnav.report import table as tables
from antnav.report import to_csv
from antnav.study import comparison, published, report, results
from antnav.study.groups import grouped
from antnav.study.record import Mark, Record
from tests.study.made_up import OPTIMUM, made_up, paper_like, rows_of


def outcomes(records: list[Record], label: str = "equiv20", paper: bool = True) -> list[dict[str, tables.Value]]:
    return rows_of(results.outcomes(label, grouped(records)[label], paper=paper, name="t", title="T"))


def test_outcomes_hold_ours_and_the_published_apart() -> None:
    first, *_ = outcomes([made_up("paco", seed, OPTIMUM + more) for seed, more in enumerate((0, 0, 0, 4))])
    assert first["runs"] == 4
    assert first["time (median wall s)"] == 0.25
    assert first["best"] == first["optimum"] == OPTIMUM
    assert first["mean"] == pytest.approx(OPTIMUM + 1)
    assert first["gap of mean (%)"] == pytest.approx(100 / OPTIMUM)
    assert (first["success (%)"], first["optimal (%)"]) == (100, 75)
    assert first["steps"] == 1001.5
    assert first[f"time s: {published.LABEL}"] == 1.63
    assert first[f"mean: {published.LABEL}"] == 29.2132


def test_published_columns_only_in_the_paper_mode() -> None:
    (row,) = outcomes([made_up("paco", 0, OPTIMUM)], paper=False)
    assert not [head for head in row if "published" in head]


def test_every_row_states_its_certainty() -> None:
    rows = outcomes(paper_like())
    assert {row["algorithm"]: row["certainty"] for row in rows}["dai"] == "reconstruction of somebody"
    assert all(row["certainty"] for row in rows)


def test_no_path_is_said_in_words_and_is_inf_in_csv() -> None:
    table = results.outcomes(
        "map 40x40", {"traditional": [made_up("traditional", 0, None)]}, paper=True, name="t", title="T"
    )
    (row,) = rows_of(table)
    assert (row["best"], row[f"best: {published.LABEL}"], row["success (%)"]) == (math.inf, math.inf, 0)
    assert table.texts[0].count("no path") == 6  # best, mean and median of ours; time, best and mean of theirs
    assert "inf" in to_csv.table(table)


def test_time_saved() -> None:
    row, *_ = rows_of(results.saved_time(grouped(paper_like()), paper=True))
    assert row["saved, wall s (%)"] == 50
    assert row["saved, CPU s (%)"] == 0
    assert row[f"saved (%): {published.LABEL}"] == 50.71
    assert results.saved_time(grouped([made_up("luo", 0, 40.0)]), paper=True) is None


def test_wall_seconds_of_runs_that_had_company_are_left_out() -> None:
    records = [replace(record, marks=(Mark.LOADED,) * (record.seed == 0)) for record in paper_like()]
    groups = grouped(records)
    row, *_ = rows_of(results.saved_time(groups, paper=True))
    assert row["saved, CPU s (%)"] == 0
    assert math.isnan(row["saved, wall s (%)"])
    assert math.isnan(row["PACO wall s"])
    table = results.outcomes("equiv20", groups["equiv20"], paper=True, name="t", title="T")
    assert {texts[3] for texts in table.texts} == {"-"}
    assert "other runs ran beside them" in table.note
    assert "beside" not in results.outcomes("m", {"a": [made_up("a", 0, 30.0)]}, paper=False, name="t", title="T").note


def test_auxiliary_cells() -> None:
    row, *_ = rows_of(results.auxiliary_cells(grouped(paper_like()), paper=True))
    assert row["most frequent (row, col)"] == row["printed (row, col)"] == "(9, 8)"
    assert (row["share (%)"], row["different cells"], row["runs with the printed one (%)"]) == (80, 2, 80)
    assert results.auxiliary_cells(grouped([made_up("luo", 0, 40.0)]), paper=True) is None


def test_who_knows_the_way_and_whose_steps_are_evaluations_is_told() -> None:
    grid = an.maps.generate("rooms", 50, 50, seed=1)
    known = an.paco(certainty="my own").on(grid).knows.names
    group = {"paco": [made_up("paco", 0, 30.0, knows=known)], "ga": [made_up("ga", 0, 30.0)]}
    note = results.outcomes("m", group, paper=False, name="t", title="T", rivals=["ga"]).note
    assert " paco: ants guided by a heuristic that knows the exact distance to the goal from every cell." in note
    assert "steps are cost evaluations" in note
    small = results.outcomes("m", {"ga": group["ga"]}, paper=False, name="t", title="T").note
    assert "guided" not in small
    assert "evaluations" not in small


def test_no_time_is_saved_where_no_path_exists() -> None:
    records = [made_up(name, 0, None, optimum=None) for name in ("paco", "npaco")]
    assert results.saved_time(grouped(records), paper=True) is None


def test_csv_of_outcomes_and_comparisons_holds_numbers_only() -> None:
    """Full precision: what readers see as "0.34 to 1.71" can be read back."""
    groups = grouped([made_up(name, seed, 30.0 + seed) for name in "ab" for seed in range(6)])
    for table in (
        results.outcomes("equiv20", groups["equiv20"], paper=False, name="t", title="T"),
        comparison.comparisons(groups),
    ):
        assert table is not None
        words = {"map", "first", "second", "algorithm", "certainty", "effect", "at 5 %"}
        for row in csv.DictReader(io.StringIO(to_csv.table(table))):
            assert all(math.isfinite(float(text)) for head, text in row.items() if head not in words)


def test_runs_csv_loses_nothing() -> None:
    records = [*paper_like(), made_up("paco", 9, 29.213203435596427, notes=("a, note", 'with "quotes"\nand a line'))]
    kinds = {field.name: str(field.type) for field in fields(Record)}

    def parsed(name: str, text: str) -> object:
        if text == "":
            return None
        if name == "environment":
            return json.loads(text)
        if name == "certainty":
            return Certainty.of(text)
        if "tuple" in kinds[name] or name == "auxiliary_cell":
            return tuple(tuple(item) if isinstance(item, list) else item for item in json.loads(text))
        return int(text) if kinds[name].startswith("int") else float(text) if "float" in kinds[name] else text

    rows = csv.DictReader(io.StringIO(report.runs_csv(records)))
    again = [
        Record(**{name: int(text) if name == "turns" and text else parsed(name, text) for name, text in row.items()})
        for row in rows
    ]
    assert again == records
