"""Comparisons: pairs, corrections, blocks, from made-up records."""

from __future__ import annotations

import pytest

from antnav.study import comparison
from antnav.study.groups import grouped
from tests.study.made_up import made_up, paper_like, rows_of


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
