"""The paper's claims, one by one: verdicts from made-up runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import pytest

import antnav as an
from antnav.study import claims, published
from antnav.study.claims import FAILS, HOLDS, OPEN, Claim
from antnav.study.groups import grouped
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.paper import SWAPPED, paper_algorithms, paper_study
from antnav.study.record import Mark, Record
from tests.study.made_up import OPTIMUM, made_up, paper_like, problems

SEEDS = range(10)  #: Ten pairs of one sign: p = 2 / 2^10.


def verdicts(records: list[Record], study: Study | None = None) -> dict[tuple[str, str], str]:
    """By place and the first words of the claim, on equiv20."""
    found = claims.examined(grouped(records), problems(("equiv20",)), study)
    return {(claim.where, claim.claim): claim.verdict for claim in found if claim.map in ("equiv20", "all")}


def of(found: Mapping[tuple[str, str], str], where: str, words: str) -> str:
    (verdict,) = [verdict for (place, claim), verdict in found.items() if place == where and words in claim]
    return verdict


def runs(algorithm: str, more: float = 0.0, **fields) -> list[Record]:
    return [made_up(algorithm, seed, OPTIMUM + more + 0.01 * seed, **fields) for seed in SEEDS]


def test_who_is_smaller_is_shown_of_all_pairs_refuted_by_one_or_open() -> None:
    low, high = [float(n) for n in SEEDS], [n + 10.0 for n in SEEDS]
    assert claims.smaller([(low, high)]) == HOLDS
    assert claims.smaller([(high, low)]) == FAILS
    assert claims.smaller([(low, low)]) == OPEN
    assert claims.smaller([(low, high), (low, low)]) == OPEN
    assert claims.smaller([(low, high), (high, low)]) == FAILS
    assert claims.smaller([(low[:5], high[:5])]) == OPEN, "five pairs cannot show it"
    assert claims.smaller([(low, [math.inf] * 10)]) == HOLDS
    assert claims.smaller([]) == claims.smaller([([], [])]) == OPEN


def test_a_run_has_converged_once_it_stays_near_the_optimum() -> None:
    curves = [(30.0, 29.5, 29.3), (29.3, 40.0, 29.3), (None, 50.0, 40.0), (), (29.3,)]
    found = claims.settled([made_up("a", 0, 29.3, best=best) for best in curves])
    assert found == [1.0, 3.0, math.inf, math.inf, 1.0]


def test_figures_5_and_6_compare_the_matched_swap_and_not_the_preset_luo() -> None:
    records = runs("npaco", lost=(1, 0)) + runs(SWAPPED, 9.0, lost=(5, 5)) + runs("luo", lost=(0, 0))
    found = verdicts(records)
    assert of(found, "Figure 5", "shorter paths") == HOLDS
    assert of(found, "Figure 5", "converge") == HOLDS
    assert of(found, "Figure 6", "lose fewer ants") == HOLDS
    turned = verdicts(runs("npaco", 9.0, lost=(5, 5)) + runs(SWAPPED, lost=(1, 0)))
    assert {turned[key] for key in turned if key[0] in ("Figure 5", "Figure 6")} == {FAILS}
    without = verdicts(runs("npaco") + runs("luo", 9.0))
    assert {without[key] for key in without if key[0] in ("Figure 5", "Figure 6")} == {OPEN}


def test_the_swapped_algorithm_differs_in_two_rules_and_nothing_else() -> None:
    (swapped,) = [entry.algorithm for entry in paper_algorithms() if entry.label == SWAPPED]
    assert isinstance(swapped, an.Algorithm)
    matched = replace(swapped, pheromone="reward_and_punish", deadlock="hybrid", certainty=an.npaco().certainty)
    assert matched == an.npaco(straighten=False)


def test_printed_lengths_are_reached_missed_or_of_a_reconstruction() -> None:
    found = verdicts(
        [made_up("paco", seed, OPTIMUM) for seed in SEEDS]
        + runs("npaco", 2.0)
        + runs("dai", 5.0)
        + runs("traditional", 20.0)
    )
    table = {claim: verdict for (where, claim), verdict in found.items() if where == "Table 2"}
    assert table["paco reaches 29.2132, and 29.2132 on average"] == HOLDS
    assert table["npaco reaches 29.2132, and 29.2132 on average"] == FAILS
    assert table["dai reaches 29.2133, and 29.3807 on average"] == OPEN
    assert table["traditional reaches 37.4143, and 38.6335 on average"] == FAILS
    better = verdicts([made_up("traditional", seed, OPTIMUM) for seed in SEEDS])
    assert of(better, "Table 2", "traditional reaches 37.4143, and 38.6335 on average") == HOLDS
    none = [made_up("traditional", seed, None, label="equiv40") for seed in SEEDS]
    (claim,) = [claim for claim in claims.examined(grouped(none), {}, None) if claim.claim == "traditional: no path"]
    assert (claim.where, claim.verdict) == ("Table 4", HOLDS)
    some = [made_up("traditional", seed, 80.0, label="equiv40") for seed in SEEDS]
    (claim,) = [claim for claim in claims.examined(grouped(some), {}, None) if claim.claim == "traditional: no path"]
    assert claim.verdict == FAILS


def test_who_is_faster_is_told_only_of_runs_without_company() -> None:
    quick = [replace(run, seconds=0.1 + 0.001 * run.seed) for run in runs("paco")]
    slow = [replace(run, seconds=0.5) for run in runs("dai", 5.0)]
    assert of(verdicts(quick + slow), "Table 2", "paco has less time than dai") == HOLDS
    assert of(verdicts(quick + slow), "Table 2", "paco has less time than npaco") == OPEN
    busy = [replace(run, marks=(Mark.BUSY,)) for run in quick]
    assert of(verdicts(busy[:1] + quick[1:] + slow), "Table 2", "paco has less time than dai") == HOLDS
    assert (
        of(
            verdicts(busy + [replace(run, marks=(Mark.BUSY,)) for run in slow]),
            "Table 2",
            "paco has less time than dai",
        )
        == OPEN
    )
    company = [replace(run, marks=(Mark.LOADED,)) for run in quick]
    assert of(verdicts(company + slow), "Table 2", "paco has less time than dai") == OPEN
    assert of(verdicts(company + slow), "Table 2", "paco has shorter paths on average than dai") == HOLDS


@pytest.mark.parametrize(
    ("paco_steps", "more", "saved", "accurate"),
    [(480, 0.0, HOLDS, HOLDS), (540, 0.0, HOLDS, HOLDS), (560, 0.0, FAILS, HOLDS), (480, 0.3, HOLDS, FAILS)],
)
def test_time_saved_and_its_price(paco_steps: int, more: float, saved: str, accurate: str) -> None:
    """The paper prints 50.71 % on its 20x20 map, at equal means."""
    found = verdicts(runs("paco", more, critical_steps=paco_steps) + runs("npaco", critical_steps=1000))
    assert of(found, "Abstract", "less time") == saved
    assert of(found, "Abstract", "accuracy") == accurate


def test_auxiliary_cells_and_the_rule_for_their_line() -> None:
    found = claims.examined(grouped(paper_like()), problems(), None)
    cells = {claim.map: claim.verdict for claim in found if "auxiliary cell is" in claim.claim}
    assert cells == {"equiv20": HOLDS, "equiv30": FAILS}
    lines = {claim.map: claim.verdict for claim in found if claim.where == "Section 4.3"}
    assert lines == {"equiv20": HOLDS, "equiv30": FAILS}, "the paper breaks its rule on its 30x30 map"


def test_parameters_are_those_of_table_1_and_section_5() -> None:
    study = paper_study(1)
    found = verdicts(paper_like(), study)
    assert of(found, "Table 1", "T 50, T0 3, m 50, Q 1, alpha 1, beta 7, lambda 0.2") == HOLDS
    assert of(found, "Table 1", "not printed") == OPEN
    assert of(found, "Section 5", "b = 0.6") == HOLDS
    place = MapEntry("equiv20", problems(("equiv20",))["equiv20"])
    other = Study("t", [place], [AlgorithmEntry("paco", an.paco(beta=5, switch=0.9))], [0])
    found = verdicts(paper_like(), other)
    assert of(found, "Table 1", "parameters") == of(found, "Section 5", "b = 0.6") == FAILS
    assert of(verdicts(paper_like()), "Table 1", "parameters") == OPEN


def test_other_maps_say_nothing_on_the_paper() -> None:
    assert claims.examined(grouped([made_up("paco", 0, 30.0, label="office")]), {}, None) == []


def test_claims_come_place_by_place_and_are_counted() -> None:
    found = claims.examined(grouped(paper_like()), problems(), None)
    places = list(dict.fromkeys(claim.where for claim in found))
    assert places == [
        *("Table 1", "Table 2", "Table 3", "Section 4.3", "Section 5"),
        *("Figure 5", "Figure 6", "Figure 7", "Figure 8", "Abstract"),
    ]
    table = claims.table(found)
    assert len(table.rows) == len(found)
    assert claims.tally([Claim("a", "m", "c", "o", HOLDS), Claim("a", "m", "c", "o", OPEN)]) == (
        "Of 2 claims: holds 1, does not hold 0, cannot be told 1."
    )
    assert len({(claim.where, claim.map, claim.claim) for claim in found}) == len(found)


def test_table_1_is_the_presets() -> None:
    chosen = an.paco()
    for name, (_, value) in published.TABLE_1.items():
        assert chosen.choices()[name] == value
