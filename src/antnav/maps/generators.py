"""Maps drawn from a seed: the same cells for the same arguments on every machine."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection
from itertools import pairwise

import numpy as np

from antnav.errors import MapError, ParameterError, check_type, shown
from antnav.maps.drawing import Cells, check_count, check_share, join_corners
from antnav.maps.warehouse import warehouse
from antnav.world.grid import Cell, GridMap, check_size

_SEEDS = 2**128  # more than `Colony` takes; beyond some length a number cannot be printed


def generate(kind: str, rows: int, cols: int, seed: int = 0, **options: float) -> GridMap:
    """Draw a map.

    Whatever the kind, two cells near the top left and the bottom right corner are free and joined by moves in four
    directions: (0, 0) and (rows - 1, cols - 1) for `random` and `u_traps`; the first and the last cell inside the outer
    walls for the others. Where the drawing does not join them, the fewest possible cells between them are opened.

    Parameters
    ----------
    kind : {"random", "rooms", "maze", "caves", "u_traps", "warehouse"}
        What to draw.
    rows, cols : int
        Size in cells.
    seed : int
        >= 0, for `numpy.random.default_rng`.
    **options
        Those of the kind:

        ========= ====================================================================================================
        random    `density` 0.3, share of occupied cells; `block` 1, side of the square obstacles in cells, at most the
                  map's longer side
        rooms     `room` 8, least side of a room; `door` 2, width of the doors; `closed` 0.2, share of walls without
        maze      `passage` 1 and `wall` 1, widths; `loops` 0, share of the inner walls taken away
        caves     `density` 0.45, share of rock before smoothing; `steps` 5, smoothing steps
        u_traps   `traps` 0, number of U shapes open to the top or left, at most as many as could fit; `size` 0, their
                  longest side; 0: by the area
        warehouse `aisle` 0, width in cells, 0: by the shorter side; `clutter` 0.5, chance of each pallet
        ========= ====================================================================================================

    Returns
    -------
    GridMap
        Resolution 1, origin (0, 0, 0).

    Raises
    ------
    ParameterError
        Unknown kind or option, a value out of range, or a map too small for its options.
    MapSizeError
        The map would be too large.
    """
    check_options(kind, options)
    rows, cols, seed = check_count("rows", rows, 1), check_count("cols", cols, 1), check_count("seed", seed, 0, _SEEDS)
    check_size(rows, cols, f"the {kind} map")
    draw = _KINDS[kind]
    cells = draw(rows, cols, np.random.default_rng(seed), **options)
    return GridMap(cells, name=f"{kind} {rows}x{cols} seed {seed}")


def check_options(kind: str, options: Collection[str]) -> None:
    """Refuse an unknown kind, and a name that is none of its options.

    Raises
    ------
    ParameterError
        With the kinds, or with the options and their defaults.
    """
    if not isinstance(kind, str) or kind not in _KINDS:
        raise ParameterError(f"kind {shown(kind)}", f"there are {', '.join(_KINDS)}", "choose one of them")
    entries = inspect.signature(_KINDS[kind]).parameters.values()
    known = {entry.name: entry.default for entry in entries if entry.kind is entry.KEYWORD_ONLY}
    for name in options:
        if name not in known:
            offered = ", ".join(f"{key}={value}" for key, value in known.items())
            raise ParameterError(f"option {name!r} of {kind}", f"its options are {offered}", "correct the name")


def generator_names() -> tuple[str, ...]:
    """Kinds that `generate` takes."""
    return tuple(_KINDS)


def ends(grid: GridMap) -> tuple[tuple[int, int], tuple[int, int]]:
    """Two free cells far apart, joined by moves in four directions: a start and a goal for any map.

    Of the largest free region, the two cells farthest apart along the one diagonal of the map or the other; of
    equals, the first from the top left.

    Returns
    -------
    start, goal : tuple of 2 ints
        (row, col). Equal if the largest region is one cell.

    Raises
    ------
    MapError
        The map has no free cell.
    """
    from scipy import ndimage

    check_type("grid", grid, GridMap, "make one of the array first")
    labels, count = ndimage.label(grid.passable())
    if not count:
        raise MapError("a map without free cells", "a start and a goal are free cells", "use another map")
    largest = np.argmax(np.bincount(labels.ravel())[1:]) + 1
    rows, cols = np.nonzero(labels == largest)
    found = []
    for rank in (rows + cols, cols - rows):
        first, last = np.argmin(rank), np.argmax(rank)
        found.append((int(rank[last] - rank[first]), first, last))
    _, first, last = max(found, key=lambda entry: entry[0])
    return (int(rows[first]), int(cols[first])), (int(rows[last]), int(cols[last]))


def random_blocks(rows: int, cols: int, rng: np.random.Generator, *, density: float = 0.3, block: int = 1) -> Cells:
    """Occupy squares of a lattice, each by chance."""
    share, block = check_share("density", density), check_count("block", block, 1, max(rows, cols))
    draws = rng.integers(0, 1000, (-(-rows // block), -(-cols // block)))
    squares = (draws < share).astype(np.uint8)
    cells: Cells = squares.repeat(block, axis=0).repeat(block, axis=1)[:rows, :cols].copy()
    join_corners(cells)
    return cells


def rooms(
    rows: int, cols: int, rng: np.random.Generator, *, room: int = 8, door: int = 2, closed: float = 0.2
) -> Cells:
    """Draw rooms in a lattice; most walls between two rooms have a door somewhere."""
    room, door, share = check_count("room", room, 1), check_count("door", door, 1), check_share("closed", closed)
    _check_sides(rows, cols, room + 2, f"rooms of {room}")
    cells = np.zeros((rows, cols), dtype=np.uint8)
    across, along = _wall_lines(rows, room), _wall_lines(cols, room)
    cells[across, :] = cells[:, along] = Cell.OCCUPIED
    for lines, spans, view in ((across, along, cells), (along, across, cells.T)):
        for line in lines[1:-1]:
            for left, right in pairwise(spans):
                width = min(door, right - left - 1)
                spot = left + 1 + int(rng.integers(0, right - left - width))
                if rng.integers(0, 1000) >= share:
                    view[line, spot : spot + width] = Cell.FREE
    join_corners(cells[1:-1, 1:-1])
    return cells


def _wall_lines(length: int, room: int) -> list[int]:
    count = (length - 1) // (room + 1)
    return [number * (length - 1) // count for number in range(count + 1)]


def maze(rows: int, cols: int, rng: np.random.Generator, *, passage: int = 1, wall: int = 1, loops: float = 0) -> Cells:
    """Draw a maze with exactly one way between any two cells, then take away some walls.

    A depth-first walk over the cells of a lattice that breaks through to cells not yet seen. Rows and columns that
    the lattice does not fill thicken the outer wall at the bottom and the right.
    """
    passage, wall, share = check_count("passage", passage, 1), check_count("wall", wall, 1), check_share("loops", loops)
    _check_sides(rows, cols, 2 * wall + passage, f"a maze with passages of {passage} and walls of {wall}")
    pitch = passage + wall
    height, width = (rows - wall) // pitch, (cols - wall) // pitch
    east, south = rng.integers(0, 1000, (2, height, width)) < share  # openings to the right and downwards
    steps = 2 * height * width - 1  # each cell but the first is entered once, and all are left once
    draws = rng.integers(0, 12, steps)  # 12: every number of choices, 1 to 4, divides it
    seen = np.zeros((height, width), dtype=bool)
    seen[0, 0] = True
    stack = [(0, 0)]
    for draw in draws:
        row, col = stack[-1]
        around = ((row, col + 1), (row + 1, col), (row, col - 1), (row - 1, col))
        choices = [(r, c) for r, c in around if 0 <= r < height and 0 <= c < width and not seen[r, c]]
        if not choices:
            stack.pop()
            continue
        r, c = choices[draw % len(choices)]
        openings = east if r == row else south
        openings[min(r, row), min(c, col)] = True
        seen[r, c] = True
        stack.append((r, c))
    cells = np.full((rows, cols), Cell.OCCUPIED, dtype=np.uint8)
    for row in range(height):
        for col in range(width):
            top, left = wall + row * pitch, wall + col * pitch
            longer = wall if east[row, col] and col + 1 < width else 0
            deeper = wall if south[row, col] and row + 1 < height else 0
            cells[top : top + passage, left : left + passage + longer] = Cell.FREE
            cells[top : top + passage + deeper, left : left + passage] = Cell.FREE
    return cells


def caves(rows: int, cols: int, rng: np.random.Generator, *, density: float = 0.45, steps: int = 5) -> Cells:
    """Smooth random rock: in each step a cell is rock where at least 5 of the 9 cells around it and itself are."""
    share, steps = check_share("density", density), check_count("steps", steps, 0, 100)
    _check_sides(rows, cols, 3, "caves")
    rock = np.pad(rng.integers(0, 1000, (rows - 2, cols - 2)) < share, 1, constant_values=True)
    for _ in range(steps):
        framed = np.pad(rock, 1, constant_values=True).astype(np.uint8)
        triples = framed[:-2] + framed[1:-1] + framed[2:]
        rock = triples[:, :-2] + triples[:, 1:-1] + triples[:, 2:] >= 5
        rock[[0, -1], :] = rock[:, [0, -1]] = True
    cells = rock.astype(np.uint8)
    join_corners(cells[1:-1, 1:-1])
    return cells


def u_traps(rows: int, cols: int, rng: np.random.Generator, *, traps: int = 0, size: int = 0) -> Cells:
    """Scatter U shapes that do not touch, open to the top or the left: dead ends for ants bound for the lower right."""
    _check_sides(rows, cols, 3, "U-shaped traps")
    short = min(rows, cols)
    size = check_count("size", size, 3, short) if size else max(3, short // 6)
    room = (rows + 1) // 4 * ((cols + 1) // 4)  # for the smallest ones, a free line between them
    traps = check_count("traps", traps, 1, max(1, room)) if traps else max(1, rows * cols // (2 * size * size))
    cells = np.zeros((rows, cols), dtype=np.uint8)
    for _ in range(8 * traps):  # most tries find room while there is some
        side = int(rng.integers(max(3, size // 2), size + 1))
        top, left = int(rng.integers(0, rows - side + 1)), int(rng.integers(0, cols - side + 1))
        opens_left = bool(rng.integers(0, 2))
        if not cells[max(0, top - 1) : top + side + 1, max(0, left - 1) : left + side + 1].any():
            square = cells[top : top + side, left : left + side]
            shape = square.T if opens_left else square
            shape[-1, :] = shape[:, 0] = shape[:, -1] = Cell.OCCUPIED
            traps -= 1
            if not traps:
                break
    join_corners(cells)
    return cells


def _check_sides(rows: int, cols: int, low: int, what: str) -> None:
    if min(rows, cols) < low:
        raise ParameterError(f"a map of {rows} x {cols} cells", f"{what} need {low} on each side", "enlarge the map")


_KINDS: dict[str, Callable[..., Cells]] = {
    "random": random_blocks,
    "rooms": rooms,
    "maze": maze,
    "caves": caves,
    "u_traps": u_traps,
    "warehouse": warehouse,
}
