"""The tables of a report: values from made-up records."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import fields, replace

import pytest

import antnav as an
from antnav.report import table as tables
from antnav.report import to_csv
from antnav.study import comparison, groups, published, report, results, verdicts
from antnav.study.groups import grouped
from antnav.study.record import LOADED, Record
from tests.study.made_up import OPTIMUM, made_up, paper_like


def rows_of(table: tables.Table | None) -> list[dict[str, tables.Value]]:
    assert table is not None
    return [dict(zip([column.head for column in table.columns], row, strict=True)) for row in table.rows]


def outcomes(records: list[Record], label: str = "equiv20", paper: bool = True) -> list[dict[str, tables.Value]]:
    return rows_of(results.outcomes(label, grouped(records)[label], paper=paper, name="t", title="T"))


def test_groups_keep_the_order_of_maps_and_algorithms_and_sort_seeds() -> None:
    records = [made_up("b", 2, 9.0), made_up("a", 1, 9.0, label="m"), made_up("b", 0, 9.0)]
    groups = grouped(records)
    assert list(groups) == ["equiv20", "m"]
    assert [run.seed for run in groups["equiv20"]["b"]] == [0, 2]


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
    records = [replace(record, notes=(LOADED,) * (record.seed == 0)) for record in paper_like()]
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


def test_equally_frequent_cells_are_settled_by_map_order() -> None:
    runs = [made_up("paco", seed, 40.0, auxiliary_cell=cell) for seed, cell in enumerate([(5, 5), (2, 9)])]
    assert groups.most_frequent(runs) == ((2, 9), 1)


def test_comparisons_pair_common_seeds_only() -> None:
    records = [made_up("a", seed, 30.0) for seed in range(8)] + [
        made_up("b", seed, 31.0 + seed) for seed in range(2, 9)
    ]
    (row,) = rows_of(comparison.comparisons(grouped(records)))
    assert [row[head] for head in ("seeds", "first shorter", "equal", "first longer", "A12")] == [6, 6, 0, 0, 1.0]
    assert row["p (Holm)"] == row["p"] == pytest.approx(2 / 2**6)
    assert row["at 5 %"] == "a shorter"


def test_verdicts_are_of_the_corrected_p() -> None:
    """Six pairs of one sign: p = 2 / 2^6 = 0.031; the least of three such is tripled."""
    records = [made_up(name, seed, 30.0 + more) for more, name in enumerate("abc") for seed in range(6)]
    rows = rows_of(comparison.comparisons(grouped(records)))
    assert [row["p"] for row in rows] == [pytest.approx(0.03125)] * 3
    assert [row["p (Holm)"] for row in rows] == [pytest.approx(0.09375)] * 3
    assert {row["at 5 %"] for row in rows} == {"no difference shown"}


def test_many_algorithms_are_compared_with_the_first() -> None:
    records = [made_up(f"a{number}", seed, 30.0) for number in range(8) for seed in range(2)]
    rows = rows_of(comparison.comparisons(grouped(records)))
    assert [(row["first"], row["second"]) for row in rows] == [("a0", f"a{number}") for number in range(1, 8)]
    assert {row["at 5 %"] for row in rows} == {"no difference shown"}
    many, few = (comparison.comparisons(grouped(some)) for some in (records, records[:12]))
    assert many is not None
    assert few is not None
    assert "only the first is compared" in many.note
    assert "is compared" not in few.note
    assert len(few.rows) == 15


def test_a_baseline_is_compared_with_each_other_one() -> None:
    records = [made_up(name, seed, 30.0) for name in "abc" for seed in range(2)]
    table = comparison.comparisons(grouped(records), "b")
    assert table is not None
    assert [(row["first"], row["second"]) for row in rows_of(table)] == [("b", "a"), ("b", "c")]
    assert "b is the study's baseline" in table.note
    without = [record for record in records if record.algorithm != "b"]
    assert comparison.comparisons(grouped(without), "b") is None


def test_too_few_seeds_for_any_verdict_are_told() -> None:
    """Three pairs of six seeds: 3 * 2 / 2^6 = 0.094; of seven: 0.047."""
    runs = {
        count: [made_up(name, seed, 30.0 + more) for more, name in enumerate("abc") for seed in range(count)]
        for count in (6, 7)
    }
    (told,) = comparison.too_few_seeds(grouped(runs[6]))
    assert "6 seeds and 3 comparisons the least p (Holm) is 0.094. 7 seeds" in told
    assert comparison.too_few_seeds(grouped(runs[7])) == []
    assert {row["at 5 %"] for row in rows_of(comparison.comparisons(grouped(runs[7])))} == {"a shorter", "b shorter"}
    assert "and 2 comparisons" in comparison.too_few_seeds(grouped(runs[6]), "a")[0]
    assert comparison.too_few_seeds(grouped([made_up("a", 0, 30.0)])) == []


def test_who_knows_the_way_and_whose_steps_are_evaluations_is_told() -> None:
    grid = an.maps.generate("rooms", 50, 50, seed=1)
    certain = an.paco().on(grid).certainty
    group = {"paco": [made_up("paco", 0, 30.0, certainty=certain)], "ga": [made_up("ga", 0, 30.0)]}
    note = results.outcomes("m", group, paper=False, name="t", title="T", rivals=["ga"]).note
    assert " paco: ants guided by the heuristic detour, which knows" in note
    assert "steps are cost evaluations" in note
    small = results.outcomes("m", {"ga": group["ga"]}, paper=False, name="t", title="T").note
    assert "detour" not in small
    assert "evaluations" not in small


def test_no_time_is_saved_where_no_path_exists() -> None:
    records = [made_up(name, 0, None, optimum=None) for name in ("paco", "npaco")]
    assert results.saved_time(grouped(records), paper=True) is None


def test_no_comparison_without_a_second_algorithm_or_a_common_seed() -> None:
    assert comparison.comparisons(grouped([made_up("a", 0, 30.0)])) is None
    assert comparison.comparisons(grouped([made_up("a", 0, 30.0), made_up("b", 1, 30.0)])) is None


def test_blocks_are_seeds_on_few_maps_and_maps_where_there_are_many() -> None:
    found, block, table = comparison.ranks(grouped(paper_like()))
    assert found is not None
    assert (found.blocks, {len(column) for column in table.values()}) == (10, {10})
    assert "one seed" in block
    many = [
        made_up(name, seed, 30.0 + len(name), label=f"m{i}") for i in range(10) for name in "abc" for seed in (1, 2)
    ]
    found, block, _ = comparison.ranks(grouped(many))
    assert found is not None
    assert found.blocks == 10
    assert "a block is a map" in block


def test_a_map_counts_by_its_median() -> None:
    lengths = {
        "a": (1.0, 6.0, 7.0),
        "b": (2.0, 3.0, 9.0),
        "c": (4.0, 5.0, 5.5),
    }  # the least: a, b, c; the medians: b, c, a
    many = [
        made_up(name, seed, length, label=f"m{i}")
        for i in range(10)
        for name, runs in lengths.items()
        for seed, length in enumerate(runs)
    ]
    found, _, table = comparison.ranks(grouped(many))
    assert found is not None
    assert found.mean_ranks == {"b": 1, "c": 2, "a": 3}
    assert table["a"] == [6.0] * 10


@pytest.mark.parametrize(
    ("figure", "ours", "theirs", "said"),
    [
        ("best", 29.2132034, 29.2133, "reached"),
        ("best", 29.22, 29.2132, "not reached"),
        ("mean", 29.3, 29.2132, "reached"),
        ("mean", 28.0, 29.2132, "shorter than printed"),
        ("best", math.inf, 37.0, "no path"),
        ("best", math.inf, math.inf, "as printed: no path"),
        ("best", 80.0, math.inf, "path, none printed"),
    ],
)
def test_verdict(figure: str, ours: float, theirs: float, said: str) -> None:
    assert verdicts.verdict(figure, ours, theirs) == said


@pytest.mark.parametrize(
    ("label", "side"),
    [
        ("equiv20", 20),
        ("equiv40", 40),
        ("map 30x30", 30),
        ("40", 40),
        ("warehouse", None),
        ("m120", None),
        ("30x40", None),
    ],
)
def test_side_of(label: str, side: int | None) -> None:
    assert published.side_of(label) == side


def test_printed_lengths_letter_by_letter() -> None:
    """Tables 2-4 once more: best and mean by side and algorithm."""
    printed = {
        "paco": ("29.2132 29.2132", "37.3848 37.9173", "51.1127 52.5414"),
        "npaco": ("29.2132 29.2132", "37.3848 37.3848", "51.1127 51.7023"),
        "dai": ("29.2133 29.3807", "37.3849 38.1262", "51.1128 51.8471"),
        "traditional": ("37.4143 38.6335", "38.2133 38.6325", None),
    }
    for algorithm, rows in printed.items():
        for side, row in zip(published.SIDES, rows, strict=True):
            found = published.PRINTED[side, algorithm]
            assert (found and f"{found.best:.4f} {found.mean:.4f}") == row
    assert {side: cell for side, (cell, _) in published.AUXILIARY.items()} == {20: (9, 8), 30: (11, 20), 40: (19, 11)}


def test_printed_time_savings_follow_from_the_printed_times() -> None:
    for side, saved in published.TIME_SAVED.items():
        paco, npaco = published.PRINTED[side, "paco"], published.PRINTED[side, "npaco"]
        assert paco is not None
        assert npaco is not None
        assert groups.percent_saved(paco.seconds, npaco.seconds) == pytest.approx(saved, abs=0.01)


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
        if "tuple" in kinds[name] or name == "auxiliary_cell":
            return tuple(tuple(item) if isinstance(item, list) else item for item in json.loads(text))
        return int(text) if kinds[name].startswith("int") else float(text) if "float" in kinds[name] else text

    rows = csv.DictReader(io.StringIO(report.runs_csv(records)))
    again = [
        Record(**{name: int(text) if name == "turns" and text else parsed(name, text) for name, text in row.items()})
        for row in rows
    ]
    assert again == records
