"""Where runs are done side by side, chosen by a text: threads, processes, Dask's scheduler, MPI."""

from __future__ import annotations

import contextlib
import logging
import shutil
from collections.abc import Iterator
from concurrent.futures import Executor
from importlib import import_module
from typing import Annotated, Any

import typer

from antnav.errors import ParameterError
from antnav.run.spmd import Processes, checked_workers, width

FORMS = "threads, processes, dask://HOST:PORT, mpi"
#: Seconds in which a scheduler must answer, and in which a first worker must be there.
CONNECTING = 10.0

Engine = Annotated[
    str,
    typer.Option(
        "--executor",
        metavar="NAME",
        help=f"Where runs are done side by side: {FORMS}.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        min=1,
        show_default="1 thread; as many as there are of others",
        help="Runs side by side; above 1, wall seconds are no measure and are marked so.",
    ),
]


@contextlib.contextmanager
def engine(text: str, workers: int | None) -> Iterator[tuple[Executor | None, int]]:
    """The executor of that name and how many jobs it does at a time; None: threads of whoever is called.

    Raises
    ------
    ParameterError
        No such executor, the extra that it needs is not installed, or nobody answers.
    """
    kind, _, address = text.partition("://")
    if kind == "dask" and address:
        with _dask(address) as executor:
            yield executor, workers or width(executor)
    elif text == "threads":
        yield None, checked_workers(workers or 1)
    elif text == "processes":
        pool = Processes(workers)
        try:
            yield pool, width(pool)
        finally:
            pool.kill()  # nobody waits for what they still do
    elif text == "mpi":
        with _mpi(workers) as executor:
            yield executor, workers or width(executor)
    else:
        raise ParameterError(f"--executor {text}", f"it is one of {FORMS}", "choose one of them")


@contextlib.contextmanager
def _dask(address: str) -> Iterator[Executor]:
    distributed = _library("distributed", f"dask://{address}", "cluster")
    for name in ("distributed.client", "distributed.core", "distributed.cfexecutor"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is told in one line
    scheme = address if "://" in address else f"tcp://{address}"
    try:
        client = distributed.Client(scheme, timeout=CONNECTING, set_as_default=False)
    except (OSError, ValueError) as error:
        rule = f"no scheduler answers there ({error})"
        raise ParameterError(
            f"--executor dask://{address}", rule, "start `dask scheduler`, and give its address"
        ) from error
    try:
        try:
            client.wait_for_workers(1, timeout=CONNECTING)
        except TimeoutError as error:
            rule, remedy = f"it has no worker within {CONNECTING:.0f} s", f"start `dask worker {scheme}`"
            raise ParameterError(f"--executor dask://{address}", rule, remedy) from error
        yield client.get_executor()
    finally:
        client.close(timeout=1)


@contextlib.contextmanager
def _mpi(workers: int | None) -> Iterator[Executor]:
    futures = _library("mpi4py.futures", "mpi", "mpi")
    world = import_module("mpi4py.MPI").COMM_WORLD
    served = import_module("mpi4py.futures._core").SharedPool is not None
    if world.size > 1 and not served:
        rule = f"each of the {world.size} ranks would do all runs"
        remedy = "start it by `mpiexec -n N python -m mpi4py.futures -m antnav ...`"
        raise ParameterError("--executor mpi", rule, remedy)
    if served and world.size == 1:
        rule = "its only rank has no workers"
        raise ParameterError("--executor mpi", rule, "give mpiexec -n 2 or more: rank 0 hands out the runs")
    if not served and shutil.which("mpiexec") is None:  # MPI would hang where it looks for it
        rule = "mpiexec, which starts its workers, is not on the PATH"
        raise ParameterError("--executor mpi", rule, "activate the environment that has it")
    executor: Any = futures.MPIPoolExecutor(None if served else checked_workers(workers or width(Processes())))
    try:
        yield executor
    finally:
        executor.shutdown(wait=False, cancel_futures=True)


def _library(name: str, text: str, extra: str) -> Any:
    try:
        return import_module(name)
    except (ImportError, RuntimeError) as error:  # RuntimeError: there is no MPI
        reason = "is not installed" if isinstance(error, ImportError) else f"finds no MPI ({error})".splitlines()[0]
        rule = f"{name.partition('.')[0]} {reason}"
        raise ParameterError(f"--executor {text}", rule, f'pip install "antnav[{extra}]"') from error
