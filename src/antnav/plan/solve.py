"""solve: a problem and a planner in, a result out."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from types import UnionType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from antnav.ants.presets import paco
from antnav.errors import AntnavError, ParameterError, PathError, RuleError, check_type, shown
from antnav.kernels.ant_kernels import History
from antnav.plan.warmup import warmup
from antnav.planner.call import Call, CancelOrFailure, Event, check_conduct
from antnav.planner.events import Ended, Started
from antnav.planner.memory import Memory
from antnav.planner.plan import Plan, Stage, Status, StoppedBy, iterations_of
from antnav.planner.planner import KINDS, Planner
from antnav.planner.result import Result, versions
from antnav.plugins.loading import innermost, said
from antnav.run.stop import Stop
from antnav.values import check_seed
from antnav.world.path import Path, check_path
from antnav.world.problem import Problem, check_problem

if TYPE_CHECKING:
    from antnav.run.channel import Asked

#: Types of a plan's fields that come from planners of one's own, too.
_TYPES: Mapping[str, type | UnionType] = {
    "status": Status | None,
    "stopped_by": StoppedBy,
    "stages": tuple,
    "history": History,
    "notes": tuple,
}


def solve(
    problem: Problem,
    algorithm: Planner | None = None,
    *,
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
    cancel: Asked | None = None,
    events: Callable[[Event], None] | None = None,
    warm: Memory | Result | None = None,
    remember: bool = False,
) -> Result:
    """Plan a path.

    Parameters
    ----------
    problem : Problem
    algorithm : Planner, optional
        A preset such as `paco()` (default), `npaco()` or `traditional()`; `astar()`, `dijkstra()` or `jps()`; one of
        `antnav.rivals.RIVALS`; or a `Planner` of your own.
    seed : int
        0 <= seed < 2**64. The same seed gives the same result whatever the executor and the number of workers.
    stop : Stop, optional
        Ends the run before its schedule does, for instance ``Seconds(0.5) | TargetLength(30)``.
    executor : concurrent.futures.Executor, optional
        Where the colonies of a stage run side by side; default: threads.
    cancel : threading.Event, optional
        Set it from elsewhere, and the best so far comes back.
    events : callable, optional
        Gets events (`antnav.events`) one at a time, from worker threads: what began, how colonies stand, better paths,
        the result. From executors in other processes of this machine, too.
    warm : Memory or Result, optional
        Begin with the pheromone of an earlier run, whatever its start, goal, corner rule and obstacles, on a map of the
        same shape. For ants on cells, whose `memory` says what becomes of it (docs/memory.md); `mmas` resets it with
        its first path, as its rule says.
    remember : bool
        Whether the result gets its `memory`, the pheromone for `warm`: 64 bytes a cell that can be reached.

    Returns
    -------
    Result
        With status "unreachable" where no path exists, "no_ant_arrived" or "no_path" where none was found: these are no
        errors.

    Raises
    ------
    ParameterError
        A parameter is out of range, the planner cannot use `warm` or `remember`, or one of your own gave no `Plan`.
    RuleError
        A planner or a rule of your own raised.
    PathError
        The path of a planner of your own does not lead from the start to the goal.
    WorkerLostError
        A worker of the executor died again and again.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> result = an.solve(problem, an.paco(), seed=7, stop=an.stop.Iterations(20))
    >>> f"{result.status}, {result.length:.4f} cells, {100 * result.gap:.2f} % above the optimum"
    'found, 30.9706 cells, 0.00 % above the optimum'
    """
    planner = checked(problem, algorithm, seed)
    check_conduct(stop, executor, cancel)
    if not (events is None or callable(events)):
        raise ParameterError(f"events {shown(events)}", "it is called with events", "give a function")
    memory = _memory(warm, remember, planner, problem)
    seconds_compile = warmup(planner, turns=problem.turning > 0)
    planner = planner.suited(problem)
    call = Call(int(seed), stop, executor, CancelOrFailure(cancel), events, warm=memory, remember=bool(remember))
    cpu = time.thread_time()
    call.tell(Started(planner.name, call.seed))
    plan = without_search(problem) or _planned(planner, problem, call)
    result = concluded(problem, planner, call, plan, time.thread_time() - cpu, seconds_compile)
    call.tell(Ended(result))
    return result


def checked(problem: Problem, algorithm: Planner | None, seed: int) -> Planner:
    """The planner, `paco` by default, if all three are what they should be.

    Raises
    ------
    ParameterError
        One is not.
    """
    planner: Planner = paco() if algorithm is None else algorithm
    check_type("algorithm", planner, Planner, "call a preset, as in an.paco(), or derive from an.Planner")
    check_problem(problem)
    check_seed(seed)
    return planner


def _memory(warm: Memory | Result | None, remember: bool, planner: Planner, problem: Problem) -> Memory | None:
    """What the run begins with, if the planner can, and it fits the map."""
    check_type("warm", warm, Result | Memory | None, "give result.memory of a run with remember=True")
    check_type("remember", remember, bool | np.bool_, "give True or False")
    memory = warm.memory if isinstance(warm, Result) else warm
    if warm is not None and memory is None:
        raise ParameterError(f"warm {warm!r}", "the result has no memory", "run it with remember=True")
    if (remember or memory) and not planner.remembers:
        given = f"{'remember' if memory is None else 'warm'} with {planner.name}"
        remedy = "leave it out, or give ants on cells, such as an.npaco()"
        raise ParameterError(given, "it has no pheromone that another run could begin with", remedy)
    if memory and memory.shape != problem.grid.shape:
        (rows, cols), grid = memory.shape, problem.grid
        rule = f"the map has {grid.rows} x {grid.cols} cells"
        raise ParameterError(f"warm of {rows} x {cols} cells", rule, "give the memory of a run on a map of that shape")
    return memory


def without_search(problem: Problem) -> Plan | None:
    """The plan of a robot that is where it should be; None where there is something to search."""
    return Plan(cells=np.array([problem.start_cell], np.int32)) if problem.start_cell == problem.goal_cell else None


def _planned(planner: Planner, problem: Problem, call: Call) -> Plan:
    """The planner's answer; what one from outside antnav raises is told as its own error.

    Raises
    ------
    RuleError
    """
    try:
        return planner.plan(problem, call)
    except AntnavError:
        raise
    except Exception as error:
        if type(planner).__module__.partition(".")[0] == "antnav":
            raise
        given = f"planner {getattr(planner, 'source', planner.name)}"
        raise RuleError(given, f"it raised {said(error)} ({innermost(error)})", "mend it") from error


def _check(plan: Plan, planner: Planner) -> None:
    """Refuse a planner's answer that contradicts itself."""
    check_type(f"plan of {planner.name}", plan, Plan, "return an.Plan(cells=...) from its method plan")
    given = f"plan of {planner.name} with"
    for name, kind in _TYPES.items():
        check_type(f"{given} {name}", getattr(plan, name), kind, "see help(an.Plan)")
    for stage in plan.stages:
        check_type(f"{given} a stage", stage, Stage, "see help(an.Plan)")
    if plan.status is Status.FOUND and plan.cells is None:
        raise ParameterError(f"{given} status found", "there are cells where a path was found", "give them as cells")
    done, lengths = iterations_of(plan.stages), sorted({len(column) for column in plan.history})
    if lengths != [done]:
        rule = f"it has a value for each of the {done} iterations of its stages"
        raise ParameterError(f"{given} a history of {lengths}", rule, "tell the iterations in stages, or no history")


def _path(cells: NDArray[np.int32], problem: Problem, planner: Planner) -> Path:
    """The cells that a planner answered as a path between the ends."""
    given = f"plan of {planner.name}"
    try:
        path = Path(cells, problem.grid, problem.start, problem.goal)
    except PathError as error:
        raise PathError(f"{given}, {error.given}", error.rule, error.remedy) from None
    if not len(path):
        raise PathError(f"{given} without cells", "a path has one or more", "give cells=None where none was found")
    for end, cell, wanted in (
        ("start", path.cells[0], problem.start_cell),
        ("goal", path.cells[-1], problem.goal_cell),
    ):
        if tuple(cell.tolist()) != wanted:
            rule = f"the {end} is cell {wanted}"
            raise PathError(f"{given} with {end} {tuple(cell.tolist())}", rule, "give cells from the start to the goal")
    # Antnav's own are checked by its tests, and by studies and --check; ants with users' rules as they walk.
    if planner.kind not in KINDS or (planner.own and planner.kind != "ants"):
        try:
            check_path(path, problem)
        except PathError as error:
            raise PathError(f"{given}, {error.given}", error.rule, "mend the planner") from None
    return path


def concluded(
    problem: Problem, planner: Planner, call: Call, plan: Plan, cpu_seconds: float, seconds_compile: float = 0.0
) -> Result:
    """The plan as a result.

    Raises
    ------
    PathError, ParameterError
        It cannot be the answer to this problem.
    """
    _check(plan, planner)
    path = None if plan.cells is None else _path(plan.cells, problem, planner)
    seconds = call.began.seconds() if plan.seconds is None else plan.seconds
    status = plan.status
    if path is not None:
        status = Status.FOUND
    elif status is None:
        status = Status.NO_PATH if problem.connected else Status.UNREACHABLE
    return Result(
        status=status,
        stopped_by=plan.stopped_by,
        problem=problem,
        algorithm=planner,
        seed=call.seed,
        path=path,
        auxiliary_cell=plan.auxiliary_cell,
        stages=plan.stages,
        history=plan.history,
        estimated=plan.estimated,
        heat=plan.heat,
        memory=(plan.memory or call.warm) if call.remember else None,  # nobody walked: what was known stays known
        stop=None if call.stop is None else repr(call.stop),
        notes=(*plan.notes, *problem.moved_ends),
        seconds_run=seconds,
        seconds_compile=seconds_compile,
        cpu_seconds=cpu_seconds if plan.cpu_seconds is None else plan.cpu_seconds,
        versions=versions() | libraries if (libraries := planner.versions()) else versions(),  # most share one
    )
