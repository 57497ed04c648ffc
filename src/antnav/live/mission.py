"""Mission: a robot on its way over a map that changes."""

from __future__ import annotations

import time
from threading import RLock
from typing import Any

import numpy as np

from antnav.errors import ParameterError, shown
from antnav.live.ants import Anew
from antnav.live.methods import replanner
from antnav.live.replanner import Path, Replanner
from antnav.live.terrain import LiveTerrain
from antnav.live.update import MissionStatus, Update
from antnav.planner.memory import Memory
from antnav.planner.planner import Planner
from antnav.search.exact import optimum
from antnav.values import whole_in
from antnav.world.grid import whole_pair
from antnav.world.problem import CellIndex, Point, Problem, check_point, check_problem

#: Rounds of improvement that one call may ask for.
MOST_ROUNDS = 1000


class Mission:
    """A robot on its way to a goal over a map that changes: a plan that is mended where it must be, and kept elsewhere.

    The map of the problem stays as it is; the mission has its own, altered by `change`. Calls from several threads wait
    for each other.

    Parameters
    ----------
    problem : Problem
        Map, the robot's place, goal, corner rule, costs. Where the robot's cell or the goal's is closed later, the plan
        begins or ends at the nearest open cell within the problem's tolerance.
    algorithm : str, Replanner or Planner
        One of `antnav.live.methods.METHODS`; or a planner such as `an.npaco(memory="eta")`, or the name of your own,
        which solves each map anew, ants on cells with the pheromone of the run before. A replanner handed in serves its
        latest mission only.
    seed : int
        Of a planner's first run. The replanners by name draw no numbers.
    radius : float
        Of the robot in metres, for a map without it: obstacles that come and go are as wide as they are for this robot.
    strict : bool
        See `GridMap.inflated`.

    Attributes
    ----------
    plan : Update
        The plan in force.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> mission = an.Mission(problem)
    >>> update = mission.change(blocked=[mission.plan.cells[10]], at=problem.start)
    >>> if update:
    ...     print(update.status, round(update.cost, 2), f"{update.changed_share:.0%} of its cells are others")
    planned 30.97 11% of its cells are others
    """

    plan: Update

    def __init__(
        self,
        problem: Problem,
        algorithm: str | Replanner | Planner = "regions",
        *,
        seed: int = 0,
        radius: float = 0.0,
        strict: bool = False,
    ) -> None:
        check_problem(problem)
        self._replanner = replanner(algorithm, seed)
        self._own = not isinstance(algorithm, str | Planner)
        self._lock = RLock()
        self._grid = problem.grid
        self.terrain = LiveTerrain(problem, radius, strict)
        self._replanner.prepare()
        self._start, self._goal = problem.flat_ends
        self._tolerances = problem.start_tolerance, problem.goal_tolerance
        self._from, self._to = self._start, self._goal  #: ends of the plan: open cells near robot and goal
        self._begun = False
        self._replanner.serves = self.terrain
        self.plan = Update(MissionStatus.UNREACHABLE, None, np.inf, "", 0, 0.0, None, self._grid)
        begin = time.perf_counter()
        self._find_ends()
        self._conclude(begin, "planned anew", 0, self._anew())

    def __repr__(self) -> str:
        return f"Mission({self.position} -> {self.goal}, {self._replanner.name}, {self.plan})"

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a mission cannot be copied or pickled; begin another with Mission(mission.problem)")

    def _repr_html_(self) -> str:
        from antnav.markup import map_html

        with self._lock:
            return map_html(self.terrain.grid.cells, repr(self), self.plan.cells)

    @property
    def position(self) -> CellIndex:
        """The robot's cell, (row, col)."""
        return self._cell(self._start)

    @property
    def goal(self) -> CellIndex:
        """The goal's cell, (row, col)."""
        return self._cell(self._goal)

    @goal.setter
    def goal(self, cell: CellIndex) -> None:
        flat = self.terrain.to_flat(whole_pair("goal", cell))
        with self._lock:
            self._check_served()
            begin = time.perf_counter()
            self._goal, self._begun = flat, False
            self._find_ends()
            self._conclude(begin, "planned anew", 0, self._anew())

    def _cell(self, flat: int) -> CellIndex:
        row, col = divmod(flat, self.terrain.width)
        return row - 1, col - 1

    def change(self, *, blocked: Any = None, freed: Any = None, cost: Any = None, at: Point | None = None) -> Update:
        """Some cells are occupied now, some are free, some cost something else.

        Parameters
        ----------
        blocked, freed : array_like, optional
            Rows and columns, shape (k, 2), or a mask of the map's shape. Freed cells hold no obstacle any more,
            whatever was there, and unknown ones are known; where the radius of the robot reaches another obstacle, they
            stay closed. A cell that is in both is blocked: of what moves, give where it is and where it was.
        cost : CostField or (cells, values), optional
            Costs per metre: of the whole map, or of some cells.
        at : (x, y), optional
            Where the robot is now, in metres; default: where it was.

        Returns
        -------
        Update
            The plan in force, now `plan`.

        Raises
        ------
        ParameterError
            A cell or the robot lies outside the map, a cost is out of range, or the replanner serves another mission by
            now. The map is as before then.
        """
        terrain = self.terrain
        closing, opening = terrain.flat_of("blocked", blocked), terrain.flat_of("freed", freed)
        if len(closing) and len(opening):
            opening = opening[np.isin(opening, closing, invert=True)]
        pricing = None if cost is None else terrain.costs(cost)
        start = None if at is None else self._flat_at(at)
        with self._lock:
            self._check_served()
            begin = time.perf_counter()
            changed = terrain.alter(closing, opening)
            if pricing is not None:
                if not terrain.priced:
                    terrain.begin_prices()
                    self._begun = False
                changed = np.concatenate((changed, terrain.price(*pricing)))
            self._start = self._start if start is None else start
            self._find_ends()
            if not self._begun or not self._ends_open:
                self._replanner.altered(changed)
                self._conclude(begin, "planned anew", len(changed), self._anew())
            else:
                self._conclude(begin, "", len(changed), self._replanner.changed(changed, self._from))
            return self.plan

    def moved(self, position: Point) -> Update:
        """The robot is at a place in metres now."""
        return self._moved(self._flat_at(position))

    def moved_to(self, cell: CellIndex) -> Update:
        """The robot is on a cell now, (row, col)."""
        return self._moved(self.terrain.to_flat(whole_pair("cell", cell)))

    def _moved(self, flat: int) -> Update:
        with self._lock:
            self._check_served()
            begin = time.perf_counter()
            self._start = flat
            self._find_ends()
            anew = not self._begun or not self._ends_open
            self._conclude(begin, "", 0, self._anew() if anew else self._replanner.moved(self._from))
            return self.plan

    def improve(self, rounds: int = 1) -> Update:
        """Use idle time: so many rounds of work on the plan, counted, so that a repetition gives the same plan."""
        rounds = whole_in("rounds", rounds, 1, MOST_ROUNDS)
        with self._lock:
            self._check_served()
            begin = time.perf_counter()
            if self.plan.status is MissionStatus.PLANNED and self._replanner.improves:
                self._conclude(begin, "", 0, self._replanner.improve(rounds))
            return self.plan

    @property
    def problem(self) -> Problem:
        """The problem of the moment, a copy that does not change: for `check_path`, `solve`, pictures.

        Raises
        ------
        OccupiedError
            The robot's cell or the goal's is closed now.
        """
        with self._lock:
            return self.terrain.problem(self._from, self._to)

    @property
    def gap(self) -> float:
        """How much more the plan costs than the exact optimum of the moment, as a share; nan without a plan.

        The optimum is searched when this is asked for.
        """
        with self._lock:
            if self.plan.flat is None:
                return np.nan
            least = optimum(self.problem).cost
            return self.plan.cost / least - 1 if least > 0 else 0.0

    @property
    def memory(self) -> Memory | None:
        """Pheromone of the latest run of ants, to be looked at and saved; None without any. `del` clears it."""
        return self._replanner.memory if isinstance(self._replanner, Anew) else None

    @memory.deleter
    def memory(self) -> None:
        with self._lock:
            if isinstance(self._replanner, Anew):
                self._replanner.memory = None

    def _check_served(self) -> None:
        if self._replanner.serves is not self.terrain:
            rule = "another mission has begun with it, and it serves one at a time"
            raise ParameterError(f"replanner {self._replanner.name!r}", rule, "give each mission one of its own")

    def _flat_at(self, position: Point) -> int:
        return self.terrain.to_flat(self._grid.cell_at(check_point("position", position)))

    @property
    def _ends_open(self) -> bool:
        return self.terrain.is_open(self._from) and self.terrain.is_open(self._to)

    def _find_ends(self) -> None:
        """Where the plan begins and ends: at robot and goal, or at open cells within the tolerances."""
        of_start, of_goal = self._tolerances
        self._from = self.terrain.open_near(self._start, of_start)
        aim = self.terrain.open_near(self._goal, of_goal)
        if aim != self._to:
            self._to, self._begun = aim, False

    def _check(self, path: Path) -> None:
        """Refuse what a replanner of the user's own should not have given."""
        terrain, name = self.terrain, type(self._replanner).__name__
        rule = "a path is int32, flat cells from the robot to the goal; None is no way"
        if not isinstance(path, np.ndarray) or path.dtype != np.int32 or path.ndim != 1 or not len(path):
            remedy = "give terrain.to_flat((row, col)) for each cell, see help(an.Replanner)"
            raise ParameterError(f"path {shown(path)} of {name}", rule, remedy)
        if path[0] != self._from or path[-1] != self._to:
            ends = f"{self._cell(int(path[0]))} -> {self._cell(int(path[-1]))}"
            told = f"it leads from {self._cell(self._from)} to {self._cell(self._to)}"
            raise ParameterError(f"path {ends} of {name}", told, "begin at start, which each call is told")
        broken = terrain.broken(path)
        if broken is not None:
            one, other = self._cell(int(path[broken])), self._cell(int(path[broken + 1]))
            raise ParameterError(f"path of {name}", f"the move {one} -> {other} is not legal", "see terrain.moves")

    def _anew(self) -> Path:
        """Plan from the beginning, where both ends are open."""
        self._begun = self._ends_open
        return self._replanner.begin(self.terrain, self._from, self._to) if self._begun else None

    def _conclude(self, begin: float, reason: str, altered: int, path: Path) -> None:
        before = self.plan.flat
        if self._own and path is not None:
            self._check(path)
        status = MissionStatus.PLANNED
        if not self.terrain.is_open(self._from):
            status = MissionStatus.START_BLOCKED
        elif not self.terrain.is_open(self._to):
            status = MissionStatus.GOAL_BLOCKED
        elif self._from == self._to:
            status = MissionStatus.ARRIVED
            path = np.array([self._from], np.int32)
        elif path is None:
            known = self._replanner.certain or not self.problem.connected
            status = MissionStatus.UNREACHABLE if known else MissionStatus.NO_PATH
        cost = np.inf if path is None else self.terrain.cost_along(path)
        if path is None:
            reason = "no way"
        elif not reason:
            kept = before is not None and len(path) <= len(before) and np.array_equal(path, before[-len(path) :])
            reason = self._replanner.did
            if before is not None and kept:
                reason = "kept" if len(path) == len(before) else "went on"
        seconds = time.perf_counter() - begin
        self.plan = Update(status, path, cost, reason, altered, seconds, before, self._grid)
