"""Queries of MovingAI scenario files: which map a file belongs to, and which of its queries are asked."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np

from antnav.errors import MapFileError, MapFormatError, ParameterError
from antnav.maps import Scenario, load_map, load_scenarios
from antnav.search import exact
from antnav.world.grid import GridMap
from antnav.world.problem import CellIndex, Problem

#: Cells by which a printed length may differ from the true one: some files print two decimals.
TOLERANCE = 5.1e-3


@dataclass(frozen=True, eq=False)
class Query:
    """One query of a scenario file, and its map.

    Attributes
    ----------
    grid : GridMap
    map_label : str
        The map's name; its path below the folder where two maps share a name.
    scenarios : str
        Name of the scenario file.
    number : int
        Place among that file's queries, from 1.
    start, goal : (row, col)
    published : float
        Length of a shortest path in cells, as printed.
    """

    grid: GridMap
    map_label: str
    scenarios: str
    number: int
    start: CellIndex
    goal: CellIndex
    published: float

    def problem(self) -> Problem:
        """The query as a new problem, corner rule forbid: nothing worked out for another one is left in it."""
        return Problem.from_cells(self.grid, self.start, self.goal)


def read_queries(folder: Path, count: int, hardest: float) -> list[Query]:
    """Read the queries to ask from all scenario files in a folder and the folders below it.

    Parameters
    ----------
    folder : Path
        Each .scen file lies beside its map: NAME.map beside NAME.map.scen, else the map that the file names.
    count : int
        Queries a file, >= 1; all that there are where the file has fewer.
    hardest : float
        Share of the file, in (0, 1], that they are spread over: its longest queries.

    Raises
    ------
    MapFileError
        No folder, no scenarios in it, or a file without its map.
    MapFormatError, MapSizeError, OccupiedError
        A file breaks its format, or a query does not fit its map.
    ParameterError
        `count` or `hardest` is out of range.
    """
    if count < 1:
        raise ParameterError(f"queries {count}", "at least 1 query a file is needed", "give 1 or more")
    if not 0 < hardest <= 1:
        raise ParameterError(f"hardest {hardest:g}", "it is a share above 0 and up to 1", "give one, such as 0.25")
    if not folder.is_dir():
        raise MapFileError(f"{folder}", "it is no folder", "name one with MovingAI .map and .scen files")
    read = [(path, load_scenarios(path)) for path in sorted(folder.rglob("*.scen"))]
    files = {path: (_map_of(path, scenarios), scenarios) for path, scenarios in read if scenarios}
    if not files:
        raise MapFileError(f"{folder}", "no .scen file in it has a query", "name a folder with MovingAI files")
    grids = {path: load_map(path) for path in dict.fromkeys(path for path, _ in files.values())}
    names = Counter(path.stem for path in grids)
    queries: list[Query] = []
    for path, (map_path, scenarios) in files.items():
        unique = names[map_path.stem] == 1
        label = map_path.stem if unique else map_path.relative_to(folder).with_suffix("").as_posix()
        indices = chosen([scenario.optimal for scenario in scenarios], count, hardest)
        queries += [_query(grids[map_path], label, path, index, scenarios[index]) for index in indices]
    return queries


def chosen(lengths: Sequence[float], count: int, hardest: float) -> list[int]:
    """Indices of up to `count` lengths, spread evenly over the longest share of them, shortest first."""
    order = sorted(range(len(lengths)), key=lambda index: lengths[index])
    hard = order[len(order) - max(1, math.ceil(hardest * len(order) - 1e-9)) :]
    places = np.linspace(0, len(hard) - 1, min(count, len(hard)))
    return [hard[round(place)] for place in places] if len(places) > 1 else hard[-1:]


def check_published(query: Query) -> None:
    """Verify that the published length is that of a shortest path under corner rule forbid.

    Raises
    ------
    MapFormatError
        It is not: the gap to it would mean nothing.
    """
    length = exact.shortest_path(query.problem()).length
    if not abs(length - query.published) <= TOLERANCE:
        raise MapFormatError(
            f"{query.scenarios}, query {query.number}: length {query.published:g}",
            f"a shortest path with corner rule forbid has length {length:.8g}",
            "leave this file out: its lengths hold for other rules",
        )


def _map_of(path: Path, scenarios: Sequence[Scenario]) -> Path:
    candidates = [path.with_suffix(""), path.parent / PurePosixPath(scenarios[0].map_name).name]
    for candidate in candidates:
        if candidate.suffix == ".map" and candidate.is_file():
            return candidate
    raise MapFileError(f"{path}", f"its map {candidates[-1].name} is not beside it", "put it there")


def _query(grid: GridMap, label: str, path: Path, index: int, scenario: Scenario) -> Query:
    if (scenario.rows, scenario.cols) != (grid.rows, grid.cols):
        raise MapFormatError(
            f"{path}, query {index + 1}: a map of {scenario.rows} rows and {scenario.cols} columns",
            f"its map has {grid.rows} and {grid.cols}",
            "restore the files from movingai.com",
        )
    return Query(grid, label, path.name, index + 1, scenario.start, scenario.goal, scenario.optimal)
