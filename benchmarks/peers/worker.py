"""Worker: the program, and its stopwatch."""

from __future__ import annotations

import json
import os
import random
import sys
import time
from typing import Any, TextIO

import numpy as np

from . import PEERS
from .task import Peer, Points, Task


def measure(peer: Peer, task: Task, runs: int, seed: int, seconds: float, out: TextIO) -> None:
    """Time the runs, after one on a small empty map that pays for imports and compilers."""
    small = Task(np.zeros((8, 8), np.bool_), (0, 0), (7, 7))
    _plan(peer, peer.build(small), small, seed)
    begin = time.perf_counter()
    for run in range(runs):
        cpu, first = time.process_time(), time.perf_counter()
        state = peer.build(task)
        built = time.perf_counter()
        path = _plan(peer, state, task, seed + run)
        end = time.perf_counter()
        line = {"total": end - first, "query": end - built, "cpu": time.process_time() - cpu, "path": _plain(path)}
        print(json.dumps(line), file=out, flush=True)
        if end - begin > seconds:
            break


def _plan(peer: Peer, state: Any, task: Task, seed: int) -> Points | None:
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002 - what the peers draw from
    return peer.solve(state, task, seed)


def _plain(path: Points | None) -> list[list[float]] | None:
    return None if path is None else [[float(row), float(col)] for row, col, *_ in path]


def main(arguments: list[str]) -> None:
    """The program."""
    with os.fdopen(os.dup(1), "w") as out:
        os.dup2(2, 1)  # what peers print is not ours to read
        if arguments == ["list"]:
            json.dump({name: version for name, peer in PEERS.items() if (version := peer.version())}, out)
            return
        name, file, runs, seed, seconds = arguments
        with np.load(file) as data:
            task = Task(data["blocked"], *(tuple(data[end].tolist()) for end in ("start", "goal")))
        measure(PEERS[name], task, int(runs), int(seed), float(seconds), out)
    sys.stdout.flush()
    os._exit(0)  # not the noisy ends of some peers
