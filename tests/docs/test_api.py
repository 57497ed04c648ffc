"""The API reference has every public name once."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

import antnav as an

PAGES = Path(__file__).parents[2] / "docs" / "reference" / "api"
#: Modules that users import from, with what they call public.
MODULES = (
    "costs",
    "fronts",
    "maps",
    "objectives",
    "scenarios",
    "plot",
    "rivals",
    "planner.events",
    "colony.parts",
    "register",
)
#: Of modules that are explained name by name: helpers of antnav's own.
HELPERS = {"check_type", "shown", "likely", "checked_workers", "gone", "stream_pairs", "width", "Job", "Result", "P"}


def explained() -> list[str]:
    """Every name that a page lists, with its module."""
    found = []
    for page in sorted(PAGES.glob("*.rst")):
        for module, names in re.findall(
            r"^\.\. names:: (\S+)\n\n((?: {3}\S+\n)+)", page.read_text("utf-8"), re.MULTILINE
        ):
            found += [f"{module}.{name}" for name in names.split()]
    return found


def meant(dotted: str) -> object:
    """What a dotted name means."""
    place, _, name = dotted.rpartition(".")
    return getattr(meant(place) if hasattr(an, place.removeprefix("antnav.")) else import_module(place), name)


def test_every_name_stands_once() -> None:
    names = explained()
    assert len(names) > 150
    assert sorted(name for name in names if names.count(name) > 1) == []


@pytest.mark.parametrize("module", ["", *MODULES])
def test_public_names_are_explained(module: str) -> None:
    there = [meant(name) for name in explained()]
    place = import_module(f"antnav.{module}".rstrip("."))
    missing = [
        name
        for name in place.__all__
        if not isinstance(getattr(place, name), type(an)) and not any(getattr(place, name) is one for one in there)
    ]
    assert missing == []


@pytest.mark.parametrize("module", [an.errors, an.exact, an.stop, an.spmd], ids=lambda module: module.__name__)
def test_names_of_modules_without_a_list_are_explained(module: object) -> None:
    there = {name.rpartition(".")[2] for name in explained()}
    own = {
        name
        for name, thing in vars(module).items()
        if not name.startswith("_") and getattr(thing, "__module__", "") == module.__name__
    }
    assert own - there - HELPERS == set()
