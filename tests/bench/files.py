"""MovingAI files made here: small maps with the lengths that antnav's exact search finds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import antnav as an
from antnav import maps
from antnav.search import exact

SIDE = 24


def write_map(folder: Path, name: str, kind: str = "rooms", seed: int = 1) -> an.GridMap:
    """A generated map as NAME.map."""
    folder.mkdir(parents=True, exist_ok=True)
    grid = maps.generate(kind, SIDE, SIDE, seed=seed)
    an.save_map(grid, folder / f"{name}.map")
    return grid


def write_scenarios(path: Path, grid: an.GridMap, count: int = 8, off: float = 0.0, map_field: str = "") -> list[float]:
    """Queries from the map's first end to free cells ever farther away, with their lengths + `off`."""
    start, _ = maps.ends(grid)
    field = exact.distance_field(an.Problem.from_cells(grid, start, start))
    reached = sorted((float(field[cell]), cell) for cell in zip(*(field < float("inf")).nonzero(), strict=True))
    chosen = [reached[round((index + 1) * (len(reached) - 1) / count)] for index in range(count)]
    path.write_text(_lines(map_field or path.name.removesuffix(".scen"), grid, start, chosen, off))
    return [length for length, _ in chosen]


def _lines(
    name: str, grid: an.GridMap, start: tuple[int, int], chosen: Sequence[tuple[float, tuple]], off: float
) -> str:
    rows = [
        f"0\t{name}\t{grid.cols}\t{grid.rows}\t{start[1]}\t{start[0]}\t{cell[1]}\t{cell[0]}\t{length + off:.6f}"
        for length, cell in chosen
    ]
    return "\n".join(["version 1", *rows]) + "\n"
