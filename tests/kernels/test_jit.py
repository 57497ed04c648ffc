"""Kernels compile where no machine code can be kept: a read-only install, a user without a home."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

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


@pytest.mark.slow
def test_kernels_that_cannot_be_cached_are_compiled_in_memory() -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert run.stdout.strip() == "found", run.stderr


TINY = """
from antnav.kernels.jit import jit

@jit
def twice(x):
    return 2 * x
"""
#: Prints, after each damage to one of the kernel's two files, what the kernel says and how often it was compiled.
DAMAGES = """
import importlib, logging, sys
from pathlib import Path

from antnav.kernels import jit

folder, sys.path[:0] = Path(sys.argv[1]), [sys.argv[1]]
import tiny

def call():
    kernel = importlib.reload(tiny).twice
    answer = kernel(21)
    return answer, sum(kernel.stats.cache_misses.values())

print(call(), call())
flips = [lambda data, at=at: data[: len(data) * at // 40] + bytes([data[len(data) * at // 40] ^ 16])
         + data[len(data) * at // 40 + 1 :] for at in range(40)]
for damage in [lambda data: b"", lambda data: data[: len(data) // 2], lambda data: data[:-1], *flips]:
    for ending in ("nbi", "nbc"):
        for file in folder.rglob(f"*.{ending}"):  # a damaged key in the index leaves a file that nothing names
            file.write_bytes(damage(file.read_bytes()))
        print(call(), call())
"""


def tiny_kernel(script: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a script that imports a kernel of its own from a folder, and keeps its machine code there."""
    (folder / "tiny.py").write_text(TINY)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder), "NUMBA_DISABLE_JIT": "0"}
    command = [sys.executable, "-c", script, str(folder)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_damaged_machine_code_is_compiled_anew_and_said_once(tmp_path: Path) -> None:
    run = tiny_kernel(DAMAGES, tmp_path)
    first, *lines = run.stdout.splitlines()
    assert first == "(42, 1) (42, 0)", run.stderr
    assert len(lines) == 2 * 43, run.stderr
    assert set(lines[1::2]) == {"(42, 1) (42, 0)"}  # machine code: compiled once more, and kept again
    assert set(lines[::2]) <= {"(42, 1) (42, 0)", "(42, 0) (42, 0)"}  # index: it has bits that say nothing
    (line,) = run.stderr.splitlines()
    assert str(tmp_path) in line
    assert "compiled anew" in line


UNWRITABLE = """
import resource, sys
sys.path[:0] = [sys.argv[1]]
resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
import tiny
print(tiny.twice(21), tiny.twice(1.5))
"""


@pytest.mark.skipif(os.name != "posix", reason="needs limits on the size of files")
def test_a_disk_without_room_for_machine_code_costs_no_run(tmp_path: Path) -> None:
    run = tiny_kernel(UNWRITABLE, tmp_path)
    assert run.stdout == "42 3.0\n", run.stderr
    (line,) = run.stderr.splitlines()
    assert str(tmp_path) in line
    assert "cannot be written (File too large)" in line


STALE = """
import sys
sys.path[:0] = [sys.argv[1]]
import tiny
from antnav.kernels import jit
if sys.argv[2:] == ["full"]:  # the index is written, then the disk is full
    jit.IndexDataCacheFile._save_data = lambda *_: None
print(tiny.twice(21))
"""


def test_old_machine_code_under_a_new_index_is_not_run(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_DISABLE_JIT": "0"}
    answers = []
    for text, words in ((TINY, []), (TINY.replace("2 *", "3 *"), ["full"]), (TINY.replace("2 *", "3 *"), [])):
        (tmp_path / "tiny.py").write_text(text)
        command = [sys.executable, "-B", "-c", STALE, str(tmp_path), *words]
        run = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        answers.append(run.stdout.strip())
    assert answers == ["42", "63", "63"]


REFUSED = """
import sys
sys.path[:0] = [sys.argv[1]]
import numpy as np
from antnav.kernels.jit import jit
import refusing

for _ in range(2):
    for arguments in ((np.empty(0), np.zeros(2)), (np.ones(3), np.zeros(2))):
        try:
            refusing.filled(*arguments)
        except ValueError as error:
            print(error)
print(refusing.filled(np.ones(2), np.zeros(2)), sum(refusing.filled.stats.cache_hits.values()))
"""


def test_kernels_from_disk_refuse_what_compiled_ones_do(tmp_path: Path) -> None:
    """They are loaded without Numba's library and without the environments of what they call there."""
    (tmp_path / "refusing.py").write_text(
        "from antnav.kernels.jit import jit\n\n\n@jit\ndef least(x):\n    return x.argmin()\n\n\n"
        "@jit\ndef filled(x, y):\n    y[:] = x[: least(x) + 3]\n    return y.copy()\n"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_DISABLE_JIT": "0"}
    command = [sys.executable, "-B", "-c", REFUSED, str(tmp_path)]
    first, second = (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=False) for _ in range(2)
    )
    lines = first.stdout.splitlines()
    assert len(lines) == 5, first.stderr
    assert "empty" in lines[0]
    assert "shape" in lines[1]
    assert lines[-1] == "[1. 1.] 0"
    assert second.stdout.splitlines() == [*lines[:-1], "[1. 1.] 1"], second.stderr
