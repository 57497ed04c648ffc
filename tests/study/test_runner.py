"""Studies that are run: interrupted, killed, out of disk, and on one or two workers, with the same records."""

from __future__ import annotations

import math
import shutil
import signal
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.planner.facts import Certainty
from antnav.rivals import RIVALS
from antnav.run.spmd import Processes
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.record import Mark, Record
from antnav.study.runner import run_study, without_times
from antnav.study.store import Store
from antnav.study.toml import load_study
from tests.conftest import grid_of

TEXT = """
seeds = 5
[[maps]]
builtin = "equiv20"
corner_rule = "allow"
[[maps]]
generate = { kind = "random", rows = 15, cols = 12, seed = 1 }
[[algorithms]]
preset = "npaco"
ants = 10
[[algorithms]]
preset = "paco"
ants = 10
"""

#: Runs the study and tells each run once it is stored; waits then, so that it can be killed at a known place.
KILLED = """
import sys, time
from antnav.study import runner, store, toml
def tell(done, total, left):
    print(done, flush=True)
    time.sleep(60 if done == 7 else 0)
runner.run_study(toml.load_study(sys.argv[1]), store.Store(sys.argv[2]), progress=tell)
"""

#: Runs the study on a file system with room for some of its records, and again when there is more.
FULL = """
import pathlib, sys
from antnav.errors import OutputError
from antnav.study import runner, store, toml
study, folder = toml.load_study(sys.argv[1]), pathlib.Path(sys.argv[2])
ballast = folder / "ballast"
ballast.write_bytes(bytes(380_000))
with store.Store(folder / "runs.db") as runs:
    try:
        runner.run_study(study, runs)
    except OutputError as error:
        print(error)
    kept = runs.records()
    print(0 < len(kept) < len(study.jobs()))
try:
    with store.Store(folder / "runs.db") as runs:
        runner.run_study(study, runs)
except OutputError as error:
    print(error)
ballast.unlink()
with store.Store(folder / "runs.db") as runs:
    print(runs.records() == kept)
    runner.run_study(study, runs)
with store.Store(sys.argv[3]) as copy:
    for record in store.Store(folder / "runs.db").records():
        copy.add(record)
"""


@pytest.fixture(scope="module")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("study") / "study.toml"
    path.write_text(TEXT)
    return path


@pytest.fixture(scope="module")
def study(config: Path) -> Study:
    return load_study(config)


@pytest.fixture(scope="module")
def undisturbed(study: Study, tmp_path_factory: pytest.TempPathFactory) -> list[Record]:
    with Store(tmp_path_factory.mktemp("undisturbed") / "runs.db") as store:
        return run_study(study, store, workers=1)


def timeless(records: list[Record]) -> list[Record]:
    return [without_times(record) for record in records]


def test_records_tell_what_solve_found(study: Study, undisturbed: list[Record]) -> None:
    assert [record.key for record in undisturbed] == [job.key for job in study.jobs()]
    for job, record in zip(study.jobs(), undisturbed, strict=True):
        result = an.solve(job.problem, job.algorithm, seed=job.seed)
        assert (record.map, record.algorithm, record.seed) == (job.map_label, job.algorithm_label, job.seed)
        assert (record.length, record.optimum, record.steps) == (result.length, result.optimum, result.steps)
        assert record.path == tuple(map(tuple, result.path.cells.tolist()))
        assert record.seconds > 0
        assert Mark.LOADED not in record.marks


def test_two_workers_agree_with_one(study: Study, undisturbed: list[Record], tmp_path: Path) -> None:
    with Store(tmp_path / "runs.db") as store:
        records = run_study(study, store, workers=2)
    assert timeless(records) == timeless(undisturbed)
    assert all(Mark.LOADED in record.marks for record in records)


def test_processes_agree_with_one_worker_and_are_left_open(
    study: Study, undisturbed: list[Record], tmp_path: Path
) -> None:
    told: list[int] = []
    with Processes(2) as pool, Store(tmp_path / "runs.db") as store:
        records = run_study(study, store, executor=pool, progress=lambda done, _total, _left: told.append(done))
        assert told == list(range(21))
        assert timeless(records) == timeless(undisturbed)
        assert all(Mark.LOADED in record.marks for record in records)
        assert run_study(study, store, executor=pool) == records, "nothing is left to run"
        assert pool.submit(abs, -1).result() == 1


def test_killed_and_started_again(config: Path, study: Study, undisturbed: list[Record], tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    command = [sys.executable, "-c", KILLED, str(config), str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line == "7\n":
                break
        process.send_signal(signal.SIGKILL)
    told: list[int] = []
    with Store(path) as store:
        kept = store.records()
        assert timeless(kept) == timeless(undisturbed)[:7]
        records = run_study(study, store, progress=lambda done, _total, _left: told.append(done))
    assert records[:7] == kept  # not run again
    assert told == list(range(7, 21))
    assert timeless(records) == timeless(undisturbed)


@pytest.mark.parametrize("workers", [1, 2])
def test_cancelled_and_started_again(study: Study, undisturbed: list[Record], tmp_path: Path, workers: int) -> None:
    cancel = threading.Event()

    def stop(done: int, _total: int, _left: float | None) -> None:
        if done == 5:
            cancel.set()

    with Store(tmp_path / "runs.db") as store:
        part = run_study(study, store, workers=workers, cancel=cancel, progress=stop)
        assert 5 <= len(part) < 5 + 2 * workers
        assert run_study(study, store, cancel=cancel) == part
        assert timeless(run_study(study, store, workers=workers)) == timeless(undisturbed)


@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c_leaves_a_valid_store(study: Study, undisturbed: list[Record], tmp_path: Path, workers: int) -> None:
    def interrupt(done: int, _total: int, _left: float | None) -> None:
        if done == 3:
            signal.raise_signal(signal.SIGINT)

    with Store(tmp_path / "runs.db") as store, pytest.raises(KeyboardInterrupt):
        run_study(study, store, workers=workers, progress=interrupt)
    assert threading.active_count() < 10
    with Store(tmp_path / "runs.db") as store:
        assert len(store.keys()) == 3
        assert timeless(run_study(study, store)) == timeless(undisturbed)


def test_full_disk(config: Path, study: Study, undisturbed: list[Record], tmp_path: Path) -> None:
    """On a real small file system that only the child process sees."""
    mount = f"mount -t tmpfs -o size=400k tmpfs {tmp_path}"
    isolated = next((way for way in _NAMESPACES if _works([*way, "sh", "-c", mount])), None)
    if isolated is None:
        pytest.skip("no right to mount a file system here")
    copy = config.parent / "copy.db"
    command = [*isolated, "sh", "-c", f'{mount} && exec "$@"', "sh", sys.executable, "-c", FULL]
    done = subprocess.run([*command, config, tmp_path, copy], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    first, some_kept, second, all_kept = done.stdout.splitlines()
    assert "full" in first
    assert "start again: it goes on where it stopped" in first
    assert "full" in second
    assert some_kept == all_kept == "True"
    with Store(copy) as store:
        assert timeless(run_study(study, store)) == timeless(undisturbed)
        assert timeless(store.records()) == timeless(undisturbed)


_NAMESPACES = (["unshare", "--mount"], ["unshare", "--user", "--map-root-user", "--mount"])


def _works(command: list[str]) -> bool:
    return (
        shutil.which(command[0]) is not None
        and not subprocess.run(command, capture_output=True, check=False).returncode
    )


def test_progress_and_time_left(study: Study, tmp_path: Path) -> None:
    told: list[tuple[int, int, float | None]] = []
    with Store(tmp_path / "runs.db") as store:
        run_study(study, store, workers=1, progress=lambda *state: told.append(state))
        assert [(done, total) for done, total, _ in told] == [(number, 20) for number in range(21)]
        assert told[0][2] is None
        assert all(left is not None and 0 < left < math.inf for _, _, left in told[1:-1])
        assert told[-1][2] == 0
        told.clear()
        run_study(study, store, progress=lambda *state: told.append(state))
        assert told == [(20, 20, 0)]


def test_names_for_one_thing_share_runs(tmp_path: Path) -> None:
    problem = an.Problem.from_cells(grid_of("....", ".##.", "...."), (0, 0), (2, 3))
    few = {"ants": 3, "iterations": 5}
    entries = [AlgorithmEntry("one", an.npaco(**few)), AlgorithmEntry("two", an.npaco(**few, certainty="another"))]
    told: list[int] = []
    with Store(tmp_path / "runs.db") as store:
        study = Study("", [MapEntry("yard", problem)], entries, [0])
        one, two = run_study(study, store, progress=lambda done, _total, _left: told.append(done))
        assert told == [0, 1]
        assert (one.algorithm, two.algorithm, str(two.certainty)) == ("one", "two", "another")
        assert replace(one, algorithm="two", certainty=Certainty.of("another")) == two
        [renamed] = run_study(Study("", [MapEntry("court", problem)], entries[:1], [0]), store)
        assert renamed == replace(one, map="court")


def test_where_no_path_exists(tmp_path: Path) -> None:
    problem = an.Problem.from_cells(grid_of("..#..", "..#..", "..#.."), (0, 0), (2, 4))
    study = Study("", [MapEntry("wall", problem)], [AlgorithmEntry("paco", an.paco())], [0])
    with Store(tmp_path / "runs.db") as store:
        [record] = run_study(study, store)
    assert (record.status, record.length, record.optimum, record.path) == ("unreachable", None, None, None)


@pytest.mark.parametrize("workers", [0, -1])
def test_workers_are_checked(study: Study, tmp_path: Path, workers: int) -> None:
    with Store(tmp_path / "runs.db") as store, pytest.raises(ParameterError, match="workers"):
        run_study(study, store, workers=workers)


def test_rivals_stand_in_the_same_table(tmp_path: Path) -> None:
    """A planner without ants, named in the TOML file, is stored and read like the others."""
    (tmp_path / "study.toml").write_text(
        'title = "t"\nseeds = 2\n[[maps]]\nbuiltin = "equiv20"\ncorner_rule = "allow"\n'
        '[[algorithms]]\npreset = "npaco"\nants = 4\niterations = 4\n[[algorithms]]\nrival = "potential-field"\n'
    )
    study = load_study(tmp_path / "study.toml")
    with Store(tmp_path / "runs.sqlite") as store:
        records = run_study(study, store)
    assert [record.algorithm for record in records] == ["npaco", "potential-field"] * 2
    assert all(record.path for record in records if record.algorithm == "potential-field")
    (tmp_path / "bad.toml").write_text(
        'title = "t"\nseeds = 1\n[[maps]]\nbuiltin = "equiv20"\n[[algorithms]]\nrival = "x"\n'
    )
    with pytest.raises(ParameterError, match=r"algorithms 1, algorithm 'x'.*the rivals"):
        load_study(tmp_path / "bad.toml")


def test_a_time_limit_and_a_busy_machine_are_noted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = an.Problem.from_cells(grid_of("....", "....", "...."), (0, 0), (2, 3))
    algorithms = [AlgorithmEntry("npaco", an.npaco(iterations=10**6)), AlgorithmEntry("woa", RIVALS["woa-exact"])]
    plan = Study("", [MapEntry("map", problem)], algorithms, [0], seconds=1e-3)
    loads = iter([(99.0, 0.0, 0.0), (0.0, 0.0, 0.0)])
    monkeypatch.setattr("os.getloadavg", lambda: next(loads), raising=False)
    with Store(tmp_path / "runs.db") as store:
        first, second = run_study(plan, store)
    assert first.marks == (Mark.LIMITED, Mark.BUSY)
    assert first.iterations < 10**6
    assert second.marks == (Mark.LIMITED,)
