"""Orders of stops, by several methods, and a bound that none can beat."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, shown
from antnav.kernels import tour_kernels
from antnav.planner.facts import Basis

#: How an order may be found, and by whom that is.
METHODS = {
    "exact": "dynamic programming over sets (Held & Karp 1962); exact",
    "ils": "iterated local search, 2-opt and Or-opt with double bridges (Johnson & McGeoch 1997)",
    "ants": "Ant Colony System with 2-opt and Or-opt (Dorigo & Gambardella 1997)",
    "library": "PyVRP, iterated local search (Wouda, Lan & Kool 2024)",
}
#: Stops up to which the order is exact by default, and where that is asked for: 2 ms and 150 ms.
EXACT, EXACT_AT_MOST = 12, 18
#: Of the other methods: rounds of local search by node, iterations of ten ants, iterations of the library.
ROUNDS, ITERATIONS, LIBRARY_ITERATIONS = 50, 30, 1000
#: Ant Colony System's own: ants, beta, q0, rho, xi.
_ANTS = (10, 2.0, 0.9, 0.1, 0.1)
_NEAR = 10  #: Nodes that count as near to each.
_BOUND_ROUNDS, _BOUND_WORK = 1000, 10**8  #: Rounds of the bound, and fewer where they would look at more pairs.


@dataclass(frozen=True, eq=False)
class Order:
    """An order of stops.

    Attributes
    ----------
    stops : tuple of int
        Numbers from 1.
    method : str
        One of `METHODS`, or "given".
    optimum : float or None
        The least cost of any order, where that is known.
    bound : float
        What none costs less than.
    """

    stops: tuple[int, ...]
    method: str
    optimum: float | None
    bound: float


def check_method(method: object, stops: int) -> str:
    """The method for so many stops.

    Raises
    ------
    ParameterError
        There is none of that name, it does not take so many, or its library is not installed.
    """
    names = ("auto", *METHODS)
    if not isinstance(method, str) or method not in names:
        raise ParameterError(f"method {shown(method)}", f"the methods are {', '.join(names)}", "choose one of them")
    if method == "exact" and stops > EXACT_AT_MOST:
        rule = f"it takes at most {EXACT_AT_MOST} stops, and there are {stops}"
        raise ParameterError("method 'exact'", rule, "take auto or ants")
    if method == "library" and find_spec("pyvrp") is None:
        raise ParameterError("method 'library'", "PyVRP is not installed", 'run: pip install "antnav[tours]"')
    if method == "auto":
        return "exact" if stops <= EXACT else "ils"
    return method


def best(costs: NDArray[np.float64], heights: NDArray[np.float64], method: str, seed: int, *, back: bool) -> Order:
    """The best order that a method finds.

    Parameters
    ----------
    costs : ndarray of float64, shape (n + 1, n + 1)
        Symmetric, finite, of the start and n stops.
    heights : ndarray of float64, shape (n + 1,)
        What ending at each place costs besides, 0 of the start.
    method : str
        As `check_method` gives it.
    back : bool
        Whether the tour leads back to the start.
    """
    matrix = _with_end(costs, heights, back=back)
    nodes = _nodes(matrix, method, seed)
    return _bounded(tuple(nodes[1:-1].tolist()), method, matrix, float(tour_kernels.cost_of(matrix, nodes)))


def given(costs: NDArray[np.float64], heights: NDArray[np.float64], *, back: bool) -> Order:
    """The order in which the stops are given."""
    matrix = _with_end(costs, heights, back=back)
    nodes = np.arange(len(matrix), dtype=np.int32)
    best_known = _nodes(matrix, check_method("auto", len(costs) - 1), 0)
    target = float(tour_kernels.cost_of(matrix, best_known))
    return _bounded(tuple(nodes[1:-1].tolist()), "given", matrix, target)


def compile_kernels() -> None:
    """Compile what orders need."""
    costs = np.hypot(*np.indices((8, 8)))
    for method in ("exact", "ils", "ants"):
        _nodes(_with_end(costs, np.zeros(8), back=True), method, 0)
    tour_kernels.bound(costs, 1.0, 2)


def _with_end(costs: NDArray[np.float64], heights: NDArray[np.float64], *, back: bool) -> NDArray[np.float64]:
    """The costs with one more node, where every order ends: the start once more, or anywhere."""
    end = costs[0] if back else heights
    matrix = np.pad(costs, ((0, 1), (0, 1)))
    matrix[-1, :-1] = matrix[:-1, -1] = end
    matrix[0, -1] = matrix[-1, 0] = 1e6 * (1 + matrix.max())  # no order has that edge
    return matrix


def _nodes(matrix: NDArray[np.float64], method: str, seed: int) -> NDArray[np.int32]:
    found: NDArray[np.int32]
    count = len(matrix)
    if method == "exact":
        found = tour_kernels.held_karp(matrix)
        return found
    if method == "library":
        return _by_library(matrix, seed)
    apart = matrix + np.diag(np.full(count, np.inf))
    near = np.argsort(apart, axis=1, kind="stable")[:, : min(_NEAR, count - 1)].astype(np.int32)
    least = 1e-12 * float(matrix[:-1, :-1].max()) + 1e-300
    key = np.random.SeedSequence(seed).generate_state(1, np.uint64)[0]
    if method == "ants":
        ants, beta, greed, rho, xi = _ANTS
        found, _ = tour_kernels.ants(matrix, near, ants, ITERATIONS, beta, greed, rho, xi, True, key, least)
    else:
        found, _ = tour_kernels.iterated(matrix, near, ROUNDS * count, key, least)
    return found


def _by_library(matrix: NDArray[np.float64], seed: int) -> NDArray[np.int32]:
    """PyVRP's order: the start is its depot, and the way to the end is that back to it."""
    import pyvrp
    from pyvrp.stop import MaxIterations

    inner = matrix[:-1, :-1].copy()
    inner[:, 0] = matrix[:-1, -1]  # back to the depot
    inner[0, 0] = 0.0
    whole = np.rint((inner - inner.min()) * (2**30 / max(float(np.ptp(inner)), 1e-300))).astype(np.int64)
    np.fill_diagonal(whole, 0)
    count = len(whole)
    data = pyvrp.ProblemData(
        locations=[pyvrp.Location(0, 0)] * count,
        clients=[pyvrp.Client(location=number) for number in range(1, count)],
        depots=[pyvrp.Depot(location=0)],
        vehicle_types=[pyvrp.VehicleType()],
        distance_matrices=[whole],
        duration_matrices=[np.zeros_like(whole)],
    )
    found = pyvrp.solve(data, MaxIterations(LIBRARY_ITERATIONS), seed=seed % 2**32, collect_stats=False, display=False)
    visits = [visit.idx + 1 for visit in found.best.routes()[0] if visit.is_client()]
    return np.array([0, *visits, count], np.int32)


def _bounded(stops: tuple[int, ...], method: str, matrix: NDArray[np.float64], target: float) -> Order:
    """An order with what is known of the best; `target` is what a good one costs, of few stops the best."""
    if len(stops) <= EXACT or method == "exact":
        least = (
            target if method in ("exact", "given") else float(tour_kernels.cost_of(matrix, _nodes(matrix, "exact", 0)))
        )
        return Order(stops, method, least, least)
    bound = bound_of(matrix, target)
    proven = bound >= target * (1 - 1e-9)
    return Order(stops, method, target if proven else None, bound)


def bound_of(matrix: NDArray[np.float64], target: float) -> float:
    """No order costs less than this; `target` is what a good one costs."""
    rounds = max(200, min(_BOUND_ROUNDS, _BOUND_WORK // matrix.size))
    return min(float(tour_kernels.bound(matrix, target, rounds)), target)


def said_of(method: str) -> str:
    """How the order came about, and how sure that is."""
    return "as given" if method == "given" else f"[{Basis.SOURCE}]: {METHODS[method]}"
