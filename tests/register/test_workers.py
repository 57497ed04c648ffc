"""Rules travel to worker processes as code, wherever they are defined."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import antnav as an
from antnav.run.spmd import Processes

PROBLEM = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
RULES = '''
import antnav as an
import numpy as np

NEAR = 0.1


def far(ground):
    rows, cols = (ground.cells - ground.cells[ground.goal]).T
    return np.sqrt(rows**2 + cols**2)


@an.register.heuristic
def homing(ground, reach=2.0):
    """1 / (reach + the straight distance to the goal)."""
    return 1 / (reach + far(ground) + NEAR)


@an.register.pheromone
def share(ants, top=an.parameter(3, least=1, most=50)):
    """The best few deposit."""
    best = ants.order[: min(top, ants.arrived)]
    ants.amounts[: best.size] = ants.q / ants.costs[best]
'''
SOLVED = """
from antnav.run.spmd import Processes

def main():
    problem = an.Problem.from_cells(an.maps.builtin("equiv20"), (0, 0), (19, 19))
    algorithm = an.paco(heuristic=homing(reach=1.0), pheromone=share(top=5), ants=9, iterations=8)
    with Processes(1) as processes:
        there = an.solve(problem, algorithm, seed=3, executor=processes)
        (many,) = an.solve_many([problem], algorithm, seed=3, executor=processes)
    here = an.solve(problem, algorithm, seed=3)
    assert there.algorithm == many.algorithm == here.algorithm
    print(here.length == there.length == many.length, algorithm.document()["own"]["heuristic"]["file"])
"""


def test_a_rule_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(RULES)
    algorithm = an.paco(heuristic=f"{tmp_path / 'mine.py'}:homing", pheromone="share", ants=9, iterations=8)
    (tmp_path / "mine.py").unlink()
    here = an.solve(PROBLEM, algorithm, seed=3)
    with Processes(1) as processes:
        there = an.solve(PROBLEM, algorithm, seed=3, executor=processes)
        (many,) = an.solve_many([PROBLEM], algorithm, seed=3, executor=processes)
    assert here.length == there.length == many.length
    assert there.algorithm == here.algorithm == many.algorithm


@pytest.mark.parametrize("guarded", [True, False], ids=["a script", "a notebook"])
def test_a_rule_of_the_main_module(tmp_path: Path, guarded: bool) -> None:
    """A notebook's main module has no file, so that workers cannot run it."""
    text = RULES + SOLVED + ("if __name__ == '__main__':\n    main()\n" if guarded else "main()\n")
    (tmp_path / "script.py").write_text(text)
    command = [sys.executable, "script.py"]
    if not guarded:
        command = [sys.executable, "-c", text]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.split() == ["True", *(["script.py"] if guarded else [])]
