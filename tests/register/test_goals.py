"""Objectives of users by name."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.objectives.named import named

GRID = an.maps.builtin("equiv20")
PROBLEM = an.Problem.from_cells(GRID, (0, 0), (19, 19))
FILE = '''
import antnav as an


@an.register.objective
class Middle(an.objectives.Objective):
    """Keep to the middle columns."""

    name, unit = "middle", "cells"

    def edges(self, terrain, graph):
        columns = graph.cells[:, 1]
        return abs(columns - columns.max() / 2)[:, None] + 0.0 * graph.graph.lengths
'''


def test_an_objective_by_its_name(tmp_path: Path) -> None:
    file = tmp_path / "goals.py"
    file.write_text(FILE)
    middle = named(f"{file}:middle", GRID)
    assert type(named("middle", GRID)) is type(middle)
    front = an.pareto(PROBLEM, [an.objectives.Length(), middle])
    assert [objective.name for objective in front.objectives] == ["length", "middle"]
    (tmp_path / "packed").write_bytes(pickle.dumps(middle))
    file.unlink()
    code = "import pickle; print(pickle.load(open('packed', 'rb')).label)"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "middle [cells]"
    with pytest.raises(ParameterError, match="your own middle; give one, such as"):
        named("midle", GRID)


def test_what_is_no_objective_is_refused() -> None:
    class Needy(an.objectives.Objective):
        name = "needy"

        def __init__(self, field: np.ndarray) -> None: ...

    class Risk(an.objectives.Objective):
        name = "risk"

    for kind, words in (
        (Needy, "it is made without arguments, and that raised TypeError"),
        (Risk, "antnav has one of that name"),
        (int, "derives from antnav.objectives.Objective"),
    ):
        with pytest.raises(ParameterError, match=words):
            an.register.objective(kind)
