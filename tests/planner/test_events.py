"""Events: what a run tells on the way, from threads and from other processes."""

from __future__ import annotations

import threading
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import events
from antnav.planner.view import Fate
from antnav.run import spmd
from antnav.run.channel import Channel, Sender
from tests.conftest import grid_of
from tests.kernels.test_ant_kernels import random_problem

BOTH = {(stage, colony) for stage in ("stage one", "stage two") for colony in (0, 1)}


def told(problem: an.Problem, algorithm: an.Planner, **arguments) -> tuple[an.Result, list[events.Event]]:
    seen: list[events.Event] = []
    return an.solve(problem, algorithm, seed=2, events=seen.append, **arguments), seen


def test_a_divided_run_tells_its_stages_and_ends_with_the_result(equivalent: an.Problem) -> None:
    result, seen = told(equivalent, an.paco(iterations=400))
    assert isinstance(seen[0], events.Started)
    assert (seen[0].planner, seen[0].seed) == ("paco", 2)
    assert seen[-1].result is result
    assert [(event.stage, event.colonies) for event in seen if isinstance(event, events.StageBegan)] == [
        ("stage one", 2),
        ("stage two", 2),
    ]
    steps = [event for event in seen if isinstance(event, events.Iterated)]
    assert all(0 < event.fraction <= 1 for event in steps)
    assert {(event.stage, event.colony) for event in steps} == {
        (s, c) for s in ("stage one", "stage two") for c in (0, 1)
    }
    last = {(event.stage, event.colony): event.number for event in steps}
    assert last == {("stage one", 0): 3, ("stage one", 1): 3, ("stage two", 0): 397, ("stage two", 1): 397}
    assert steps[-1].best == pytest.approx(result.history.best[-1])
    for stage in ("stage one", "stage two"):
        better = [event.best for event in seen if isinstance(event, events.Improved) and event.stage == stage]
        assert better == sorted(better, reverse=True)
        assert len(set(better)) == len(better) > 0
    assert told(equivalent, an.paco(iterations=400))[0].path.cells.tolist() == result.path.cells.tolist()


def test_a_view_shows_the_colony_and_cannot_be_written_to() -> None:
    problem = random_problem(3, side=12)
    seen: list[int] = []

    def look(event: events.Event) -> None:
        if not isinstance(event, events.Iterated):
            return
        view = event.view
        assert view is not None
        seen.append(view.iteration)
        arrived = np.flatnonzero(view.fates == Fate.ARRIVED)
        assert sorted(view.order.tolist()) == arrived.tolist()
        assert np.all(np.diff(view.lengths[view.order]) >= 0)
        for ant in range(len(view.fates)):
            walk = view.path(ant)
            assert tuple(view.cells[walk[0]]) == problem.start_cell
            assert (tuple(view.cells[walk[-1]]) == problem.goal_cell) == (ant in arrived)
            assert all(after in view.neighbours[before] for before, after in pairwise(walk))
        if len(arrived):
            assert view.best_length <= view.lengths[arrived].min() + 1e-9
            assert an.Path(view.cells[view.best].astype(np.int32), problem.grid).length == pytest.approx(
                view.best_length
            )
        for array in (view.tau, view.order, view.lengths, view.fates, view.paths, view.steps):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0

    an.solve(problem, an.npaco(ants=6, iterations=5), stop=an.stop.Iterations(5), events=look)
    assert seen[0] == 1
    assert seen[-1] == 5


@pytest.mark.parametrize("algorithm", [an.astar(), an.algorithm("potential-field")], ids=lambda one: one.name)
def test_planners_without_ants_tell_beginning_and_end(algorithm: an.Planner) -> None:
    result, seen = told(random_problem(3, side=12), algorithm)
    assert isinstance(seen[0], events.Started)
    assert isinstance(seen[-1], events.Ended)
    assert seen[-1].result is result


def test_events_come_from_other_processes_and_change_nothing() -> None:
    problem, algorithm = random_problem(3, side=14), an.paco(ants=9, iterations=30)
    with spmd.Processes(2) as processes:
        result, seen = told(problem, algorithm, executor=processes)
    here, _ = told(problem, algorithm)
    assert result.path.cells.tolist() == here.path.cells.tolist()
    assert result.history.best.tobytes() == here.history.best.tobytes()
    steps = [event for event in seen if isinstance(event, events.Iterated)]
    assert {(event.stage, event.colony) for event in steps} == {
        (s, c) for s in ("stage one", "stage two") for c in (0, 1)
    }
    last = {(event.stage, event.colony): event for event in steps}
    assert last["stage two", 1].number == 27
    assert last["stage two", 1].view.tau.shape == (len(problem.graph), 8)


def test_a_run_in_other_processes_can_be_cancelled() -> None:
    problem, cancel = random_problem(3, side=14), threading.Event()
    endless = an.npaco(ants=9, iterations=10**8)
    with spmd.Processes(1) as processes:
        result = an.solve(
            problem,
            endless,
            executor=processes,
            cancel=cancel,
            events=lambda event: isinstance(event, events.Iterated) and cancel.set(),
        )
    assert result.stopped_by == "cancelled"
    assert 0 < result.iterations < 10**8


def test_a_failing_listener_ends_colonies_in_other_processes() -> None:
    def fail(event: events.Event) -> None:
        if isinstance(event, events.Iterated):
            raise ZeroDivisionError

    with spmd.Processes(1) as processes, pytest.raises(ZeroDivisionError):
        an.solve(random_problem(3, side=14), an.npaco(ants=9, iterations=10**8), executor=processes, events=fail)


def test_a_worker_that_cannot_reach_us_works_in_silence(tmp_path: Path) -> None:
    with Sender(str(tmp_path / "nobody"), b"key") as sender:
        sender.send("heard by nobody")
        assert not sender.is_set()


def test_a_channel_hears_all_and_passes_on_stop() -> None:
    heard, stop = [], threading.Event()
    with Channel(heard.append, stop) as address, address as sender:
        for number in range(100):
            sender.send(number)
        stop.set()
        while not sender.is_set():
            pass
    assert heard == list(range(100))


def test_a_channel_closes_whatever_its_thread_is_doing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody accepts any more when it is closed: between two looks, that thread has seen that it should end."""
    for _ in range(20):
        with Channel(print, threading.Event()):
            pass
    monkeypatch.setattr("antnav.run.channel.PATIENCE", 0.05)
    monkeypatch.setattr(Channel, "_accept", lambda self: None)
    with Channel(print, threading.Event()):
        pass


def test_too_large_a_view_is_not_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    from antnav.ants import run

    colony = an.Colony(random_problem(3, side=12), an.npaco(ants=3, iterations=2), seed=0)
    colony.step()
    assert run._Told.of(colony).to_send().view is not None
    monkeypatch.setattr(run, "MOST_SENT", 10)
    assert run._Told.of(colony).to_send() == (0, 1, colony.best_length, None)


def test_nobody_listens_to_what_has_no_search() -> None:
    problem = an.Problem.from_cells(grid_of(".."), (0, 0), (0, 0))
    _, seen = told(problem, replace(an.npaco(), iterations=3))
    assert [type(event) for event in seen] == [events.Started, events.Ended]
