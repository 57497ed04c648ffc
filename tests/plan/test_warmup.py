"""warmup: what it compiles is all that runs need."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

SCRIPT = """
import antnav as an
from antnav import maps
from antnav.kernels import ant_kernels, grid_kernels, straight_kernels
rooms = (ant_kernels, grid_kernels, straight_kernels)
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
for algorithm in (an.npaco(iterations=3), an.paco(iterations=6), an.paco_large(coarse=8, windows=9, iterations=3)):
    an.solve(problem, algorithm).gap
print({name: count for name, count in compiled().items() if warm.get(name) != count})
"""


@pytest.mark.skipif(bool(os.environ.get("NUMBA_DISABLE_JIT")), reason="nothing is compiled")
def test_no_run_compiles_after_it() -> None:
    found = subprocess.run([sys.executable, "-c", SCRIPT], check=True, capture_output=True, text=True)
    assert found.stdout.splitlines() == ["{}", "True 0.0", "1 1", "{}"]
