"""The second process: when there is one, how it ends, and that nothing depends on it."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from antnav.ants import second
from antnav.ants.second import SecondProcess

ENDLESS = "import time; print('said', flush=True); time.sleep(600)"


@pytest.fixture
def cold(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Nothing is kept in that folder, and there are two cores."""
    monkeypatch.setattr(second, "folder_of", lambda _: tmp_path)
    monkeypatch.setattr(second, "is_kept", lambda _: False)
    monkeypatch.setattr(second, "_cores", lambda: 2)
    return tmp_path


def started(names: tuple[str, ...] = ("exact",)) -> bool:
    with SecondProcess() as process:
        process.start(names)
        return process._process is not None


def test_it_is_told_names_and_says_nothing(
    cold: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        second,
        "CODE",
        f"import pathlib, sys; print(1, file=sys.stderr); pathlib.Path({str(cold / 'told')!r})"
        ".write_text(' '.join(sys.argv[2:])); print(2)",
    )
    with SecondProcess() as process:
        process.start(["exact", "windows"])
        assert [file.name for file in cold.iterdir() if file.name != "told"] == ["compiling.lock"]
        process._began -= 60.0
        process.join()
    assert [file.name for file in cold.iterdir()] == ["told"]
    assert (cold / "told").read_text() == "exact windows"
    assert capfd.readouterr() == ("", "")


def test_there_is_one_where_it_helps(cold: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second, "CODE", "")
    assert started()
    assert not started(())
    for name, value in {
        "is_kept": lambda _: True,
        "folder_of": lambda _: None,
        "_cores": lambda: 1,
    }.items():
        with monkeypatch.context() as patch:
            patch.setattr(second, name, value)
            assert not started(), name
    for executable in ("", None, "/opt/planner", "/opt/no/python3"):  # embedded, frozen, gone
        with monkeypatch.context() as patch:
            patch.setattr(sys, "executable", executable)
            assert not started(), executable
    assert not list(cold.iterdir())


def test_there_is_one_a_folder(cold: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second, "CODE", "")
    lock = cold / "compiling.lock"
    lock.touch()
    assert not started()
    assert lock.exists(), "it is another process's"
    os.utime(lock, (0.0, time.time() - 2 * second.STALE))
    assert started()
    assert not lock.exists()


def test_it_is_not_waited_for_longer_than_the_other_half_took(cold: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second, "CODE", ENDLESS)
    with SecondProcess() as process:
        process.start(["exact"])
        child = process._process
        process.join()
        assert child is not None
        assert child.poll() is None
    assert child.returncode not in (0, None)


def test_it_ends_where_the_work_is_interrupted(cold: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second, "CODE", ENDLESS)
    process = SecondProcess()
    with pytest.raises(KeyboardInterrupt), process:
        process.start(["exact"])
        raise KeyboardInterrupt
    assert process._process is not None
    assert process._process.returncode not in (0, None)
    assert not list(cold.iterdir())


ORPHAN = """
import os, subprocess, sys
code = "import time; from antnav.ants import second; second.end_with_the_first(); print('alive', flush=True)"
code += "; time.sleep(600)"
child = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE)
sys.stdin.read(1)
os._exit(1)
"""


def test_it_ends_with_the_first_however_that_ends() -> None:
    first = subprocess.Popen([sys.executable, "-c", ORPHAN], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert first.stdin and first.stdout
    assert first.stdout.readline() == "alive\n"
    first.stdin.write("x")
    first.stdin.close()
    assert first.wait() == 1
    assert first.stdout.read() == "", "the output closes with the last process that has it"


COLD = """
import sys
from antnav.ants import second, warmup
from antnav.kernels import ant_kernels, jump_kernels
second._cores = lambda: 2
second.CODE = second.CODE if sys.argv[1] == "works" else "1 / 0"
second.SecondProcess.join = lambda self: self._process.wait()  # however busy the machine is
print(warmup.kernels(windows=False, regions=False) > 0, warmup.kernels(windows=False, regions=False))
for kernel in (ant_kernels.advance, jump_kernels.jump_search):
    print(sum(kernel.stats.cache_hits.values()), sum(kernel.stats.cache_misses.values()))
"""


@pytest.mark.slow
@pytest.mark.parametrize("second_process", ["works", "fails"])
def test_what_it_compiled_is_loaded_and_the_rest_compiled(tmp_path: Path, second_process: str) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_DISABLE_JIT": "0"}
    command = [sys.executable, "-c", COLD, second_process]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    jumps = "1 0" if second_process == "works" else "0 1"
    assert run.stdout.splitlines() == ["True 0.0", "0 1", jumps], run.stderr
    assert run.stderr == ""
    assert not list(tmp_path.rglob("*.lock"))
