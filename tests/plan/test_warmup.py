"""warmup: what it compiles is all that runs need."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

SCRIPT = """
import antnav as an
from antnav import maps
from antnav.kernels import ant_kernels, grid_kernels, straight_kernels, walk_kernels
from antnav.rivals import Metaheuristic, PotentialField, Segments
from antnav.search import exact

rooms = (ant_kernels, grid_kernels, straight_kernels, walk_kernels)
kernels = {f"{room.__name__}.{name}": kernel for room in rooms for name, kernel in vars(room).items()
           if hasattr(kernel, "signatures")}
def compiled():
    return {name: len(kernel.signatures) for name, kernel in kernels.items() if kernel.signatures}
print(compiled())
print(an.warmup() > 0, an.warmup())
warm = compiled()
print(warm.get("antnav.kernels.ant_kernels.advance"), warm.get("antnav.kernels.grid_kernels.search"))
grid = maps.generate("caves", 60, 60, seed=2)
problem = an.Problem.from_cells(grid, *maps.ends(grid))
chosen = [preset(ants=3, iterations=9) for preset in an.PRESETS.values()]
chosen += [an.paco_large(coarse=8, windows=9, iterations=3), an.paco(search="half", iterations=6)]
results = [an.solve(problem, algorithm) for algorithm in chosen]
rivals = [Metaheuristic(method="woa", population=6, evaluations=30, segments=kind) for kind in Segments]
results += [an.solve(problem, rival) for rival in (*rivals, PotentialField(escapes=3))]
for result in results:
    result.to_dict(), result.path and (result.path.clearance, result.path.wall_distance)
for method in ("astar", "dijkstra"):
    exact.shortest_path(problem, method)
print({name: count for name, count in compiled().items() if warm.get(name) != count})
"""


@pytest.mark.skipif(bool(os.environ.get("NUMBA_DISABLE_JIT")), reason="nothing is compiled")
def test_nothing_compiles_after_it() -> None:
    found = subprocess.run([sys.executable, "-c", SCRIPT], check=True, capture_output=True, text=True)
    assert found.stdout.splitlines() == ["{}", "True 0.0", "2 1", "{}"]  # advance: with and without searches
