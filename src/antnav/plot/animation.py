"""Films of ants at work: GIF, WebP, MP4, and a page with a slider."""

from __future__ import annotations

import base64
import io
import math
import os
import shutil
import subprocess
import tempfile
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.ants.algorithm import Algorithm
from antnav.errors import OutputError, ParameterError, check_type
from antnav.files import as_path, write_whole
from antnav.markup import escaped, printable
from antnav.plan.solve import checked
from antnav.plan.warmup import warmup
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.planner.view import Fate
from antnav.plot.ants import Seen, Watched
from antnav.plot.data import costs, map_colours
from antnav.plot.style import BLUE, FAINT, GREEN, INK, PURPLE, VERMILLION
from antnav.search.exact import optimum
from antnav.values import whole_in
from antnav.world.problem import CellIndex, Problem

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

FILMS = ("gif", "webp", "mp4", "html")
#: Pixels of the map's longer side, and of a cell, at most; pixels of a frame's width at least.
MOST_PIXELS, LARGEST_CELL, NARROWEST = 560, 28, 420
#: Frames at most, and those in which the ants of one iteration walk.
MOST_FRAMES, WALK = 300, 14
#: Milliseconds of a frame, of one with many iterations around it, and of the last.
SLOW, FAST, LAST = 80, 120, 3000
#: How WebP keeps frames: without loss, which takes a third of what a good quality with losses does on even colours.
SHARP: dict[str, Any] = {"lossless": True, "method": 2, "quality": 50}
GIF_COLOURS = 128
CAPTION, CHART, MARGIN = 106, 70, 10
#: Lines of the caption, and letters of each.
LINES, LETTERS = 6, 68
#: Shades of the colonies' pheromone at its most: on the start's side, on the goal's.
HUES = np.array([bytes.fromhex(BLUE[1:]), bytes.fromhex(PURPLE[1:])]).view(np.uint8).reshape(2, 3)
STRENGTH = 0.75
_ANTS = ("#003f66", "#7d2f5a")
_DEAD = "#9b1c1c"


class Moment(NamedTuple):
    """A frame to be drawn: what is seen, how far the ants have walked, 0 to 1, and for how many milliseconds."""

    seen: Seen
    walked: float
    milliseconds: int


class Animation:
    """A run as a film. Made by `animate`.

    Attributes
    ----------
    result : Result
        What `solve` returns for that problem, algorithm and seed.
    moments : list of Moment
    """

    def __init__(self, watched: Watched, moments: list[Moment], shortest: float) -> None:
        assert watched.result is not None
        self.result: Result = watched.result
        self.moments = moments
        self._painter = _Painter(self.result, watched.rows, shortest)

    def __repr__(self) -> str:
        return f"Animation({self.result.algorithm.name}, {len(self.moments)} frames)"

    def _repr_html_(self) -> str:
        return _player(self)

    def frames(self) -> Iterator[Image]:
        """The frames, as RGB images."""
        yield from map(self._painter.picture, self.moments)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the film, whole or not at all.

        Parameters
        ----------
        path : path-like
            Ends in .gif, .webp, .html (a page with a slider that needs nothing else) or .mp4 (needs ffmpeg).

        Raises
        ------
        ParameterError
            Another ending; there is no ffmpeg.
        OutputError
            The file cannot be written.
        """
        ending = check_ending(path)
        writers = {"gif": _gif, "webp": _webp, "mp4": _mp4}
        write_whole(path, _page(self).encode() if ending == "html" else writers[ending](self))


def check_ending(path: str | os.PathLike[str]) -> str:
    """The ending of a film's file.

    Raises
    ------
    ParameterError
        It is none of a film; there is no ffmpeg for .mp4.
    """
    name = as_path(path).name
    ending = as_path(path).suffix.lower().removeprefix(".")
    if ending not in FILMS:
        raise ParameterError(f"file name {name}", f"films end in .{', .'.join(FILMS)}", "choose one of them")
    if ending == "mp4" and shutil.which("ffmpeg") is None:
        raise ParameterError(f"file name {name}", "there is no ffmpeg here", "install it, or choose .webp or .gif")
    return ending


def animate(problem: Problem, algorithm: Planner | None = None, *, seed: int = 0, walks: int = 2) -> Animation:
    """Let ants run and film them: walks, dead ends, pheromone, best paths, both halves of PACO.

    Parameters
    ----------
    problem : Problem
    algorithm : Algorithm, optional
        A preset such as `paco()` (default).
    seed : int
        0 <= seed < 2**64.
    walks : int
        Iterations of each stage, 0 to 20, in which ants are seen walking; the others are a frame each.

    Returns
    -------
    Animation
        With `save("film.gif")`, shown in notebooks.

    Raises
    ------
    ParameterError
        A parameter is out of range, the algorithm has no ants, or no way leads from start to goal.

    Examples
    --------
    ::

        an.animate(problem, an.paco(), seed=7).save("paco.gif")
    """
    planner = checked(problem, algorithm, seed)
    check_type("algorithm", planner, Algorithm, "call a preset, as in an.paco(): films are of ants")
    walks = whole_in("walks", walks, 0, 20)
    if not problem.connected or problem.start_cell == problem.goal_cell:
        raise ParameterError("a film", "no ant has a way to go from the start to the goal", "move one of them")
    warmup(planner)
    shortest = optimum(problem).cost
    watched = Watched(problem, planner, seed)
    moments = [moment for one, slow in _seen(watched, shortest, walks) for moment in _moments(one, slow)]
    return Animation(watched, moments, shortest)


def _seen(watched: Watched, shortest: float, walks: int) -> list[tuple[Seen, bool]]:
    """What is shown of a run, and whether its ants walk: of long runs every second, fourth, ... iteration is kept."""
    kept, step, number, stage, slow = list[tuple[int, Seen, bool]](), 1, 0, None, 0
    while not watched.done:
        watched.advance(1, math.inf)
        before, stage = stage, watched.step.stage if watched.step else None
        slow = walks if stage != before else slow - 1
        if slow > 0 or watched.done or number % step == 0:
            kept.append((number, watched.seen(shortest), slow > 0))
        if len(kept) > MOST_FRAMES:
            step *= 2
            kept = [one for one in kept if one[2] or one[1].done or one[0] % step == 0]
        number += 1
    return [(one, walking) for _, one, walking in kept]


def _moments(one: Seen, slow: bool) -> list[Moment]:
    if slow and one.ants and not one.done:
        return [Moment(one, (part + 1) / WALK, SLOW) for part in range(WALK)]
    return [Moment(one, 1.0, LAST if one.done else FAST)]


class _Painter:
    """Draws frames of one run."""

    def __init__(self, result: Result, rows: list[list[float | None]], shortest: float) -> None:
        self._result, self._rows, self._shortest = result, rows, shortest
        grid = result.problem.grid
        self._colours = map_colours(grid, costs(result.problem))
        self._open = result.problem.passable
        self._block = max(1, -(-max(grid.shape) // MOST_PIXELS))
        self._scale = max(1, min(MOST_PIXELS // max(grid.shape), LARGEST_CELL))
        self._height, self._width = (-(-side // self._block) * self._scale for side in grid.shape)
        wide = max(self._width, NARROWEST) + 2 * MARGIN
        self._size = wide + wide % 2, (tall := CAPTION + self._height + CHART + MARGIN) + tall % 2  # even, for MP4
        self._left = (self._size[0] - self._width) // 2

    def picture(self, moment: Moment) -> Image:
        """A frame."""
        from PIL import Image, ImageDraw, ImageFont

        seen = moment.seen
        whole = Image.new("RGB", self._size, "white")
        whole.paste(Image.fromarray(self._map(seen)), (self._left, CAPTION))
        draw = ImageDraw.Draw(whole)
        thick = max(2, self._scale // 5)
        if not seen.done:
            self._ants(draw, seen, moment.walked, max(1.5, self._scale * 0.16))
        for cells in seen.bests:
            self._line(draw, cells, "white", thick + 3)
            self._line(draw, cells, VERMILLION, thick)
        size = max(4.0, 0.36 * self._scale)
        if seen.auxiliary is not None:
            self._diamond(draw, seen.auxiliary, 1.5 * size)
        problem = self._result.problem
        for cell, letter in ((problem.start_cell, "S"), (problem.goal_cell, "G")):
            self._mark(draw, cell, letter, size + 2)
        lines = [f"{printable(self._result.algorithm.name)}, seed {self._result.seed}"]
        lines += [line for words in seen.words for line in textwrap.wrap(words, LETTERS)]
        for number, line in enumerate(lines[:LINES]):
            font = ImageFont.load_default(13)
            draw.text((MARGIN, 6 + 16 * number), line, fill=INK if number else BLUE, font=font)
        self._chart(draw, seen)
        return whole

    def _map(self, seen: Seen) -> NDArray[np.uint8]:
        colours = self._colours.astype(np.float32)
        for hue, shades in zip(HUES, seen.heat, strict=True):
            if shades.size:
                share = (STRENGTH / 255) * np.where(self._open, shades, 0)[..., None]
                colours += (hue - colours) * share
        pixels = np.rint(colours).astype(np.uint8)
        if self._block > 1:
            for axis in (0, 1):
                pixels = np.minimum.reduceat(pixels, np.arange(0, pixels.shape[axis], self._block), axis=axis)
        return pixels.repeat(self._scale, axis=0).repeat(self._scale, axis=1)

    def _places(self, cells: NDArray[Any]) -> list[tuple[float, float]]:
        """Middles of cells, x and y in pixels."""
        places = (cells[:, ::-1] + 0.5) * (self._scale / self._block) + (self._left, CAPTION)
        return [(x, y) for x, y in places.tolist()]

    def _line(self, draw: ImageDraw, cells: NDArray[Any], colour: str, width: int) -> None:
        if len(cells) > 1:
            draw.line(self._places(cells), fill=colour, width=width, joint="curve")

    def _ants(self, draw: ImageDraw, seen: Seen, walked: float, size: float) -> None:
        at, longest = 0, max((count for _, _, count in seen.ants), default=1)
        for side, fate, count in seen.ants:
            head = min(round(walked * (longest - 1)), count - 1)
            walk = seen.walks[at : at + count]
            at += count
            self._line(draw, walk[max(0, head - 5) : head + 1], _ANTS[side], 1)
            ((x, y),) = self._places(walk[head : head + 1])
            draw.ellipse((x - size, y - size, x + size, y + size), fill=_ANTS[side])
            if fate == Fate.DEAD and head == count - 1:
                self._cross(draw, x, y, 1.8 * size)
        if walked == 1.0:
            for x, y in self._places(seen.dead):
                self._cross(draw, x, y, 1.8 * size)

    def _cross(self, draw: ImageDraw, x: float, y: float, arm: float) -> None:
        for sign in (-1, 1):
            draw.line((x - arm, y - sign * arm, x + arm, y + sign * arm), fill=_DEAD, width=2)

    def _diamond(self, draw: ImageDraw, cell: CellIndex, size: float) -> None:
        ((x, y),) = self._places(np.array([cell]))
        points = [(x, y - size), (x + size, y), (x, y + size), (x - size, y)]
        draw.polygon(points, fill="white", outline=VERMILLION, width=2)

    def _mark(self, draw: ImageDraw, cell: CellIndex, letter: str, size: float) -> None:
        from PIL import ImageFont

        ((x, y),) = self._places(np.array([cell]))
        shape = draw.ellipse if letter == "S" else draw.rectangle
        shape((x - size, y - size, x + size, y + size), fill="white", outline=INK, width=2)
        draw.text((x, y), letter, fill=INK, font=ImageFont.load_default(1.5 * size), anchor="mm")

    def _chart(self, draw: ImageDraw, seen: Seen) -> None:
        """Best and mean by iteration, so far, and the optimum."""
        from PIL import ImageFont

        known = [value for row in self._rows for value in row[:2] if value is not None]
        if not known or not math.isfinite(self._shortest):
            return
        least, most = min(self._shortest, *known), max(known)
        left, right = 60, self._size[0] - MARGIN
        top, floor = CAPTION + self._height + 14, self._size[1] - 16
        high = (most - least) or 1.0

        def place(number: int, value: float) -> tuple[float, float]:
            share = (number + 0.5) / len(self._rows)
            return left + (right - left) * share, floor - (floor - top) * (value - least) / high

        level = place(0, self._shortest)[1]
        draw.line((left, level, right, level), fill=GREEN, width=1)
        for column, colour, width in ((1, FAINT, 1), (0, VERMILLION, 2)):
            shown = enumerate(self._rows[: seen.iteration])
            points = [place(number, value) for number, row in shown if (value := row[column]) is not None]
            if len(points) > 1:
                draw.line(points, fill=colour, width=width)
        font = ImageFont.load_default(11)
        for value, y in ((most, top), (least, floor)):
            draw.text((left - 6, y), f"{value:.1f}", fill=FAINT, font=font, anchor="rm")
        for text, colour, x in (("best", VERMILLION, left), ("mean", FAINT, left + 40), ("optimum", GREEN, left + 84)):
            draw.text((x, floor + 9), text, fill=colour, font=font, anchor="lm")


def _gif(film: Animation) -> bytes:
    """One palette for all frames, of those that have most colours: the middle one and the last."""
    from PIL import Image

    some = [np.asarray(film._painter.picture(film.moments[at])) for at in (len(film.moments) // 2, -1)]
    palette = Image.fromarray(np.vstack(some)).quantize(GIF_COLOURS, Image.Quantize.MEDIANCUT)
    first, *others = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in film.frames())
    content = io.BytesIO()
    first.save(content, "GIF", save_all=True, append_images=others, loop=0, optimize=True, disposal=1, **_times(film))
    return content.getvalue()


def _webp(film: Animation) -> bytes:
    content = io.BytesIO()
    first, *others = film.frames()
    first.save(content, "WEBP", save_all=True, append_images=others, loop=0, **SHARP, **_times(film))
    return content.getvalue()


def _times(film: Animation) -> dict[str, Any]:
    return {"duration": [moment.milliseconds for moment in film.moments]}


def _mp4(film: Animation) -> bytes:
    """Twenty-five frames a second, each moment as often as it lasts."""
    first = next(film.frames())
    with tempfile.TemporaryDirectory(prefix="antnav-film-") as folder:
        source, target = Path(folder, "frames.rgb"), Path(folder, "film.mp4")
        with source.open("wb") as stream:
            for frame, moment in zip(film.frames(), film.moments, strict=True):
                stream.write(frame.tobytes() * max(1, moment.milliseconds // 40))
        raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{first.width}x{first.height}", "-r", "25"]
        coded = ["-an", "-vcodec", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        command = ["ffmpeg", "-loglevel", "error", "-nostdin", *raw, "-i", str(source), *coded, str(target)]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            told = done.stderr.strip().splitlines() or ["it failed"]
            raise OutputError("the film", f"ffmpeg: {told[-1]}", "choose .webp")
        return target.read_bytes()


_SCRIPT = """
for (const root of document.querySelectorAll("[data-antnav-film]:not([data-on])")) {
  root.dataset.on = "1";
  const film = JSON.parse(root.querySelector("script").textContent), image = root.querySelector("img");
  const slider = root.querySelector("input"), button = root.querySelector("button");
  let at = 0, timer = null;
  const show = (number) => {
    at = slider.value = number;
    image.src = `data:image/webp;base64,${film.frames[number]}`;
    slider.setAttribute("aria-valuetext", film.words[number]);
    image.alt = film.words[number];
  };
  const stop = () => { clearTimeout(timer); timer = null; button.textContent = "Play"; };
  const next = () => {
    if (at + 1 === film.frames.length) return stop();
    show(at + 1);
    timer = setTimeout(next, film.times[at]);
  };
  button.onclick = () => {
    if (timer) return stop();
    if (at + 1 === film.frames.length) show(0);
    button.textContent = "Pause";
    timer = setTimeout(next, film.times[at]);
  };
  slider.max = film.frames.length - 1;
  slider.oninput = () => { stop(); show(Number(slider.value)); };
  show(0);
}
"""


def _player(film: Animation) -> str:
    """Frames, a slider and a button, as a piece of HTML that needs nothing else."""
    frames = list[str]()
    for frame in film.frames():
        content = io.BytesIO()
        frame.save(content, "WEBP", **SHARP)
        frames.append(base64.b64encode(content.getvalue()).decode())
    data = {
        "frames": frames,
        "times": [moment.milliseconds for moment in film.moments],
        "words": [" ".join(moment.seen.words) for moment in film.moments],
    }
    content_text = msgspec.json.encode(data).decode().replace("<", "\\u003c")
    return f"""<div data-antnav-film style="max-width:40rem">
<img alt="" style="width:100%;height:auto;background:#fff">
<div style="display:flex;gap:.6rem"><button type="button" style="min-width:5rem">Play</button>
<input type="range" min="0" value="0" step="1" aria-label="Frame" style="flex:1"></div>
<script type="application/json">{content_text}</script>
<script>{_SCRIPT}</script></div>"""


def _page(film: Animation) -> str:
    title = escaped(f"{film.result.algorithm.name} on {film.result.problem.grid.name or 'a map'}")
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title></head>
<body style="font:16px/1.5 system-ui,sans-serif;margin:1rem;color-scheme:light dark">
<h1 style="font-size:1.2rem">{title}</h1>
{_player(film)}
</body></html>
"""
