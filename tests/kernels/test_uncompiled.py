"""The kernels with the compiler off (NUMBA_DISABLE_JIT=1) give the same results as with it on."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest

SCRIPT = """
import json, warnings
from dataclasses import replace
import numpy as np
import antnav as an
from antnav.colony.parts import DeadlockPart, PheromonePart, TransitionPart, parameter
from antnav.colony.parts.names import OwnName
from antnav.plugins.source import Source
warnings.simplefilter("ignore", RuntimeWarning)  # NumPy's integers warn where machine integers wrap
cells = (np.random.default_rng(11).random((8, 9)) < 0.25).astype(np.uint8)
cells[0, 0] = cells[-1, -1] = 0
problem = an.Problem.from_cells(an.GridMap(cells), (0, 0), (7, 8), corner_rule="allow")
class Late(DeadlockPart):
    name, basis, own, jit = OwnName("late"), "stated", True, True
    source = Source("own", "", "", "")
    function = staticmethod(lambda stuck: stuck.backs > 2)
class Ranked(PheromonePart):
    name, basis, own, jit = OwnName("ranked"), "stated", True, True
    source = Source("own", "", "", "")
    top = parameter(3, least=1)
    @staticmethod
    def function(ants, top):
        for rank in range(min(top, ants.arrived)):
            ants.amounts[rank] = ants.q / ants.costs[ants.order[rank]]
class Greedy(TransitionPart):
    name, basis, own, jit = OwnName("greedy"), "stated", True, True
    source = Source("own", "", "", "")
    function = staticmethod(lambda choice: np.argmax(choice.weights * (0.5 + choice.draws[0])))
answers = {}
for name, algorithm in {
    "paco": an.paco(ants=6, iterations=8), "backtrack": an.npaco(ants=6, iterations=6, deadlock="backtrack"),
    "luo": an.npaco(ants=6, iterations=6, deadlock="luo", alpha=2), "traditional": an.traditional(ants=6, iterations=6),
    "nobody arrives": an.preset("gao", ants=2, iterations=3, beta=0), "levels": an.paco_levels(ants=6, iterations=6),
    "own": replace(an.npaco(ants=6, iterations=6), pheromone=Ranked(), deadlock=Late(), transition=Greedy()),
    "large": an.paco_large(coarse=4, windows=6, ants=4, iterations=4),
}.items():
    result = an.solve(problem, algorithm, seed=3)
    path = result.path.cells.tolist() if result.path else None
    answers[name] = [path, result.history.best.tolist(), result.history.arrived.tolist(), result.steps, result.optimum]
print(json.dumps(answers))
"""


def answers(disable: str) -> dict:
    environment = os.environ | {"NUMBA_DISABLE_JIT": disable}
    run = subprocess.run([sys.executable, "-c", SCRIPT], env=environment, check=True, capture_output=True, text=True)
    return json.loads(run.stdout)


def test_compiled_and_uncompiled_agree() -> None:
    compiled = answers("0")
    assert compiled == answers("1")
    assert 0 in compiled["nobody arrives"][2]


@pytest.mark.skipif(os.environ.get("NUMBA_DISABLE_JIT") == "1", reason="nothing is compiled")
def test_every_kernel_has_one_signature_for_all_problems() -> None:
    """A second signature would be compiled at a user's second call, seconds late."""
    import antnav as an
    from antnav.kernels import ant_kernels, grid_kernels
    from antnav.world.cost import CostField

    for rows, algorithm in ((3, an.paco()), (30, an.traditional(alpha=1.5)), (2, an.npaco(heuristic="geodesic"))):
        grid = an.GridMap(np.zeros((rows, 5), np.uint8))
        for cost in (None, CostField(np.ones(grid.shape))):
            an.solve(an.Problem.from_cells(grid, (0, 0), (rows - 1, 4), cost=cost), algorithm)
    for kernel in (grid_kernels.search, grid_kernels.components, grid_kernels.trace):
        assert len(kernel.signatures) == 1, kernel
    assert (
        len({signature[:-3] for signature in ant_kernels.advance.signatures}) == 1
    )  # the last ones: `searches`, `own`, `walking`
