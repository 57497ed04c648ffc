"""Certainty and knowledge as data: what is printed comes from parts, not from words."""

from __future__ import annotations

import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.planner.facts import Basis, Certainty, Clause, Knows

SMALL, LARGE = an.GridMap([[0] * 40]), an.GridMap([[0] * 41])


@pytest.mark.parametrize(
    ("algorithm", "grid", "known"),
    [
        (an.paco(), SMALL, Knows.NOTHING),
        (an.paco(), LARGE, Knows.TO_GOAL),
        (an.npaco(heuristic="geodesic"), SMALL, Knows.TO_GOAL),
        (an.npaco(heuristic="edge", windows=30), LARGE, Knows.WINDOWS),
        (an.paco_levels(heuristic="target"), LARGE, Knows.FROM_START | Knows.WINDOWS),
        (an.two_ended(), LARGE, Knows.NOTHING),
        (an.two_ended(local_search="weave"), LARGE, Knows.WOVEN),
        (an.paco_large(), SMALL, Knows.REGIONS | Knows.WINDOWS),
        (an.paco_large(heuristic="target", windows=0), SMALL, Knows.NOTHING),
    ],
)
def test_what_is_known_follows_from_the_parts(algorithm: an.Algorithm, grid: an.GridMap, known: Knows) -> None:
    assert algorithm.on(grid).knows == known


def test_knowledge_by_name() -> None:
    assert (Knows.WINDOWS | Knows.TO_GOAL).names == ("to_goal", "windows")
    assert Knows.NOTHING.names == ()


@pytest.mark.parametrize("heuristic", ["detour", "geodesic"])
def test_own_words_hide_nothing(heuristic: str) -> None:
    algorithm = an.npaco(heuristic=heuristic, windows=30, certainty="my own").on(SMALL)
    known = f"windows are searched exactly; heuristic {heuristic} ours: it knows the exact distances"
    assert str(algorithm.certainty) == f"my own; {known}"
    assert algorithm.on(SMALL) == algorithm, "nothing is said twice"
    assert algorithm.certainty.bases == {Basis.STATED, Basis.EXACT, Basis.OURS}


def test_knowledge_goes_with_the_part() -> None:
    assert "exactly" not in str(an.paco_ls(windows=0).certainty)
    assert "regions" in str(an.paco_large().on(SMALL).certainty)


@pytest.mark.parametrize(
    ("clause", "printed"),
    [
        (Clause(Basis.PAPER, "A & B"), "paper (A & B)"),
        (Clause(Basis.PAPER), "paper"),
        (Clause(Basis.SOURCE, "A & B"), "source (A & B)"),
        (Clause(Basis.RECONSTRUCTION, "A & B"), "reconstruction of A & B"),
        (Clause(Basis.OURS, "A & B"), "ours, built on A & B"),
        (Clause(Basis.CALIBRATED, part="rho"), "rho calibrated"),
        (Clause(Basis.OURS, "a reason", "rho"), "rho ours: a reason"),
        (Clause(Basis.MODIFIED, "rho 0.2"), "modified: rho 0.2"),
        (Clause(Basis.STATED, "my own"), "my own"),
    ],
)
def test_sentences(clause: Clause, printed: str) -> None:
    assert str(clause) == printed


def test_certainty_is_what_it_says() -> None:
    both = Certainty((Clause(Basis.PAPER, "A"), Clause(Basis.CALIBRATED, part="rho")))
    assert both.bases == {Basis.PAPER, Basis.CALIBRATED}
    assert both == Certainty.of("paper (A); rho calibrated") != Certainty.of("paper (A)")
    assert len({both, Certainty.of(str(both))}) == 1
    assert Certainty.of(both) is both
    with pytest.raises(ParameterError, match="certainty 3"):
        an.npaco(certainty=3)  # type: ignore[arg-type]
    assert str(both.modified("rho 0.2").modified("beta 3")) == f"{both}; modified: rho 0.2, beta 3"
