"""Parts: each owns its parameters, and says once what they may be."""

from __future__ import annotations

import copy
import inspect
import pickle
import re

import pytest

from antnav.colony.parameters import FAMILIES
from antnav.colony.parts import (
    Astar,
    Auto,
    Death,
    Deposit,
    HeuristicPart,
    Hybrid,
    MaxMin,
    Part,
    PheromonePart,
    PseudoRandom,
    RankBased,
    parameter,
)
from antnav.errors import ParameterError
from antnav.kernels import ant_kernels
from antnav.planner.facts import Basis

PARTS = [part for family in FAMILIES.values() for part in family.family.values()]


@pytest.mark.parametrize("family", FAMILIES.values(), ids=lambda family: family.__name__)
def test_every_name_has_its_part(family: type[Part]) -> None:
    assert family.family.keys() == set(family.kind())
    assert [str(family.of(name)) for name in family.kind()] == list(family.kind())


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_a_part_and_its_name_say_the_same(part: type[Part]) -> None:
    """The docstring of the names lists what the parts' own say, with the tag of what each rests on."""
    listed = re.search(rf"^- {part.name}: (.*)$", inspect.getdoc(type(part.name)) or "", re.MULTILINE)
    first = (inspect.getdoc(part) or "").partition("\n")[0].removesuffix(".")
    assert listed is not None
    assert listed[1].casefold() == first.casefold()
    assert first.endswith(f"[{part.basis}]")


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_a_part_documents_the_parameters_that_it_owns(part: type[Part]) -> None:
    names = re.findall(r"^(\w+(?:, \w+)*) : ", inspect.getdoc(part) or "", re.MULTILINE)
    assert {name for line in names for name in line.split(", ")} == part.parameters.keys()


def test_shares_of_all_parts_fill_the_same_fields_of_the_kernel() -> None:
    for family in FAMILIES.values():
        shares = [part().share(50) for part in family.family.values()]
        assert {frozenset(share) for share in shares} == {frozenset(shares[0])}
        assert shares[0].keys() <= set(ant_kernels.Choices._fields)
        assert {tuple(map(type, share.values())) for share in shares} == {tuple(map(type, shares[0].values()))}


def test_shares_by_hand() -> None:
    assert Hybrid(switch=0.6, punish=0.1).share(50) == {"deadlock": 4, "punish": 0.1, "retract_until": 30}
    assert Death().share(50) == {"deadlock": 0, "punish": 0.0, "retract_until": 0}
    assert MaxMin(best_every=5, restart=7).share(50) == PheromonePart.of("max_min").share(50) | {
        "best_every": 5,
        "restart": 7,
    }
    assert (Astar().share(50), Auto().share(50)) == ({"headings": 9}, {"headings": 1})


def test_a_part_is_a_frozen_value() -> None:
    part = RankBased(elite=3)
    with pytest.raises(AttributeError, match="frozen"):
        part.elite = 4  # type: ignore[misc]
    with pytest.raises(AttributeError, match="frozen"):
        del part.elite
    assert part == RankBased(elite=3) != RankBased()
    assert MaxMin() != RankBased()
    assert len({part, RankBased(elite=3), RankBased()}) == 2
    assert pickle.loads(pickle.dumps(part)) == copy.deepcopy(part) == part
    assert (repr(part), str(part)) == ("RankBased(elite=3)", "rank_based")
    assert part.changed(elite=9) == RankBased(elite=9)


def test_a_parameter_without_its_part_cannot_be_written() -> None:
    with pytest.raises(ParameterError, match="its parameters are best_every, restart"):
        MaxMin(elite=3)  # type: ignore[call-arg]
    with pytest.raises(ParameterError, match="it has no parameters"):
        Death(punish=0.1)  # type: ignore[call-arg]


def test_a_part_of_another_kind_is_refused() -> None:
    with pytest.raises(ParameterError, match="heuristic"):
        HeuristicPart.of(MaxMin())
    with pytest.raises(ParameterError, match="heuristic"):
        HeuristicPart.of("max_min")


@pytest.mark.parametrize("wrong", [True, "0.5", float("nan"), -0.1, 1.1, None, [0.5]])
def test_numbers_out_of_range_are_refused(wrong: object) -> None:
    with pytest.raises(ParameterError, match=r"q0_min lies in 0\.\.1"):
        PseudoRandom(q0_min=wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("wrong", [True, 0, 2.0, "3", None])
def test_whole_numbers_out_of_range_are_refused(wrong: object) -> None:
    with pytest.raises(ParameterError, match="elite is a whole number from 1"):
        RankBased(elite=wrong)  # type: ignore[arg-type]


def test_ends_of_ranges() -> None:
    class Holder:
        share = parameter(1.0, most=1, above=True)
        side = parameter(0, least=4, most=8, zero=True)
        left_open = parameter(None, most=2)
        way = parameter(Deposit.BOTH)
        turned_on = parameter(False)

    own = vars(Holder)
    assert Holder.share == 1.0
    assert [own["side"].checked(value) for value in (0, 4, 8)] == [0, 4, 8]
    assert own["left_open"].checked(None) is None
    assert own["way"].checked("forward") is Deposit.FORWARD
    for name, value in (("share", 0), ("side", 3), ("side", 9), ("left_open", 3), ("way", "up"), ("turned_on", 1)):
        with pytest.raises(ParameterError):
            own[name].checked(value)
    assert {name: one.range for name, one in own.items() if hasattr(one, "range")} == {
        "share": "above 0, up to 1",
        "side": "0, or 4 to 8",
        "left_open": "0 to 2",
        "way": "both, cells, forward",
        "turned_on": "true or false",
    }


def test_defaults_lie_in_their_ranges() -> None:
    for part in PARTS:
        for one in part.parameters.values():
            assert one.checked(one.default) == one.default
            assert one.certainty in Basis
