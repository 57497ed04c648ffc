"""Films and pictures of replays show what the replay holds, and are whole files."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import subprocess
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav.errors import OutputError, ParameterError
from antnav.plot.film import COLOURS, VEILED, Shade, film_of
from antnav.plot.gif import CAPTION, MARGIN, MOST_FRAMES, TRAIL, arranged, gif, palette
from antnav.plot.page import packed, page
from antnav.scenarios import Event
from tests.plot.samples import line, texts

GRID = an.maps.generate("rooms", 40, 40, 4)
PROBLEM = an.Problem.from_cells(GRID, *an.maps.ends(GRID))
CORRIDOR = an.Problem.from_cells(an.GridMap(np.zeros((1, 10), np.uint8)), (0, 0), (0, 9))


@pytest.fixture(scope="module")
def crowd() -> list[an.Replay]:
    scenario = an.scenarios.named("doors:3+people:6+traffic:4", PROBLEM, seed=3, speed=2)
    return [an.replay(PROBLEM, scenario, name) for name in ("regions", "dstar_lite")]


@pytest.fixture(scope="module")
def unknown() -> an.Replay:
    return an.replay(PROBLEM, an.scenarios.named("unknown:4+people:4", PROBLEM, seed=3), "mpgaa_star")


def corridor(*events: Event, **choices) -> an.Replay:
    return an.replay(CORRIDOR, an.Scenario.of(CORRIDOR, events, **{"ticks": 30, **choices}), "astar")


def truth(replay: an.Replay):
    """Tick by tick a shade for each cell, plainly."""
    problem = replay.problem
    closed, price = ~problem.passable, np.zeros(problem.grid.shape)
    events = {event.tick: event for event in replay.scenario.events}
    for tick in range(len(replay)):
        if tick in events:
            closed[tuple(events[tick].blocked.T)], closed[tuple(events[tick].freed.T)] = True, False
            price[tuple(events[tick].priced.T)] = events[tick].prices
        shades = np.where(price > 0, Shade.PRICED, Shade.FREE)
        yield np.where(closed, np.where(problem.passable, Shade.BLOCKED, Shade.OCCUPIED), shades)


@pytest.mark.parametrize("block", [1, 2, 3])
def test_the_map_is_the_scenarios_at_each_tick(crowd: list[an.Replay], block: int) -> None:
    film = film_of(crowd, -(-40 // block))
    assert (film.block, len(film)) == (block, max(map(len, crowd)))
    kinds = set()
    longest = max(crowd, key=len)
    for shown, shades in zip(film.pictures(), truth(longest), strict=True):
        rows, cols = (-(-side // block) for side in shades.shape)
        expected = [
            [shades[row * block : (row + 1) * block, col * block : (col + 1) * block].max() for col in range(cols)]
            for row in range(rows)
        ]
        np.testing.assert_array_equal(shown, expected)
        kinds |= set(np.unique(shown).tolist())
    assert kinds >= {Shade.FREE, Shade.PRICED, Shade.OCCUPIED, Shade.BLOCKED}


def test_a_door_in_a_wall_opens_and_closes_again() -> None:
    grid = an.GridMap(np.array([[0, 0, 1, 0, 0]], np.uint8))
    problem = an.Problem.from_cells(grid, (0, 0), (0, 4))
    door = [(0, 2)]
    scenario = an.Scenario.of(problem, [Event(2, freed=door), Event(3, blocked=door)], ticks=5)
    shown = [shades[0, 2] for shades in film_of(an.replay(problem, scenario), 9).pictures()]
    assert shown == [Shade.OCCUPIED, Shade.OCCUPIED, Shade.FREE, Shade.OCCUPIED, Shade.OCCUPIED]


def test_plans_are_kept_where_they_change(crowd: list[an.Replay]) -> None:
    for replay, drive in zip(crowd, film_of(crowd, 40).drives, strict=True):
        begins = dict(drive.plans)
        assert 1 < len(begins) < len(replay)
        plan = None
        for tick, shown in zip(replay.ticks, replay.plans, strict=True):
            plan = begins.get(tick.tick, plan)
            assert (plan is None) == (shown is None)
            if plan is not None:
                np.testing.assert_array_equal(plan, shown)
                plan = plan[tick.moves :]
        places = [drive.way[at].tolist() for at in drive.passed]
        assert places == [[tick.row, tick.col] for tick in replay.ticks]


def test_what_is_seen_is_within_the_sensors_reach(unknown: an.Replay) -> None:
    film = film_of(unknown, 40)
    seen = np.zeros((40, 40), bool)
    film.look(seen, (20, 3))
    rows, cols = np.indices(seen.shape)
    np.testing.assert_array_equal(seen, np.hypot(rows - 20, cols - 3) <= 4.5)


def frames_of(content: bytes) -> list[np.ndarray]:
    with Image.open(io.BytesIO(content)) as image:
        frames = []
        for number in range(image.n_frames):
            image.seek(number)
            frames.append(np.asarray(image.convert("RGB")))
    return frames


def test_frames_show_robot_people_and_walls() -> None:
    replay = corridor(Event(2, blocked=[(0, 8)]), Event(4, freed=[(0, 8)], priced=[(0, 7)], prices=[2.0]))
    frames = frames_of(gif(replay))
    assert len(frames) == len(replay)
    colours = np.array(palette()).reshape(-1, 3)

    def middle(number: int, col: int) -> list[int]:
        return frames[number][CAPTION + 12, frames[number].shape[1] // 2 - 120 + 24 * col + 12].tolist()

    for tick in (0, 3, 9):
        assert middle(tick, replay.ticks[tick].col) == colours[TRAIL].tolist()
    assert middle(1, 8) != COLOURS[Shade.BLOCKED].tolist() == middle(2, 8) == middle(3, 8)
    corner = frames[5][CAPTION + 2, frames[5].shape[1] // 2 - 120 + 24 * 7 + 2].tolist()
    assert corner == COLOURS[Shade.PRICED].tolist()


def test_frames_veil_what_was_not_seen(unknown: an.Replay) -> None:
    first = frames_of(gif(unknown))[0]
    assert first.shape == (40 * 20 + CAPTION + MARGIN, 40 * 20 + 2 * MARGIN, 3)
    assert first[CAPTION + 400, MARGIN + 10].tolist() == VEILED[Shade.OCCUPIED].tolist()
    assert first[CAPTION + 10, MARGIN + 10].tolist() == COLOURS[Shade.OCCUPIED].tolist()


def test_several_robots_stand_side_by_side_and_long_replays_skip_ticks(crowd: list[an.Replay]) -> None:
    both = frames_of(gif(crowd))
    assert len(both) == max(map(len, crowd))
    assert both[0].shape[1] == 2 * (600 + 2 * MARGIN)
    with Image.open(io.BytesIO(gif(corridor(Event(0, blocked=[(0, 9)]), ticks=2 * MOST_FRAMES + 1)))) as image:
        assert 1 <= image.n_frames <= MOST_FRAMES
        image.seek(image.n_frames - 1)
        assert image.info["duration"] >= 2500


@pytest.mark.parametrize(
    ("count", "shape", "columns", "side"),
    [
        (1, (300, 600), 1, 800),
        (2, (300, 600), 1, 800),
        (2, (600, 300), 2, 800),
        (2, (400, 400), 2, 600),
        (4, (300, 600), 2, 600),
        (3, (40, 40), 2, 600),
        (2, (1, 9000), 1, 800),
    ],
)
def test_maps_are_set_so_that_they_get_largest(count: int, shape: tuple[int, int], columns: int, side: int) -> None:
    assert arranged(count, shape) == (columns, side)


class Stream:
    """Numbers of a page, read plainly."""

    def __init__(self, text: str) -> None:
        self.bytes = list(base64.b64decode(text))

    def next(self) -> int:
        low = self.bytes.pop(0)
        return low if low < 128 else low - 128 + 128 * self.next()

    def signed(self) -> int:
        value = self.next()
        return -(value + 1) // 2 if value % 2 else value // 2

    def cells(self) -> list[list[int]]:
        found, at = [], [0, 0]
        while self.bytes:
            at = [at[0] + self.signed(), at[1] + self.signed()]
            found.append(at)
        return found


def content_of(text: str) -> dict:
    return json.loads(re.search(r'<script type="application/json" id="film">(.*?)</script>', text).group(1))


def test_the_page_holds_the_replays(crowd: list[an.Replay]) -> None:
    data = content_of(page(crowd))
    assert (data["rows"], data["cols"], data["ticks"]) == (40, 40, max(map(len, crowd)))
    stream, shades = Stream(data["map"]), []
    while stream.bytes:
        count, shade = divmod(stream.next(), 8)
        shades += [shade] * count
    changes = Stream(data["changes"])
    for expected in truth(max(crowd, key=len)):
        at = 0
        for _ in range(changes.next()):
            at += changes.next()
            count, shade = divmod(changes.next(), 8)
            shades[at : at + count] = [shade] * count
            at += count
        assert shades == expected.ravel().tolist()
    assert changes.bytes == []
    for replay, drive in zip(crowd, data["drives"], strict=True):
        assert (drive["name"], drive["arrived"]) == (replay.algorithm, replay.arrived)
        way = Stream(drive["way"]).cells()
        assert [way[sum(drive["moves"][:tick])] for tick in range(len(replay))] == [
            [t.row, t.col] for t in replay.ticks
        ]
        assert [time >= 0 for time in drive["times"]] == [tick.noticed > 0 for tick in replay.ticks]
        assert max(drive["times"]) == round(1e6 * replay.percentile(1.0))
        assert drive["driven"][-1] == pytest.approx(replay.travelled - replay.ticks[-1].length, abs=0.01)
        assert {data["words"][word] for word in drive["status"]} >= {"on its way"}
        for tick, text in drive["plans"]:
            turns, plan = Stream(text).cells(), replay.plans[tick]
            assert (turns == []) == (plan is None)
            if plan is not None:
                assert turns[0] == plan[0].tolist()
                assert turns[-1] == plan[-1].tolist()
                moves = sum(max(abs(a - c), abs(b - d)) for (a, b), (c, d) in pairwise(turns))
                assert moves == len(plan) - 1


def test_numbers_of_all_sizes_are_packed() -> None:
    numbers = [0, 1, 127, 128, 16383, 16384, 2**31, 2**40 + 5]
    stream = Stream(packed(numbers))
    assert [stream.next() for _ in numbers] == numbers


def test_names_are_text_and_nothing_else() -> None:
    name = "</script><script>alert(1)</script>&"
    grid = an.GridMap(np.zeros((3, 5), np.uint8), name=name)
    problem = an.Problem.from_cells(grid, (0, 0), (2, 4))
    scenario = an.Scenario.of(problem, name=name, ticks=9)
    text = page(replace(an.replay(problem, scenario), algorithm=name))
    assert text.count("<script") == text.count("</script>") == 2
    assert "<script>alert" not in text
    assert content_of(text)["drives"][0]["name"] == name
    assert "http" not in text.replace("http-equiv", "")


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
def test_the_script_reads_what_the_page_holds(tmp_path, crowd: list[an.Replay]) -> None:
    """Its upper half, which touches nothing of the page but the data, in a process without one."""
    text = page(crowd)
    whole, script = tmp_path / "whole.mjs", tmp_path / "half.mjs"
    whole.write_text(text.split('<script type="module">')[1].split("</script>")[0])
    subprocess.run(["node", "--check", whole], check=True)
    (tmp_path / "data.json").write_text(json.dumps(content_of(text)))
    script.write_text(
        "import { readFileSync } from 'fs';\n"
        "const document = { getElementById: () => ({ textContent: readFileSync('data.json', 'utf8') }) };\n"
        + whole.read_text().split("\nconst styles")[0]
        + "\nconst ahead = drives.map((drive) => drive.passed.map((passed, now) => {"
        "const plan = drive.plans.findLast((each) => each.tick <= now);"
        "return rest(plan.cells, passed - drive.passed[plan.tick])[0] ?? null; }));\n"
        "console.log(JSON.stringify({ map: [...map], changes, ahead, ends: drives.map((drive) => drive.way.at(-1)) }));"
    )
    done = subprocess.run(["node", script], check=True, capture_output=True, cwd=tmp_path)
    told = json.loads(done.stdout)
    shades = told["map"]
    for expected, runs in zip(truth(max(crowd, key=len)), told["changes"], strict=True):
        for start, count, shade in runs:
            shades[start : start + count] = [shade] * count
        assert shades == expected.ravel().tolist()
    for replay, ahead in zip(crowd, told["ahead"], strict=True):
        expected = [None if plan is None else plan[0].tolist() for plan in replay.plans]
        assert ahead == expected


def test_the_picture_shows_way_plans_and_times(crowd: list[an.Replay]) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    ax = an.plot_replay(crowd)
    assert len(ax.figure.axes) == 4
    way = crowd[0].problem.grid.cell_to_world([(tick.row, tick.col) for tick in crowd[0].ticks])
    drawn = line(ax, "way driven").get_xydata()
    assert {*map(tuple, way.tolist())} <= {*map(tuple, drawn.tolist())}
    bars = ax.figure.axes[2].collections[0].get_segments()
    np.testing.assert_allclose([1e-3 * bar[1][1] for bar in bars], crowd[0].times)
    assert "doors:3+people:6+traffic:4 on rooms" in ax.figure.get_suptitle()
    given_up = [plan for _, plan in film_of(crowd, 40).drives[0].plans[:-1] if plan is not None]
    assert f"plans given up ({len(given_up)})" in texts(ax.figure)


def test_how_long_cells_are_blocked() -> None:
    from antnav.plot.replay import stays

    replay = corridor(Event(1, blocked=[(0, 8), (0, 7)]), Event(4, freed=[(0, 8)]), Event(6, freed=[(0, 7)]))
    film = film_of(replay, 10)
    heat = stays(film, Shade.BLOCKED, len(replay))
    assert heat.label == "blocked for up to 5 ticks"
    assert np.flatnonzero(heat.shade).tolist() == [7, 8]
    assert heat.shade[0, 7:9].tolist() == pytest.approx([1.0, 0.2 + 0.8 * 3 / 5])
    assert stays(film, Shade.PRICED, len(replay)) is None


def test_files(tmp_path, unknown: an.Replay) -> None:
    pytest.importorskip("matplotlib")
    for ending in ("html", "gif", "png", "svg", "pdf", "HTML"):
        an.save_film(unknown, tmp_path / f"film.{ending}")
    assert (tmp_path / "film.html").read_bytes() == (tmp_path / "film.HTML").read_bytes()
    assert (tmp_path / "film.gif").read_bytes().startswith(b"GIF89a")
    with Image.open(tmp_path / "film.png") as image:
        assert min(image.size) > 600
    with pytest.raises(OutputError):
        an.save_film(unknown, tmp_path / "none" / "film.gif")


def test_what_is_no_film_is_refused(tmp_path, crowd: list[an.Replay], unknown: an.Replay) -> None:
    for given, ending, told in (
        (crowd, "mp4", "films end in .gif, .html, pictures in .png"),
        ([], "gif", "there is one or several"),
        (replace(unknown, ticks=(), plans=(), news=()), "gif", "of a tick or more"),
        ([crowd[0], unknown], "html", "they are of one scenario"),
        (["replay"], "html", "make one with antnav.replay"),
        (7, "html", "there is one or several"),
    ):
        with pytest.raises(ParameterError, match=told):
            an.save_film(given, tmp_path / f"film.{ending}")
    assert list(tmp_path.iterdir()) == []
