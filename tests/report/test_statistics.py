"""Statistics against values worked out by hand, against brute force, and against scipy."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from scipy import stats

from antnav.report import statistics as st

INF = math.inf


def test_summary_by_hand() -> None:
    found = st.summary([4.0, 2.0, 2.0, 6.0], 2.0)
    assert (found.runs, found.arrived, found.best, found.mean, found.median) == (4, 4, 2.0, 3.5, 3.0)
    assert found.iqr == 2.5  # quartiles 2 and 4.5
    assert found.std == pytest.approx(math.sqrt((0.25 + 2.25 + 2.25 + 6.25) / 3))
    assert (found.success_rate, found.optimal_rate) == (1.0, 0.5)


def test_summary_counts_a_missing_path_as_infinitely_long() -> None:
    found = st.summary([INF, 3.0, 3.0, 3.0], 3.0)
    assert (found.best, found.mean, found.median, found.success_rate, found.optimal_rate) == (3, 3, 3, 0.75, 0.75)
    most = st.summary([INF, INF, 3.0], 3.0)
    assert most.median == INF
    assert math.isnan(most.iqr)
    assert math.isnan(most.std)
    none = st.summary([INF, INF], 3.0)
    assert (none.arrived, none.success_rate, none.optimal_rate, none.median) == (0, 0.0, 0.0, INF)
    assert math.isnan(none.best)
    assert math.isnan(none.mean)


def test_one_run_has_no_spread() -> None:
    found = st.summary([5.0], 5.0)
    assert (found.median, found.iqr, found.optimal_rate) == (5.0, 0.0, 1.0)
    assert math.isnan(found.std)


def test_quantiles_are_numpys_where_finite() -> None:
    values = np.random.default_rng(1).random((11, 7))
    assert st.quantiles(values, (0.1, 0.5, 0.8)) == pytest.approx(np.quantile(values, (0.1, 0.5, 0.8), axis=0))


@pytest.mark.parametrize(
    ("values", "expected"), [([1, 2, INF], 2), ([1, INF], INF), ([INF, INF], INF), ([1, 2, 3, INF], 2.5)]
)
def test_median_with_missing_paths(values: list[float], expected: float) -> None:
    assert st.quantiles(values, (0.5,))[0] == expected


def test_interval_holds_the_mean_and_is_the_same_each_time() -> None:
    values = np.random.default_rng(2).random(12)
    low, high = st.interval([*values, INF])
    assert low < values.mean() < high
    assert st.interval(values) == (low, high)
    assert st.interval([2.0, 2.0, 2.0]) == (2.0, 2.0)
    assert st.interval([2.0]) == (2.0, 2.0)
    assert all(map(math.isnan, st.interval([])))


def test_interval_is_of_95_per_cent() -> None:
    """Of 50 runs of 0 or 1, half each: the normal approximation is 0.5 +- 1.96 x 0.5 / sqrt 50."""
    low, high = st.interval([0.0, 1.0] * 25)
    assert (low, high) == pytest.approx((0.5 - 0.1386, 0.5 + 0.1386), abs=0.015)


def test_paired_is_scipys_where_nothing_is_special() -> None:
    rng = np.random.default_rng(3)
    first, second = rng.random(20), rng.random(20) + 0.2
    found = st.paired(first, second)
    assert found.p == pytest.approx(stats.wilcoxon(first, second).pvalue)
    assert (found.shorter, found.longer) == (int((first < second).sum()), int((first > second).sum()))
    assert found.favours_first


def test_paired_by_enumeration_of_all_signs_where_differences_tie() -> None:
    first, second = [1, 1, 1, 1, 2, 5], [2, 2, 3, 1, 1, 9]
    difference = np.array([-1, -1, -2, 1, -4])  # the fourth pair is equal
    ranks = stats.rankdata(np.abs(difference))
    observed = abs((np.sign(difference) * ranks).sum())
    sums = [abs((np.array(signs) * ranks).sum()) for signs in product((-1, 1), repeat=5)]
    found = st.paired(first, second)
    assert found.p == pytest.approx(np.mean(np.array(sums) >= observed))
    assert (found.pairs, found.shorter, found.equal, found.longer) == (6, 4, 1, 1)


def test_paired_of_equal_groups_shows_nothing() -> None:
    found = st.paired([3.0, INF, 4.0], [3.0, INF, 4.0 + 1e-13])
    assert (found.p, found.a12, found.equal) == (1.0, 0.5, 3)


def test_a_missing_path_loses_every_pair() -> None:
    found = st.paired([9.0] * 6, [INF] * 6)
    assert (found.shorter, found.a12, found.favours_first) == (6, 1.0, True)
    assert found.p == pytest.approx(2 / 2**6)
    assert st.paired([INF, 1, 1], [5, 90, 80]).p == 1.0  # ranks 3 (missing), 2 and 1: +3 - 2 - 1 = 0


def test_a12_by_counting() -> None:
    rng = np.random.default_rng(4)
    first, second = rng.integers(0, 5, 9).astype(float), rng.integers(0, 6, 13).astype(float)
    first[0] = second[0] = INF
    wins = sum(1.0 if a < b else 0.5 if a == b else 0.0 for a in first for b in second)
    assert st.a12(first, second) == pytest.approx(wins / (9 * 13))
    assert st.a12(first, second) + st.a12(second, first) == pytest.approx(1)


@pytest.mark.parametrize(
    ("effect", "word"),
    [
        (0.5, "negligible"),
        (0.55, "negligible"),
        (0.56, "small"),
        (0.6, "small"),
        (0.64, "medium"),
        (0.65, "medium"),
        (0.71, "large"),
        (0.72, "large"),
        (1.0, "large"),
    ],
)
def test_magnitude(effect: float, word: str) -> None:
    assert st.magnitude(effect) == st.magnitude(1 - effect) == st.magnitude(round(1 - effect, 9)) == word


def test_holm_by_hand() -> None:
    assert st.holm([0.04, 0.01, 0.03]) == pytest.approx([0.06, 0.03, 0.06])  # 3 x 0.01, 2 x 0.03, then not below it
    assert st.holm([0.6, 0.7]) == [1.0, 1.0]
    assert st.holm([]) == []


def test_friedman_is_scipys_and_ranks_missing_paths_last() -> None:
    table = {"a": [1.0, 2.0, 1.5, 3.0], "b": [2.0, 3.0, 2.5, 1.0], "c": [INF, 9.0, INF, 4.0]}
    found = st.friedman(table)
    assert found is not None
    assert found.mean_ranks == {"a": 1.25, "b": 1.75, "c": 3.0}
    expected = stats.friedmanchisquare([1, 2, 1.5, 3], [2, 3, 2.5, 1], [99, 9, 99, 4])
    assert (found.statistic, found.p) == pytest.approx((expected.statistic, expected.pvalue))
    # Demsar 2006, table 5: q of three algorithms at 5 % is 2.343.
    assert found.critical_difference == pytest.approx(2.343 * math.sqrt(3 * 4 / (6 * 4)), abs=1e-3)


def test_friedman_of_equal_columns_and_where_it_is_not_defined() -> None:
    found = st.friedman({name: [INF, 1.0] for name in "abc"})
    assert found is not None
    assert (found.p, found.statistic) == (1.0, 0.0)
    assert st.friedman({"a": [1.0, 2.0], "b": [2.0, 3.0]}) is None
    assert st.friedman({name: [1.0] for name in "abc"}) is None
    assert st.friedman({}) is None


def ranks_of(*mean: float, critical: float = 1.0) -> st.Ranks:
    return st.Ranks(10, {str(i): rank for i, rank in enumerate(mean)}, 0.0, 1.0, critical)


@pytest.mark.parametrize(
    ("found", "groups"),
    [
        (ranks_of(3.5, 3.5, 3.5, 3.5), [(0, 3)]),
        (ranks_of(1.0, 3.0, 5.0), []),
        (ranks_of(1.0, 1.5, 2.2, 4.0, 4.0), [(0, 1), (1, 2), (3, 4)]),
        (ranks_of(1.0, 2.0, 3.0), [(0, 1), (1, 2)]),
    ],
    ids=["all equal", "all apart", "overlapping", "just the difference"],
)
def test_who_is_joined_by_a_bar(found: st.Ranks, groups: list[tuple[int, int]]) -> None:
    assert st.alike(found) == groups
