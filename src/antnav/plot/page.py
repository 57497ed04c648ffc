"""A film of replays as one HTML page that needs nothing else: maps, plans and times of replans, tick by tick."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from importlib.resources import files
from itertools import accumulate
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from antnav.live.update import MissionStatus
from antnav.markup import escaped, printable
from antnav.plot.film import Change, Drive, Film, Shade, check_replays, corners, film_of, status_text
from antnav.scenarios.comparison import HEADS, rows
from antnav.scenarios.model import Replay

MOST_PIXELS = 1024  #: Rows and columns of the map in the page.

_MARKS = {"trail": "robot, way driven", "plan": "plan", "goal": "goal"}
_SHADES = {
    Shade.BLOCKED: "blocked for now",
    Shade.PRICED: "dearer for now",
    Shade.OCCUPIED: "wall",
    Shade.INFLATED: "inflated or kept out",
    Shade.UNKNOWN: "unknown, not seen yet",
}


def page(replays: Replay | Sequence[Replay]) -> str:
    """The page."""
    given = check_replays(replays)
    film = film_of(given, MOST_PIXELS)
    scenario, grid = film.scenario, film.problem.grid
    place = printable(grid.name) or f"{grid.rows} x {grid.cols} cells"
    title = f"{scenario.name} on {place}, seed {scenario.seed}"
    content = msgspec.json.encode(data(film)).decode().replace("<", "\\u003c")
    aspect = film.shades.shape[1] / film.shades.shape[0]
    css, script = (files(__package__).joinpath(f"film.{ending}").read_text("utf-8") for ending in ("css", "js"))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escaped(title)}</title>
<style>{css}</style>
</head>
<body>
<h1>{escaped(title)}</h1>
<div id="controls">
<button id="play" type="button">Play</button>
<input id="tick" type="range" min="0" value="0" aria-label="Tick">
<span id="count"></span>
<label>Speed <select id="speed">
<option value="5">5 ticks/s</option><option value="20" selected>20 ticks/s</option>
<option value="60">60 ticks/s</option><option value="200">200 ticks/s</option>
</select></label>
</div>
<p class="note">Space plays and pauses, arrow keys go tick by tick, with Shift by ten.</p>
<main>
<div id="panels" style="--aspect: {aspect:.4f}; --least: {30 if len(given) % 2 else 40}%"></div>
<ul class="legend">{_legend(film)}</ul>
<p class="note">Bars: CPU time of each replan, at a logarithmic scale; a click goes there.</p>
{_table(given)}
</main>
<template id="panel"><section><h2></h2><canvas class="map" role="img"></canvas>
<canvas class="times" role="img"></canvas><p class="now"></p></section></template>
<noscript><p>The film needs JavaScript; the table does not.</p></noscript>
<script type="application/json" id="film">{content}</script>
<script type="module">
{script}</script>
</body>
</html>
"""


def _legend(film: Film) -> str:
    """The marks, and the shades that there are."""
    found = {*np.unique(film.shades).tolist(), *np.concatenate([change.shades for change in film.changes]).tolist()}
    found |= set() if film.scenario.sensor is None else {Shade.UNKNOWN}
    shades = {shade.name.lower(): text for shade, text in _SHADES.items() if shade in found}
    named = {**_MARKS, **shades}
    return "".join(f'<li><i style="background: var(--{name})"></i>{text}</li>' for name, text in named.items())


def data(film: Film) -> dict[str, Any]:
    """The film as JSON types; streams of numbers as base64 of `packed`."""
    words = sorted({status_text(tick) for drive in film.drives for tick in drive.ticks})
    times = [tick.seconds for drive in film.drives for tick in drive.ticks if tick.noticed]
    return {
        "rows": film.shades.shape[0],
        "cols": film.shades.shape[1],
        "block": film.block,
        "ticks": len(film),
        "seconds": film.scenario.seconds,
        "sensor": film.scenario.sensor,
        "radius": film.scenario.radius / film.problem.grid.resolution,
        "goal": film.problem.goal_cell,
        "words": words,
        "slowest": _microseconds(max(times, default=0.0)),
        "map": packed(_runs(film.shades.ravel())),
        "changes": packed(number for change in film.changes for number in _change(change)),
        "drives": [_drive(drive, words) for drive in film.drives],
    }


def _drive(drive: Drive, words: list[str]) -> dict[str, Any]:
    """Of times, -1 stands for a tick without a replan."""
    lengths = accumulate((tick.length for tick in drive.ticks), initial=0.0)
    return {
        "name": printable(drive.name),
        "arrived": drive.ticks[-1].status is MissionStatus.ARRIVED,
        "moves": np.diff(drive.passed, append=len(drive.way) - 1).tolist(),
        "status": [words.index(status_text(tick)) for tick in drive.ticks],
        "times": [_microseconds(tick.seconds) if tick.noticed else -1 for tick in drive.ticks],
        "cost": [round(tick.cost, 2) if math.isfinite(tick.cost) else None for tick in drive.ticks],
        "driven": [round(length, 2) for length, _ in zip(lengths, drive.ticks, strict=False)],
        "way": _cells(drive.way),
        "plans": [(tick, "" if plan is None else _cells(corners(plan))) for tick, plan in drive.plans],
    }


def _microseconds(seconds: float) -> int:
    return round(1e6 * seconds)


def packed(numbers: Iterable[int]) -> str:
    """Whole numbers from 0 as base64 text: seven bits a byte, lowest first, the eighth says that more follow."""
    stream = bytearray()
    for number in numbers:
        rest = number
        while rest > 127:
            stream.append(rest & 127 | 128)
            rest >>= 7
        stream.append(rest)
    return base64.b64encode(stream).decode()


def _cells(cells: NDArray[np.int32]) -> str:
    """Rows and columns, each as the difference to the one before, zigzag."""
    steps = np.diff(cells.astype(np.int64), axis=0, prepend=[(0, 0)])
    return packed(np.where(steps < 0, -2 * steps - 1, 2 * steps).ravel().tolist())


def _runs(shades: NDArray[np.uint8]) -> list[int]:
    """Runs of equal shades: 8 times their length, plus the shade."""
    starts = np.flatnonzero(np.diff(shades, prepend=255))
    found: list[int] = (np.diff(starts, append=len(shades)) * 8 + shades[starts]).tolist()
    return found


def _change(change: Change) -> Iterable[int]:
    """How many runs there are; of each the pixels since the run before, and 8 times its length, plus its shade."""
    pixels, shades = change
    if not len(pixels):
        return [0]
    breaks = (np.diff(pixels) != 1) | (np.diff(shades) != 0)
    starts = np.concatenate(([0], np.flatnonzero(breaks) + 1))
    lengths = np.diff(starts, append=len(pixels))
    gaps = pixels[starts] - np.concatenate(([0], (pixels[starts] + lengths)[:-1]))
    return [len(starts), *np.stack((gaps, 8 * lengths + shades[starts]), axis=-1).ravel().tolist()]


def _table(replays: Sequence[Replay]) -> str:
    """What was measured, a row for each robot."""
    heads = "".join(f'<th scope="col">{escaped(head).replace(" %", "&nbsp;%")}</th>' for head in HEADS)
    body = "\n".join(
        f'<tr><th scope="row">{escaped(row[0])}</th>'
        + "".join(f"<td>{escaped(cell)}</td>" for cell in row[1:])
        + "</tr>"
        for row in rows(replays)
    )
    return (
        f'<div class="scroll" tabindex="0"><table><thead><tr>{heads}</tr></thead>\n<tbody>{body}</tbody></table></div>'
    )
