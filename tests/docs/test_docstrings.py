"""Examples in docstrings of public names do what they print."""

from __future__ import annotations

import doctest

import pytest

from tests.docs.test_api import explained, meant

FOUND = [
    example
    for name in explained()
    for example in doctest.DocTestFinder(recurse=False).find(meant(name), name.rpartition(".")[2], globs={})
    if example.examples
]


def test_the_main_functions_have_examples() -> None:
    assert {"solve", "Problem", "GridMap", "Colony", "Steps", "Mission", "pareto", "tour", "alternatives"} <= {
        example.name for example in FOUND
    }


@pytest.mark.parametrize("example", FOUND, ids=lambda example: example.name)
def test_examples_print_what_they_say(example: doctest.DocTest) -> None:
    told: list[str] = []
    assert not doctest.DocTestRunner().run(example, out=told.append).failed, "".join(told)
