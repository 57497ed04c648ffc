"""The stages that a run can have."""

from __future__ import annotations

from enum import StrEnum


class Phase(StrEnum):
    """What is done in a stage of a run.

    - whole map: one colony looks for the whole way
    - stage one: PACO's two colonies look for the cell at which to divide
    - stage two: PACO's colonies each look for their piece of the way
    - abstraction: the map in short is worked out, without ants
    - regions: two colonies look for routes on the graph of regions
    - routes: the best routes are laid out on cells, without ants
    - windows: pieces of the path are searched anew, exactly
    - search: a planner without ants does all its work
    """

    WHOLE_MAP = "whole map"
    STAGE_ONE = "stage one"
    STAGE_TWO = "stage two"
    ABSTRACTION = "abstraction"
    REGIONS = "regions"
    ROUTES = "routes"
    WINDOWS = "windows"
    SEARCH = "search"
