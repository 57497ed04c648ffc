"""Studies on real engines: Dask, MPI, processes; workers and schedulers that are killed from outside in mid-run."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

import antnav as an
from antnav.cli import main
from antnav.errors import ParameterError, PathError, WorkerLostError
from antnav.fronts.pareto import METHODS
from antnav.maps import builtin, builtin_query
from antnav.objectives.named import collected
from antnav.run import chunks
from antnav.run.spmd import Processes
from antnav.study import model
from antnav.study.budget import Budget
from antnav.study.changes import Changes
from antnav.study.dynamic_model import DynamicStudy
from antnav.study.front_model import FrontPlanner, FrontStudy
from antnav.study.model import AlgorithmEntry, AnyStudy, MapEntry, Study
from antnav.study.record import without_times
from antnav.study.runner import RunFailedError, run_study
from antnav.study.store import Store

#: Seconds after which a test gives up.
LONGEST = 120.0


def place(name: str = "equiv20") -> MapEntry:
    problem = an.Problem.from_cells(builtin(name), *builtin_query(name), corner_rule="allow")
    return MapEntry(name, problem)


def short(seeds: int, **more) -> Study:
    entries = [AlgorithmEntry("few", an.npaco(ants=10, iterations=4)), AlgorithmEntry("luo", an.luo(iterations=4))]
    return Study("", [place(), place("equiv30")], entries, range(seeds), **more)


@contextmanager
def in_time() -> Iterator[threading.Event]:
    """An event that ends a study that hangs."""
    cancel = threading.Event()
    timer = threading.Timer(LONGEST, cancel.set)
    timer.start()
    try:
        yield cancel
    finally:
        timer.cancel()


def done(study: AnyStudy[Any], path: Path, executor: Executor | None = None, **more) -> list[Any]:
    with in_time() as cancel, Store(path, study.keeps) as store:
        found = run_study(study, store, executor=executor, cancel=cancel, **more)
        assert not cancel.is_set()
    return [without_times(record) for record in found]


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    return done(short(100), tmp_path_factory.mktemp("alone") / "runs.db")


@contextmanager
def dask() -> Iterator[tuple[Any, Any]]:
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield cluster, client


def after(count: int, act: Callable[[], object]) -> Callable[[int, int, float | None], None]:
    """Progress that does something once so many runs are stored."""
    acted = False

    def tell(runs: int, _total: int, _left: float | None) -> None:
        nonlocal acted
        if runs >= count and not acted:
            acted = True
            act()

    return tell


def test_a_process_that_is_killed_costs_a_retry(alone: list[Any], tmp_path: Path) -> None:
    with Processes(2) as pool:

        def kill() -> None:
            worker = next(iter(pool._pool._processes.values()))
            os.kill(worker.pid, signal.SIGKILL)

        assert done(short(100), tmp_path / "runs.db", pool, progress=after(50, kill)) == alone


@pytest.mark.slow
def test_a_dask_worker_that_is_killed_costs_a_retry(alone: list[Any], tmp_path: Path) -> None:
    with dask() as (cluster, client):
        pids: list[int] = []

        def kill() -> None:
            pids.append(cluster.workers[0].pid)
            os.kill(pids[0], signal.SIGKILL)

        executor = client.get_executor()
        assert done(short(100), tmp_path / "runs.db", executor, progress=after(50, kill)) == alone
        assert pids


@pytest.mark.slow
def test_a_scheduler_that_dies_costs_nothing_that_is_stored(alone: list[Any], tmp_path: Path) -> None:
    """The same study goes on in processes."""
    distributed = pytest.importorskip("distributed", reason="the extra antnav[cluster] is not installed")
    file = tmp_path / "scheduler.json"
    commands = [
        ["dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)],
        *[["dask_worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-dashboard"]] * 2,
    ]
    started = [
        subprocess.Popen([sys.executable, "-m", f"distributed.cli.{name}", *rest], stderr=subprocess.DEVNULL)
        for name, *rest in commands
    ]
    kept: list[Any] = []
    try:
        while not file.exists():
            time.sleep(0.1)
        with distributed.Client(scheduler_file=str(file), timeout=5) as client, Store(tmp_path / "runs.db") as store:
            client.wait_for_workers(2, timeout=60)
            with in_time() as cancel, pytest.raises(WorkerLostError, match="scheduler"):
                run_study(
                    short(100), store, executor=client.get_executor(), cancel=cancel,
                    progress=after(50, started[0].kill),
                )  # fmt: skip
            kept += store.records()
    finally:
        for process in started:
            process.kill()
            process.wait()
    assert 50 <= len(kept) < len(alone)
    with Processes(2) as pool:
        assert done(short(100), tmp_path / "runs.db", pool) == alone
    with Store(tmp_path / "runs.db") as store:
        assert store.records()[: len(kept)] == kept


@dataclass(frozen=True)
class Deadly(an.Planner):
    """A* that kills its process under one seed."""

    seed: int = 13
    name: str = "deadly"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        if call.seed == self.seed:
            os.kill(os.getpid(), signal.SIGKILL)
        return an.astar().plan(problem, call)


def test_a_run_that_kills_its_workers_is_named_and_all_others_are_stored(tmp_path: Path) -> None:
    study = Study("", [place()], [AlgorithmEntry("deadly", Deadly()), AlgorithmEntry("astar", an.astar())], range(30))
    with Processes(2) as pool, Store(tmp_path / "runs.db") as store, in_time() as cancel:
        with pytest.raises(WorkerLostError, match="1 run: deadly on equiv20 under seed 13: workers died 3 times"):
            run_study(study, store, executor=pool, cancel=cancel)
        assert len(store.keys()) == 59


@dataclass(frozen=True)
class Failing(an.Planner):
    """A* that raises under these seeds, leaves the map under seed 4, and is interrupted under seed 5."""

    seeds: tuple[int, ...] = (2,)
    ready: bool = True
    name: str = "failing"

    def prepare(self, problem: an.Problem | None = None) -> float:
        if not self.ready:
            raise LookupError("not ready")
        return 0.0

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        if call.seed in self.seeds:
            raise ValueError("two\nlines")
        if call.seed == 5:
            raise KeyboardInterrupt
        found = an.astar().plan(problem, call)
        return an.Plan(cells=found.cells[::2]) if call.seed == 4 else found


@contextmanager
def in_processes() -> Iterator[tuple[Executor, int]]:
    with Processes(2) as pool:
        yield pool, 2


ENGINES = {
    "one": lambda: nullcontext((None, 1)),
    "threads": lambda: nullcontext((None, 2)),
    "processes": in_processes,
}


def failing(planner: an.Planner, seeds: Iterable[int]) -> Study:
    return Study("", [place()], [AlgorithmEntry("mine", planner), AlgorithmEntry("astar", an.astar())], [*seeds])


@pytest.mark.parametrize("engine", ENGINES)
def test_runs_that_raise_are_named_and_all_others_are_stored(tmp_path: Path, engine: str) -> None:
    study = failing(Failing(), range(5))
    with ENGINES[engine]() as (pool, workers), Store(tmp_path / "runs.db") as store, in_time() as cancel:
        with pytest.raises(RunFailedError) as caught:
            run_study(study, store, executor=pool, workers=workers, cancel=cancel)
        assert "2 runs: mine on equiv20 under seed 2, mine on equiv20 under seed 4: they failed: " in str(caught.value)
        assert "failed: planner failing: it raised ValueError: two lines" in str(caught.value)
        assert "; plan of failing" in str(caught.value)
        assert "in plan" in caught.value.__notes__[0]
        assert len(store.keys()) == 8
    again = failing(an.astar(), range(5))
    assert len(done(again, tmp_path / "runs.db")) == 10


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("planner", [Failing(tuple(range(30))), Failing(ready=False)])
def test_a_study_ends_after_ten_runs_that_raise(tmp_path: Path, engine: str, planner: Failing) -> None:
    study = failing(planner, [seed for seed in range(31) if seed != 5])
    with ENGINES[engine]() as (pool, workers), Store(tmp_path / "runs.db") as store, in_time() as cancel:
        with pytest.raises(RunFailedError, match=r"10 runs: mine on .*: they failed: [^;]*; mend"):
            run_study(study, store, executor=pool, workers=workers, cancel=cancel)
        assert len(store.keys()) < 60


def test_an_interrupt_and_a_bug_of_antnav_end_a_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Store(tmp_path / "runs.db") as store:
        with pytest.raises(KeyboardInterrupt):
            run_study(failing(Failing(), [2, 5, 6]), store)
        monkeypatch.setattr(model, "solve", Mock(side_effect=PathError("a path", "it is none", "tell us")))
        with pytest.raises(PathError):
            run_study(Study("", [place()], [AlgorithmEntry("npaco", an.npaco())], [0]), store)


@pytest.mark.slow
def test_runs_that_raise_on_dask_are_named(tmp_path: Path) -> None:
    with dask() as (_, client), Store(tmp_path / "runs.db") as store, in_time() as cancel:
        with pytest.raises(
            RunFailedError,
            match="1 run: mine on equiv20 under seed 2: it failed: planner failing: it raised ValueError",
        ):
            run_study(failing(Failing(), range(4)), store, executor=client.get_executor(), cancel=cancel)
        assert len(store.keys()) == 7


@dataclass(frozen=True)
class Unsendable(an.Planner):
    """One that cannot be pickled."""

    name: str = "unsendable"

    def plan(self, problem: an.Problem, call: an.Call) -> an.Plan:
        return an.astar().plan(problem, call)

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("not this one")


def test_what_cannot_be_sent_is_refused(tmp_path: Path) -> None:
    study = Study("", [place()], [AlgorithmEntry("own", Unsendable())], range(3))
    with Processes(2) as pool, pytest.raises(ParameterError, match="cannot be sent: not this one"):
        done(study, tmp_path / "runs.db", pool)


def test_a_worker_with_other_code_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("antnav.study.runner.sources", lambda: "another")
    with Processes(1) as pool, pytest.raises(ParameterError, match="other code of antnav"):
        done(short(2), tmp_path / "runs.db", pool)


def test_more_maps_than_workers_keep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They come map after map then."""
    study = short(6)
    expected = done(study, tmp_path / "one.db")
    monkeypatch.setattr("antnav.study.runner.KEPT_BYTES", 1500)
    monkeypatch.setattr(chunks, "KEPT_BYTES", 1500)
    with Processes(2) as pool:
        assert done(study, tmp_path / "two.db", pool) == expected
    with Store(tmp_path / "two.db") as store:
        assert {record.map for record in store.records()[:6]} == {"equiv20"}


def fronts() -> FrontStudy:
    goals = collected(["length", "risk:clearance:3"], place().problem.grid)
    entries = [AlgorithmEntry(name, FrontPlanner(METHODS[name]())) for name in ("exact", "sweep")]
    return FrontStudy("", [place()], entries, range(3), objectives={"equiv20": goals})


def dynamic() -> DynamicStudy:
    entries = [AlgorithmEntry("few", an.npaco(ants=5))]
    return DynamicStudy("", [place()], entries, range(4), changes=Changes(count=2, every=3))


@pytest.mark.parametrize("make", [fronts, dynamic, lambda: short(6, equal_budget=Budget.STEPS)])
def test_other_studies_and_budgets_in_processes(make: Callable[[], AnyStudy[Any]], tmp_path: Path) -> None:
    study = make()
    if isinstance(study, FrontStudy):
        pytest.importorskip("moocore", reason="the extra antnav[fronts] is not installed")
    with Processes(2) as pool:
        assert done(study, tmp_path / "two.db", pool) == done(study, tmp_path / "one.db")


def test_seconds_as_budget_need_one_worker(tmp_path: Path) -> None:
    study = short(2, equal_budget=Budget.SECONDS)
    with Processes(2) as two, Processes(1) as one:
        with pytest.raises(ParameterError, match="2 workers with equal_budget seconds"):
            done(study, tmp_path / "runs.db", two)
        assert len(done(study, tmp_path / "runs.db", one)) == 8


CONFIG = """
title = "tiny"
seeds = 50
[[maps]]
builtin = "equiv20"
corner_rule = "allow"
[[algorithms]]
preset = "npaco"
ants = 5
iterations = 5
[[algorithms]]
preset = "luo"
ants = 5
iterations = 5
"""


@contextmanager
def mpiexec() -> Iterator[tuple[list[str], dict[str, str]]]:
    """The command that starts ranks, and the environment for it."""
    pytest.importorskip("mpi4py", reason="the extra antnav[mpi] is not installed")
    try:
        own = [Path(str(each.locate())) for each in files("mpich") or () if each.name in ("mpiexec", "libmpi.so.12")]
    except PackageNotFoundError:
        own = []
    found = next((str(path) for path in own if path.name == "mpiexec"), shutil.which("mpiexec"))
    if found is None:
        pytest.skip("there is no mpiexec")
    libraries = [str(path.resolve().parent) for path in own if path.suffix == ".12"]
    if "LD_LIBRARY_PATH" in os.environ:
        libraries.append(os.environ["LD_LIBRARY_PATH"])
    path = f"{Path(found).parent}:{os.environ.get('PATH', '')}"
    yield [found], os.environ | {"LD_LIBRARY_PATH": ":".join(libraries), "PATH": path}


def csv_of(folder: Path) -> list[str]:
    """runs.csv without what depends on the machine's mood."""
    import csv

    with (folder / "runs.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return [
        str({name: value for name, value in row.items() if "seconds" not in name and name != "marks"}) for row in rows
    ]


@pytest.mark.slow
@pytest.mark.parametrize("way", ["ranks", "spawned"])
def test_on_mpi(way: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="the extra antnav[plot] is not installed")
    (tmp_path / "study.toml").write_text(CONFIG)
    study = ["study", str(tmp_path / "study.toml"), "-q"]
    assert main([*study, "-o", str(tmp_path / "one")]) == 0  # and compiles what there is to compile
    with mpiexec() as (start, environment):
        if way == "ranks":
            many = [*start, "-n", "3", sys.executable, "-m", "mpi4py.futures", "-m", "antnav", *study]
        else:
            many = [sys.executable, "-m", "antnav", *study, "--workers", "2"]
        many += ["--executor", "mpi", "-o", str(tmp_path / "mpi")]
        ended = subprocess.run(many, env=environment, capture_output=True, text=True, timeout=LONGEST, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "100 runs" in ended.stdout
    assert csv_of(tmp_path / "one") == csv_of(tmp_path / "mpi")
