"""Setup: what a study ran, as tables and as one document from which it can be repeated."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from antnav.plan import algorithms
from antnav.planner.planner import Planner, parameters, plain
from antnav.planner.result import versions
from antnav.report.table import Column, Table, Value
from antnav.study.model import AlgorithmEntry, AnyStudy, MapEntry, Study
from antnav.study.sources import sources
from antnav.study.toml import CELL_KEYS, METRE_KEYS, SOURCES
from antnav.world.problem import Problem

CHANGED = "*"  #: After a value that is not the preset's.


def defaults(chosen: Planner) -> dict[str, Any]:
    """Parameters of antnav's planner of that name and kind; all empty where there is none."""
    usual = algorithms.algorithm(chosen.name) if chosen.name in algorithms.names() else None
    return parameters(usual) if usual and usual.kind == chosen.kind else {}


def tables(study: Study) -> list[Table]:
    """The algorithms with ants, those without, and the maps of a study."""
    ants = [entry for entry in study.algorithms if entry.algorithm.ants]
    rivals = [entry for entry in study.algorithms if not entry.algorithm.ants]
    found = []
    if ants:
        found.append(choices("parameters", "Parameters of the algorithms", "preset", ants))
    if rivals:
        found.append(choices("rivals", "Parameters of the planners without ants", "planner", rivals))
    return [*found, problems(study.maps)]


def choices(
    name: str,
    title: str,
    kind: str,
    entries: Sequence[AlgorithmEntry],
    usual: Callable[[Planner], dict[str, Any]] = defaults,
) -> Table:
    """A row for each algorithm, a column for each parameter that not all share, or turned; the others in the note."""
    shown = {entry.label: _texts(entry.algorithm, usual(entry.algorithm)) for entry in entries}
    keys = list(dict.fromkeys(key for texts in shown.values() for key in texts))
    common = {key for key in keys if len({texts.get(key) for texts in shown.values()}) == 1}
    varied = [key for key in keys if key not in common]
    rows: list[tuple[Value, ...]] = [
        (entry.label, entry.algorithm.name, *(shown[entry.label].get(key) for key in varied)) for entry in entries
    ]
    heads: tuple[Value, ...] = ("algorithm", kind, *varied)
    if len(varied) > len(entries):  # a few algorithms side by side
        heads, *rows = zip(heads, *rows, strict=True)
    first = shown[entries[0].label]
    note = f"{CHANGED} is not the {kind}'s own value."
    if common:
        note = f"The same for all: {', '.join(f'{key} {first[key]}' for key in keys if key in common)}. {note}"
    return Table(name, title, tuple(Column(str(head)) for head in heads), tuple(rows), note)


def _texts(chosen: Planner, usual: Mapping[str, Any]) -> dict[str, str]:
    """Parameters as readers see them, those that differ from the preset marked; users' rules with their files."""
    own = {one.source.name: f"own rule {one.source}" for one in chosen.own}
    return {
        key: _word(key, own.get(str(value), value)) + CHANGED * (bool(usual) and usual.get(key) != value)
        for key, value in parameters(chosen).items()
    }


def _word(key: str, value: object) -> str:
    if value is None:
        return "by map" if key == "switch" else "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def problems(maps: Sequence[MapEntry]) -> Table:
    """Each map: where it comes from, its size, ends and rules."""
    columns = (
        Column("map"),
        Column("source"),
        Column("rows", "d"),
        Column("cols", "d"),
        Column("resolution (m)", "g"),
        Column("robot radius (m)", "g"),
        Column("start (row, col)"),
        Column("goal (row, col)"),
        Column("ends"),
        Column("corner rule"),
        Column("unknown cells"),
        Column("costs"),
        Column("digest"),
    )
    note = "Rows and columns from 0 at the top left. The digest is of the cells after inflation by the radius."
    if any(not entry.problem.objective.plain for entry in maps):
        note += " Where a map has costs, what this report calls a length, best, mean or optimum is the cost."
    return Table("problems", "Maps", columns, tuple(_problem(entry) for entry in maps), note)


def _problem(entry: MapEntry) -> tuple[Value, ...]:
    problem, grid = entry.problem, entry.problem.grid
    return (
        entry.label,
        _origin(entry.source),
        grid.rows,
        grid.cols,
        grid.resolution,
        float(entry.source.get("robot_radius", 0.0)),
        str(problem.start_cell),
        str(problem.goal_cell),
        _ends(entry.source),
        str(problem.corner_rule),
        "free" if problem.allow_unknown else "blocked",
        _costs(problem),
        grid.digest[:16],
    )


def _costs(problem: Problem) -> str:
    names = [] if problem.cost is None else [problem.cost.name]
    return ", ".join(names + [f"turns, {problem.turning:g} a radian"] * (problem.turning > 0)) or "-"


def _origin(source: Mapping[str, Any]) -> str:
    for kind in SOURCES:
        if kind in source:
            value = source[kind]
            words = ", ".join(f"{key} {item}" for key, item in value.items()) if isinstance(value, dict) else value
            return f"{kind} {words}"
    return "-"


def _ends(source: Mapping[str, Any]) -> str:
    if any(key in source for key in (*METRE_KEYS, *CELL_KEYS)):
        return "given"
    if "builtin" in source:
        return "the map's own"
    return "chosen: free cells far apart" if source else "-"


def document(
    study: AnyStudy[Any],
    usual: Callable[[Planner], dict[str, Any]] = defaults,
    *,
    without_ants: str = "rival",
    **more: Any,
) -> str:
    """Everything that decides the outcome of the runs, as JSON."""
    content = {
        "title": study.title,
        "versions": versions(),
        "sources": sources(),
        "seeds": list(study.seeds),
        "seconds": study.seconds,
        "baseline": study.baseline,
        "equal_budget": study.equal_budget,
        "maps": {entry.label: _described(entry) for entry in study.maps},
        "algorithms": {entry.label: _composition(entry, study, usual, without_ants) for entry in study.algorithms},
        **more,
    }
    return json.dumps(content, indent=1) + "\n"


def _described(entry: MapEntry) -> dict[str, Any]:
    problem, grid = entry.problem, entry.problem.grid
    return {
        "source": dict(entry.source),
        "rows": grid.rows,
        "cols": grid.cols,
        "resolution": grid.resolution,
        "origin": grid.origin,
        "start_cell": problem.start_cell,
        "goal_cell": problem.goal_cell,
        "corner_rule": str(problem.corner_rule),
        "allow_unknown": problem.allow_unknown,
        "digest": grid.digest,
        "costs": "" if problem.cost is None else problem.cost.name,
        "turning": problem.turning,
    }


def _composition(
    entry: AlgorithmEntry, study: AnyStudy[Any], usual_of: Callable[[Planner], dict[str, Any]], without_ants: str
) -> dict[str, Any]:
    chosen, values = entry.algorithm, parameters(entry.algorithm)
    usual = usual_of(chosen)
    kind = "preset" if chosen.ants else without_ants
    found: dict[str, Any] = {kind: chosen.name, "certainty": str(chosen.certainty), "parameters": values}
    found["changed"] = [key for key, value in values.items() if usual and usual.get(key) != value]
    found |= {"own": own} if (own := chosen.document().get("own")) else {}
    on_maps = {place.label: _resolved(chosen, place) for place in study.maps}
    return plain(chosen, found | ({"on_maps": on_maps} if any(on_maps.values()) else {}))


def _resolved(chosen: Planner, place: MapEntry) -> dict[str, Any]:
    """The choices that depend on the map, as they were made for it; of ants those that may."""
    given, resolved = parameters(chosen), parameters(chosen.suited(place.problem))
    always = {"heuristic", "switch"} & resolved.keys()
    return {key: value for key, value in resolved.items() if key in always or key not in given or value != given[key]}
