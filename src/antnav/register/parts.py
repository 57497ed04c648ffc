"""Rules of colonies: a function becomes a part, its further arguments the part's parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from antnav.colony.parts import (
    CutsPart,
    HeuristicPart,
    InitialPart,
    LocalSearchPart,
    Part,
    PheromonePart,
    TransitionPart,
)
from antnav.colony.parts.deadlock import Punishing
from antnav.colony.parts.ground import Ground, checked_nodes, checked_values
from antnav.colony.parts.names import OwnName
from antnav.errors import AntnavError, ParameterError, RuleError, check_type
from antnav.kernels.graph import PlacedGraph
from antnav.planner.facts import Basis, Knows
from antnav.plugins.loading import said
from antnav.plugins.source import Source
from antnav.register.checks import (
    check_free,
    check_parameters,
    check_version,
    checked_name,
    knows_of,
    parameters_of_function,
)
from antnav.register.sending import packed, received
from antnav.values import read_only

Function = Callable[..., Any]


class Spec(NamedTuple):
    """All that makes a user's part: what other processes are sent."""

    kind: str
    function: Function
    source: Source
    jit: bool


class OwnHeuristic(HeuristicPart):
    """A heuristic that a user's function works out."""

    own = True

    def on_ground(self, ground: Ground) -> NDArray[np.float64]:
        """By edge, or by the cell that an edge leads to."""
        n = len(ground)
        return checked_values(called(self, ground), ground, self.source, ((n, 8), (n,)))


class OwnInitial(InitialPart):
    """Initial pheromone that a user's function works out."""

    own = True

    def tau(self, tau0: float, grid_graph: PlacedGraph, start: int, goal: int) -> NDArray[np.float64]:
        """By edge, by the cell that an edge leads to, or the same everywhere."""
        ground = Ground(grid_graph, start, goal, tau0)
        n = len(ground)
        values = checked_values(called(self, ground), ground, self.source, ((n, 8), (n,), ()))
        if values.ndim == 1:
            return ground.at_neighbours(values)
        return np.broadcast_to(values, (n, 8)).copy()


class OwnCuts(CutsPart):
    """Auxiliary nodes that a user's function chooses."""

    own = True

    def crossings(self, ground: Ground, paths: Sequence[NDArray[np.int32]], pieces: int) -> list[int]:
        """Between the start and the goal, in the order in which the path is to pass them."""
        return checked_nodes(called(self, ground, tuple(map(read_only, paths)), pieces), ground, self.source)


#: Of what a rule of each kind is made, and what its function is given.
KINDS: dict[str, tuple[type[Part], tuple[str, ...]]] = {
    "heuristic": (OwnHeuristic, ("ground",)),
    "initial": (OwnInitial, ("ground",)),
    "cuts": (OwnCuts, ("ground", "paths", "pieces")),
    "pheromone": (PheromonePart, ("ants",)),
    "local_search": (LocalSearchPart, ("ants",)),
    "transition": (TransitionPart, ("choice",)),
    "deadlock": (Punishing, ("stuck",)),
}


#: Kinds whose functions are called before the first ant walks.
ONCE_A_PROBLEM = ("heuristic", "initial", "cuts")


def called(part: Part, *given: Any) -> Any:
    """What the function of a part returns.

    Raises
    ------
    RuleError
        It raised an error; that of antnav's own stays as it is.
    """
    try:
        return part.function(*given, **part.values())
    except AntnavError:
        raise
    except Exception as error:
        raise RuleError(f"own rule {part.source}", f"it raised {said(error)}", "mend it") from error


def made(spec: Spec) -> type[Part]:
    """The class of parts of a user's function."""
    base, given = KINDS[spec.kind]
    function = spec.function
    knows = knows_of(function) if spec.kind in ONCE_A_PROBLEM else Knows.NOTHING
    about = {
        "name": OwnName(spec.source.name),
        "own": True,
        "basis": Basis.OWN,
        "knows": Knows.FROM_START if knows and spec.kind == "cuts" else knows,
        "source": spec.source,
        "function": staticmethod(function),
        "jit": spec.jit,
        "__doc__": function.__doc__,
        "__module__": function.__module__,
        "__qualname__": function.__qualname__,
        "__reduce__": lambda part: _packed(part, spec),
    }
    return type(function.__name__, (base,), about | parameters_of_function(function, given, spec.source))


def _packed(part: Part, spec: Spec) -> tuple[Callable[..., Part], tuple[Any, ...]]:
    """A part for `pickle`: its code, and its parameters."""
    code = packed(spec.kind, spec.source, spec.function.__module__, tuple(spec))
    return part_again, (spec.kind, spec.source, code, part.values())


def part_again(kind: str, source: Source, code: bytes, values: dict[str, Any]) -> Part:
    """The part that was packed; of the class that is registered here, where that is the same code."""
    known = KINDS[kind][0].registered.get(source.name)
    if known is None or known.source != source:
        known = received(kind, source, code, lambda spec: made(Spec(*spec)))
    again: Part = known(**values)
    return again


def registered(spec: Spec) -> type[Part]:
    """Make a part known by its name."""
    name, family = spec.source.name, KINDS[spec.kind][0]
    part = made(spec)
    check_free(spec.kind, spec.source, [*family.kind()], family.registered)
    check_parameters(spec.kind, part, spec.source)
    family.registered[name] = part
    return part


def _decorator(kind: str, function: Function | None, name: str | None, version: str, jit: bool) -> Any:
    def register(function: Function) -> type[Part]:
        compiled = getattr(function, "py_func", None)  # of Numba
        if compiled is not None and kind not in ONCE_A_PROBLEM:
            return register_plain(compiled, True)
        return register_plain(function, jit)

    def register_plain(function: Function, jit: bool) -> type[Part]:
        known = checked_name(kind, function, name)
        check_version(known, version)
        check_type(f"jit of {known}", jit, bool, "give True or False")
        if jit and kind in ONCE_A_PROBLEM:
            rule = f"a rule of the kind {kind} is called once a problem, with NumPy: compiling it saves nothing"
            raise ParameterError(f"{known} with jit=True", rule, "leave jit out")
        return registered(Spec(kind, function, Source.of(function, known, version), jit))

    return register if function is None else register(function)


def heuristic(
    function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False
) -> Any:
    """Register a heuristic: what draws an ant from a cell to its neighbour, eta of eq. (3.1).

    Called once for each colony of a run, with NumPy.

    Parameters
    ----------
    function : callable
        ``function(ground, **parameters)`` with a `Ground`; it returns finite numbers of at least 0: eta of each move,
        shape (n, 8), or of the node that a move leads to, shape (n,). Its further arguments are its parameters: their
        defaults are numbers or truths, or `antnav.parameter` with a range. The first line of its docstring says what
        it is.
    name : str, optional
        Default: the function's.
    version : str
        Printed behind the name.
    jit : bool
        Of other kinds of rules.

    Returns
    -------
    type of Part
        In place of the function, which it keeps as ``function``; called with parameters it makes a part.

    Raises
    ------
    ParameterError
        The name or a parameter's is taken, or the function has other arguments.
    """
    return _decorator("heuristic", function, name, version, jit)


def initial(function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False) -> Any:
    """Register an initial pheromone.

    Parameters
    ----------
    function : callable
        ``function(ground, **parameters)`` as of `heuristic`; it returns the pheromone of each move, shape (n, 8), of
        the node that a move leads to, shape (n,), or one number for all.
    name, version, jit
        As of `heuristic`.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("initial", function, name, version, jit)


def cuts(function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False) -> Any:
    """Register a decomposition: at which nodes PACO divides the way after its first stage.

    Parameters
    ----------
    function : callable
        ``function(ground, paths, pieces, **parameters)`` with a `Ground`, the paths that both colonies of stage one
        know at its end, as nodes from the start to the goal, the best of each colony and those of its last iteration,
        and the number of pieces that is asked for. It returns up to 63 different nodes between start and goal, in the
        order in which the path is to pass them.
    name, version, jit
        As of `heuristic`.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("cuts", function, name, version, jit)


def pheromone(
    function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False
) -> Any:
    """Register a pheromone rule: who deposits how much at the end of an iteration.

    Parameters
    ----------
    function : callable
        ``function(ants, **parameters)``, called once an iteration with an `Ants`, to whose writeable arrays it writes.
    name, version
        As of `heuristic`.
    jit : bool
        Whether Numba compiles it.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("pheromone", function, name, version, jit)


def local_search(
    function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False
) -> Any:
    """Register a local search: what is done to the paths of arrived ants before they count.

    Parameters
    ----------
    function : callable
        ``function(ants, **parameters)``, called once an iteration with an `Ants`, to whose paths it writes.
    name, version, jit
        As of `pheromone`.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("local_search", function, name, version, jit)


def transition(
    function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False
) -> Any:
    """Register a transition rule: how an ant chooses among the neighbours that it may enter.

    Parameters
    ----------
    function : callable
        ``function(choice, **parameters)``, called at every step with a `Choice`; it returns the slot of the move.
    name, version, jit
        As of `pheromone`; without `jit` it is slow.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("transition", function, name, version, jit)


def deadlock(function: Function | None = None, *, name: str | None = None, version: str = "", jit: bool = False) -> Any:
    """Register a deadlock rule: what happens to an ant that has no free, unvisited neighbour.

    Parameters
    ----------
    function : callable
        ``function(stuck, **parameters)``, called in each dead end with a `Stuck`; it returns True: the ant dies, or
        False: it steps back. The edges that led there fade by eq. (4.2) all the same: each such rule has the
        parameter ``punish``, lambda, 0.2 [paper]; 0 turns that off.
    name, version, jit
        As of `pheromone`.

    Returns
    -------
    type of Part

    Raises
    ------
    ParameterError
        As of `heuristic`.
    """
    return _decorator("deadlock", function, name, version, jit)
