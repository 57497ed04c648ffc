"""TOML: a study as a file says it."""

from __future__ import annotations

import contextlib
import math
import os
import tomllib
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

from antnav.colony.parameters import RULES
from antnav.colony.parts import Part
from antnav.costs.named import collected
from antnav.errors import AntnavError, ParameterError, likely
from antnav.files import as_path, open_regular
from antnav.fronts.pareto import METHODS
from antnav.maps import builtin, builtin_query, ends, generate, load_map
from antnav.objectives.named import collected as objectives_named
from antnav.plan.algorithms import EXACT, algorithm, arguments
from antnav.planner.planner import Planner
from antnav.plugins.loading import beside, divided, load_all
from antnav.study.changes import Changes
from antnav.study.dynamic_model import DynamicStudy
from antnav.study.front_model import FrontPlanner, FrontStudy
from antnav.study.model import MAX_RUNS, AlgorithmEntry, MapEntry, Study, Sweep
from antnav.world.grid import GridMap
from antnav.world.problem import CellIndex, Problem


class StudyFormatError(ParameterError):
    """A study file cannot be read, or says what a study does not understand."""


def load_study(path: str | os.PathLike[str]) -> Study | FrontStudy | DynamicStudy:
    """Read a study from a TOML file; docs/studies.md has all keys.

    With `objectives` it is one of fronts, with `changes` one of maps that change.

    ::

        title = "How greedy?"           # default: the file's name
        seeds = 30                      # 0..29; or a list
        baseline = "one colony"         # compared with each other one; default: each with each
        plugins = ["mine.py"]           # your own rules, from this file's folder; see antnav.register
        seconds = 0.5                   # time limit of a run; default: none
        equal_budget = "walks"          # or "steps", "seconds": as much as the baseline has; default: own schedules

        [[maps]]
        builtin = "equiv40"             # or file = "office.yaml", relative to this file,
        corner_rule = "allow"           # or generate = { kind = "rooms", rows = 40, cols = 40, seed = 1 }

        [[maps]]
        label = "office"
        file = "office.yaml"
        start = [1.0, 2.5]              # in metres; or start_cell, goal_cell = [row, col]; default: the map's own,
        goal = [7.0, 2.5]               # or two free cells far apart
        robot_radius = 0.2              # in metres
        allow_unknown = false
        cost = ["clearance:0.5"]        # keep off walls; keepout and speed = [masks], turning = cells a radian

        [[algorithms]]
        preset = "npaco"
        label = "one colony"            # default: the preset
        ants = 30                       # any parameter of the preset

        [[algorithms]]
        rival = "ga-straight"           # a planner without ants

        [sweep]                         # or [[sweep]], several
        preset = "paco"
        rho = [0.05, 0.1, 0.2]          # lists are multiplied out: "paco rho=0.05 beta=5", ...
        beta = [5, 7]

    Of fronts::

        objectives = ["length", "risk:clearance:0.5"]   # on each map

        [[algorithms]]
        method = "nsga2"
        points = 4

    Of maps that change::

        changes = { count = 10, every = 20, share = 0.03, seed = 0 }    # these are the defaults

        [[algorithms]]
        preset = "npaco"
        memory = "repair"

    Raises
    ------
    StudyFormatError
        The file cannot be read; a key is unknown, missing, or of the wrong type.
    AntnavError
        A map, an end or a parameter is refused, with the typed error of its own; it says where in the file.
    """
    path = as_path(path)
    text = _text(path)
    table = _Table(_placed(_parse(path, text), path.parent), path.name)
    with _located(path.name):
        load_all(path.parent / file for file in table.texts("plugins"))
    if "objectives" in table.values:
        table.check_keys((*KEYS, "objectives"))
        return _front_study(table, path, text)
    if "changes" in table.values:
        table.check_keys(("title", "seeds", "baseline", "changes", "maps", "algorithms", "sweep", "plugins"))
        return _dynamic_study(table, path, text)
    table.check_keys((*KEYS, "sweep", "objectives", "changes"))
    return _study(table, path, text)


KEYS = ("title", "seeds", "baseline", "seconds", "equal_budget", "maps", "algorithms", "plugins")


def _placed(table: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The same with users' rules, "mine.py:name", found from a folder."""

    def placed(value: Any) -> Any:
        match value:
            case str():
                return beside(value, folder)
            case list():
                return [placed(each) for each in value]
            case dict():
                return {key: placed(each) for key, each in value.items()}
        return value

    return table | {key: placed(table[key]) for key in table.keys() & {"algorithms", "sweep", "objectives"}}


def _study(table: _Table, path: Path, text: str) -> Study:
    maps = [_map(entry, path.parent) for entry in table.tables("maps")]
    algorithms, sweeps = _algorithms(table)
    with _located(path.name):
        return Study(maps=maps, algorithms=algorithms, sweeps=sweeps, **_common(table, path, text))


def _common(table: _Table, path: Path, text: str) -> dict[str, Any]:
    """What studies of all kinds say."""
    return {
        "title": table.get("title", str, path.stem),
        "seeds": _seeds(table),
        "baseline": table.get("baseline", str, None),
        "seconds": table.get("seconds", float, None),
        "text": text,
        "equal_budget": table.get("equal_budget", str, None),
    }


def _front_study(table: _Table, path: Path, text: str) -> FrontStudy:
    places, asked = table.tables("maps"), [_beside(words, path.parent) for words in table.texts("objectives")]
    for place in places:
        place.check_keys((*SOURCES, "label", *METRE_KEYS, *CELL_KEYS, *RULE_KEYS, "keepout"))
    maps = [_map(place, path.parent) for place in places]
    methods = [_method(entry) for entry in table.tables("algorithms")]
    with _located(path.name):
        objectives = {place.label: objectives_named(asked, place.problem.grid) for place in maps}
        return FrontStudy(maps=maps, algorithms=methods, objectives=objectives, **_common(table, path, text))


def _algorithms(table: _Table) -> tuple[list[AlgorithmEntry], list[Sweep]]:
    """The algorithms, those of sweeps among them, and the sweeps."""
    algorithms, sweeps = [_algorithm(entry) for entry in table.tables("algorithms")], []
    for entry in table.tables("sweep"):
        sweep, points = _sweep(entry)
        sweeps.append(sweep)
        algorithms += points
    return algorithms, sweeps


def _dynamic_study(table: _Table, path: Path, text: str) -> DynamicStudy:
    places = table.tables("maps")
    for place in places:  # walls move, and what was worked out of them would not
        place.check_keys((*SOURCES, "label", *METRE_KEYS, *CELL_KEYS, "corner_rule", "allow_unknown", "turning"))
    maps = [_map(place, path.parent) for place in places]
    algorithms, sweeps = _algorithms(table)
    given = _Table(table.get("changes", dict), f"{path.name}, changes")
    kinds = {"count": int, "every": int, "share": float, "seed": int}
    given.check_keys(kinds)
    with _located(path.name):
        changes = Changes(**{key: given.get(key, kinds[key]) for key in given.values})
        common = _common(table, path, text)
        return DynamicStudy(maps=maps, algorithms=algorithms, sweeps=sweeps, changes=changes, **common)


def _beside(words: str, folder: Path) -> str:
    """An objective with its file, if it has one, found from the study's folder."""
    kind, _, file = words.partition(":")
    return f"{kind}:{folder / file}" if kind in {"time", "energy"} and file else words


def _method(table: _Table) -> AlgorithmEntry:
    name = table.get("method", str)
    if name not in METHODS:
        rule = f"the methods are {', '.join(METHODS)}"
        raise StudyFormatError(f"{table.where}, method = {name!r}", rule, "choose one of them")
    default = METHODS[name]()
    known = {key: value for key, value in default.document().items() if key != "name"}
    table.check_keys(("method", "label", *known))
    choices = {key: value for key, value in table.values.items() if key in known}
    for key, value in choices.items():
        kind = bool if isinstance(known[key], bool) else str if isinstance(known[key], str) else float
        table.checked(key, value, kind)
    with _located(table.where):
        return AlgorithmEntry(table.get("label", str, name), FrontPlanner(replace(default, **choices)))


def _text(path: Path) -> str:
    try:
        with open_regular(path) as stream:
            return stream.read().decode()
    except (OSError, ValueError) as error:  # ValueError: not UTF-8
        raise _unreadable(path, error) from error


def _parse(path: Path, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: Exception) -> StudyFormatError:
    reason = (isinstance(error, OSError) and error.strerror) or str(error)
    return StudyFormatError(f"study {path}", reason, "name a TOML file that can be read")


@contextlib.contextmanager
def _located(where: str) -> Iterator[None]:
    """Errors of the parts, each of its own type, say where in the file their cause stands."""
    try:
        yield
    except StudyFormatError:
        raise
    except AntnavError as error:
        error.given = f"{where}, {error.given}"
        raise


_TYPES = {
    str: "a text",
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    list: "a list",
    dict: "a table",
}


_NEEDED: Any = object()


@dataclass(frozen=True)
class _Table:
    """A table of the file and where it stands."""

    values: dict[str, Any]
    where: str

    def check_keys(self, allowed: Collection[str]) -> None:
        for key in self.values:
            if key not in allowed:
                near = likely(key, allowed)
                rule = f"{'did you mean ' + near + '? ' if near else ''}the keys are {', '.join(allowed)}"
                raise StudyFormatError(f"{self.where}, key {key!r}", rule, "correct or remove it")

    def get(self, key: str, kind: type, default: Any = _NEEDED) -> Any:
        """The value of a key, of one of `_TYPES`."""
        if key not in self.values:
            if default is _NEEDED:
                raise StudyFormatError(self.where, f"{key} is missing", f"give {key}, {_TYPES[kind]}")
            return default
        return self.checked(key, self.values[key], kind)

    def checked(self, key: str, value: Any, kind: type) -> Any:
        good = isinstance(value, int | float if kind is float else kind)
        if not good or (isinstance(value, bool) and kind is not bool):
            raise StudyFormatError(f"{self.where}, {key} = {value!r}", f"it is {_TYPES[kind]}", "change it")
        return value

    def pair(self, key: str, kind: type) -> tuple[Any, Any]:
        values = [self.checked(key, value, kind) for value in self.get(key, list)]
        if len(values) != 2:
            raise StudyFormatError(f"{self.where}, {key} = {values}", "it is a list of two numbers", "give two")
        return values[0], values[1]

    def texts(self, key: str) -> list[str]:
        """A text or a list of texts; none where the key is missing."""
        given = self.values.get(key, [])
        return [self.checked(key, text, str) for text in (given if isinstance(given, list) else [given])]

    def tables(self, key: str) -> list[_Table]:
        """Those of `[[key]]`, or the one of `[key]`; none where the key is missing."""
        found = self.values.get(key, [])
        found = [found] if isinstance(found, dict) else found
        if not isinstance(found, list) or not all(isinstance(value, dict) for value in found):
            raise StudyFormatError(f"{self.where}, {key}", "it is a table, or several", f"begin each with [[{key}]]")
        return [_Table(value, f"{self.where}, {key} {number}") for number, value in enumerate(found, 1)]


def _seeds(table: _Table) -> Sequence[int]:
    given = table.values.get("seeds")
    if isinstance(given, list):
        return given  # each is checked by the study
    count: int = table.get("seeds", int)
    if not 1 <= count <= MAX_RUNS:
        raise StudyFormatError(
            f"{table.where}, seeds = {count}", f"a count of seeds lies in 1..{MAX_RUNS}", "give one, or a list"
        )
    return range(count)


RULE_KEYS, COST_KEYS = ("corner_rule", "allow_unknown", "robot_radius"), ("cost", "keepout", "speed")


def _map(table: _Table, folder: Path) -> MapEntry:
    table.check_keys((*SOURCES, "label", *METRE_KEYS, *CELL_KEYS, *RULE_KEYS, *COST_KEYS, "turning"))
    sources = [key for key in SOURCES if key in table.values]
    if len(sources) != 1:
        rule = f"a map comes from one of {', '.join(SOURCES)}"
        raise StudyFormatError(f"{table.where}, {' and '.join(sources) or 'no map'}", rule, "give exactly one")
    rules: dict[str, Any] = {
        "corner_rule": table.get("corner_rule", str, "forbid"),
        "allow_unknown": table.get("allow_unknown", bool, False),
    }
    with _located(table.where):
        grid, name = SOURCES[sources[0]](table, folder)
        rules["cost"] = collected(grid, *[table.texts(key) for key in COST_KEYS], folder=folder)
        rules["turning"] = table.get("turning", float, 0.0)
        grid = grid.inflated(table.get("robot_radius", float, 0.0))
        return MapEntry(table.get("label", str, name), _problem(table, grid, rules), table.values)


def _problem(table: _Table, grid: GridMap, rules: dict[str, Any]) -> Problem:
    given = tuple(key for key in (*METRE_KEYS, *CELL_KEYS) if key in table.values)
    if given == METRE_KEYS:
        return Problem(grid, table.pair("start", float), table.pair("goal", float), **rules)
    if given == CELL_KEYS:
        return Problem.from_cells(grid, table.pair("start_cell", int), table.pair("goal_cell", int), **rules)
    if given:
        rule = "it is start and goal in metres, start_cell and goal_cell, or none of them"
        raise StudyFormatError(f"{table.where}, {' and '.join(given)}", rule, "give one of these pairs")
    own: tuple[CellIndex, CellIndex] = builtin_query(grid.name) if "builtin" in table.values else ends(grid)
    return Problem.from_cells(grid, *own, **rules)


def _from_file(table: _Table, folder: Path) -> tuple[GridMap, str]:
    name: str = table.get("file", str)
    return load_map(folder / name), Path(name).stem


def _from_builtin(table: _Table, _folder: Path) -> tuple[GridMap, str]:
    name: str = table.get("builtin", str)
    return builtin(name), name


def _from_generator(table: _Table, _folder: Path) -> tuple[GridMap, str]:
    options = _Table(table.get("generate", dict), f"{table.where}, generate")
    kind, rows, cols = options.get("kind", str), options.get("rows", int), options.get("cols", int)
    rest = {key: value for key, value in options.values.items() if key not in {"kind", "rows", "cols"}}
    grid = generate(kind, rows, cols, **rest)
    return grid, grid.name


SOURCES: dict[str, Callable[[_Table, Path], tuple[GridMap, str]]] = {
    "file": _from_file,
    "builtin": _from_builtin,
    "generate": _from_generator,
}


METRE_KEYS, CELL_KEYS = ("start", "goal"), ("start_cell", "goal_cell")


def _algorithm(table: _Table) -> AlgorithmEntry:
    if "rival" in table.values:
        table.check_keys(("rival", "label"))
        rival = table.get("rival", str)
        with _located(table.where):
            return AlgorithmEntry(table.get("label", str, divided(rival)[1]), algorithm(rival))
    name = table.get("preset", str)
    return AlgorithmEntry(table.get("label", str, divided(name)[1]), _composed(table, name, _choices(table)))


def _sweep(table: _Table) -> tuple[Sweep, list[AlgorithmEntry]]:
    """One algorithm for each combination of the values in lists."""
    name = table.get("preset", str)
    label = table.get("label", str, divided(name)[1])
    choices = _choices(table)
    varied = {key: values for key, values in choices.items() if isinstance(values, list)}
    count = math.prod(map(len, varied.values()))
    if not varied or not 1 <= count <= MAX_RUNS:
        rule = f"at least one parameter is a list of values, and they have 1..{MAX_RUNS} combinations"
        raise StudyFormatError(f"{table.where}, a sweep of {count if varied else 'nothing'}", rule, "change the lists")
    points = {}
    for values in product(*varied.values()):
        chosen = dict(zip(varied, values, strict=True))
        words = [f"{key}={divided(value)[1] if isinstance(value, str) else value}" for key, value in chosen.items()]
        points[" ".join([label, *words])] = chosen
    if len(points) < count:
        rule = "each combination of values stands there once"
        raise StudyFormatError(f"{table.where}, a value twice in a list", rule, "remove one of them")
    entries = [AlgorithmEntry(words, _composed(table, name, choices | chosen)) for words, chosen in points.items()]
    return Sweep(label, points), entries


def _own_parts(choices: dict[str, Any]) -> dict[str, Part]:
    """The users' rules among the choices, which have parameters that the preset lacks."""
    named = {kind: choices[kind] for kind in RULES.keys() & choices.keys() if isinstance(choices[kind], str)}
    parts = {kind: RULES[kind].of(name) for kind, name in named.items() if name not in [*RULES[kind].kind()]}
    return {kind: part for kind, part in parts.items() if part.own}


def _choices(table: _Table) -> dict[str, Any]:
    return {key: value for key, value in table.values.items() if key not in {"preset", "label"}}


def _composed(table: _Table, name: str, choices: dict[str, Any]) -> Planner:
    """The planner of that name with the choices, all of them known and none a table, a list or a date."""
    with _located(table.where):
        default = algorithm(name, **_own_parts(choices))
    known = {} if name in EXACT else {**default.document(), **default.choices(), **arguments(name)}
    for key in ("kind", "name", "certainty", "decomposition", "own"):
        known.pop(key, None)
    table.check_keys(("preset", "label", *sorted(known)))
    for key, value in choices.items():
        kind = bool if isinstance(known[key], bool) else str if isinstance(known[key], str) else float
        if isinstance(value, list):
            rule = f"it is {_TYPES[kind]}"
            raise StudyFormatError(
                f"{table.where}, {key} = {value}", rule, "give one value; lists of them belong in [[sweep]]"
            )
        table.checked(key, value, kind)
    with _located(table.where):
        return algorithm(name, **choices)
