"""Rules of the user's own, as a colony hands them to its kernel: see `kernels.plugs`."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import RuleError
from antnav.kernels import plugs
from antnav.kernels.ant_kernels import Choices, State
from antnav.kernels.graph import Graph
from antnav.plugins.loading import innermost, said, said_by_compiler
from antnav.values import read_only

#: What rules may write to, beside their notes.
WRITEABLE = {"pheromone": {"tau", "bounds", "amounts"}, "local_search": {"paths", "steps"}}

#: What else may go wrong: in a rule of which kind, what it did, with a place for whose path it was, and what helps.
_WRONG = {
    plugs.CLOSED: (
        plugs.TRANSITION,
        "it chose a slot for {} whose weight is 0: there is no edge, or the ant has been at its end",
        "choose one of those with a weight above 0",
    ),
    plugs.BROKEN: (
        plugs.LOCAL_SEARCH,
        "its path of {} does not lead from the start to the goal, edge by edge and nowhere twice",
        "write nodes and steps of such a path",
    ),
    plugs.ASTRAY: (
        plugs.LOCAL_SEARCH,
        "the walk of {}, which did not arrive, has left the map",
        "write only to paths of ants that have arrived",
    ),
    plugs.NO_NUMBER: (plugs.PHEROMONE, "what it wrote to amounts for {} is no finite number", "write finite numbers"),
    plugs.NO_TAU: (plugs.PHEROMONE, "what it wrote to tau for an edge is no finite number", "write finite numbers"),
    plugs.NO_BOUNDS: (
        plugs.PHEROMONE,
        "what it wrote to bounds is not 0 <= tau_min <= tau_max, tau_min finite",
        "write such bounds",
    ),
}


class Asked:
    """The own rules of one colony.

    Parameters
    ----------
    rules : dict of int to Part
        By their places in `plugs.KINDS`.
    graph, choices, state
        Of the colony.
    """

    def __init__(self, rules: dict[int, Any], graph: Graph, choices: Choices, state: State) -> None:
        self._rules = rules
        self._raised: list[tuple[int, BaseException]] = []
        values = {
            place: {name: getattr(rule, name) for name in _arguments(_kind(rule))} for place, rule in rules.items()
        }
        own = np.zeros((len(plugs.KINDS), max(1, *map(len, values.values()))))
        ways, addresses = np.zeros(len(plugs.KINDS), np.int64), np.zeros(len(plugs.KINDS), np.int64)
        for place, rule in rules.items():
            own[place, : len(values[place])] = [
                math.nan if value is None else value for value in values[place].values()
            ]
            ways[place] = plugs.COMPILED if rule.jit else plugs.PYTHON
            if rule.jit:
                addresses[place] = _compiled(rule, place).address
        # Nothing of this refers to itself: a colony's arrays go when it does, and not when garbage is collected.
        calls: dict[int, Callable[[], int]] = {}
        self._callback = plugs.Callback(partial(_answer, calls, self._raised))
        self.plugs = plugs.Plugs(
            ways=ways,
            addresses=addresses,
            callback=self._callback.address,
            notes=np.zeros((len(plugs.KINDS), plugs.NOTES)),
            own=own,
            amounts=np.zeros(len(state.order) + 1),
            weights=np.zeros(8),
            draws=np.zeros(plugs.DRAWS),
            numbers=np.zeros(7, np.int64),
            measures=np.zeros(2),
            error=np.zeros(2, np.int64),
        )
        #: The same for the walk; None where no rule is asked while ants walk.
        self.walking = self.plugs if asked_walking(rules) else None
        for place, rule in rules.items():
            if not rule.jit:
                calls[place] = self._call(place, values[place], graph, choices, state)

    def check(self) -> None:
        """Raise what went wrong in the last call of the kernel.

        Raises
        ------
        RuleError
        """
        wrong, ant = self.plugs.error.tolist()
        if wrong == plugs.RAISED and not self._raised:
            rule = "it raised an error, such as an index beyond an array's end, of which machine code tells no more"
            raise RuleError(described(self._rules[ant]), rule, "run it without jit=True, which says what and where")
        if wrong == plugs.RAISED:
            place, error = self._raised[0]
            if not isinstance(error, Exception):
                raise error  # such as Ctrl-C
            raise RuleError(described(self._rules[place]), f"it raised {_told(error)}", "mend it") from error
        if wrong in _WRONG:
            place, rule, remedy = _WRONG[wrong]
            whose = "the best path so far" if ant < 0 else f"ant {ant}"
            raise RuleError(described(self._rules[place]), rule.format(whose), remedy)

    def check_path(self, nodes: NDArray[np.int32], start: int, goal: int, graph: Graph) -> None:
        """Refuse a best path that a compiled rule has written to: nobody stops it.

        Raises
        ------
        RuleError
        """
        whole = nodes[0] == start and nodes[-1] == goal and nodes.min() >= 0 and nodes.max() < len(graph.neighbours)
        if not (whole and (graph.neighbours[nodes[:-1]] == nodes[1:, None]).any(axis=1).all()):
            rules = " or ".join(map(described, self._rules.values()))
            rule = "the best path, to which no rule may write, does not lead from the start to the goal any more"
            raise RuleError(rules, rule, "write only to what is said to be writeable")

    def _call(self, place: int, own: dict[str, Any], graph: Graph, choices: Choices, state: State) -> Callable[[], int]:
        """The function of a rule in Python, with what it sees."""
        kind, function = plugs.KINDS[place], type(self._rules[place]).function
        numbers, measures = self.plugs.numbers, self.plugs.measures
        arrays = _arrays(graph, state) | {name: getattr(self.plugs, name) for name in ("amounts", "weights", "draws")}
        arrays |= {"notes": self.plugs.notes[place], "own": self.plugs.own[place, : len(own)]}
        known: dict[str, float] = {"iterations": choices.iterations, "start": choices.start, "goal": choices.goal}
        known |= {"q": choices.q, "tau0": choices.tau0}
        shown: Any = plugs.SEEN[place]
        may = WRITEABLE.get(kind, set()) | {"notes"}
        fields: dict[str, Any] = {
            name: known.get(name, 0) if name not in arrays else arrays[name] if name in may else _shown(arrays[name])
            for name in shown._fields
        }
        seen = shown(**fields)

        def iteration() -> int:
            t, arrived, best_steps, stagnant = numbers[:4].tolist()
            best, rho = measures.tolist()
            now = seen._replace(t=t, arrived=arrived, best_steps=best_steps, stagnant=stagnant, best=best, rho=rho)
            answer = function(now, **own)
            if answer is not None:
                raise TypeError(f"it returned {type(answer).__name__}: it writes to what it is given, and returns None")
            return 0

        def transition() -> int:
            t, _, _, node, steps, came, stagnant = numbers.tolist()
            slot = function(seen._replace(t=t, node=node, steps=steps, came=came, stagnant=stagnant), **own)
            return max(-1, min(8, int(slot)))

        def deadlock() -> int:
            t, _, _, node, steps, backs, _ = numbers.tolist()
            return int(bool(function(seen._replace(t=t, node=node, steps=steps, backs=backs), **own)))

        return {plugs.TRANSITION: transition, plugs.DEADLOCK: deadlock}.get(place, iteration)


def _answer(calls: dict[int, Callable[[], int]], raised: list[tuple[int, BaseException]], place: int) -> int:
    """What the kernel calls."""
    try:
        return calls[place]()
    except BaseException as error:
        raised.append((place, error))
        return plugs.FAILED


def asked(algorithm: Any, graph: Graph, choices: Choices, state: State) -> Asked | None:
    """The own rules of an algorithm that its kernel must ask; None: there are none."""
    rules = rules_of(algorithm)
    return Asked(rules, graph, choices, state) if rules else None


def rules_of(algorithm: Any) -> dict[int, Any]:
    """The own rules that a kernel asks, by their places in `plugs.KINDS`."""
    parts = {place: getattr(algorithm, kind) for place, kind in enumerate(plugs.KINDS)}
    return {place: part for place, part in parts.items() if part.own}


def asked_walking(rules: Collection[int]) -> bool:
    """Whether some of the rules at these places are asked while ants walk, which takes a walk of its own."""
    return plugs.TRANSITION in rules or plugs.DEADLOCK in rules


def prepare(algorithm: Any) -> None:
    """Compile the rules that are to be."""
    for place, rule in rules_of(algorithm).items():
        if rule.jit:
            _compiled(rule, place)


def _kind(rule: Any) -> Any:
    return type(rule)


def _compiled(rule: Any, place: int) -> Any:
    return compiled(_kind(rule), place)


@cache
def compiled(kind: Any, place: int) -> Any:
    """The machine code of a class of rules, as the kernel calls it.

    Raises
    ------
    RuleError
        It cannot be compiled.
    """
    whole = [isinstance(kind.parameters[name].default, int) for name in _arguments(kind)]
    try:
        return plugs.code_of(kind.function, place, whole)
    except Exception as error:
        rule = f"it cannot be compiled: {said_by_compiler(error, kind.function)}"
        raise RuleError(described(kind), rule, "mend it, or leave jit=True out: it then runs in Python") from error


@cache
def _arguments(kind: Any) -> list[str]:
    """The parameters that are arguments of a rule's function, in their order; others are antnav's, such as punish."""
    return list(inspect.signature(kind.function).parameters)[1:]


def _arrays(graph: Graph, state: State) -> dict[str, NDArray[Any]]:
    """The arrays that rules see, by their names there."""
    named = {"costs": state.length, "fates": state.status, "steps": state.steps_on_path, "paths": state.path}
    same = ("order", "slots", "best_path", "best_slots", "visits", "tau", "bounds")
    return graph._asdict() | named | {name: getattr(state, name) for name in same}


def _shown(array: NDArray[Any]) -> NDArray[Any]:
    return read_only(array.view())


def described(rule: Any) -> str:
    """Kind, name and file of a rule, for errors."""
    return f"{rule.role.replace('_', ' ')} rule {rule.source}"


def _told(error: Exception) -> str:
    """An exception in one line, with where it was raised."""
    return f"{said(error)} ({innermost(error)})"
