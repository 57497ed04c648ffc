"""Replays: the robot drives as it must, what is measured is worked out by hand, and wrong plans are found out."""

from __future__ import annotations

import csv
import io
import math
import subprocess
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest

import antnav as an
from antnav.errors import EndpointError, OutputError, ParameterError
from antnav.live.methods import METHODS
from antnav.live.replanner import Replanner
from antnav.live.update import MissionStatus
from antnav.scenarios import Event
from antnav.scenarios.comparison import HEADS, rows
from antnav.scenarios.known import Known
from antnav.scenarios.model import TIMES, Tick, csv_of, save_ticks

CORRIDOR = an.Problem.from_cells(an.GridMap(np.zeros((1, 10), np.uint8)), (0, 0), (0, 9))
FLOOR = an.Problem.from_cells(an.GridMap(np.zeros((20, 30), np.uint8)), (10, 2), (10, 27))
ROOMS = an.maps.generate("rooms", 40, 40, 4)
IN_ROOMS = an.Problem.from_cells(ROOMS, *an.maps.ends(ROOMS))
SQRT2 = math.sqrt(2)


def driven(problem: an.Problem, *events: Event, algorithm="astar", **choices) -> an.Replay:
    scenario = an.Scenario.of(problem, events, **{"ticks": 60, **choices})
    return an.replay(problem, scenario, algorithm, verify=True)


def test_where_nothing_happens_the_robot_drives_the_optimum() -> None:
    done = driven(FLOOR)
    assert (done.arrived, done.travelled, done.detour, done.waits) == (True, 25.0, 1.0, 0)
    assert (len(done), len(done.times), done.plan_changes) == (26, 0, 0)
    assert [(tick.row, tick.col) for tick in done.ticks] == [(10, col) for col in range(2, 28)]
    assert math.isnan(done.percentile(0.5))
    assert math.isnan(done.mean)
    assert done.failures == ()


def test_a_fast_robot_makes_several_moves_and_stops_at_the_goal() -> None:
    done = driven(FLOOR, speed=4)
    assert [tick.moves for tick in done.ticks] == [4, 4, 4, 4, 4, 4, 1, 0]


def test_it_waits_where_there_is_no_way_and_goes_on_when_there_is() -> None:
    done = driven(CORRIDOR, Event(2, blocked=[(0, 5)]), Event(7, freed=[(0, 5)]))
    statuses = [tick.status for tick in done.ticks]
    assert statuses[1:8] == ["planned", *["unreachable"] * 5, "planned"]
    assert (done.waits, done.travelled, len(done) - 1, len(done.times)) == (5, 9.0, 14, 2)
    assert [tick.changed_share for tick in done.ticks if tick.changed_share] == [1.0]


def test_a_goal_that_stays_blocked_is_never_reached() -> None:
    done = driven(CORRIDOR, Event(3, blocked=[(0, 9)]), ticks=12)
    assert (done.arrived, done.ticks[-1].status, len(done)) == (False, MissionStatus.GOAL_BLOCKED, 12)
    assert math.isnan(done.detour)
    assert done.summary().splitlines()[0].split()[1:3] == ["not", "arrived"]


def test_what_stands_on_the_robot_is_left_out_until_it_has_gone_on() -> None:
    done = driven(CORRIDOR, Event(3, blocked=[(0, 3), (0, 8)]), Event(5, freed=[(0, 8)]))
    assert [tick.left_out for tick in done.ticks][:7] == [0, 0, 0, 1, 1, 1, 0]
    assert [tick.noticed for tick in done.ticks][:8] == [0, 0, 0, 1, 0, 1, 1, 0]
    assert (done.arrived, done.left_out, done.waits) == (True, 3, 2)


def test_prices_of_the_moment_are_paid() -> None:
    done = driven(CORRIDOR, Event(1, priced=[(0, 3)], prices=[4.0]), Event(3, priced=[(0, 3)], prices=[0.0]))
    assert [tick.paid for tick in done.ticks][:5] == [1.0, 1.0, 3.0, 1.0, 1.0]
    assert (done.travelled, done.paid) == (9.0, 11.0)
    detour = driven(FLOOR, Event(0, priced=[(row, 12) for row in range(8, 13)], prices=[9.0] * 5))
    assert detour.travelled == pytest.approx(19 + 6 * SQRT2)
    assert detour.detour == pytest.approx((19 + 6 * SQRT2) / 25)


def test_costs_at_rest_are_paid_too_and_added_to() -> None:
    problem = replace(CORRIDOR, cost=an.costs.array(np.full((1, 10), 0.5)))
    done = driven(problem, Event(0, priced=[(0, 1)], prices=[1.0]))
    assert done.paid == pytest.approx(9 * 1.5 + 1.0)
    assert done.ticks[0].cost == pytest.approx(done.paid)


@pytest.mark.parametrize("algorithm", METHODS)
@pytest.mark.parametrize("rule", an.CornerRule)
@pytest.mark.parametrize("text", ["doors:3+people:6+traffic:3+obstacles:4:1", "unknown:4+people:6:0+traffic:3"])
def test_plans_and_verdicts_are_right_and_replays_the_same(algorithm: str, rule: an.CornerRule, text: str) -> None:
    problem = replace(IN_ROOMS, corner_rule=rule)
    scenario = an.scenarios.named(text, problem, seed=5)
    one = an.replay(problem, scenario, algorithm, verify=True)
    assert one.failures == ()
    assert len(one.times) > 20
    assert csv_of([one], times=False) == csv_of([an.replay(None, scenario, algorithm)], times=False)


@pytest.mark.parametrize("algorithm", METHODS)
def test_a_robot_with_a_radius_keeps_it_from_what_comes(algorithm: str) -> None:
    scenario = an.scenarios.named("people:4+unknown", FLOOR, seed=2, radius=2.0)
    done = an.replay(FLOOR, scenario, algorithm, verify=True)
    assert (scenario.sensor, done.failures) == (10, ())
    assert MissionStatus.PLANNED in {tick.status for tick in done.ticks}


def test_in_unknown_terrain_it_knows_what_it_has_seen() -> None:
    """Against a plain loop over the cells."""
    cells = (np.random.default_rng(3).random((15, 18)) < 0.3).astype(np.uint8)
    problem = an.Problem.from_cells(an.GridMap(cells * (np.indices(cells.shape).sum(0) % 31 > 0)), (0, 0), (14, 17))
    known, seen = Known(problem, 3), np.zeros(cells.shape, np.uint8)
    for robot in [(0, 0), (2, 2), (2, 3), (14, 17), (7, 0)]:
        noticed = known.notice(robot)
        before = seen.copy()
        for row, col in np.ndindex(cells.shape):
            if math.dist((row, col), robot) <= 3.5 and (row, col) != robot:
                seen[row, col] = not problem.passable[row, col]
        assert {*map(tuple, noticed.blocked.tolist())} == {*map(tuple, np.argwhere(seen > before).tolist())}
        assert (known.grid(0.0).cells == seen).all()


def test_a_scenario_that_opens_a_wall() -> None:
    grid = an.GridMap(np.array([[0, 0, 0, 1, 0, 0]], np.uint8))
    done = driven(an.Problem.from_cells(grid, (0, 0), (0, 5)), Event(4, freed=[(0, 3)]))
    assert (done.arrived, done.waits, done.optimum) == (True, 4, math.inf)
    assert math.isnan(done.detour)


class Liar(Replanner):
    """Goes straight on, whatever is there; or says that there is no way."""

    name, exact, source = "liar", True, "nobody"

    def __init__(self, way: bool) -> None:
        self.way = way

    def begin(self, terrain, start, goal):
        self.goal = goal
        return self.moved(start)

    def changed(self, cells, start):
        return self.moved(start)

    def moved(self, start):
        return np.arange(start, self.goal + 1, dtype=np.int32) if self.way else None


@pytest.fixture
def believed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Missions believe a test's replanner, as they believe antnav's own."""
    monkeypatch.setattr(an.Mission, "_check", lambda *_: None)


@pytest.mark.usefixtures("believed")
def test_wrong_plans_and_verdicts_are_found_out() -> None:
    through = driven(FLOOR, Event(1, blocked=[(10, 6)]), algorithm=Liar(way=True), ticks=8)
    assert through.failures[0] == "tick 1: cell (10, 6): it is outside the map or not free"
    assert (through.ticks[-1].row, through.ticks[-1].col, through.travelled) == (10, 5, 3.0)
    nothing = driven(FLOOR, Event(1, blocked=[(10, 6)]), algorithm=Liar(way=False), ticks=3)
    assert nothing.failures[0] == "tick 0: it says unreachable, and it is planned"
    scenario = an.Scenario.of(FLOOR, [Event(1, blocked=[(10, 6)])], ticks=8)
    unchecked = an.replay(FLOOR, scenario, Liar(way=True))
    assert unchecked.failures == tuple(
        f"tick {tick}: collision on the way from (10, 5) to (10, 6)" for tick in (3, 4, 5, 6, 7)
    )


@pytest.mark.usefixtures("believed")
def test_a_corner_that_may_not_be_cut_is_a_collision() -> None:
    class Diagonal(Liar):
        def moved(self, start):
            return np.array([start, self.goal], np.int32)

    grid = an.GridMap(np.zeros((2, 2), np.uint8))
    for rule, allowed in (("forbid", 0), ("graze", 1), ("allow", 2)):
        for walls in ([(0, 1)], [(0, 1), (1, 0)]):
            problem = an.Problem.from_cells(grid, (0, 0), (1, 1), corner_rule=rule)
            scenario = an.Scenario.of(problem, [Event(0, blocked=walls)], ticks=2)
            assert an.replay(problem, scenario, Diagonal(way=True)).arrived == (len(walls) <= allowed), (rule, walls)


def test_figures_by_hand() -> None:
    done = driven(CORRIDOR)
    bare = {"status": MissionStatus.PLANNED, "cost": 1.0, "left_out": 0, "paid": 1.0, "failure": ""}
    ticks = [
        Tick(
            number,
            0,
            0,
            changed_share=share,
            noticed=noticed,
            moves=1,
            length=1.0,
            seconds=time,
            idle_seconds=0.5,
            **bare,
        )
        for number, (share, noticed, time) in enumerate([(0.0, 1, 0.002), (0.5, 3, 0.02), (0.0, 0, 9.0), (1.0, 2, 0.2)])
    ]
    done = replace(done, ticks=tuple(ticks), seconds_first=1.0)
    assert done.times.tolist() == [0.002, 0.02, 0.2]
    assert (done.percentile(0.5), done.percentile(1.0)) == (0.02, 0.2)
    assert done.mean == pytest.approx(0.074)
    assert [done.missed(rate) for rate in (10, 100, 1000)] == [1, 2, 3]
    assert (done.plan_changes, done.changed_share) == (2, 0.5)
    assert done.seconds_total == pytest.approx(1 + 9.222 + 2)


def test_ticks_as_csv(tmp_path) -> None:
    done = driven(CORRIDOR, Event(2, blocked=[(0, 5)]), Event(4, freed=[(0, 5)]))
    done.save(tmp_path / "ticks.csv")
    read = list(csv.DictReader(io.StringIO((tmp_path / "ticks.csv").read_text())))
    assert list(read[0]) == ["algorithm", *Tick._fields]
    assert [row["status"] for row in read] == [tick.status for tick in done.ticks]
    assert read[2]["cost"] == "inf"
    assert {*TIMES} & {*csv_of([done], times=False).splitlines()[0].split(",")} == set()
    save_ticks([done, done], tmp_path / "two.csv")
    assert len((tmp_path / "two.csv").read_text().splitlines()) == 1 + 2 * len(done)
    with pytest.raises(ParameterError, match=r"\.csv"):
        done.save(tmp_path / "ticks.json")
    with pytest.raises(OutputError):
        done.save(tmp_path / "none" / "ticks.csv")


def test_frames_tell_a_film_everything() -> None:
    events = (Event(2, blocked=[(0, 5)]), Event(4, freed=[(0, 5)]))
    frames = list(driven(CORRIDOR, *events).frames)
    assert [frame.happened for frame in frames[:5]] == [None, None, events[0], None, events[1]]
    assert frames[2].noticed.blocked.tolist() == [[0, 5]]
    assert (frames[2].plan, frames[2].status, frames[2].position) == (None, "unreachable", (0, 2))
    assert frames[4].plan.tolist() == [[0, col] for col in range(2, 10)]


def test_replays_side_by_side() -> None:
    events = (Event(2, blocked=[(0, 5)]), Event(4, freed=[(0, 5)]))
    astar = driven(CORRIDOR, *events)
    late = driven(CORRIDOR, Event(2, blocked=[(0, 5)]), ticks=9, algorithm="regions")
    table = [dict(zip(HEADS, row, strict=True)) for row in rows([late, astar])]
    assert [row["ticks"] for row in table] == ["> 9", "11"]
    assert [row["way / astar"] for row in table] == ["-", "1.0000"]
    assert [row["way / optimum"] for row in table] == ["-", "1.0000"]
    assert [row["failures"] for row in table] == ["0", "0"]
    assert [row["waits"] for row in table] == ["7", "2"]


def test_cancelling_keeps_the_ticks_so_far() -> None:
    cancel, done = threading.Event(), []

    def count(number: int, of: int) -> None:
        done.append((number, of))
        if number == 4:
            cancel.set()

    scenario = an.Scenario.of(FLOOR, ticks=60)
    assert len(an.replay(FLOOR, scenario, "astar", cancel=cancel, progress=count)) == 4
    assert done == [(1, 60), (2, 60), (3, 60), (4, 60)]


FRESH = """
import sys
from pkgutil import iter_modules
from importlib import import_module
import antnav as an
from antnav import kernels
from antnav.scenarios.replay import prepare

def compiled():
    modules = [import_module(f"antnav.kernels.{one.name}") for one in iter_modules(kernels.__path__)]
    found = {(one.__name__, name): kernel for one in modules for name, kernel in vars(one).items()}
    return {name: len(kernel.signatures) for name, kernel in found.items() if hasattr(kernel, "signatures")}

rooms = an.maps.generate("rooms", 40, 40, 4)
problem = an.Problem.from_cells(rooms, *an.maps.ends(rooms), corner_rule="allow")
texts = ("people:5+traffic:3", "unknown:4", "doors:2", "obstacles:40")
scenarios = [an.scenarios.named(text, problem, seed=1) for text in texts]
prepare(sys.argv[1])
before = compiled()
for scenario in scenarios:
    an.replay(problem, scenario, sys.argv[1])
print(sum(before.values()) > 3, sorted(compiled().items() - before.items()), prepare(sys.argv[1]))
"""


@pytest.mark.slow
@pytest.mark.parametrize("algorithm", METHODS)
def test_nothing_is_compiled_while_times_are_measured(algorithm: str) -> None:
    ended = subprocess.run([sys.executable, "-c", FRESH, algorithm], check=True, capture_output=True, text=True)
    assert ended.stdout == "True [] 0.0\n"


def test_what_cannot_be_replayed() -> None:
    scenario = an.Scenario.of(FLOOR, ticks=9)
    with pytest.raises(ParameterError, match="replanner 'ants'"):
        an.replay(FLOOR, scenario, "ants")
    with pytest.raises(ParameterError, match="the scenario is of"):
        an.replay(CORRIDOR, scenario)
    with pytest.raises(ParameterError, match="improve"):
        an.replay(FLOOR, scenario, improve=-1)
    with pytest.raises(ParameterError, match="scenario"):
        an.replay(FLOOR, "people:20")
    with pytest.raises(EndpointError):
        an.replay(IN_ROOMS, an.Scenario.of(IN_ROOMS, radius=1.0))
