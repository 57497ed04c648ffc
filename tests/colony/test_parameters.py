"""An algorithm: parts, flat names, documents, and what the docs say of its parameters."""

from __future__ import annotations

import inspect
import re
from dataclasses import replace
from pathlib import Path

import pytest

import antnav as an
from antnav.colony.parameters import FAMILIES, OWNED
from antnav.colony.parts import (
    Astar,
    BestAndWorst,
    Death,
    Hybrid,
    MaxMin,
    Parameter,
    PseudoRandom,
    RankBased,
    parameters_of,
)
from antnav.errors import ParameterError

DOCS = Path(__file__).parents[2] / "docs" / "algorithms"
OWN = parameters_of(an.Algorithm) | parameters_of(an.Decomposition)
ALL = OWN | {
    name: one
    for family in FAMILIES.values()
    for part in family.family.values()
    for name, one in part.parameters.items()
}
RANGE = re.compile(r"(\d[\d.]*) to (\d+(?:\.\d+)?)")


@pytest.mark.parametrize(
    ("choices", "reason"),
    [
        (
            {"elite": 3},
            'elite 3 with pheromone max_min: elite belongs to pheromone rank_based; .*pheromone="rank_based"',
        ),
        ({"punish": 0.1}, "punish belongs to deadlock backtrack or luo or hybrid"),
        ({"heuristic": "detour", "q2": 1.0}, "q2 belongs to heuristic astar"),
        ({"pheromone": RankBased(), "restart": 9}, "restart belongs to pheromone max_min"),
        ({"axis": "row"}, "parameter 'axis': mmas has"),
        ({"speed": 3}, "parameter 'speed': mmas has .*best_every"),
    ],
)
def test_a_parameter_without_its_part_is_refused(choices: dict, reason: str) -> None:
    with pytest.raises(ParameterError, match=reason):
        an.mmas(**choices)


def test_flat_names_reach_their_parts() -> None:
    assert an.mmas(restart=9).pheromone == MaxMin(restart=9)
    assert an.npaco(heuristic="astar", q2=2.0).heuristic == Astar(q2=2.0)
    assert an.npaco(pheromone=MaxMin(restart=9), best_every=4).pheromone == MaxMin(restart=9, best_every=4)
    assert an.luo(deadlock="hybrid", punish=0.1).deadlock == Hybrid(punish=0.1)


def test_a_part_by_name_has_its_defaults_unless_it_is_there_already() -> None:
    assert an.luo(transition="pseudo_random").transition == PseudoRandom(q0_min=0.1, q0_max=0.8, q0_relief=0.8)
    assert an.npaco(transition="pseudo_random").transition == PseudoRandom()


def test_changes_add_up() -> None:
    algorithm = an.paco(punish=0.1).changed(pheromone="best_and_worst", search="half")
    assert (algorithm.deadlock, algorithm.pheromone) == (Hybrid(punish=0.1), BestAndWorst())
    assert str(algorithm.certainty).endswith("modified: punish 0.1, pheromone best_and_worst, search half")
    assert str(an.luo(transition="roulette").certainty).endswith("modified: transition roulette")
    assert str(an.paco(decomposition=None).certainty).endswith("modified: decomposition")


@pytest.mark.parametrize("name", an.PRESETS)
def test_there_and_back_by_a_document(name: str) -> None:
    for algorithm in (an.PRESETS[name](), an.PRESETS[name](beta=3).on(an.GridMap([[0] * 50]))):
        document = algorithm.document()
        assert an.Algorithm.of(document) == algorithm
        assert OWNED.keys() <= document.keys(), "files have the same names for all algorithms"


def test_a_document_may_hold_what_no_part_of_it_owns() -> None:
    """Files of version 1 have every parameter of every part."""
    old = an.npaco().document() | {"elite": 3, "switch": 0.7, "of_a_later_version": 1}
    assert an.Algorithm.of(old) == an.npaco(switch=0.7, certainty=an.npaco().certainty)
    del old["q2"], old["transition"]
    assert an.Algorithm.of(old) == an.npaco(switch=0.7, certainty=an.npaco().certainty)


@pytest.mark.parametrize(
    "change",
    [
        {"name": 3},
        {"heuristic": None},
        {"pheromone": ["max_min"]},
        {"certainty": None},
        {"decomposition": [3]},
        {"decomposition": {"stage_one": 0}},
        {"punish": 2},
        {"ants": 1.5},
    ],
)
def test_broken_documents_are_refused(change: dict) -> None:
    with pytest.raises(ParameterError):
        an.Algorithm.of(an.paco().document() | change)


def test_parts_may_be_given_by_name() -> None:
    made = an.Algorithm(name="mine", heuristic="edge", pheromone="max_min", deadlock="death")  # type: ignore[arg-type]
    assert (made.pheromone, made.deadlock, str(made.certainty)) == (MaxMin(), Death(), "own composition")
    assert replace(made, pheromone=RankBased(elite=2)).choices()["elite"] == 2


@pytest.mark.parametrize("coarse", [{"heuristic": "edge"}, {"heuristic": "astar"}, {"pheromone": "best_and_turns"}])
def test_regions_carry_no_edges_or_directions(coarse: dict) -> None:
    (kind,) = coarse
    with pytest.raises(ParameterError, match=f"coarse 16 with {kind} {coarse[kind]}: edges"):
        an.paco_large(**coarse)


def stated(text: str) -> list[tuple[float, float]]:
    return [(float(low), float(high)) for low, high in RANGE.findall(text)]


@pytest.mark.parametrize("kind", [an.Algorithm, an.Decomposition], ids=lambda kind: kind.__name__)
def test_docstrings_say_what_the_parameters_are(kind: type) -> None:
    entries = re.findall(r"^(\w+(?:, \w+)*) : .*\n((?:    .*\n?)+)", inspect.getdoc(kind) or "", re.MULTILINE)
    parameters = parameters_of(kind)
    told = {name: " ".join(text.split()) for names, text in entries for name in names.split(", ") if name in parameters}
    assert told.keys() == parameters.keys()
    for name, text in told.items():
        one = parameters[name]
        assert stated(text.partition("Sane: ")[2]) == ([one.sane] if one.sane else []), name
        if match := re.search(r"default \"?([\w.]+)\"? \[(\w+)", text):
            assert match.groups() == (
                f"{one.default:g}" if type(one.default) in (int, float) else str(one.default),
                one.certainty,
            )


def test_tables_of_the_docs_have_the_sane_ranges_of_the_parameters() -> None:
    checked: set[str] = set()
    for file in DOCS.glob("*.md"):
        for table in re.findall(r"^\| parameter \| default \| sane .*\n(?:\|.*\n)+", file.read_text(), re.MULTILINE):
            for row in table.splitlines()[2:]:
                cells = row.split(" | ")
                names = [name for name in re.findall(r"\w+", cells[0]) if name in ALL]
                if "ants" in names and file.name == "large.md":  # a few ants on a graph of regions
                    continue
                for name, sane in zip(names, stated(cells[2]), strict=False):
                    assert ALL[name].sane == sane, (file.name, name)
                    checked.add(name)
    assert checked >= {
        "ants",
        "iterations",
        "stage_one",
        "coarse",
        "pieces",
        "alpha",
        "beta",
        "punish",
        "switch",
        "rho",
        "initial_weight",
    }


def test_every_name_stands_for_one_thing() -> None:
    assert not OWN.keys() & OWNED.keys()
    assert all(isinstance(one, Parameter) and one.name == name for name, one in ALL.items())
