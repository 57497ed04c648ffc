"""Statistics of repeated runs: summaries, paired tests, ranks over blocks, effect sizes.

Lengths are in cells, and a run without a path has length inf: it ranks last, tied with other such runs. Lengths that
differ by less than `TIE` are equal: sums of the same moves in another order differ in the last bits.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

TIE = 1e-9  #: Cells.
ALPHA = 0.05
#: Upper ends of |A12 - 0.5| for each word (Vargha & Delaney 2000, doi 10.3102/10769986025002101).
MAGNITUDES = ((0.06, "negligible"), (0.14, "small"), (0.21, "medium"), (math.inf, "large"))
RESAMPLES = 2000  #: Of the bootstrap.


@dataclass(frozen=True)
class Summary:
    """A group of runs of one algorithm on one problem.

    Attributes
    ----------
    runs, arrived : int
        All runs, and those with a path.
    best, mean, std : float
        Of the runs with a path, in cells; std with n - 1; nan where too few.
    median, iqr : float
        Of all runs, a missing path counting as inf. Spread = interquartile range; nan where a quartile is inf.
    success_rate, optimal_rate : float
        Shares of all runs with a path, and with one of the optimum's length.
    """

    runs: int
    arrived: int
    best: float
    mean: float
    std: float
    median: float
    iqr: float
    success_rate: float
    optimal_rate: float


def summary(lengths: ArrayLike, optimum: float) -> Summary:
    """Summarise the lengths of a group's runs, at least one."""
    values = np.asarray(lengths, np.float64)
    arrived = values[np.isfinite(values)]
    low, median, high = (float(value) for value in quantiles(values, (0.25, 0.5, 0.75)))
    return Summary(
        runs=len(values),
        arrived=len(arrived),
        best=float(arrived.min()) if len(arrived) else math.nan,
        mean=float(arrived.mean()) if len(arrived) else math.nan,
        std=float(arrived.std(ddof=1)) if len(arrived) > 1 else math.nan,
        median=median,
        iqr=high - low if math.isfinite(high) else math.nan,
        success_rate=len(arrived) / len(values),
        optimal_rate=float(np.mean(arrived <= optimum + TIE)) * len(arrived) / len(values) if len(arrived) else 0.0,
    )


def quantiles(values: ArrayLike, at: Sequence[float]) -> NDArray[np.float64]:
    """Linear quantiles along the first axis, of values some of which may be inf (`numpy.quantile` gives nan there)."""
    ordered = np.sort(np.asarray(values, np.float64), axis=0)
    position = np.asarray(at, np.float64) * (len(ordered) - 1)
    below = np.floor(position).astype(np.int64)
    part = (position - below).reshape(-1, *[1] * (ordered.ndim - 1))
    low, high = ordered[below], ordered[np.ceil(position).astype(np.int64)]
    with np.errstate(invalid="ignore"):
        between = low + part * (high - low)
    return np.where(np.isfinite(high), between, np.where(part > 0, np.inf, low))


def interval(values: ArrayLike, level: float = 0.95) -> tuple[float, float]:
    """Bootstrap interval of the mean of finite values (BCa, fixed seed); the value itself where all are equal."""
    from scipy.stats import bootstrap

    sample = np.asarray(values, np.float64)
    sample = sample[np.isfinite(sample)]
    if len(sample) == 0:
        return math.nan, math.nan
    if np.ptp(sample) < TIE:
        return float(sample.mean()), float(sample.mean())
    found = bootstrap(
        (sample,),
        np.mean,
        confidence_level=level,
        n_resamples=RESAMPLES,
        method="BCa",
        random_state=np.random.default_rng(0),
    ).confidence_interval
    return float(found.low), float(found.high)


@dataclass(frozen=True)
class Paired:
    """Two groups compared seed by seed; all from the first one's view.

    Attributes
    ----------
    pairs, shorter, equal, longer : int
        Seeds in common, and in how many of them the first one's path is shorter, of equal length, longer.
    p : float
        Two-sided, of the Wilcoxon signed-rank test; 1 where all pairs are equal.
    a12 : float
        Vargha & Delaney's probability that a run of the first is shorter than one of the second.
    favours_first : bool
        Whether the signed ranks, which p judges, speak for the first.
    """

    pairs: int
    shorter: int
    equal: int
    longer: int
    p: float
    a12: float
    favours_first: bool


def paired(first: ArrayLike, second: ArrayLike) -> Paired:
    """Compare lengths whose i-th entries belong to the same seed.

    Wilcoxon's signed-rank test of the pairs that differ: exact without ties and, by permutation, with ties in up to 13
    pairs; else the normal approximation, corrected for ties. A pair in which one has no path differs by more than any
    finite pair; where neither has one, the pair is equal.
    """
    from scipy.stats import rankdata, wilcoxon

    difference = _differences(np.asarray(first, np.float64), np.asarray(second, np.float64))
    unequal = difference[difference != 0]
    return Paired(
        pairs=len(difference),
        shorter=int((difference < 0).sum()),
        equal=int((difference == 0).sum()),
        longer=int((difference > 0).sum()),
        p=float(wilcoxon(unequal).pvalue) if len(unequal) else 1.0,
        a12=a12(first, second),
        favours_first=bool(np.sign(unequal) @ rankdata(np.abs(unequal)) < 0),
    )


def _differences(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Differences, rounded to `TIE`, with one finite value for "one has no path" and 0 for "neither has"."""
    with np.errstate(invalid="ignore"):
        difference = np.where(np.isinf(first) & np.isinf(second), 0.0, first - second)
    finite = np.isfinite(difference)
    most = np.abs(difference[finite]).max(initial=0.0) + 1.0
    return np.round(np.where(finite, difference, np.sign(difference) * most) / TIE) * TIE


def a12(first: ArrayLike, second: ArrayLike) -> float:
    """Probability that a value of the first group is smaller than one of the second, ties counted half.

    0.5: no difference; 1: every value of the first is smaller. Vargha & Delaney 2000,
    doi 10.3102/10769986025002101; smaller is better here.
    """
    left, right = _rounded(first)[:, None], _rounded(second)[None, :]
    return float(np.mean((left < right) + 0.5 * (left == right)))


def magnitude(effect: float) -> str:
    """The word for an A12: negligible, small, medium or large, whichever group it favours."""
    distance = round(abs(effect - 0.5), 9)  # 0.71 and 0.29 lie equally far from 0.5, but not in floating point
    return next(word for most, word in MAGNITUDES if distance < most)


def holm(p_values: Sequence[float]) -> list[float]:
    """The p values of one family after Holm's step-down correction, in the order given."""
    order = sorted(range(len(p_values)), key=p_values.__getitem__)
    adjusted, highest = [0.0] * len(p_values), 0.0
    for place, index in enumerate(order):
        highest = max(highest, min(1.0, (len(p_values) - place) * p_values[index]))
        adjusted[index] = highest
    return adjusted


@dataclass(frozen=True)
class Ranks:
    """Friedman's test, and what a critical-difference diagram shows (Demsar 2006).

    Attributes
    ----------
    blocks : int
    mean_ranks : dict of str to float
        By algorithm, best first; 1 is the best possible.
    statistic, p : float
        Of Friedman's test, corrected for ties; 0 and 1 where all are equal everywhere.
    critical_difference : float
        Mean ranks further apart than this differ at `ALPHA` by Nemenyi's test.
    """

    blocks: int
    mean_ranks: dict[str, float]
    statistic: float
    p: float
    critical_difference: float


def friedman(table: Mapping[str, Sequence[float]]) -> Ranks | None:
    """Rank at least three algorithms over blocks.

    Parameters
    ----------
    table : mapping
        By algorithm, its values in the same order of blocks; smaller is better.

    Returns
    -------
    Ranks or None
        None with fewer than three algorithms or two blocks, for which the test is not defined.
    """
    from scipy.stats import friedmanchisquare, studentized_range

    names = list(table)
    blocks = len(table[names[0]]) if names else 0
    if len(names) < 3 or blocks < 2:
        return None
    ranks = rank_rows(table)
    mean = ranks.mean(axis=0)
    order = sorted(range(len(names)), key=lambda index: (mean[index], index))
    statistic, p = 0.0, 1.0
    if np.ptp(ranks, axis=1).any():
        outcome = friedmanchisquare(*ranks.T)
        statistic, p = float(outcome.statistic), float(outcome.pvalue)
    k = len(names)
    q = float(studentized_range.ppf(1 - ALPHA, k, math.inf)) / math.sqrt(2)
    return Ranks(
        blocks, {names[i]: float(mean[i]) for i in order}, statistic, p, q * math.sqrt(k * (k + 1) / (6 * blocks))
    )


def alike(found: Ranks) -> list[tuple[int, int]]:
    """Groups of algorithms that Nemenyi's test cannot tell apart: places of the first and the last, best first.

    A group is as large as it can be, holds two or more, and lies in no other; equal ranks are in it.
    """
    ranks = list(found.mean_ranks.values())
    groups: list[tuple[int, int]] = []
    for first, rank in enumerate(ranks):
        last = max(place for place, other in enumerate(ranks) if other - rank <= found.critical_difference)
        if last > first and (not groups or last > groups[-1][1]):
            groups.append((first, last))
    return groups


def rank_rows(table: Mapping[str, Sequence[float]]) -> NDArray[np.float64]:
    """Ranks within each block, 1 the smallest, ties averaged; shape (blocks, algorithms)."""
    from scipy.stats import rankdata

    values = np.stack([_rounded(column) for column in table.values()], axis=1)
    return np.asarray(rankdata(values, axis=1), np.float64)


def _rounded(values: ArrayLike) -> NDArray[np.float64]:
    return np.round(np.asarray(values, np.float64) / TIE) * TIE
