"""New files: they pass as they are, and never take the place of others."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import antnav as an
from antnav.conformance import writing
from antnav.conformance.checks import CHECKS
from antnav.conformance.subject import ASKED
from antnav.conformance.writing import RULES, write_new
from antnav.errors import OutputError, ParameterError

EVERY = [(kind, False) for kind in (*RULES, "algorithm", "planner")] + [(kind, True) for kind in ASKED]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with files of all kinds."""
    folder = tmp_path_factory.mktemp("new")
    for kind, jit in EVERY:
        write_new(f"{'fast' if jit else 'my'}_{kind}", kind, folder, jit=jit)
    return folder


def test_ruff_takes_them(written: Path) -> None:
    ruff = shutil.which("ruff", path=str(Path(sys.executable).parent))
    if ruff is None:
        pytest.skip("ruff is not installed")
    ours = Path(__file__).parents[2] / "pyproject.toml"
    for options in (["--isolated"], ["--config", str(ours)]):
        found = subprocess.run([ruff, "check", *options, written], capture_output=True, text=True, check=False)
        assert found.returncode == 0, found.stdout
    found = subprocess.run([ruff, "format", "--isolated", "--diff", written], capture_output=True, check=False)
    assert found.returncode == 0, found.stdout


def test_rules_are_short_and_say_what_they_are(written: Path) -> None:
    for kind, jit in EVERY:
        text = (written / f"{'fast' if jit else 'my'}_{kind}.py").read_text()
        assert len(text.splitlines()) < (36 if kind == "planner" else 30)
        assert "Source: AUTHOR (YEAR), doi: DOI" in text
        assert "$" not in text
        assert ("jit=True" in text) == (jit or kind == "transition")


@pytest.mark.slow
def test_their_tests_pass(written: Path) -> None:
    """The twins, and all checks: in a process of their own, as a user runs them."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-rf", "."]
    ended = subprocess.run(command, cwd=written, capture_output=True, text=True, check=False, timeout=500)
    assert ended.returncode == 0, ended.stdout
    passed = int(ended.stdout.split(" passed")[0].split()[-1])
    assert passed > len(EVERY) * (len(CHECKS) - 3)


@pytest.mark.parametrize(
    ("name", "kind", "words"),
    [
        ("Share", "pheromone", "small letters"),
        ("my share", "pheromone", "small letters"),
        ("../share", "pheromone", "small letters"),
        ("", "pheromone", "small letters"),
        ("lambda", "pheromone", "none of Python's own"),
        ("test_share", "pheromone", "pytest"),
        ("conftest", "pheromone", "pytest"),
        ("random", "pheromone", "would hide"),
        ("numpy", "pheromone", "would hide"),
        ("antnav", "pheromone", "would hide"),
        ("max_min", "pheromone", "antnav has a pheromone of that name; choose another, such as my_max_min"),
        ("levels", "cuts", "antnav has a cuts"),
        ("paco", "algorithm", "antnav has an algorithm"),
        ("astar", "planner", "antnav has a planner"),
        ("length", "objective", "antnav has an objective"),
        ("share", "memory", "the kinds are heuristic"),
    ],
)
def test_names_that_cannot_be(name: str, kind: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=words):
        write_new(name, kind, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_compiled(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="pheromone, local_search, transition, deadlock can be compiled"):
        write_new("share", "heuristic", tmp_path, jit=True)


@pytest.mark.parametrize("there", ["share.py", "test_share.py"])
def test_nothing_is_written_over(there: str, tmp_path: Path) -> None:
    (tmp_path / there).write_text("mine")
    with pytest.raises(ParameterError, match="it is there already"):
        write_new("share", "pheromone", tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == [there]
    assert (tmp_path / there).read_text() == "mine"


def test_both_files_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(path: Path, content: bytes) -> None:
        if path.name.startswith("test_"):
            raise OutputError(str(path), "no space is left", "make room")
        path.write_bytes(content)

    monkeypatch.setattr(writing, "write_whole", failing)
    with pytest.raises(OutputError, match="no space"):
        write_new("share", "pheromone", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_made(tmp_path: Path) -> None:
    file, test = write_new("share", "pheromone", tmp_path / "a" / "b")
    assert file.is_file()
    assert test.is_file()
    assert an.npaco(pheromone=f"{file}:share", top=5).pheromone.top == 5
    with pytest.raises(OutputError):
        write_new("share", "pheromone", file)
