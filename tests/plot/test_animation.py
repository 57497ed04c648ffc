"""Films of ants at work."""

from __future__ import annotations

import io
import shutil
import subprocess
import textwrap

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav.errors import AntnavError
from antnav.planner.view import Fate
from antnav.plot.animation import LETTERS, LINES
from antnav.world.cost import CostField
from tests.conftest import grid_of


@pytest.fixture(scope="module")
def problem():
    start, goal = an.maps.builtin_query("equiv20")
    return an.Problem.from_cells(an.maps.builtin("equiv20"), start, goal, corner_rule="allow")


@pytest.fixture(scope="module")
def film(problem):
    return an.animate(problem, an.paco(), seed=3)


def test_a_film_is_of_the_run_that_solve_makes(problem, film):
    result = an.solve(problem, an.paco(), seed=3)
    assert film.result.length == result.length
    iterations = [moment.seen.iteration for moment in film.moments]
    assert iterations == sorted(iterations)
    assert {moment.seen.stage for moment in film.moments} == {"stage one", "stage two"}
    assert film.moments[-1].seen.done
    assert "fewer turns" in film.moments[-1].seen.words[-1]
    assert len(film.moments[-1].seen.bests) == 1
    np.testing.assert_array_equal(film.moments[-1].seen.bests[0], result.path.cells)


def test_gif_webp_and_page_have_all_frames_and_their_times(film, tmp_path):
    for ending in ("gif", "webp"):
        film.save(tmp_path / f"film.{ending}")
        with Image.open(tmp_path / f"film.{ending}") as image:
            assert image.format.lower() == ending
            shown = 0
            for frame in range(image.n_frames):
                image.seek(frame)
                image.load()
                shown += image.info["duration"]
            assert shown == sum(moment.milliseconds for moment in film.moments)
    film.save(tmp_path / "film.html")
    text = (tmp_path / "film.html").read_text()
    assert text.count("UklGR") == len(film.moments)  # "RIFF" in base64
    assert "http" not in text
    assert film._repr_html_() in text


def test_walls_path_and_ends_are_seen_in_the_last_frame(problem, film):
    *_, last = film.frames()
    pixels = np.asarray(last).astype(int)
    vermillion = np.abs(pixels - (213, 94, 0)).sum(axis=2) < 40
    dark = np.abs(pixels - (38, 41, 46)).sum(axis=2) < 20
    scale = 28
    assert dark.sum() > 0.9 * scale**2 * (problem.grid.cells == 1).sum()
    assert vermillion.sum() > len(film.result.path.cells) * scale * 3


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg here")
def test_mp4_lasts_as_long(film, tmp_path):
    film.save(tmp_path / "film.mp4")
    command = ["ffprobe", "-v", "error", "-show_entries", "format=duration", "-of", "csv=p=0", tmp_path / "film.mp4"]
    seconds = float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert seconds == pytest.approx(sum(moment.milliseconds // 40 for moment in film.moments) / 25, abs=0.1)


def test_same_film_same_bytes(problem, tmp_path):
    contents = []
    for name in ("one.gif", "other.gif"):
        an.animate(problem, an.npaco(iterations=5), seed=1).save(tmp_path / name)
        contents.append((tmp_path / name).read_bytes())
    assert contents[0] == contents[1]


def test_a_large_map_is_drawn_in_blocks_and_keeps_its_walls(tmp_path):
    grid = an.maps.generate("rooms", 600, 700, seed=2)
    free = np.argwhere(grid.cells == 0)
    query = an.Problem.from_cells(grid, tuple(free[0].tolist()), tuple(free[40].tolist()))
    frames = list(an.animate(query, an.npaco(ants=2, iterations=2, heuristic="detour"), walks=0).frames())
    assert max(frames[0].size) < 700
    assert (np.asarray(frames[-1]).max(axis=2) < 60).mean() > 0.05


def test_what_cannot_be_filmed_is_refused(problem, film, tmp_path):
    walled = an.Problem.from_cells(grid_of("..#.", "..#."), (0, 0), (0, 3))
    for call in (
        lambda: an.animate(problem, an.astar()),
        lambda: an.animate(walled),
        lambda: an.animate(problem, walks=99),
        lambda: film.save(tmp_path / "film.avi"),
        lambda: film.save(tmp_path / "no" / "film.gif"),
    ):
        with pytest.raises(AntnavError):
            call()
    assert list(tmp_path.iterdir()) == []


def test_without_ffmpeg_the_remedy_is_told(film, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(AntnavError, match="ffmpeg"):
        film.save(tmp_path / "film.mp4")


def test_ants_that_got_lost_are_among_the_ants(problem):
    colony = an.Colony(problem, an.traditional(), seed=0)
    assert colony.ants() == []
    colony.step(2)
    ants = colony.ants()
    assert len(ants) == 50
    assert sum(ant.fate is Fate.DEAD for ant in ants) == colony.last.lost > 0
    for ant in ants:
        assert tuple(ant.cells[0]) == problem.start_cell
        assert (tuple(ant.cells[-1]) == problem.goal_cell) is (ant.fate is Fate.ARRIVED)
        assert np.isfinite(ant.length) == (ant.fate is Fate.ARRIVED)


def test_pictures_stay_in_memory(film):
    frame = next(film.frames())
    content = io.BytesIO()
    frame.save(content, "PNG")
    assert frame.mode == "RGB"
    assert frame.width % 2 == frame.height % 2 == 0


def test_long_runs_keep_few_frames_and_wide_maps_their_columns():
    grid = an.GridMap(np.zeros((1, 70_000), np.uint8))
    query = an.Problem.from_cells(grid, (0, 69_000), (0, 69_020))
    film = an.animate(query, an.npaco(ants=2, iterations=700, heuristic="detour"), walks=1)
    numbers = [moment.seen.iteration for moment in film.moments]
    assert len(numbers) <= 300 + 13
    assert numbers == sorted(numbers)
    assert {1, 257, 700} <= {*numbers}
    assert film.moments[0].seen.walks[0].tolist() == [0, 69_000]
    assert film.moments[-1].seen.done
    assert "fewer turns" in film.moments[-1].seen.words[-1]


def test_words_tell_lengths_from_costs(problem):
    values = np.zeros(problem.grid.shape)
    values[8:12] = 5.0
    query = an.Problem.from_cells(
        problem.grid, problem.start_cell, problem.goal_cell, corner_rule="allow", cost=CostField(values)
    )
    film = an.animate(query, an.npaco(iterations=20), walks=0)
    first, last = film.moments[0].seen, film.moments[-1].seen
    assert f"costs {first.cost:.2f}" in first.words[-1]
    assert f"{film.result.length:.2f} cells that costs {film.result.cost:.2f}" in last.words[-1]


def test_the_caption_has_room_for_all_words(film):
    for moment in film.moments:
        lines = [line for words in moment.seen.words for line in textwrap.wrap(words, LETTERS)]
        assert len(lines) < LINES
