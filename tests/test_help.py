"""What `help()` and an editor tell: members of enums, parameters of presets, types."""

from __future__ import annotations

import inspect
import pydoc
from dataclasses import fields
from enum import Enum
from importlib import import_module, resources
from pkgutil import walk_packages
from typing import get_type_hints

import pytest

import antnav as an
from antnav.ants import presets
from antnav.colony.parameters import OWNED


def enums() -> list[type[Enum]]:
    """Every public enum of the package with members."""
    modules = [
        import_module(found.name)
        for found in walk_packages(an.__path__, "antnav.")
        if "__main__" not in found.name and found.name != "antnav.ros.node"  # which needs ROS
    ]
    found = {
        one: None
        for module in modules
        for one in vars(module).values()
        if inspect.isclass(one)
        and issubclass(one, Enum)
        and len(one)
        and one.__module__.startswith("antnav.")
        and one.__module__ != "antnav.kernels.codes"  # numbers for machines; what they mean stands with `parts`
    }
    return list(found)


@pytest.mark.parametrize("kind", enums(), ids=lambda kind: kind.__name__)
def test_help_tells_what_each_member_means(kind: type[Enum]) -> None:
    shown = pydoc.render_doc(kind, renderer=pydoc.plaintext)
    for member in kind:
        name = member.value if isinstance(member.value, str) else member.name
        assert f"- {name}: " in shown, f"{member!r} is not explained in the docstring"


def test_the_package_says_that_it_is_typed() -> None:
    assert (resources.files("antnav") / "py.typed").is_file()


@pytest.mark.parametrize("name", an.PRESETS)
def test_help_shows_the_parameters_of_a_preset_with_their_defaults(name: str) -> None:
    made = an.PRESETS[name]()
    shown = inspect.signature(an.PRESETS[name]).parameters
    assert {"ants", "iterations", "heuristic", "pheromone", "deadlock", "beta", "rho"} <= shown.keys()
    assert ("axis" in shown) == (made.decomposition is not None)
    assert shown["ants"].default == made.ants
    assert shown["heuristic"].default == str(made.heuristic)
    line = pydoc.render_doc(an.PRESETS[name], renderer=pydoc.plaintext)
    assert f"ants: int = {made.ants}" in line
    assert "help(antnav.Algorithm)" in line
    defaults = {key: one.default for key, one in shown.items() if key != "decomposition"}
    assert an.PRESETS[name](**defaults) == made, "giving every default changes nothing"


def test_editors_know_every_parameter() -> None:
    known = {field.name for kind in (an.Algorithm, an.Decomposition) for field in fields(kind)}
    assert get_type_hints(presets.Choices).keys() == known | OWNED.keys()
