"""The problems on which rules are checked: small, and each with something that rules stumble over."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from antnav.costs import array
from antnav.maps.generators import ends, generate
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.problem import Problem

_DRAWN = {
    "open": "|".join(["." * 12] * 9),
    "corridor": "............",
    "zigzag": "......|#####.|......|.#####|......|#####.|......",
    "comb": "...........|.#.#.#.#.#.|.#.#.#.#.#.|.#.#.#.#.#.|##########.",
    "pocket": "#######....|#.....#....|#.###.#....|#.#.#.#....|###...#....|......#....|.##########|...........",
    "doors": "....#....|....#....|.........|....#....|####.####|....#....|.........|....#....|....#....",
}
_GENERATED = {
    "sparse": ("random", 16, 16, {"density": 0.1}),
    "blocks": ("random", 12, 14, {"density": 0.25}),
    "rooms": ("rooms", 15, 15, {}),
    "maze": ("maze", 15, 15, {}),
    "traps": ("u_traps", 16, 16, {}),
    "caves": ("caves", 16, 16, {}),
}


def drawn(text: str) -> NDArray[np.uint8]:
    """Cells of rows that are divided by bars: # is occupied, . free."""
    return np.array([[Cell.OCCUPIED if one == "#" else Cell.FREE for one in row] for row in text.split("|")], np.uint8)


def maps() -> Iterator[GridMap]:
    """A map of each sort."""
    for name, text in _DRAWN.items():
        yield GridMap(drawn(text), name=name)
    for name, (kind, rows, cols, options) in _GENERATED.items():
        yield GridMap(generate(kind, rows, cols, seed=4, **options).cells, name=name)


def problem_on(grid: GridMap, rule: CornerRule | str = "allow") -> Problem:
    """From one end of a map to the other."""
    return Problem.from_cells(grid, *ends(grid), corner_rule=rule)


def problems() -> Iterator[tuple[str, Problem]]:
    """All sorts, under each corner rule; with costs, turns and unknown cells; from a cell to itself; and cut off."""
    for grid in maps():
        for rule in CornerRule:
            yield f"{grid.name}, {rule}", problem_on(grid, rule)
    grid = next(maps())
    first, last = ends(grid)
    rng = np.random.default_rng(5)
    priced = array(rng.random(grid.shape) * 3)
    unknown = GridMap(np.where(rng.random(grid.shape) < 0.3, Cell.UNKNOWN, Cell.FREE).astype(np.uint8), name="unknown")
    yield "open with costs", Problem.from_cells(grid, first, last, cost=priced)
    yield "open with prices of turns", Problem.from_cells(grid, first, last, turning=1.0)
    yield "unknown cells", Problem.from_cells(unknown, *ends(unknown), allow_unknown=True)
    yield "start beside goal", Problem.from_cells(grid, first, (first[0], first[1] + 1))
    yield "start is goal", Problem.from_cells(grid, first, first)
    parted = drawn("...#...|...#...|...#...")
    yield "no path", Problem.from_cells(GridMap(parted, name="parted"), (0, 0), (0, 6))
