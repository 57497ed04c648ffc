"""Whatever is passed to what antnav offers, only its own errors come out: value, rule and remedy, no traceback of ours.

Every public callable is called with good arguments of which one is replaced by each odd value in turn.
"""

from __future__ import annotations

import inspect
import itertools
import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import antnav as an
from antnav import events, plot
from antnav.errors import AntnavError, OutputError, ParameterError, PathError, shown


@dataclass(frozen=True)
class Own(an.Planner):
    name: str = "own"


class OwnGoal(an.objectives.Objective):
    name = "own"


GRID = an.GridMap(np.zeros((5, 6), np.uint8), 0.5, (1.0, 2.0, 0.0), "small")
PROBLEM = an.Problem.from_cells(GRID, (0, 0), (4, 5))
QUICK = an.npaco(ants=3, iterations=2)
RESULT = an.solve(PROBLEM, QUICK)
PATH = RESULT.path
FIELD = an.costs.array(np.ones((5, 6)))
OBJECTIVES = [an.objectives.Length(), an.objectives.Risk(FIELD)]
FRONT = an.pareto(PROBLEM, OBJECTIVES)
ROUTES = an.alternatives(PROBLEM)
SCENARIO = an.scenarios.named("people:2", PROBLEM, ticks=9)
TRAJECTORY = RESULT.trajectory()
TOUR = an.tour(GRID, (1.2, 2.2), [(3.2, 4.2), (1.2, 4.2)])

ODD: tuple[Any, ...] = (
    None,
    True,
    -1,
    2.5,
    math.nan,
    math.inf,
    10**400,
    -(10**5000),
    1j,
    "odd",
    "",
    "a\0b",
    b"odd",
    [],
    [1],
    [[1, 2], [3]],
    (0.5, 0),
    ("a", "b"),
    (math.nan, 1),
    {},
    {"a": 1},
    object(),
    int,
    math.sin,
    np.array([["a", None]], object),
    np.float64(2.5),
    np.array(7),
    np.zeros((2, 2, 2)),
    Path("no/such/file"),
    GRID,
    PROBLEM,
    RESULT,
)

#: Good arguments by the names of the parameters.
GOOD: dict[str, Any] = {
    "problem": PROBLEM,
    "algorithm": QUICK,
    "grid": GRID,
    "result": RESULT,
    "path": PATH,
    "alternatives": ROUTES,
    "cell": (1, 1),
    "mask": np.zeros(GRID.shape, np.bool_),
    "cells": [(0, 0), (1, 1)],
    "points": [(1.2, 2.2)],
    "point": (1.2, 2.2),
    "start": (1.2, 2.2),
    "goal": (3.2, 4.2),
    "number": 3,
    "radius": 0.2,
    "resolution": 0.5,
    "origin": (0.0, 0.0, 0.0),
    "name": "equiv20",
    "kind": "random",
    "rows": 9,
    "cols": 9,
    "count": 2,
    "limit": 2.0,
    "length": 9.0,
    "criteria": (an.stop.Iterations(2),),
    "workers": 2,
    "function": repr,
    "executor": None,
    "what": "grid",
    "value": GRID,
    "remedy": "none",
    "jobs": [1, 2],
    "axis": "auto",
    "stage_one": 3,
    "flat": [9, 10],
    "iterations": 9,
    "seconds": 0.5,
    "best": 9.0,
    "stagnant": 0,
    "number_of_rows": 3,
    "inflation_radius": 0.55,
    "cost_scaling_factor": 10.0,
    "inscribed_radius": 0.2,
    "objectives": OBJECTIVES,
    "front": FRONT,
    "weights": [1.0, 2.0],
    "reference": [9.0, 9.0],
    "field": FIELD,
    "slopes": FIELD,
    "query": SCENARIO.query,
    "ticks": 9,
    "tick": 3,
    "speed": 2,
    "text": "people:2",
    "prices": [1.0, 2.0],
    "blocked": [(0, 0), (1, 1)],
    "freed": [(3, 3)],
    "priced": [(0, 0), (1, 1)],
    "sensor": 5,
    "given": GRID,
    "scenario": SCENARIO,
    "replays": an.replay(PROBLEM, SCENARIO, "astar"),
    "trajectory": TRAJECTORY,
    "spacing": 0.2,
    "margin": 0.0,
    "footprint": None,
    "footprint_padding": 0.0,
    "padding": 0.01,
    "queries": [PROBLEM],
    "stops": [(1.2, 2.2), (3.2, 4.2)],
    "tour": TOUR,
    "ahead": 2,
    "walks": 1,
}
#: Parameters that mean another thing there.
ELSEWHERE: dict[str, dict[str, Any]] = {
    "GridMap": {"cells": [[0, 1], [0, 0]]},
    "Problem.from_cells": {"start": (0, 0), "goal": (4, 5)},
    "costs.array": {"values": np.ones((5, 6))},
    "costs.costmap": {"costs": np.full((5, 6), 9, np.uint8)},
    "costs.keepout": {"mask": np.eye(5, 6, dtype=bool)},
    "costs.slope": {"elevation": np.zeros((5, 6))},
    "costs.speed": {"mask": np.full((5, 6), 50)},
    "maps.load_grades": {"path": "map.yaml"},
    "maps.to_cells": {"values": np.zeros((2, 3), np.int8)},
    "Terrain.graph": {"start": (0, 0)},
    "Terrain.reached": {"start": (0, 0)},
    "Terrain.joins": {"one": (0, 0), "other": (4, 5)},
    "preset": {"name": "paco"},
    "parameter": {"default": 3},
    "register.planner": {"kind": Own, "name": "own"},
    "register.objective": {"kind": OwnGoal, "name": "own"},
    "replay": {"algorithm": "astar"},
    "Mission": {"algorithm": "astar"},
    "algorithm": {"name": "astar"},
    "Result.save": {"path": "plan.json"},
    "Result.load": {"path": "plan.json"},
    "Scenario": {"events": SCENARIO.events},
    "Scenario.of": {"events": SCENARIO.events},
    "scenarios.Scenario": {"events": SCENARIO.events},
    "save_film": {"path": "film.html"},
    "Trajectory.save": {"path": "drive.ros2.yaml", "frame": "map", "stamp": 1.0},
    "Trajectory.load": {"path": "drive.csv"},
    "Footprint": {"points": [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.0)]},
    "Footprint.of_nav2": {"text": "[[0.3, 0.2], [0.3, -0.2], [-0.3, 0.0]]"},
    "Footprint.of": {"given": [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.0)]},
    "Scenario.save": {"path": "scenario.json"},
    "Scenario.load": {"path": "scenario.json"},
    "Front.save": {"path": "front.json"},
    "Front.load": {"path": "front.json"},
    "fronts.Exact": {"limit": 9},
    "fronts.Auto": {"limit": 9},
    "fronts.Nsga2": {"points": 3},
    "pareto": {"algorithm": "exact"},
    "fronts.pareto": {"algorithm": "exact"},
    "Alternatives.save": {"path": "routes.json"},
    "Animation.save": {"path": "film.gif"},
    "Tour.save": {"path": "tour.json"},
    "tour": {"cells": False},
    "Alternatives.load": {"path": "routes.json"},
    "load_map": {"path": "map.yaml"},
    "save_map": {"path": "saved.yaml"},
    "maps.load_map": {"path": "map.yaml"},
    "maps.save_map": {"path": "saved.yaml"},
    "maps.load_scenarios": {"path": "map.scen"},
}
REGISTRARS = ("algorithm", "cuts", "deadlock", "heuristic", "initial", "local_search", "pheromone", "transition")
ELSEWHERE |= {f"register.{kind}": {"function": lambda seen: 1, "name": "own"} for kind in REGISTRARS}
ELSEWHERE["register.cuts"]["function"] = lambda ground, paths, pieces: [1]
CHOICES = {an.Algorithm: QUICK, an.Decomposition: an.paco().decomposition}
#: Anything is true or false, but for an array of several values.
FLAGS = {"unknown", "allow_unknown", "map_cells", "invert", "turns"}
#: What they raise themselves passes.
FUNCTIONS = {"events", "function", "progress"}
#: Not called: types that come out of antnav, classes that only name things, abstract ones, and what is none of ours.
LEFT_OUT = {"AntnavError", "Result", "PRESETS", "maps.MapWarning", "maps.Scenario", "stop.Stop", "stop.Progress"}
LEFT_OUT |= {
    "maps.Grades",
    "exact.Optimum",
    "exact.ShortestLine",
    "spmd.Serial",
    "stop.Clock",
    "Cell",
    "CornerRule",
    "Status",
}
#: It starts processes: tests/conformance asks it.
LEFT_OUT |= {"check_rules"}
LEFT_OUT |= {
    "register.Ground",
    "register.OwnAlgorithm",
    "Front",
    "fronts.Front",
    "fronts.Method",
    "objectives.Objective",
    "objectives.over_cells",
}
LEFT_OUT |= {"Alternatives", "Animation", "plot.Animation", "Route", "Replay", "Tour", "Trajectory", "Update"}
LEFT_OUT |= {"Call", "Memory", "Plan", "Planner", "Replanner", *(f"events.{name}" for name in events.__all__)}
METHODS: dict[str, Any] = {
    "GridMap": GRID,
    "Problem": PROBLEM,
    "Path": PATH,
    "Result": RESULT,
    "Alternatives": ROUTES,
    "Terrain": PROBLEM.terrain,
    "Front": FRONT,
    "Scenario": SCENARIO,
    "Trajectory": TRAJECTORY,
    "Tour": TOUR,
    "Animation": an.animate(PROBLEM, QUICK, walks=0),
    "Footprint": an.Footprint.disc(0.2),
}


def offered() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Name and callable of all that antnav and its public submodules offer, and of its classes' methods."""
    for name in an.__all__:
        thing = getattr(an, name)
        if inspect.ismodule(thing):
            public = getattr(thing, "__all__", [inner for inner in vars(thing) if not inner.startswith("_")])
            found = {f"{name}.{inner}": getattr(thing, inner) for inner in public if name != "errors"}
        else:
            found = {name: thing}
        for full, inner in found.items():
            if full in LEFT_OUT or not callable(inner) or not inner.__module__.startswith("antnav"):
                continue
            if full == inner.__name__ or inner.__module__.startswith(thing.__name__):
                yield full, inner
    for name, instance in METHODS.items():
        for inner in dir(type(instance)):
            method = inspect.getattr_static(type(instance), inner)
            if not inner.startswith("_") and (inspect.isfunction(method) or isinstance(method, classmethod)):
                yield f"{name}.{inner}", getattr(instance, inner)
    yield "Colony.step", an.Colony(PROBLEM, QUICK).step
    yield "Colony.best_path", an.Colony(PROBLEM, QUICK).best_path


def arguments(name: str, call: Callable[..., Any]) -> dict[str, Any]:
    """Good arguments for all parameters that have no default, and names of the others."""
    good = GOOD | ELSEWHERE.get(name, {})
    if call in CHOICES:
        good |= {field.name: getattr(CHOICES[call], field.name) for field in fields(CHOICES[call])}
    taken = {}
    for parameter in inspect.signature(call).parameters.values():
        if parameter.kind in {parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD}:
            continue
        taken[parameter.name] = good.get(parameter.name, parameter.default)
        assert taken[parameter.name] is not parameter.empty, f"a good {parameter.name} of {name} is wanted above"
    return taken


def called(call: Callable[..., Any], given: dict[str, Any]) -> Any:
    parameters = inspect.signature(call).parameters
    first = [value for name, value in given.items() if parameters[name].kind is inspect.Parameter.POSITIONAL_ONLY]
    return call(*first, **dict(list(given.items())[len(first) :]))


@pytest.fixture(autouse=True)
def _in_a_folder_with_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    RESULT.save("plan.json")
    FRONT.save("front.json")
    ROUTES.save("routes.json")
    SCENARIO.save("scenario.json")
    TRAJECTORY.save("drive.csv")
    an.save_map(GRID, "map.yaml")
    Path("map.scen").write_text("version 1\n0 a.map 5 5 0 0 1 1 1.41421356\n")


NAMES = dict(offered())


def test_the_list_is_whole() -> None:
    wanted = {
        "solve",
        "Colony",
        "GridMap",
        "Problem.from_cells",
        "maps.generate",
        "costs.speed",
        "stop.AnyOf",
        "spmd.run_jobs",
        "npaco",
    }
    assert wanted <= NAMES.keys()
    assert len(NAMES) > 50


@pytest.mark.parametrize("name", NAMES)
def test_only_our_own_errors_come_out(name: str) -> None:
    call = NAMES[name]
    good = arguments(name, call)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        called(call, good)
        for parameter, value in itertools.product(good, ODD):
            if (parameter in FLAGS and isinstance(value, np.ndarray)) or (parameter in FUNCTIONS and callable(value)):
                continue
            try:
                called(call, good | {parameter: value})
            except AntnavError as error:
                assert error.rule, (name, parameter)
            except Exception as error:
                raise AssertionError(f"{name}({parameter}={shown(value)}) raises {error!r}") from error


def test_a_colony_before_its_first_iteration_has_no_last_one() -> None:
    colony = an.Colony(PROBLEM, QUICK)
    with pytest.raises(ParameterError, match="none is done yet"):
        _ = colony.last
    colony.step()
    assert colony.last.number == 1


def test_a_field_of_distances_is_to_a_whole_cell() -> None:
    assert an.exact.distance_field(PROBLEM, (0, 0))[0, 0] == 0
    for cell in ((0.5, 0), (-1, 0), (0, 6), (True, 0), "ab"):
        with pytest.raises(ParameterError, match="cell"):
            an.exact.distance_field(PROBLEM, cell)


@pytest.mark.parametrize("cells", [[(0.5, 1)], [(2**32, 0)], [1, 2, 3, 4], "ab", [(0, 1, 2)], [None]])
def test_paths_are_of_whole_cells(cells: object) -> None:
    with pytest.raises(PathError):
        an.Path(cells, GRID)


def test_a_path_without_cells_has_no_length() -> None:
    assert an.Path([], GRID).length == an.Path([(0, 0)], GRID).length == 0.0


@pytest.mark.parametrize("name", ["a\0b.json", "a\0b.csv", "a\0b.png", "a\0b.yaml", "a\0b.npy"])
def test_a_nul_in_a_name_is_told(name: str) -> None:
    writers = {".png": plot.save_picture, ".yaml": an.save_map, ".npy": an.save_map}
    save = writers.get(Path(name).suffix, an.Result.save)
    with pytest.raises(OutputError, match="null"):
        save(GRID if save is an.save_map else RESULT, name)
    with pytest.raises(AntnavError):
        an.load_map(name)
