"""Ant-colony path planning for mobile robots on grid maps.

PACO (Si & Bao 2024, doi 10.3934/mbe.2024113), the algorithms around it, and the exact optimum beside every result.
"""

from __future__ import annotations

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from antnav import errors
from antnav.ants.algorithm import Algorithm
from antnav.ants.presets import (
    PRESETS,
    acs,
    dai,
    luo,
    mmas,
    npaco,
    paco,
    paco_extended,
    paco_large,
    paco_levels,
    paco_ls,
    paco_taut,
    preset,
    rank_as,
    traditional,
    two_ended,
)
from antnav.colony.colony import Colony
from antnav.colony.parameters import Decomposition
from antnav.colony.parts import parameter
from antnav.errors import AntnavError
from antnav.plan.algorithms import algorithm
from antnav.plan.solve import solve
from antnav.plan.steps import Steps
from antnav.plan.warmup import warmup
from antnav.planner import events
from antnav.planner.call import Call
from antnav.planner.exact import astar, dijkstra, jps
from antnav.planner.memory import Memory
from antnav.planner.plan import Plan, Status
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.run import spmd, stop
from antnav.search import exact
from antnav.search.abstraction import prepare
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import Path, check_path
from antnav.world.problem import Problem
from antnav.world.terrain import Terrain

if _TYPE_CHECKING:
    from antnav import costs, fronts, maps, objectives, register, scenarios
    from antnav.batch.many import solve_many
    from antnav.conformance import check_rules
    from antnav.fronts.front import Front
    from antnav.fronts.pareto import pareto
    from antnav.live.mission import Mission
    from antnav.live.replanner import Replanner
    from antnav.live.update import Update
    from antnav.maps import load_map, save_map
    from antnav.plot import Animation, animate, plot_front, plot_replay, plot_result, save_film
    from antnav.plot.routes import plot_alternatives
    from antnav.plot.tours import plot_tour
    from antnav.routes.alternatives import alternatives
    from antnav.routes.model import Alternatives, Route
    from antnav.scenarios import Scenario
    from antnav.scenarios.model import Replay
    from antnav.scenarios.replay import replay
    from antnav.tours.model import Tour
    from antnav.tours.tour import tour
    from antnav.trajectories.check import check_trajectory
    from antnav.trajectories.footprint import Footprint
    from antnav.trajectories.model import Trajectory
    from antnav.trajectories.trajectory import trajectory
    from antnav.view.widget import View

    __version__: str


#: What is imported where it is used first.
_LAZY = {
    "Alternatives": "antnav.routes.model",
    "Animation": "antnav.plot",
    "Footprint": "antnav.trajectories.footprint",
    "Front": "antnav.fronts",
    "Mission": "antnav.live.mission",
    "Replay": "antnav.scenarios.model",
    "Replanner": "antnav.live.replanner",
    "Route": "antnav.routes.model",
    "Scenario": "antnav.scenarios",
    "Tour": "antnav.tours.model",
    "Trajectory": "antnav.trajectories.model",
    "Update": "antnav.live.update",
    "View": "antnav.view.widget",
    "alternatives": "antnav.routes.alternatives",
    "animate": "antnav.plot",
    "check_rules": "antnav.conformance",
    "check_trajectory": "antnav.trajectories.check",
    "costs": "",
    "fronts": "",
    "load_map": "antnav.maps",
    "maps": "",
    "objectives": "",
    "pareto": "antnav.fronts",
    "plot": "",
    "plot_alternatives": "antnav.plot.routes",
    "plot_front": "antnav.plot",
    "plot_replay": "antnav.plot",
    "plot_result": "antnav.plot",
    "plot_tour": "antnav.plot.tours",
    "register": "",
    "replay": "antnav.scenarios.replay",
    "save_film": "antnav.plot",
    "save_map": "antnav.maps",
    "scenarios": "",
    "tour": "antnav.tours.tour",
    "trajectory": "antnav.trajectories.trajectory",
    "solve_many": "antnav.batch.many",
}


def __getattr__(name: str) -> _Any:
    found: _Any
    if name == "__version__":
        from importlib.metadata import version

        found = version("antnav")
    elif name not in _LAZY:
        raise AttributeError(f"module 'antnav' has no attribute {name!r}")
    else:
        found = getattr(_import_module(_LAZY[name]), name) if _LAZY[name] else _import_module(f"antnav.{name}")
    globals()[name] = found  # so that nobody asks here again
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY, "__version__"})


__all__ = [
    "PRESETS",
    "Algorithm",
    "Alternatives",
    "Animation",
    "AntnavError",
    "Call",
    "Cell",
    "Colony",
    "CornerRule",
    "Decomposition",
    "Footprint",
    "Front",
    "GridMap",
    "Memory",
    "Mission",
    "Path",
    "Plan",
    "Planner",
    "Problem",
    "Replanner",
    "Replay",
    "Result",
    "Route",
    "Scenario",
    "Status",
    "Steps",
    "Terrain",
    "Tour",
    "Trajectory",
    "Update",
    "View",
    "acs",
    "algorithm",
    "alternatives",
    "animate",
    "astar",
    "check_path",
    "check_rules",
    "check_trajectory",
    "costs",
    "dai",
    "dijkstra",
    "errors",
    "events",
    "exact",
    "fronts",
    "jps",
    "load_map",
    "luo",
    "maps",
    "mmas",
    "npaco",
    "objectives",
    "paco",
    "paco_extended",
    "paco_large",
    "paco_levels",
    "paco_ls",
    "paco_taut",
    "parameter",
    "pareto",
    "plot_alternatives",
    "plot_front",
    "plot_replay",
    "plot_result",
    "plot_tour",
    "prepare",
    "preset",
    "rank_as",
    "register",
    "replay",
    "save_film",
    "save_map",
    "scenarios",
    "solve",
    "solve_many",
    "spmd",
    "stop",
    "tour",
    "traditional",
    "trajectory",
    "two_ended",
    "warmup",
]
