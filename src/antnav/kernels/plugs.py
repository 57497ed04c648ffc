"""Plugs: how a kernel calls a rule of the user's own, compiled or in Python, and what it shows to it.

A compiled rule is a pointer with a signature that all rules of its kind share, so the kernel that calls it is compiled
once, for all of them, and kept on disk: 10 ns a call. A function in Python is called through one C callback, which
waits for the interpreter's lock: 0.1 us and what the function itself takes. Both get the same NamedTuple of arrays.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple, get_args, get_type_hints

import numba
import numpy as np
from numba import from_dtype, types
from numba.core.errors import TypingError
from numba.extending import intrinsic
from numpy.typing import NDArray

#: How a rule is called: not at all, since there is none; as machine code; in Python.
BUILT_IN, COMPILED, PYTHON = 0, 1, 2
#: Places of `Plugs.error`: what went wrong, and with which ant; where a rule has raised, the place of its kind.
WRONG, ANT = 0, 1
#: What a rule says where it has raised, compiled or in Python.
FAILED = -1_000
#: What may go wrong: the function raised; it chose a neighbour that must not be entered; its path is none; an amount is
#: no finite number; pheromone is none; bounds are none; the walk of an ant that did not arrive leaves the map.
RAISED, CLOSED, BROKEN, NO_NUMBER, NO_TAU, NO_BOUNDS, ASTRAY = 1, 2, 3, 4, 5, 6, 7
#: Numbers that a transition rule may draw on in each step, and that any rule may keep between its calls.
DRAWS, NOTES = 4, 64


class Ants(NamedTuple):
    """What the ants of an iteration did, for pheromone rules and local searches of one's own.

    Arrays over ants have m rows, arrays over nodes n; a node is a cell that can be reached. Nothing may be written to
    but what is said to be writeable.

    Attributes
    ----------
    t : int
        Number of the iteration, from 1.
    iterations : int
        T of the schedule.
    start : int
        Node.
    goal : int
        Node.
    arrived : int
        How many ants have arrived.
    best : float
        Cost of the best path so far, this iteration's included; inf before the first arrival.
    stagnant : int
        Iterations since the best path became better.
    rho : float
        Evaporation rate in this iteration, which a pheromone rule finds done.
    q : float
        Q, pheromone of one deposit.
    tau0 : float
        Initial pheromone.
    order : ndarray of int64, shape (m,)
        The first `arrived` are the ants that have arrived, cheapest first.
    costs : ndarray of float64, shape (m,)
        Cost in cells of the path of an ant that has arrived: its length without costs.
    fates : ndarray of uint8, shape (m,)
        1: arrived, 2: died.
    steps : ndarray of int64, shape (m,)
        Moves of each path; a local search may write it.
    paths : ndarray of int32, shape (m, n)
        Row a: nodes of ant a, of which `steps[a] + 1` count; a local search may write it.
    slots : ndarray of uint8, shape (m, n)
        Row a: the slots of its moves, `neighbours[paths[a, s], slots[a, s]]` comes next.
    best_steps : int
        Moves of the best path so far; -1 without one.
    best_path : ndarray of int32, shape (n,)
        Its nodes.
    best_slots : ndarray of uint8, shape (n,)
        Its slots.
    visits : ndarray of int64, shape (n,)
        Arrived ants that came through each node, over all iterations.
    neighbours : ndarray of int32, shape (n, 8)
        Node at the end of each edge, n where there is none.
    lengths : ndarray of float64, shape (n, 8)
        Length of the edge in cells; its cost, where moves have prices.
    reverse : ndarray of uint8, shape (n, 8)
        Slot of the same edge as seen from its end.
    tau : ndarray of float64, shape (n, 8)
        Pheromone of each edge away from its node; a pheromone rule may write it.
    bounds : ndarray of float64, shape (2,)
        Tau_min and tau_max, kept from the next iteration on; a rule may write them.
    amounts : ndarray of float64, shape (m + 1,)
        Zeros, to be written: what the ant of rank r leaves along its path, which may be below 0, and at the end
        what the best path so far gets; laid down in that order, as `deposit` says.
    notes : ndarray of float64, shape (64,)
        Zeros at the beginning; the rule's own, kept from call to call.
    own : ndarray of float64
        The rule's own parameters in the order of its arguments.
    """

    t: int
    iterations: int
    start: int
    goal: int
    arrived: int
    best: float
    stagnant: int
    rho: float
    q: float
    tau0: float
    order: NDArray[np.int64]
    costs: NDArray[np.float64]
    fates: NDArray[np.uint8]
    steps: NDArray[np.int64]
    paths: NDArray[np.int32]
    slots: NDArray[np.uint8]
    best_steps: int
    best_path: NDArray[np.int32]
    best_slots: NDArray[np.uint8]
    visits: NDArray[np.int64]
    neighbours: NDArray[np.int32]
    lengths: NDArray[np.float64]
    reverse: NDArray[np.uint8]
    tau: NDArray[np.float64]
    bounds: NDArray[np.float64]
    amounts: NDArray[np.float64]
    notes: NDArray[np.float64]
    own: NDArray[np.float64]


class Choice(NamedTuple):
    """An ant before a step, for transition rules of one's own. Nothing may be written to but `notes`.

    Attributes
    ----------
    t : int
        Number of the iteration, from 1.
    iterations : int
        T of the schedule.
    goal : int
        Node.
    node : int
        Where it is.
    steps : int
        Moves of its path so far.
    came : int
        Slot of its last move, -1 before the first.
    stagnant : int
        Iterations since the best path became better.
    weights : ndarray of float64, shape (8,)
        Tau^alpha eta^beta of each edge, 0 where it must not go.
    draws : ndarray of float64, shape (4,)
        Drawn evenly from [0, 1) for this step.
    neighbours : ndarray of int32, shape (n, 8)
    lengths : ndarray of float64, shape (n, 8)
    tau : ndarray of float64, shape (n, 8)
    notes : ndarray of float64, shape (64,)
        As of `Ants`.
    own : ndarray of float64
        As of `Ants`.
    """

    t: int
    iterations: int
    goal: int
    node: int
    steps: int
    came: int
    stagnant: int
    weights: NDArray[np.float64]
    draws: NDArray[np.float64]
    neighbours: NDArray[np.int32]
    lengths: NDArray[np.float64]
    tau: NDArray[np.float64]
    notes: NDArray[np.float64]
    own: NDArray[np.float64]


class Stuck(NamedTuple):
    """An ant in a dead end, for deadlock rules of one's own. Nothing may be written to but `notes`.

    Attributes
    ----------
    t : int
        Number of the iteration, from 1.
    iterations : int
        T of the schedule.
    goal : int
        Node.
    node : int
        Where it is.
    steps : int
        Moves of its path so far.
    backs : int
        Steps back that it has made since its last step ahead.
    notes : ndarray of float64, shape (64,)
        As of `Ants`.
    own : ndarray of float64
        As of `Ants`.
    """

    t: int
    iterations: int
    goal: int
    node: int
    steps: int
    backs: int
    notes: NDArray[np.float64]
    own: NDArray[np.float64]


class Step(NamedTuple):
    """What a kernel hands over in each step and dead end: arrays that stay, so that nothing is counted there.

    `Choice` and `Stuck` are made of them in the rule's own machine code, where most of that is optimised away.
    """

    numbers: NDArray[np.int64]  #: (7,), the first fields of `Choice` or `Stuck`
    weights: NDArray[np.float64]
    draws: NDArray[np.float64]
    neighbours: NDArray[np.int32]
    lengths: NDArray[np.float64]
    tau: NDArray[np.float64]
    notes: NDArray[np.float64]
    own: NDArray[np.float64]


class Plugs(NamedTuple):
    """The rules of one colony that are the user's own."""

    ways: NDArray[np.int64]  #: (4,), how each of them is called, in the order of `KINDS`
    addresses: NDArray[np.int64]  #: (4,), of machine code: `int64 rule(seen)`
    callback: int  #: address of the C function `int64 callback(int64 kind)`; it returns `FAILED` where Python raised
    notes: NDArray[np.float64]  #: (4, 64)
    own: NDArray[np.float64]  #: (4, most parameters of one rule)
    amounts: NDArray[np.float64]  #: (m + 1,)
    weights: NDArray[np.float64]  #: (8,)
    draws: NDArray[np.float64]  #: (4,)
    numbers: NDArray[np.int64]  #: (7,), what changes from call to call; see `Step`
    measures: NDArray[np.float64]  #: (2,), the same, best and rho
    error: NDArray[np.int64]  #: (2,), see `WRONG`


#: Kinds of rules that a kernel calls, in the order of their places.
KINDS = ("pheromone", "local_search", "transition", "deadlock")
PHEROMONE, LOCAL_SEARCH, TRANSITION, DEADLOCK = range(len(KINDS))
#: What rules of each kind see.
SEEN: tuple[type, ...] = (Ants, Ants, Choice, Stuck)
#: What the kernel gives to the machine code of rules of each kind.
GIVEN: tuple[type, ...] = (Ants, Ants, Step, Step)


@cache
def type_of(seen: type) -> types.Type:
    """The compiler's type of what a rule sees, as the kernel makes it."""
    kinds = {"int": types.int64, "float": types.float64}
    rows = ("tau", "neighbours", "lengths", "reverse", "paths", "slots")
    fields = []
    for name, annotation in get_type_hints(seen, include_extras=True).items():
        given: Any = kinds.get(getattr(annotation, "__name__", ""))
        if given is None:
            number = from_dtype(np.dtype(get_args(get_args(annotation)[1])[0]))
            given = types.Array(number, 2 if name in rows else 1, "C")
        fields.append(given)
    made: types.Type = types.NamedTuple(fields, seen)  # type: ignore[no-untyped-call]
    return made


def _calling(types_of: tuple[types.Type, ...], context: Any, builder: Any, arguments: Any) -> Any:
    """The code of a call: of an address with arguments of these types, as C functions of the compiler's take them."""
    from llvmlite import ir  # type: ignore[import-untyped]

    function = ir.FunctionType(ir.IntType(64), [context.get_value_type(one) for one in types_of])
    return builder.call(builder.inttoptr(arguments[0], function.as_pointer()), arguments[1:])


@intrinsic
def _ask(typingctx: Any, address: Any, seen: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _calling(signature.args[1:], context, builder, arguments)

    wanted = type_of(seen.instance_class)
    if seen != wanted:
        raise TypingError(f"the kernel makes {seen}, compiled rules are given {wanted}")
    return types.int64(types.int64, seen), codegen


@intrinsic
def _call(typingctx: Any, address: Any, kind: Any) -> Any:
    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _calling(signature.args[1:], context, builder, arguments)

    return types.int64(types.int64, types.int64), codegen


#: With the compiler switched off kernels are functions in Python, and so is all that they call, by these addresses.
_HELD: dict[int, Callable[[Any], int]] = {}
COMPILES = not numba.config.DISABLE_JIT  # type: ignore[attr-defined]


def _held(address: int, seen: Any) -> int:
    return _HELD[address](seen)


#: What the compiled rule at an address says to what it sees.
ask: Any = _ask if COMPILES else _held
#: What the C callback at an address says to the place of a kind.
call: Any = _call if COMPILES else _held

_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64)


class Callback:
    """A function in Python that a kernel can call at `address`, as long as somebody holds this."""

    def __init__(self, function: Callable[[Any], int]) -> None:
        if COMPILES:
            self._pointer = _CALLBACK(function)
            # Not by ctypes.cast, after which the pointer refers to itself.
            self.address = ctypes.c_void_p.from_buffer(self._pointer).value or 0
        else:
            self.address = id(self)
            _HELD[self.address] = function

    def __del__(self) -> None:
        _HELD.pop(self.address, None)


def code_of(function: Callable[..., Any], place: int, whole: Sequence[bool]) -> Any:
    """A rule as machine code at an `address`; it gets its own parameters as arguments, whole numbers as such.

    Division by zero gives inf, as in NumPy. What else raises, an index beyond an end among it, makes it say `FAILED`:
    C functions cannot tell more.
    """
    own = [f"int(seen.own[{number}])" if one else f"seen.own[{number}]" for number, one in enumerate(whole)]
    shown = f"shown({', '.join(_from_step(SEEN[place]))})" if GIVEN[place] is Step else "seen"
    words = f"rule({', '.join(['shown_', *own])})"
    answer = f"return int({words})" if GIVEN[place] is Step else f"{words}\n        return 0"
    compiled = hasattr(function, "py_func") or not COMPILES
    names: dict[str, Any] = {
        "rule": function if compiled else numba.njit(error_model="numpy", boundscheck=True)(function),
        "shown": SEEN[place],
    }
    guarded = f"try:\n        {answer}\n    except Exception:\n        return {FAILED}"
    exec(f"def asked(seen):\n    shown_ = {shown}\n    {guarded}\n", names)
    if not COMPILES:
        return Callback(names["asked"])
    return numba.cfunc(types.int64(type_of(GIVEN[place])))(names["asked"])


def _from_step(seen: type) -> list[str]:
    """How each field is found in a `Step`: the first ones are numbers, arrays have the same names."""
    return [
        f"seen.{name}" if name in Step._fields else f"seen.numbers[{number}]"
        for number, name in enumerate(seen.__annotations__)
    ]
