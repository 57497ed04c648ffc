"""Sessions: what a page sees and does, without a network."""

from __future__ import annotations

import time

import numpy as np
import pytest

import antnav as an
from antnav.maps import builtin, builtin_query
from antnav.view import messages as say
from antnav.view.messages import Panel
from antnav.view.session import AHEAD
from tests.view.conftest import Page


def run_to_end(page):
    page.say(say.Speed(0))
    page.say(say.Play())
    to_the_end(page)


def to_the_end(page):
    for _ in range(400):
        page.take()
        if page.last("state")["done"]:
            return
        time.sleep(min(page.session.due(), 0.05))
    raise AssertionError("the run does not end")


def test_a_run_shown_is_the_run_that_solve_makes(page):
    run_to_end(page)
    problem = an.Problem.from_cells(builtin("equiv20"), *builtin_query("equiv20"), corner_rule="allow")
    result = an.solve(problem, an.npaco(), seed=0)
    last = page.last("frame")
    assert last["done"]
    assert last["cost"] == result.cost
    np.testing.assert_array_equal(last["best"].reshape(-1, 2), result.path.cells)
    rows = [row for one in page.heard if one["is"] == "frame" for row in one["rows"]]
    assert [row[0] for row in rows] == result.history.best.tolist()
    assert [row[3] for row in rows] == result.history.lost.tolist()


def test_both_halves_and_the_auxiliary_cell_of_paco():
    page = Page("paco")
    page.say(say.Open())
    page.step(4)  # three iterations of stage one
    frame = page.last("frame")
    assert frame["stage"] == "stage two"
    assert {side for side, _, _ in frame["ants"]} == {0, 1}
    assert frame["auxiliary"] is not None
    assert len(frame["bests"]) == 2
    assert frame["heat0"].max() == frame["heat1"].max() == 255
    assert any("half" in text for text in frame["words"])


def test_walks_are_those_of_the_ants(page):
    page.step(2)
    frame = page.last("frame")
    start, goal = page.session.scene.mission.position, page.session.scene.mission.goal
    at = 0
    assert frame["ants"]
    for _, fate, count in frame["ants"]:
        walk = frame["walks"].reshape(-1, 2)[at : at + count]
        at += count
        assert tuple(walk[0]) == start
        assert (np.abs(np.diff(walk.astype(int), axis=0)).max(axis=1) == 1).all()
        if fate == 1:
            assert tuple(walk[-1]) == goal
    assert at * 2 == len(frame["walks"])


def test_same_seed_same_frames_and_two_panels_side_by_side():
    one, two = Page("npaco", "npaco", seed=3), Page("npaco", seed=4)
    for page in (one, two):
        page.say(say.Open())
        page.step(3)
    frames = {}
    for made in one.heard:
        if made["is"] == "frame":
            frames[made["panel"]] = made
    np.testing.assert_array_equal(frames[0]["walks"], frames[1]["walks"])
    assert not np.array_equal(frames[0]["walks"], two.last("frame")["walks"])


def test_a_wall_across_the_path_makes_another_path_and_another_plan(page):
    run_to_end(page)
    before = page.last("frame")["best"].reshape(-1, 2)
    plan = page.last("scene")["plan"].reshape(-1, 2)
    wall = [tuple(map(int, cells[len(cells) // 2])) for cells in (before, plan)]
    page.say(say.Draw(wall, "wall"))
    scene = page.last("scene")
    assert all(scene["cells"].reshape(20, 20)[cell] == 1 for cell in wall)
    assert not {*wall} & {*map(tuple, scene["plan"].reshape(-1, 2).tolist())}
    assert scene["mended"]["milliseconds"] > 0
    page.calm()
    run_to_end(page)
    after = page.last("frame")["best"].reshape(-1, 2)
    assert not {*wall} & {*map(tuple, after.tolist())}


def test_a_goal_walled_in_is_told_in_words_and_freed_again(page):
    row, col = page.session.scene.mission.goal
    ring = [(row + dr, col + dc) for dr in (-1, 0, 1) for dc in (-1, 0, 1) if (dr, dc) != (0, 0)]
    page.say(say.Draw(ring, "wall"))
    assert "No way" in page.last("scene")["words"]
    assert page.last("scene")["optimum"] is None
    page.calm()
    page.say(say.Play())
    assert page.session.runs == []
    page.say(say.Draw(ring, "free"))
    page.calm()
    assert page.last("scene")["words"] == ""
    assert page.session.runs


def test_costs_painted_lead_the_plan_elsewhere(page):
    plan = [tuple(map(int, cell)) for cell in page.last("scene")["plan"].reshape(-1, 2)][3:-3]
    before = page.last("scene")["optimum"]
    page.say(say.Draw(plan, "cost", 50.0))
    scene = page.last("scene")
    assert scene["optimum"] > before
    assert scene["prices"].reshape(20, 20)[plan[0]] == 255
    assert page.session.scene.problem.cost.values[plan[0]] == 50.0
    page.say(say.Draw(plan, "cost", 0.0))
    assert page.last("scene")["optimum"] == pytest.approx(before)


def test_a_link_holds_all_of_it(page):
    page.say(say.Draw([(3, 4), (3, 5)], "wall"))
    page.say(say.Draw([(8, 8)], "cost", 2.5))
    page.say(say.Choose([Panel("paco", {"ants": 12, "rho": 0.2}), Panel("astar")], 11, "graze"))
    page.say(say.Save("link"))
    other = Page("mmas")
    other.say(say.Open(page.last("link")["link"]))
    assert other.session.state() == page.session.state()
    np.testing.assert_array_equal(other.session.scene.cells, page.session.scene.cells)
    page.step(5)
    other.step(5)
    np.testing.assert_array_equal(page.last("frame")["walks"], other.last("frame")["walks"])


@pytest.mark.parametrize(
    ("message", "word"),
    [
        (say.Choose([Panel("nobody")]), "planners"),
        (say.Choose([Panel("paco", {"rho": 3})]), "rho"),
        (say.Choose([Panel("paco", {"ants": 10**6})]), "MB"),
        (say.Choose([Panel("paco")], 0, "sideways"), "corner"),
        (say.Ends(start=(99, 99)), "99"),
        (say.Load("nowhere"), "nowhere"),
        (say.Load("random", 2048, 2048), "262144"),
        (say.Open("no link"), "link"),
        (say.Save("result"), "done"),
        (say.Draw([(1, 1)], "cost", 100.0), None),
        (say.Draw([(-1, -1), (500, 500)], "wall"), None),
    ],
)
def test_what_is_wrong_is_told_and_the_session_goes_on(page, message, word):
    page.say(message)
    notes = [one for one in page.heard if one["is"] == "note"]
    assert bool(notes) == (word is not None)
    if word:
        assert word in " ".join(map(str, notes[-1].values()))
    if page.session.panels == [Panel("npaco")]:
        page.step(1)
        assert page.last("frame")["iteration"] == 1


def test_files_map_and_result(page):
    page.say(say.Save("map"))
    assert bytes(page.last("file")["content"]).startswith(b"type octile")
    run_to_end(page)
    page.say(say.Save("result"))
    assert page.last("file")["name"] == "npaco.json"


def test_frames_wait_until_the_page_has_drawn(page):
    page.session.do(say.Speed(0))
    page.session.do(say.Play())
    for _ in range(50):  # nobody acknowledges
        page.take_in_silence()
        time.sleep(min(page.session.due(), 0.02))
    iteration = page.session.runs[0].iteration
    assert sum(one["is"] == "frame" for one in page.heard) <= AHEAD + 1
    assert page.take_in_silence() == []
    assert page.session.runs[0].iteration == iteration
    assert page.session.due() == float("inf")


@pytest.mark.parametrize("ends", [{"start": (1, 14)}, {"goal": (1, 14)}, {"start": (9, 9), "goal": (9, 9)}])
def test_ends_dragged_into_a_wall_or_onto_each_other_outlast_a_reload_and_another_rule(page, ends):
    page.say(say.Ends(**ends))
    page.calm()
    page.say(say.Choose([Panel("acs")], 1, "forbid"))
    page.say(say.Save("link"))
    other = Page("npaco")
    other.say(say.Open(page.last("link")["link"]))
    assert not [one for one in page.heard + other.heard if one["is"] == "note"]
    assert other.session.state() == page.session.state()
    assert other.last("scene")["words"] == page.last("scene")["words"] != ""
    other.say(say.Ends(start=(0, 0), goal=(19, 19)))
    other.calm()
    other.step(1)
    assert other.last("frame")["iteration"] == 1


def test_a_map_too_large_for_the_parameters_is_shown_and_smaller_ones_go_on(page):
    page.say(say.Choose([Panel("paco", {"ants": 2000})]))
    page.say(say.Load("empty", 256, 256))
    assert "MB" in page.last("note")["rule"]
    assert page.last("scene")["rows"] == 256
    page.say(say.Draw([(3, 3)], "wall"))
    page.calm()
    page.say(say.Save("link"))
    other = Page("npaco")
    other.say(say.Open(page.last("link")["link"]))
    assert other.last("scene")["rows"] == 256
    page.say(say.Choose([Panel("paco", {"ants": 20})]))
    page.step(1)
    assert page.last("frame")["iteration"] == 1


def test_a_link_holds_a_map_named_as_a_built_in_one_a_robot_and_prices_everywhere():
    cells = np.zeros((20, 20), np.uint8)
    cells[5, :10] = 1
    page = Page(grid=an.GridMap(cells, 0.5, (1.0, 2.0, 0.3), name="equiv20"), radius=0.6)
    page.say(say.Draw([(12, 12)], "wall"))
    page.say(say.Save("link"))
    other = Page("mmas")
    other.say(say.Open(page.last("link")["link"]))
    assert other.session.state() == page.session.state()
    assert other.session.scene.grid.origin == (1.0, 2.0, 0.3)
    for one in (page, other):
        one.say(say.Draw([(12, 12)], "free"))
    np.testing.assert_array_equal(other.session.scene.cells, page.session.scene.cells)

    page = Page(grid=an.GridMap(cells, name="equiv20"))
    page.say(say.Save("link"))
    other.say(say.Open(page.last("link")["link"]))
    np.testing.assert_array_equal(other.session.scene.cells, cells)

    page.say(say.Load("empty", 512, 512))
    page.say(say.Draw([(row, col) for row in range(512) for col in range(512)], "cost", 3.25))
    page.say(say.Save("link"))
    other.say(say.Open(page.last("link")["link"]))
    assert other.session.scene.prices.min() == 3.25


def test_ends_lie_in_the_largest_part_of_a_map_and_where_the_robot_fits():
    cells = np.ones((40, 60), np.uint8)
    cells[0, :3] = 0  # a speck outside the room
    cells[5:35, 5:55] = 0
    for radius in (0.0, 2.0):
        page = Page(grid=an.GridMap(cells), radius=radius)
        page.say(say.Open())
        assert page.last("scene")["words"] == ""
        assert page.last("scene")["optimum"] > 40


def test_what_a_view_cannot_begin_with_is_refused():
    for panels, seed in (
        (["paco", "npaco", "acs"], 0),
        (["paco"], -1),
        (["paco"], 2**53),
        (["pso-straight"], 0),  # not on the menu
    ):
        with pytest.raises(an.AntnavError):
            Page(*panels, seed=seed)


def test_a_run_is_halted_and_goes_on(page):
    page.say(say.Play())
    assert page.last("state") == {"is": "state", "playing": True, "done": False}
    page.say(say.Pause())
    assert not page.last("state")["playing"]
    iteration = page.session.runs[0].iteration
    time.sleep(0.6)
    page.take()
    assert page.session.runs[0].iteration == iteration
    page.say(say.Play())
    assert page.last("state")["playing"]
    time.sleep(0.6)
    page.take()
    assert page.session.runs[0].iteration > iteration


def test_jump_point_search_among_costs_is_told_in_words_beside_ants(page):
    page.say(say.Draw([(3, 3)], "cost", 2.0))
    page.say(say.Choose([Panel("jps"), Panel("npaco", {"iterations": 3})]))
    run_to_end(page)
    words = {one["panel"]: one["words"] for one in page.heard if one["is"] == "frame"}
    assert "astar" in words[0][0]
    assert "Done: a path of" in words[1][-1]
    assert "that costs" in words[1][-1]


def test_a_generator_and_a_built_in_map_of_one_name(page):
    page.say(say.Load("warehouse", 40, 40))
    assert page.session.scene.grid.shape == builtin("warehouse").shape
    page.say(say.Load("warehouse", 40, 40, drawn=True))
    assert page.session.scene.grid.shape == (40, 40)


def test_ants_that_had_ended_go_on_after_a_stroke_and_those_that_were_halted_do_not(page):
    page.step(2)
    page.say(say.Draw([(3, 4)], "wall"))
    page.calm()
    assert not page.last("state")["playing"]
    run_to_end(page)
    page.heard.clear()
    page.say(say.Draw([(3, 5)], "wall"))
    page.calm()
    to_the_end(page)  # nobody says play
    assert page.last("began")
    assert page.last("frame")["iteration"] == 50
    page.heard.clear()
    page.say(say.Draw([(3, 6)], "wall"))
    page.say(say.Pause())
    page.calm()
    assert page.last("frame")["iteration"] == 0
    assert not page.last("state")["playing"]
