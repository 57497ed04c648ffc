"""The digest of the sources: what changes it, and that runs of other code are done anew."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import antnav as an
from antnav.study import model
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.runner import run_study
from antnav.study.sources import WITH_SAY, WITHOUT_SAY, digest_of, sources
from antnav.study.store import Store
from tests.conftest import grid_of

PACKAGE = Path(an.__file__).parent
KEY = (
    "from pathlib import Path; import antnav as an; from antnav.maps import builtin\n"
    "from antnav.study.model import AlgorithmEntry, MapEntry, Study\n"
    "problem = an.Problem.from_cells(builtin('equiv20'), (0, 0), (19, 19))\n"
    "study = Study('', [MapEntry('map', problem)], [AlgorithmEntry('npaco', an.npaco())], [0])\n"
    "print(Path(an.__file__).parent, study.jobs()[0].key)"
)


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """A copy of the package's sources."""
    return Path(shutil.copytree(PACKAGE, tmp_path / "antnav", ignore=shutil.ignore_patterns("__pycache__")))


def test_what_decides_outcomes_changes_it_and_nothing_else(copied: Path) -> None:
    rooms = {"world", "kernels", "search", "planner", "colony", "ants", "plan", "rivals", "run"}
    assert rooms <= {entry.name for entry in copied.iterdir()} - WITHOUT_SAY
    seen = [digest_of(copied)]
    assert seen == [sources()]
    for name in (*rooms, "bench", "cli", "costs", "maps", "plot", "study", "__init__.py"):
        entry = copied / name
        file = entry if entry.is_file() else sorted(entry.glob("*.py"))[-1]
        file.write_bytes(file.read_bytes() + b"# changed\n")
        assert (digest_of(copied) != seen[-1]) == (name in rooms), name
        seen.append(digest_of(copied))
    (copied / "kernels" / "another.py").write_bytes(b"")
    (copied / "unheard_of.py").write_bytes(b"")
    assert digest_of(copied) != seen[-1]


def imported_from_study(name: str) -> set[str]:
    """The modules of the study room that one of them imports, and what these import in turn, itself among them."""
    found, waiting = set(), {name}
    while waiting:
        found.add(name := waiting.pop())
        for node in ast.walk(ast.parse((PACKAGE / "study" / f"{name}.py").read_text())):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("antnav.study"):
                modules = {node.module.rpartition(".")[2]}
                waiting |= (modules if node.module != "antnav.study" else {one.name for one in node.names}) - found
    return found


def test_what_does_runs_and_makes_records_changes_it(copied: Path) -> None:
    doing = (imported_from_study("runner") | imported_from_study("front_model")) - {
        "shard",
        "sources",
        "store",
    }  # these say which runs, name and keep records
    assert {f"study/{name}.py" for name in doing} == WITH_SAY
    for name in sorted(WITH_SAY):
        before = digest_of(copied)
        (copied / name).write_text("changed")
        assert digest_of(copied) != before


def test_a_changed_heuristic_has_other_keys_at_the_same_version(copied: Path) -> None:
    def key() -> str:
        found = subprocess.run(
            [sys.executable, "-c", KEY], cwd=copied.parent, env=environment, check=True, capture_output=True, text=True
        )
        package, digest = found.stdout.split()
        assert Path(package) == copied
        return digest

    metadata = copied.parent / "antnav-0.dist-info" / "METADATA"
    metadata.parent.mkdir()
    metadata.write_text(f"Metadata-Version: 2.1\nName: antnav\nVersion: {an.__version__}\n")
    environment = {**os.environ, "PYTHONPATH": str(copied.parent), "NUMBA_CACHE_DIR": str(copied.parent / "cache")}
    before = key()
    (copied / "study" / "report.py").write_text("")
    assert key() == before
    heuristic = copied / "colony" / "heuristic.py"
    heuristic.write_text(heuristic.read_text() + "\nCHANGED = True\n")
    assert key() != before


def test_a_store_made_by_other_code_does_the_runs_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = an.Problem.from_cells(grid_of("...", ".#.", "..."), (0, 0), (2, 2))
    study = Study("", [MapEntry("map", problem)], [AlgorithmEntry("npaco", an.npaco(iterations=2))], [0, 1])
    done: list[int] = []

    def run(store: Store) -> list[str]:
        done.clear()
        found = [record.key for record in run_study(study, store, progress=lambda count, *_: done.append(count))]
        return found

    with Store(tmp_path / "runs.sqlite") as store:
        first = run(store)
        assert done == [0, 1, 2]
        assert run(store) == first
        assert done == [2]
        monkeypatch.setattr(model, "sources", lambda: "other")
        second = run(store)
        assert done == [0, 1, 2]
        assert not set(first) & set(second)
        assert store.keys() == {*first, *second}
