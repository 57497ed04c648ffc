"""Kernels compile where no machine code can be kept: a read-only install, a user without a home."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
from numba.core import caching

for implementation in (caching.CodeLibraryCacheImpl, caching.CompileResultCacheImpl):
    implementation._locator_classes = []  # what Numba is left with where no folder can be written

import numba
import numpy as np

try:
    numba.njit(cache=True)(lambda x: x)
except RuntimeError:
    pass
else:
    raise SystemExit("the trap is not set")

import antnav as an

problem = an.Problem.from_cells(an.GridMap(np.zeros((3, 4), np.uint8)), (0, 0), (2, 3))
print(an.solve(problem, an.npaco(ants=3, iterations=3)).status)
"""


def test_kernels_that_cannot_be_cached_are_compiled_in_memory() -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert run.stdout.strip() == "found", run.stderr
