"""The view in headless Chromium: frames a second, and how soon an action is answered.

    python benchmarks/bench_view.py [--seconds 5]

Needs the extra antnav[view], playwright and Chromium. Frames are those that the page has drawn, each after a packet of
the server; an action is a stroke, answered when its scene has been drawn.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

from antnav import maps

VIEW = "document.querySelector('#antnav').antnavView"
COUNTS = f"() => [{VIEW}.frames, {VIEW}.packets]"
STROKE = """(cell) => new Promise((done) => {
  const view = document.querySelector('#antnav').antnavView, see = view.see.bind(view), began = performance.now();
  view.see = (scene) => { see(scene); view.see = see; requestAnimationFrame(() => done(performance.now() - began)); };
  view.apply('wall', [cell]);
})"""


def measured(page: Page, seconds: float) -> tuple[float, ...]:
    """Frames a second at full speed, drawn and from the server; drawn at a walk; ms of strokes: median, largest."""
    page.wait_for_function(f"() => {VIEW}?.scene")
    rates = []
    for speed in ("0", "2"):
        page.select_option(".speed", speed)
        page.click(".restart")
        page.wait_for_timeout(300)
        page.click(".play")
        page.wait_for_timeout(300)
        drawn, sent = page.evaluate(COUNTS)
        page.wait_for_timeout(1000 * seconds)
        after = page.evaluate(COUNTS)
        rates += [(after[0] - drawn) / seconds] + ([(after[1] - sent) / seconds] if speed == "0" else [])
        if page.inner_text(".play") == "Pause":
            page.click(".play")
    rows, cols = page.evaluate(f"() => [{VIEW}.scene.rows, {VIEW}.scene.cols]")
    page.click(".play")
    times = []
    for number in range(25):
        cell = [rows // 4 + number % 5, cols // 3 + number]
        times.append(page.evaluate(STROKE, cell))
        page.wait_for_timeout(250)
    return (*rates, statistics.median(times), max(times))


def main() -> None:
    """Print a row a map."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0)
    seconds = parser.parse_args().seconds
    print("| map | drawn/s, full speed | sent/s | drawn/s, two iterations a second | stroke, ms: median | largest |")
    print("|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as program:
        browser = program.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for side in (40, 100, 256, 512):
            grid = maps.generate("random", side, side, seed=1, density=0.2)
            path = Path(folder, f"random{side}.npy")
            maps.save_map(grid, path)
            options = ["--no-browser", "--port", "0", "-q", "--algorithm", "paco"]
            command = [sys.executable, "-m", "antnav", "view", str(path), *options]
            with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
                assert server.stdout is not None
                page = browser.new_page(viewport={"width": 1280, "height": 900})
                page.goto(server.stdout.readline().strip())
                page.wait_for_function(f"() => {VIEW}?.scene")
                page.fill("[data-parameter=iterations]", "9999")
                page.press("[data-parameter=iterations]", "Tab")
                figures = measured(page, seconds)
                page.close()
                server.terminate()
            print(f"| {side} x {side} | " + " | ".join(f"{figure:.1f}" for figure in figures) + " |", flush=True)
        browser.close()


if __name__ == "__main__":
    main()
