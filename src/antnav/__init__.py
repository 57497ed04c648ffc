"""Ant-colony path planning for mobile robots on grid maps.

PACO (Si & Bao 2024, doi 10.3934/mbe.2024113), the algorithms around it, and the exact optimum beside every result.
"""

from __future__ import annotations

from importlib import import_module as _import_module
from importlib.metadata import version as _version
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from antnav import errors, maps
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
    preset,
    rank_as,
    traditional,
)
from antnav.colony.colony import Colony
from antnav.colony.parameters import Decomposition
from antnav.errors import AntnavError
from antnav.maps import load_map, save_map
from antnav.plan.algorithms import algorithm
from antnav.plan.solve import solve
from antnav.plan.steps import Steps
from antnav.plan.warmup import warmup
from antnav.planner import events
from antnav.planner.call import Call
from antnav.planner.exact import astar, dijkstra
from antnav.planner.memory import Memory
from antnav.planner.plan import Plan, Status
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.plot import plot_result
from antnav.run import spmd, stop
from antnav.search import exact
from antnav.search.abstraction import prepare
from antnav.world.grid import Cell, GridMap
from antnav.world.moves import CornerRule
from antnav.world.path import Path, check_path
from antnav.world.problem import Problem
from antnav.world.terrain import Terrain

if _TYPE_CHECKING:
    from antnav import costs

__version__ = _version("antnav")


def __getattr__(name: str) -> _Any:
    """`antnav.costs` is imported where it is used first."""
    if name == "costs":
        return _import_module("antnav.costs")
    raise AttributeError(f"module 'antnav' has no attribute {name!r}")


__all__ = [
    "PRESETS",
    "Algorithm",
    "AntnavError",
    "Call",
    "Cell",
    "Colony",
    "CornerRule",
    "Decomposition",
    "GridMap",
    "Memory",
    "Path",
    "Plan",
    "Planner",
    "Problem",
    "Result",
    "Status",
    "Steps",
    "Terrain",
    "acs",
    "algorithm",
    "astar",
    "check_path",
    "costs",
    "dai",
    "dijkstra",
    "errors",
    "events",
    "exact",
    "load_map",
    "luo",
    "maps",
    "mmas",
    "npaco",
    "paco",
    "paco_extended",
    "paco_large",
    "paco_levels",
    "paco_ls",
    "plot_result",
    "prepare",
    "preset",
    "rank_as",
    "save_map",
    "solve",
    "spmd",
    "stop",
    "traditional",
    "warmup",
]
