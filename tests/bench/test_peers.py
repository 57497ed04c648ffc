"""Peers: the courses, the judge, the worker's adapters, and trials in processes of their own."""

from __future__ import annotations

import importlib
import math
import subprocess
import sys
import threading
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav.bench import peers
from antnav.bench.courses import Course, course
from antnav.bench.peers import ADAPTERS, Run, Trial, judge, unit_steps
from antnav.errors import ParameterError, PathError
from antnav.search import exact
from tests.conftest import grid_of

PEERS = peers.peers()
graph, presets, tasks = (
    importlib.import_module(f"antnav_peers.{name}") for name in ("graph", "antnav_presets", "task")
)
CORNER = Course("corner", grid_of("..#", "#..", "..."), (0, 0), (2, 2))
HERE = {name: (metadata.version("antnav"), sys.executable) for name in ("antnav-astar", "antnav-npaco")}


@pytest.mark.parametrize(
    ("name", "allow", "forbid"), [("u20", 32.14, 33.90), ("u30", 42.18, 43.94), ("u40", 60.43, 62.18)]
)
def test_courses_are_the_same_everywhere(name: str, allow: float, forbid: float) -> None:
    found = course(name)
    for rule, length in (("allow", allow), ("forbid", forbid)):
        problem = an.Problem.from_cells(found.grid, found.start, found.goal, corner_rule=rule)
        assert exact.shortest_path(problem).length == pytest.approx(length, abs=0.005)
    assert 0.25 <= found.grid.cells.mean() <= 0.30


def test_the_strictest_corner_rule_is_found() -> None:
    assert judge([(0, 0), (0, 1), (1, 1), (2, 2)], CORNER) == (pytest.approx(2 + math.sqrt(2)), "forbid")
    assert judge([(0, 0), (2, 2)], CORNER) == (pytest.approx(2 * math.sqrt(2)), "allow")  # past (1, 0)
    assert judge([(0, 0), (0.2, 0.9), (2, 2)], CORNER)[1] == "any angle"


@pytest.mark.parametrize(
    "path",
    [
        [(0, 0), (1, 1)],  # ends too early
        [(0, 0), (0, 2), (2, 2)],  # through a wall
        [(0, 0), (0.1, 2), (2, 2)],  # the same at any angle
        [(0.5, 0), (2, 2)],
        [(0, 0), (-3, 0.5), (2, 2)],
    ],
)
def test_a_broken_path_is_no_success(path: list[tuple[float, float]]) -> None:
    with pytest.raises(PathError):
        judge(path, CORNER)


def test_jumps_become_steps() -> None:
    assert unit_steps([(0, 0), (0, 2), (2, 0)]) == [(0, 0), (0, 1), (0, 2), (1, 1), (2, 0)]
    assert unit_steps([(0, 0), (1, 2)]) is None
    assert unit_steps([(0, 0), (0.5, 0.5)]) is None


def test_rows_by_hand() -> None:
    runs = [
        Run(0.01, 0.005, 0.02, 3.0, "forbid"),
        Run(0.03, 0.015, 0.04, 5.0, "forbid"),
        Run(0.05, 0.02, 0.06, fault="no path"),
    ]
    optimum = 2 + math.sqrt(2)  # forbid; with corners cut 2 sqrt(2)
    (row,) = peers.rows([Trial("antnav-npaco", "1", CORNER, runs)])
    assert (row.total, row.query, row.cpu, row.length) == pytest.approx((30, 15, 40, 4))
    assert (row.success, row.corner, row.note) == (pytest.approx(200 / 3), "forbid", "no path")
    assert row.gap == pytest.approx(100 * (4 / optimum - 1))
    (cut,) = peers.rows([Trial("antnav-npaco", "1", CORNER, [Run(1, 1, 1, 2 * math.sqrt(2), "allow")])])
    assert (cut.corner, cut.gap) == ("allow", 0), "a broken promise is judged by the rule that is kept"
    (angle,) = peers.rows([Trial("ompl-rrtconnect", "1", CORNER, [Run(1, 1, 1, 2.9, "any angle")])])
    assert math.isnan(angle.gap)
    (lost,) = peers.rows([Trial("scipy", "1", CORNER, [], "out of time after 1 s")])
    assert (lost.note, math.isnan(lost.total), math.isnan(lost.success)) == ("out of time after 1 s", True, True)


def test_absent_peers_are_named() -> None:
    (row,) = peers.rows([Trial("scipy", "1", CORNER, [Run(1, 1, 1, fault="no path")])])
    assert peers.summary([row], ["tcod", "igraph"]).note == "Not installed: tcod, igraph."
    with pytest.raises(ParameterError, match="nobody"):
        peers.check_peers(["antnav-astar", "nobody"])


def test_own_presets_exist() -> None:
    assert {f"antnav-{name}" for name in presets.PRESETS if name in an.PRESETS} | {"antnav-astar"} == {
        name for name in PEERS if name.startswith("antnav-")
    }


@pytest.mark.parametrize("name", PEERS)
def test_installed_adapters_find_a_path(name: str) -> None:
    peer = PEERS[name]
    if peer.version() is None:
        pytest.skip(f"{peer.distribution} is not installed")
    found = Course.on("rooms", an.maps.generate("rooms", 16, 16, seed=2))
    task = tasks.Task(~found.grid.passable(), found.start, found.goal)
    path = peer.solve(peer.build(task), task, 0)
    if path is not None:
        length, corner = judge(path, found)
        assert length >= math.dist(found.start, found.goal)
        assert peers.ANY_ANGLE in (corner, peer.corner) or corner in ("forbid", peer.corner)


def test_edges_are_the_legal_moves() -> None:
    blocked = ~CORNER.grid.passable()
    assert len(graph.graph_of(blocked).source) == 2 * (1 + 1 + 1 + 2 + 2 + 2)
    assert len(graph.graph_of(blocked, allow=True).source) == 2 * (9 + 3)


def test_trials_run_in_processes(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    trials = peers.run(
        ["antnav-astar", "tcod", "antnav-npaco"],
        [CORNER],
        HERE,
        runs=2,
        progress=lambda *done: seen.append(done),
    )
    assert [trial.peer for trial in trials] == ["antnav-astar", "antnav-npaco"]
    assert seen == [(1, 2), (2, 2)]
    for trial in trials:
        assert len(trial.runs) == 2
        assert not trial.note
        assert all(run.length == pytest.approx(2 + math.sqrt(2)) and run.corner == "forbid" for run in trial.runs)
        assert all(run.total >= run.query > 0 for run in trial.runs)
    assert len(peers.runs_table(trials).rows) == 4


def test_a_trial_out_of_time_ends_and_larger_maps_are_left(tmp_path: Path) -> None:
    trials = peers.run(["antnav-astar"], [CORNER, CORNER], HERE, timeout=1e-3)
    assert [trial.note for trial in trials] == ["out of time after 0.001 s", "out of time on corner"]
    assert not any(trial.runs for trial in trials)


def test_maps_too_large_for_a_peer_are_said_to_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PEERS["antnav-npaco"], "largest", 2, raising=False)
    (trial,) = peers.run(["antnav-npaco"], [CORNER], HERE)
    assert trial.note == "too large: above 2 cells a side"


def test_a_failing_peer_says_why() -> None:
    walled = Course("walled", grid_of(".#.", "...", "..."), (0, 0), (5, 5))  # a goal that antnav refuses
    (trial,) = peers.run(["antnav-astar"], [walled], HERE)
    assert trial.note.startswith("failed: ")
    assert "outside the map" in trial.note


def test_cancelling_ends_at_once() -> None:
    cancel = threading.Event()
    cancel.set()
    assert peers.run(["antnav-astar"], [CORNER], HERE, cancel=cancel) == []


def test_interpreters_are_asked_what_they_have() -> None:
    found = peers.installed([sys.executable])
    assert found["antnav-astar"] == HERE["antnav-astar"]
    assert set(found) <= set(PEERS)
    for wrong in ("no-such-python", "false"):
        with pytest.raises(ParameterError, match="interpreter"):
            peers.installed([wrong])


def test_the_program_needs_nothing_of_antnav() -> None:
    script = (
        f"import sys, runpy; sys.argv = ['peers', 'list']; runpy.run_path({str(ADAPTERS)!r})\n"
        "print(sorted({name.split('.')[0] for name in sys.modules} & {'antnav', 'numba', 'scipy', 'peers'}))"
    )
    found = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert found.stderr.endswith("['peers']\n")


def test_neighbours_of_the_program_do_not_pass_for_peers() -> None:
    script = (
        f"import sys, runpy; sys.argv = ['peers', 'list']; runpy.run_path({str(ADAPTERS)!r})\n"
        "print([entry for entry in sys.path if 'benchmarks' in entry])"
    )
    found = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert found.stderr.endswith("[]\n")


def test_without_the_source_tree_the_command_says_where_its_adapters_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(peers, "peers", peers.peers.__wrapped__)
    monkeypatch.setattr(peers, "ADAPTERS", tmp_path / "benchmarks" / "peers")
    with pytest.raises(ParameterError, match=r"in antnav's source tree, benchmarks/peers.*pip install -e"):
        peers.check_peers(["tcod"])


def test_what_peers_print_does_not_disturb(tmp_path: Path) -> None:
    file = tmp_path / "task.npz"
    np.savez(file, blocked=~CORNER.grid.passable(), start=CORNER.start, goal=CORNER.goal)
    command = f"""
import sys
sys.path.insert(0, {str(ADAPTERS.parent)!r})
from peers import PEERS, task, worker
class Noisy(task.Peer):
    def build(self, task): print("building")
    def solve(self, state, task, seed): print("solving"); return [task.start, task.goal]
PEERS["noisy"] = Noisy()
worker.main(["noisy", {str(file)!r}, "2", "0", "9"])
"""
    found = subprocess.run([sys.executable, "-c", command], check=True, capture_output=True, text=True)
    assert [line[0] + line[-1] for line in found.stdout.splitlines()] == ["{}", "{}"]
    assert "solving" in found.stderr
