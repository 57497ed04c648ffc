"""pareto: a problem and its objectives in, a front out."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from functools import partial

import numpy as np

from antnav.errors import ParameterError, shown
from antnav.fronts.auto import Auto
from antnav.fronts.colonies import Colonies
from antnav.fronts.exact import Exact
from antnav.fronts.front import Front, ObjectivePart
from antnav.fronts.instance import Instance
from antnav.fronts.method import Found, Method
from antnav.fronts.nsga2 import Nsga2
from antnav.fronts.p_aco import PAco
from antnav.fronts.sweep import Sweep
from antnav.kernels import front_kernels
from antnav.objectives.objective import Objective, check_objectives
from antnav.objectives.turning import Turns
from antnav.objectives.way import Length
from antnav.planner.call import Call, CancelOrFailure, check_conduct
from antnav.planner.once import once
from antnav.planner.plan import Status
from antnav.planner.result import versions
from antnav.run.stop import Iterations, Stop
from antnav.values import check_seed, read_only
from antnav.world.grid import GridMap
from antnav.world.path import Path
from antnav.world.problem import Problem, check_problem

#: Methods by name, with their defaults.
METHODS: Mapping[str, type[Method]] = {
    "auto": Auto,
    "exact": Exact,
    "sweep": Sweep,
    "ants": Colonies,
    "p-aco": PAco,
    "nsga2": Nsga2,
}


def pareto(
    problem: Problem,
    objectives: Sequence[Objective],
    *,
    algorithm: Method | str = "auto",
    seed: int = 0,
    stop: Stop | None = None,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Front:
    """Find the paths that no other path beats: better in none of the objectives without being worse in another.

    Parameters
    ----------
    problem : Problem
        Its cells, corner rule and ends. Costs that it has besides are not weighed: say them as objectives.
    objectives : sequence of 2 to 6 Objective
        Of `antnav.objectives`, or of your own.
    algorithm : Method or str
        "auto" (default), another of `fronts.METHODS`, or one of `antnav.fronts` with parameters of its own.
    seed : int
        0 <= seed < 2**64. The same seed gives the same front whatever the executor and the number of workers.
    stop : Stop, optional
        Ends the search before it is done, for instance ``Seconds(0.5)``.
    executor : concurrent.futures.Executor, optional
        Where colonies run side by side; default: threads.
    cancel : threading.Event, optional
        Set it from elsewhere, and the best so far comes back.

    Returns
    -------
    Front
        With status "unreachable" where no path exists.

    Raises
    ------
    ParameterError
        What is given is out of range, or the problem has costs of its own.

    Examples
    --------
    >>> import antnav as an
    >>> problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start=(0, 0), goal=(19, 19))
    >>> front = an.pareto(problem, [an.objectives.Length(), an.objectives.Turns()])
    >>> front.values.round(2)
    array([[30.97,  7.  ],
           [31.56,  6.  ],
           [32.14,  5.  ],
           [32.73,  3.  ],
           [35.07,  2.  ]])
    """
    check_problem(problem)
    chosen = check_objectives(objectives)
    check_seed(seed)
    check_conduct(stop, executor, cancel)
    check_unpriced(problem)
    method = chosen_method(algorithm)
    call = Call(int(seed), stop, executor, CancelOrFailure(cancel))
    began = time.perf_counter()
    instance = Instance.of(problem, chosen)
    found = method.find(instance, call) if problem.connected else Found(paths=(), complete=True, work={})
    nodes, values = _undominated(instance, found)
    return Front(
        status=Status.FOUND if problem.connected else Status.UNREACHABLE,
        stopped_by=found.stopped_by,
        complete=found.complete,
        problem=problem,
        objectives=tuple(
            ObjectivePart(each.name, each.unit, prices.step)
            for each, prices in zip(chosen, instance.prices, strict=True)
        ),
        values=read_only(values),
        paths=tuple(Path(instance.graph.cells[path], problem.grid, problem.start, problem.goal) for path in nodes),
        method=method.document(),
        certainty=method.certainty,
        seed=call.seed,
        work=found.work,
        stop=None if stop is None else repr(stop),
        notes=(*found.notes, *problem.moved_ends),
        seconds_run=time.perf_counter() - began,
        versions=versions() | method.versions(),
    )


def check_unpriced(problem: Problem) -> None:
    """Refuse a problem that has costs beside its objectives; cells that are closed are no costs.

    Raises
    ------
    ParameterError
        It has.
    """
    if problem.turning or (problem.cost is not None and (problem.cost.slope or problem.cost.values.any())):
        rule = "what conflicts is weighed as objectives, not beside them"
        raise ParameterError("a problem with costs", rule, "give objectives such as Risk(field) or TurningAngle()")


def warmup(algorithm: Method | str = "auto") -> float:
    """Compile the kernels of a method, or load them from the disk cache; seconds that it took, 0 once done.

    Raises
    ------
    ParameterError
        No such method, or the library that it needs is not installed.
    """
    return once({f"front by {part.name}": partial(_tiny, part) for part in chosen_method(algorithm).parts})


def _tiny(method: Method) -> None:
    problem = Problem.from_cells(GridMap(np.zeros((2, 5), np.uint8)), (0, 0), (1, 4))
    pareto(problem, [Length(), Turns()], algorithm=method, stop=Iterations(1))


def chosen_method(algorithm: Method | str) -> Method:
    """The method of that name.

    Raises
    ------
    ParameterError
        No such method.
    """
    if isinstance(algorithm, Method):
        return algorithm
    if not isinstance(algorithm, str) or algorithm not in METHODS:
        rule = f"the methods are {', '.join(METHODS)}"
        raise ParameterError(f"algorithm {shown(algorithm)}", rule, "choose one of them, or one of antnav.fronts")
    return METHODS[algorithm]()


def _undominated(instance: Instance, found: Found) -> tuple[list[np.ndarray], np.ndarray]:
    """The paths that no other beats, one for each vector, sorted by value; and their values (p, k)."""
    if not found.paths:
        return [], np.empty((0, instance.k))
    steps = instance.steps(found.paths)
    order = np.lexsort(steps.T[::-1])
    kept = order[front_kernels.undominated(steps[order])]
    paths = [found.paths[i] for i in kept]
    values = instance.values(paths)
    order = np.lexsort(values.T[::-1])  # rounded steps may order otherwise
    order = order[front_kernels.undominated(values[order])]
    return [paths[i] for i in order], values[order]
