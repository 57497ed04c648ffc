"""Machine code is never old: what a kernel is made from stands in its file, or in the digest that stamps the cache."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import antnav
from antnav.colony import parts
from antnav.kernels import codes

PACKAGE = Path(antnav.__file__).parent
FILES = sorted(PACKAGE.rglob("*.py"))


def compiled_functions(tree: ast.Module) -> dict[str, ast.FunctionDef]:
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return {f.name: f for f in functions if any(isinstance(d, ast.Name) and d.id == "jit" for d in f.decorator_list)}


def imported_names(tree: ast.Module) -> set[str]:
    """Names that a module has from other rooms of ours."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("antnav"):
            if ((node.module or "") + ".").startswith("antnav.kernels."):
                continue  # the stamp of machine code holds a digest of this room
            found |= {alias.asname or alias.name for alias in node.names}
    return found


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(PACKAGE)))
def test_no_kernel_calls_what_stands_in_another_room(file: Path) -> None:
    """Its machine code would be frozen into this one's, and grow old there."""
    tree = ast.parse(file.read_text())
    functions, imported = compiled_functions(tree), imported_names(tree)
    assert not functions or file.parent.name == "kernels", "kernels live in one room, whose sources stamp the cache"
    for name, function in functions.items():
        for call in (node for node in ast.walk(function) if isinstance(node, ast.Call)):
            root = call.func
            while isinstance(root, ast.Attribute):
                root = root.value
            assert not (isinstance(root, ast.Name) and root.id in imported), (name, ast.unparse(call.func))


def test_there_are_kernels() -> None:
    counts = {file.name: len(compiled_functions(ast.parse(file.read_text()))) for file in FILES}
    kernels = {name for name, count in counts.items() if count}
    assert kernels == {file.name for file in (PACKAGE / "kernels").glob("*_kernels.py")}
    assert len(kernels) > 4


@pytest.mark.parametrize("kind", ["PheromoneRule", "Deadlock", "Deposit", "LocalSearch", "Transition"])
def test_every_member_has_its_code(kind: str) -> None:
    members = getattr(parts, kind)
    assert {part.name for part in members} == {code.name for code in getattr(codes, kind)}
    assert len({part.code for part in members}) == len(members)
    assert all(type(part.code) is int for part in members)


CALL = """
import sys
sys.path.insert(0, sys.argv[1])
from room import user
print(user.doubled_code(), sum(user.doubled_code.stats.cache_hits.values()))
"""


@pytest.mark.parametrize(
    ("other", "imported", "used"),
    [
        ("CODE = {}\n", "CODE", "CODE"),
        ("from room.jit import jit\n\n\n@jit\ndef code():\n    return {}\n", "code", "code()"),
    ],
    ids=["a constant", "a kernel that is called"],
)
def test_what_changes_in_another_file_is_compiled_anew(tmp_path: Path, other: str, imported: str, used: str) -> None:
    """With Numba's own stamp the third run prints what the second did."""
    room = tmp_path / "room"
    room.mkdir()
    (room / "__init__.py").touch()
    (room / "jit.py").write_text((PACKAGE / "kernels" / "jit.py").read_text())
    (room / "user.py").write_text(
        f"from room.jit import jit\nfrom room.other import {imported}\n\n\n"
        f"@jit\ndef doubled_code():\n    return 2 * {used}\n"
    )
    said = []
    for code in (1, 1, 2):
        (room / "other.py").write_text(other.format(code))
        run = subprocess.run(
            [sys.executable, "-B", "-c", CALL, str(tmp_path)], capture_output=True, text=True, check=False
        )
        said.append(run.stdout.split() or run.stderr)
    assert said == [["2", "0"], ["2", "1"], ["4", "0"]]
