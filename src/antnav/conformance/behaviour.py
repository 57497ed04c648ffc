"""What a rule does: it ends, its paths are legal, its pheromone stays in bounds, it writes to nothing else."""

from __future__ import annotations

import functools
import inspect
from typing import Any

import numpy as np

from antnav.colony.colony import Colony
from antnav.colony.own import WRITEABLE
from antnav.colony.parts import Part
from antnav.colony.parts.parameter import LARGEST
from antnav.conformance.grounds import maps, problem_on, problems
from antnav.conformance.sameness import SEED, colony_of, first_problem, unshared
from antnav.conformance.subject import ASKED, Subject
from antnav.conformance.verdict import Broken, LeftOut, Measured, Told
from antnav.errors import PathError
from antnav.kernels import plugs
from antnav.plan.solve import solve
from antnav.world.path import check_cost, check_path
from antnav.world.problem import Problem


def documented(subject: Subject) -> Told:
    """A docstring, whose first line says what it is; each parameter with its range."""
    first = subject.doc.partition("\n")[0].strip()
    if not first:
        raise Broken("it has no docstring: its first line is what lists, reports and menus say of it")
    if isinstance(subject.made, Part):
        endless = [name for name, one in subject.made.parameters.items() if _is_endless(one)]
        if endless:
            raise Broken(
                f"{', '.join(endless)} has no range: write {endless[0]}=an.parameter(default, least=..., most=...)"
            )
    return first if len(first) <= 60 else f"{first[:57]}..."


def _is_endless(one: Any) -> bool:
    return not isinstance(one.default, bool) and one.least <= -LARGEST and one.most >= LARGEST


def runs(subject: Subject) -> Told:
    """It runs to its end."""
    planner = subject.planner()
    result = solve(first_problem(), planner, seed=SEED)
    if result.path is None:
        return "to its end, without a path"
    return Measured(f"to its end, gap {result.gap:.1%}", {"gap": result.gap})


def legal_paths(subject: Subject) -> Told:
    """Every path on every map is legal, and costs what is said; where there is none, none is found."""
    planner, tried, found = subject.planner(), 0, 0
    for name, problem in problems():
        tried += 1
        try:
            result = solve(problem, planner, seed=SEED)
            if result.path is None:
                if problem.start_cell == problem.goal_cell:
                    raise Broken(f"on {name}: no path")
                continue
            found += 1
            if not problem.connected:
                raise Broken(f"on {name}: a path where there is none")
            check_path(result.path, problem)
            check_cost(result.path, problem, result.cost)
        except PathError as error:
            raise Broken(f"on {name}: {error}") from error
        except (Broken, LeftOut):
            raise
        except Exception as error:
            raise Broken(f"on {name}: {error}") from error
    return Measured(f"{tried} problems, {found} paths, all legal", {"problems": tried, "paths": found})


def bounds(subject: Subject) -> Told:
    """After each iteration all pheromone is finite and within its bounds."""
    planner, most = colony_of(subject), 0.0
    for grid in maps():
        problem = problem_on(grid)
        colony = Colony(problem, planner, SEED)
        edges = colony.task.grid_graph.graph.neighbours < len(colony.task.grid_graph)
        for iteration in colony:
            low, high = colony._state.bounds
            tau = colony.tau[edges]
            where = f"on {grid.name}, iteration {iteration.number}"
            if not np.isfinite(tau).all():
                raise Broken(f"{where}: pheromone of {tau[~np.isfinite(tau)][0]}")
            if not low > 0:
                raise Broken(f"{where}: a lower bound of {low:g}, so that edges can be lost for good")
            if tau.min() < low or tau.max() > high:
                raise Broken(f"{where}: pheromone in {tau.min():g}..{tau.max():g}, its bounds are {low:g} and {high:g}")
            most = max(most, float(tau.max()))
    return Measured(f"finite and within its bounds, {most:.3g} at most", {"largest": most})


def writes(subject: Subject) -> Told:
    """It writes to nothing but what it may."""
    planner, problem = subject.planner(), first_problem()
    with unshared(problem):
        solve(problem, planner, seed=SEED)
    if subject.kind not in ASKED:
        return "nothing of the problem"
    if type(subject.made).jit:
        _compile_closed(subject.made, subject.kind)
    _watched(subject, problem)
    may = sorted(WRITEABLE.get(subject.kind, set()) | {"notes"})
    return f"to nothing but {', '.join(may)}"


def _compile_closed(part: Part, kind: str) -> None:
    """Compile a rule once more, for arrays that are read-only where it must not write: the compiler then refuses."""
    import numba
    from numba import types
    from numba.core.errors import NumbaError

    place = plugs.KINDS.index(kind)
    seen: Any = plugs.SEEN[place]
    given: Any = plugs.type_of(seen)
    may = WRITEABLE.get(kind, set()) | {"notes"}
    closed = [
        one.copy(readonly=True) if isinstance(one, types.Array) and name not in may else one
        for name, one in zip(seen._fields, given.types, strict=True)
    ]
    function = type(part).function
    values = [getattr(part, name) for name in list(inspect.signature(function).parameters)[1:]]
    own = [types.int64 if isinstance(value, int) else types.float64 for value in values]
    compiled: Any = numba.njit(error_model="numpy")(getattr(function, "py_func", function))
    try:
        compiled.compile((type(given)(closed, seen), *own))
    except NumbaError as error:
        lines = [line.strip() for line in str(error).splitlines() if "readonly" in line or "read-only" in line]
        if lines:
            raise Broken(f"it writes to what it is only shown: {lines[0]}") from None


def _watched(subject: Subject, problem: Problem) -> None:
    """Run a rule in Python, and look after each call whether something else has changed."""
    part = subject.made
    may = WRITEABLE.get(subject.kind, set()) | {"notes"}
    function = type(part).function
    plain = getattr(function, "py_func", function)

    @functools.wraps(plain)
    def watched(seen: Any, *given: Any, **own: Any) -> Any:
        shown = {
            name: value for name, value in seen._asdict().items() if isinstance(value, np.ndarray) and name not in may
        }
        before = {name: value.copy() for name, value in shown.items()}
        answer = plain(seen, *given, **own)
        for name, value in shown.items():
            if value.tobytes() != before[name].tobytes():
                raise Broken(f"it writes to {name}, which it is only shown")
        return answer

    kind: Any = type(type(part).__name__, (type(part),), {"function": staticmethod(watched), "jit": False})
    few = {"iterations": 4, "ants": 8}
    try:
        solve(problem, subject.planner(**{subject.kind: kind(**part.values())}, **few), seed=SEED)
    except Exception as error:
        cause: BaseException | None = error
        while cause is not None and not isinstance(cause, Broken):
            cause = cause.__cause__
        if cause is not None:
            raise cause from None
        if "read-only" in str(error):
            raise Broken(f"it writes to what it is only shown: {error}") from None
        raise
