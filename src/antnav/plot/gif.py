"""A film of replays as GIF: every frame rasterised at once, robots side by side, one palette for all."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.markup import printable
from antnav.plot.film import COLOURS, VEILED, Drive, Film, check_replays, film_of, status_text
from antnav.plot.style import GREEN, INK, PURPLE, VERMILLION
from antnav.scenarios.model import Replay
from antnav.world.problem import CellIndex

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

MOST_PIXELS = 800  #: Width and height of a map.
MOST_TOGETHER = 1200  #: Width and height of several together.
MOST_FRAMES = 240  #: Of longer replays, every second tick or every third ...
LARGEST_CELL = 24
NARROWEST = 250  #: Of a robot's panel, in pixels: its caption takes so much.
CAPTION = 42
MARGIN = 8

_GREYS = 8  #: Between paper and ink, for letters.
_SHADES = len(COLOURS)
TRAIL, PLAN, GOAL, EDGE, PAPER = (2 * _SHADES + number for number in range(5))


def _colour(text: str) -> list[int]:
    return list(bytes.fromhex(text[1:]))


def palette() -> list[int]:
    """Red, green and blue of each index of a frame: shades, veiled shades, marks, greys from paper to ink."""
    marks = [_colour(text) for text in (GREEN, VERMILLION, PURPLE, INK)]
    greys = np.linspace((255, 255, 255), _colour(INK), _GREYS).astype(int).tolist()
    return [part for colour in (*COLOURS.tolist(), *VEILED.tolist(), *marks, *greys) for part in colour]


def gif(replays: Replay | Sequence[Replay]) -> bytes:
    """The film as a GIF."""
    given = check_replays(replays)
    columns, side = arranged(len(given), given[0].problem.grid.shape)
    film = film_of(given, most=side)
    step = -(-len(film) // MOST_FRAMES)
    first, *others = _frames(film, side, columns, step)
    count = 1 + len(others)
    durations = [int(min(max(20_000 / count, 40), 150) // 10 * 10)] * (count - 1)
    content = io.BytesIO()
    times: dict[str, Any] = {"duration": [*durations, 2500], "loop": 0}
    first.save(content, "GIF", save_all=True, append_images=others, optimize=False, disposal=1, **times)
    return content.getvalue()


def arranged(count: int, shape: tuple[int, int]) -> tuple[int, int]:
    """How many maps to set side by side so that they get largest, and the pixels of a map's longer side then."""
    most = MOST_PIXELS if count == 1 else MOST_TOGETHER
    scales = {
        columns: min(most / (columns * shape[1]), most / (-(-count // columns) * shape[0]))
        for columns in range(1, count + 1)
    }
    columns = max(scales, key=lambda columns: (scales[columns], columns))
    return columns, min(max(int(scales[columns] * max(shape)), 1), MOST_PIXELS)


def _frames(film: Film, side: int, columns: int, step: int) -> Iterator[Image]:
    from PIL import Image

    panels = [_Panel(film, drive, side) for drive in film.drives]
    colours = palette()
    for tick, shades in enumerate(film.pictures()):
        for panel in panels:
            panel.look(tick)
        if tick % step == 0 or tick == len(film) - 1:
            pictures = [panel.picture(tick, shades) for panel in panels]
            pictures += [np.full_like(pictures[0], PAPER)] * (-len(panels) % columns)
            rows = [np.hstack(pictures[at : at + columns]) for at in range(0, len(pictures), columns)]
            frame = Image.fromarray(np.vstack(rows), "P")
            frame.putpalette(colours)
            yield frame


class _Panel:
    """One robot's part of each frame."""

    def __init__(self, film: Film, drive: Drive, side: int) -> None:
        self.film, self.drive = film, drive
        rows, cols = film.shades.shape
        self.scale = min(max(side // max(rows, cols), 1), LARGEST_CELL)
        self.height, self.width = rows * self.scale, cols * self.scale
        self.seen = np.zeros(film.shades.shape, bool)
        self.plans = dict(drive.plans)
        self.plan: NDArray[np.int32] | None = None
        self.began = 0  # of the plan: where in the way

    def look(self, tick: int) -> None:
        if tick < len(self.drive.ticks):
            self.film.look(self.seen, (self.drive.ticks[tick].row, self.drive.ticks[tick].col))
            if tick in self.plans:
                self.plan, self.began = self.plans[tick], int(self.drive.passed[tick])

    def picture(self, tick: int, shades: NDArray[np.uint8]) -> NDArray[np.uint8]:
        from PIL import Image, ImageDraw

        drive, number = self.drive, min(tick, len(self.drive.ticks) - 1)
        indices = np.where(self.seen, shades, shades + np.uint8(_SHADES))
        image = Image.fromarray(indices.repeat(self.scale, axis=0).repeat(self.scale, axis=1), "P")
        draw = ImageDraw.Draw(image)
        width = max(2, min(self.scale // 4, 5))
        place = int(drive.passed[number])
        if self.plan is not None:
            self._line(draw, self.plan[place - self.began :], PLAN, width)
        self._line(draw, drive.way[: place + 1], TRAIL, width)
        size = max(4.0, 0.42 * self.scale)
        self._mark(draw, self.film.problem.goal_cell, GOAL, size, square=True)
        radius = self.film.scenario.radius / self.film.problem.grid.resolution / self.film.block * self.scale
        self._mark(draw, (drive.ticks[number].row, drive.ticks[number].col), TRAIL, max(size, radius))
        whole = Image.new("P", (max(self.width, NARROWEST) + 2 * MARGIN, self.height + CAPTION + MARGIN), PAPER)
        whole.paste(self._caption(tick, number, whole.width), (0, 0))
        whole.paste(image, ((whole.width - self.width) // 2, CAPTION))
        return np.asarray(whole)

    def _places(self, cells: NDArray[np.int32]) -> NDArray[np.float64]:
        """Middles of cells, x and y in pixels."""
        places: NDArray[np.float64] = (cells[:, ::-1] + 0.5) * (self.scale / self.film.block)
        return places

    def _line(self, draw: ImageDraw, cells: NDArray[np.int32], colour: int, width: int) -> None:
        if len(cells) > 1:
            draw.line(self._places(cells).ravel().tolist(), fill=colour, width=width)

    def _mark(self, draw: ImageDraw, cell: CellIndex, colour: int, size: float, *, square: bool = False) -> None:
        ((x, y),) = self._places(np.array([cell], np.int32)).tolist()
        shape = draw.rectangle if square else draw.ellipse
        shape((x - size, y - size, x + size, y + size), fill=colour, outline=EDGE)

    def _caption(self, tick: int, number: int, width: int) -> Image:
        """Two lines of letters in greys of the palette."""
        from PIL import Image, ImageDraw, ImageFont

        now, missing = self.drive.ticks[number], tick - number
        replanned = f", replanned in {1e3 * now.seconds:.2g} ms" if now.noticed and not missing else ""
        mask = Image.new("L", (width, CAPTION), 0)
        draw, font = ImageDraw.Draw(mask), ImageFont.load_default(13)
        draw.text((MARGIN, 4), f"{printable(self.drive.name, 24)}, tick {tick}", fill=255, font=font)
        draw.text((MARGIN, 22), f"{status_text(now)}{replanned}", fill=255, font=font)
        greys = np.asarray(mask).astype(np.int64) * (_GREYS - 1) // 255
        return Image.fromarray((PAPER + greys).astype(np.uint8), "P")
