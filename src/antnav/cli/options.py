"""Errors in the words of the command line: what Python calls a thing, and the option that gives it."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

from antnav.errors import AntnavError

#: At the beginning of an error, what was given ...
GIVEN = {
    r"radius ": "--robot-radius ",
    r"(seconds|time_limit) ": "--time-limit ",
    r"(start|goal) tolerance ": r"--\1-tolerance ",
    r"(ants|iterations|seed|workers|resolution|algorithm|heuristic|axis|rules|rows|cols|longest) ": r"--\1 ",
    r"(scenario|ticks|speed|improve|order|method|margin|shard) ": r"--\1 ",
    r"Heuristic ": "--heuristic ",
    r"replanner ": "--algorithm ",
    r"k (?=\S+$)": "--alternatives ",
    r"least_difference ": "--least-difference ",
    r"values='(\w+)'": r"--values \1",
    r"values ": "--values ",
    r"invert ": "--invert ",
}
#: ... and in its remedy, what helps.
REMEDIES = {
    r"a (start|goal) tolerance": r"--\1-tolerance",
    r"(start|goal) tolerance": r"--\1-tolerance",
    r"allow unknown cells": "give --allow-unknown",
    r"a smaller radius": "give a smaller --robot-radius",
    r"are read with values='occupancy' \(--values occupancy\)": "are read with --values occupancy",
    r"take antnav\.maps\.to_cells.*": "give --values occupancy",
}


def in_options(error: AntnavError, offered: Collection[str]) -> str:
    """The error's text, with options where it names parameters, as far as the command has these options."""
    given = _renamed(error.given, "^", GIVEN, offered)
    remedy = _renamed(error.remedy, r"\b", REMEDIES, offered)
    return f"{given}: {error.rule}; {remedy}"


def _renamed(text: str, begin: str, names: Mapping[str, str], offered: Collection[str]) -> str:
    def option_for(match: re.Match[str]) -> str:
        option = match.expand(names[pattern])
        return option if any(word in offered for word in option.split()) else match[0]

    for pattern in names:
        text = re.sub(f"{begin}(?:{pattern})", option_for, text)
    return text
