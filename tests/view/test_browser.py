"""The view in a real browser: Chromium, where it is installed."""

from __future__ import annotations

import io
import shutil

import numpy as np
import pytest
from PIL import Image

import antnav as an
from antnav.maps import builtin
from tests.view.test_server import Served

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here: apt install chromium")


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as program:
        made = program.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield made
        made.close()


@pytest.fixture(scope="module")
def served():
    made = Served("equiv20", "--algorithm", "paco")
    yield made
    made.process.kill()
    made.process.communicate()


@pytest.fixture
def errors():
    return []


@pytest.fixture
def page(browser, served, errors):
    made = browser.new_page(viewport={"width": 1280, "height": 900})
    made.on("pageerror", lambda error: errors.append(str(error)))
    made.on("console", lambda told: told.type == "error" and errors.append(told.text))
    made.goto(served.url)
    made.wait_for_function("() => document.querySelector('#antnav').antnavView?.scene")
    yield made
    made.close()
    assert errors == []


def state(page, expression):
    return page.evaluate(f"() => {{ const view = document.querySelector('#antnav').antnavView; return {expression}; }}")


def to_the_end(page):
    page.select_option(".speed", "0")
    if page.inner_text(".play") != "Pause":
        page.click(".play")
    page.wait_for_function("() => document.querySelector('.play').textContent === 'Again'", timeout=30_000)


def at(page, row, col):
    """Where the middle of a cell lies on the page."""
    box = page.locator(".map").first.bounding_box()
    rows, cols = state(page, "[view.scene.rows, view.scene.cols]")
    return box["x"] + (col + 0.5) * box["width"] / cols, box["y"] + (row + 0.5) * box["height"] / rows


def drag(page, *cells):
    page.mouse.move(*at(page, *cells[0]))
    page.mouse.down()
    for cell in cells[1:]:
        page.mouse.move(*at(page, *cell), steps=4)
    page.mouse.up()


def best(page):
    flat = state(page, "Array.from(view.panels[0].frame.best)")
    return np.array(flat).reshape(-1, 2)


def pixels(page):
    """The map as it is seen."""
    return np.asarray(Image.open(io.BytesIO(page.locator(".map").first.screenshot())).convert("RGB")).astype(int)


def test_a_wall_across_the_path_and_the_ants_find_another(page):
    to_the_end(page)
    before = best(page)
    row, col = before[len(before) // 2].tolist()
    state(page, "(view.panels[0].frame.old = true)")
    drag(page, (row, col), (row, col - 1), (row - 1, col - 1))
    page.wait_for_function(f"() => document.querySelector('#antnav').antnavView.scene.cells[{row * 20 + col}] === 1")
    view = "document.querySelector('#antnav').antnavView"
    page.wait_for_function(f"() => ((frame) => frame && !frame.old && frame.done)({view}.panels[0].frame)")
    after = best(page)
    assert (row, col) not in set(map(tuple, after.tolist()))
    assert "Done" in page.inner_text(".words")
    assert "Exact plan: " in page.inner_text(".scene")


def test_a_reload_shows_the_same_map_ends_and_parameters(page):
    drag(page, (4, 10), (4, 14))
    page.fill("[data-parameter=ants]", "17")
    page.press("[data-parameter=ants]", "Tab")
    page.wait_for_function("() => location.hash.length > 10")
    page.wait_for_timeout(900)
    shown = "[view.scene.cells.join(''), view.chosen[0].parameters.ants, view.scene.start.join(), view.seed]"
    before = state(page, shown)
    assert before[1] == 17
    page.reload()
    page.wait_for_function("() => document.querySelector('#antnav').antnavView?.scene")
    assert state(page, shown) == before


def test_ends_are_dragged_and_moved_by_keys(page):
    start = state(page, "view.scene.start")
    drag(page, start, (10, 1), (9, 1))
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.start.join() === '9,1'")
    page.locator(".map").first.focus()
    page.keyboard.press("w")
    page.keyboard.press("ArrowDown")
    cursor = state(page, "view.cursor")
    page.keyboard.press("Enter")
    row, col = cursor
    page.wait_for_function(f"() => document.querySelector('#antnav').antnavView.scene.cells[{row * 20 + col}] === 1")
    page.keyboard.press("Space")
    page.wait_for_function("() => document.querySelector('.play').textContent === 'Pause'")


def test_a_dropped_file_becomes_the_map(page, tmp_path):
    array = np.zeros((30, 50), np.uint8)
    array[10:20, 25] = 1
    np.save(tmp_path / "wall.npy", array)
    page.set_input_files("input[type=file]", tmp_path / "wall.npy")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.cols === 50")
    assert "Shortest way" in page.inner_text(".scene")
    (tmp_path / "bad.png").write_bytes(b"no image")
    page.set_input_files("input[type=file]", tmp_path / "bad.png")
    page.wait_for_function("() => document.querySelector('.note').textContent.includes('bad.png')")


def test_what_is_seen_are_walls_path_and_two_halves(page):
    to_the_end(page)
    seen, grid = pixels(page), builtin("equiv20")
    size = seen.shape[0] / 20
    rows, cols = ((np.arange(20) + 0.5) * size).astype(int), ((np.arange(20) + 0.5) * size).astype(int)
    colours = seen[np.ix_(rows, cols)]
    walls = grid.cells == 1
    assert (colours[walls].max(axis=1) < 80).mean() > 0.95
    assert (colours[~walls].max(axis=1) > 120).mean() > 0.95
    on_path = tuple(best(page)[2:-2].T)
    near = colours[on_path]
    assert (np.abs(near - (213, 94, 0)).sum(axis=1) < 60).mean() > 0.7  # vermillion
    bluish = (seen[..., 2] - seen[..., 0] > 30) & (seen[..., 1] > seen[..., 0])
    purplish = (seen[..., 0] - seen[..., 1] > 15) & (seen[..., 2] - seen[..., 1] > 15)
    assert bluish.mean() > 0.005
    assert purplish.mean() > 0.005


@pytest.mark.parametrize(("width", "height", "dark"), [(360, 740, False), (1280, 900, True), (3840, 2160, False)])
def test_it_fits_phones_and_large_screens_by_day_and_night(browser, served, width, height, dark):
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme="dark" if dark else "light")
    page.goto(served.url)
    page.wait_for_function("() => document.querySelector('#antnav').antnavView?.scene")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    box = page.locator(".map").first.bounding_box()
    assert box["width"] >= 0.5 * min(width, height)
    assert box["y"] + box["height"] <= 1.1 * height
    apart = page.evaluate(
        """() => { const box = (name) => document.querySelector(name).getBoundingClientRect();
             const [words, side] = [box('.words'), box('.side')];
             return words.right <= side.left + 1 || words.bottom <= side.top + 1; }"""
    )
    assert apart
    background = page.evaluate("() => getComputedStyle(document.querySelector('.antnav')).backgroundColor")
    assert (background == "rgb(255, 255, 255)") is not dark
    page.close()


def test_two_algorithms_side_by_side(page):
    page.check(".compare")
    page.wait_for_function("() => document.querySelectorAll('.panel canvas.map').length === 2")
    to_the_end(page)
    titles = page.locator(".panel h2").all_inner_texts()
    assert titles == ["paco", "npaco"]
    assert len(page.locator(".words").all_inner_texts()[1]) > 20


def test_everything_is_named_for_those_who_hear_the_page(page):
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll('button, select, input:not([type=file]), canvas')].filter((one) =>
             !(one.labels?.length || one.textContent.trim() || one.ariaLabel || one.getAttribute('aria-label')))
             .map((one) => one.outerHTML)"""
    )
    assert unnamed == []


def test_map_picture_film_and_result_are_saved(page, tmp_path):
    found = {}
    for what in ("map", "picture"):
        with page.expect_download() as waiting:
            page.evaluate(f"() => document.querySelector('[data-save={what}]').click()")
        waiting.value.save_as(tmp_path / what)
        found[what] = (tmp_path / what).read_bytes()
    page.evaluate("() => document.querySelector('[data-save=film]').click()")
    page.wait_for_timeout(300)
    page.click(".play")
    page.wait_for_timeout(1200)
    to_the_end(page)
    for what in ("film", "result"):
        with page.expect_download() as waiting:
            page.evaluate(f"() => document.querySelector('[data-save={what}]').click()")
        waiting.value.save_as(tmp_path / f"{what}.json")
        found[what] = (tmp_path / f"{what}.json").read_bytes()
    assert found["map"].startswith(b"type octile")
    assert found["picture"].startswith(b"\x89PNG")
    assert found["film"].startswith(b"\x1a\x45\xdf\xa3")  # Matroska, of which WebM is a kind
    assert an.Result.load(tmp_path / "result.json").path is not None


def test_a_finger_draws_and_a_file_falls_on_the_page(browser, served, errors):
    page = browser.new_context(has_touch=True, viewport={"width": 390, "height": 800}).new_page()
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(served.url)
    page.wait_for_function("() => document.querySelector('#antnav').antnavView?.scene")
    grid = builtin("equiv20").cells
    row, col = next((row, col) for row, col in np.argwhere(grid == 0).tolist() if 5 < row < 15 and 5 < col < 15)
    page.touchscreen.tap(*at(page, row, col))
    page.wait_for_function(f"() => document.querySelector('#antnav').antnavView.scene.cells[{row * 20 + col}] === 1")
    page.evaluate(
        """() => {
          const files = new DataTransfer();
          files.items.add(new File(["0 0 0\\n0 1 0\\n0 0 0\\n0 0 0\\n"], "small.txt"));
          const dropped = new DragEvent("drop", { dataTransfer: files, bubbles: true });
          document.querySelector("#antnav").dispatchEvent(dropped);
        }"""
    )
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 4")
    assert errors == []
    page.context.close()


def test_when_the_server_has_gone_the_page_says_so(browser):
    served = Served("equiv20", "--algorithm", "npaco")
    page = browser.new_page()
    page.goto(served.url)
    page.wait_for_function("() => document.querySelector('#antnav').antnavView?.scene")
    served.end()
    page.wait_for_function("() => document.querySelector('.connection').textContent.includes('gone')")
    page.close()


def test_pause_halts_and_play_goes_on(page):
    page.select_option(".speed", "5")
    page.click(".play")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.panels[0].frame?.iteration > 0")
    page.click(".play")
    page.wait_for_function("() => document.querySelector('.play').textContent === 'Play'")
    iteration = state(page, "view.panels[0].frame.iteration")
    page.click(".play")
    page.wait_for_function(
        f"() => document.querySelector('#antnav').antnavView.panels[0].frame.iteration > {iteration}"
    )


def test_another_link_in_the_same_tab_and_back(page):
    page.select_option(".speed", "5")
    page.wait_for_function("() => location.hash.length > 10")
    page.wait_for_timeout(900)
    before = page.evaluate("() => location.hash")
    page.select_option(".maps", "equiv30")
    page.click(".load")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 30")
    page.wait_for_function(f"() => location.hash !== '{before}'")
    page.evaluate(f"() => {{ location.hash = '{before}'; }}")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 20")
    page.wait_for_timeout(900)
    page.go_back()
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 30")


def test_numbers_beyond_their_bounds_are_led_back_and_narrow_maps_fit(page):
    page.select_option(".maps", "empty")
    page.fill(".rows", "9999")
    page.fill(".cols", "")
    page.fill(".seed", "-4")
    page.click(".load")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 512")
    assert [page.input_value(name) for name in (".rows", ".cols", ".seed")] == ["512", "2", "0"]
    assert page.locator(".map").first.bounding_box()["height"] <= 2 * 900


def test_a_page_finds_the_server_that_has_come_back(browser):
    served = Served("equiv20", "--algorithm", "npaco")
    page = browser.new_page()
    page.goto(served.url)
    page.wait_for_function("() => location.hash.length > 10")
    page.wait_for_timeout(300)
    drag(page, (4, 10), (4, 14))
    before = page.evaluate("() => location.hash")
    page.wait_for_function(f"() => location.hash !== '{before}'")
    cells = state(page, "view.scene.cells.join('')")
    served.end()
    page.wait_for_function("() => document.querySelector('.connection').textContent.includes('gone')")
    served = Served("equiv30", "--algorithm", "npaco", "--port", served.host.rsplit(":", 1)[1])
    page.wait_for_function("() => document.querySelector('.connection').textContent === ''")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.rows === 20")
    assert state(page, "view.scene.cells.join('')") == cells
    page.close()
    served.end()


def test_of_two_ends_on_one_cell_the_pen_chosen_moves_its_own(page):
    start, goal = state(page, "[view.scene.start, view.scene.goal]")
    drag(page, goal, start)
    page.wait_for_function("() => document.querySelector('.scene').textContent.includes('same cell')")
    page.wait_for_function("() => document.querySelector('.words').textContent.includes('same cell')")
    page.click("[data-tool=goal]")
    drag(page, start, goal)
    page.wait_for_function("() => document.querySelector('.scene').textContent.includes('Shortest way')")
    assert state(page, "[view.scene.start, view.scene.goal]") == [start, goal]


def test_no_diagonal_move_passes_a_slanting_stroke(page):
    page.select_option(".maps", "empty")
    page.click(".load")
    page.wait_for_function("() => document.querySelector('#antnav').antnavView.scene.name === 'empty'")
    rows, cols = state(page, "[view.scene.rows, view.scene.cols]")
    drag(page, (rows - 1, 0), (0, cols - 1))  # across the way, from edge to edge
    page.wait_for_function("() => document.querySelector('.scene').textContent.includes('No way')")
    walls = np.array(state(page, "Array.from(view.scene.cells)")).reshape(rows, cols)
    assert walls.sum() < 2.5 * max(rows, cols)
