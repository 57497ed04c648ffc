"""Objective: one of several goals, as the prices of moves and of turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from antnav.errors import ParameterError, check_type, shown
from antnav.values import finite_number
from antnav.world.grid_graph import GridGraph
from antnav.world.terrain import Terrain

#: Largest price of a move or turn: sums over any path stay exact enough to be compared.
LARGEST = 1e12


class Objective:
    """What is to be small about a path: a sum over its moves, or over its pairs of moves.

    Derive from it, give a `name` and a `unit`, and override `edges`, `turns`, or both.

    Attributes
    ----------
    name : str
        For tables, legends and files.
    unit : str
        Of the values, such as "m"; "" for counts.
    step : float or None
        Exact searches count in whole steps of this size; None: a thousandth of the dearest move or turn.
    """

    name: str = "objective"
    unit: str = ""
    step: float | None = None

    def edges(self, terrain: Terrain, graph: GridGraph) -> NDArray[np.float64] | None:
        """Price of each move of a graph of the terrain's cells, shape (n, 8), >= 0; None where moves cost nothing.

        Row i is node i, at `graph.cells[i]`; column k the neighbour `graph.graph.neighbours[i, k]`, n where there is
        none, at `graph.graph.lengths[i, k]` cells. It may be another price than the way back's.
        """
        return None

    def turns(self) -> NDArray[np.float64] | None:
        """Price of each pair of moves, shape (9, 8), >= 0: by the last move + 1, 0 before the first, and the next one.

        Moves are numbered as the columns of `edges`. None where turns cost nothing.
        """
        return None

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class Prices:
    """An objective's prices on one graph, checked.

    Attributes
    ----------
    edges : ndarray of float64, shape (n, 8)
    turns : ndarray of float64, shape (9, 8)
    step : float
        What one whole step is worth.
    """

    edges: NDArray[np.float64]
    turns: NDArray[np.float64]
    step: float

    @classmethod
    def of(cls, objective: Objective, terrain: Terrain, graph: GridGraph) -> Prices:
        """Ask an objective.

        Raises
        ------
        ParameterError
            Other shapes, or prices that are no numbers in the range.
        """
        neighbours = graph.graph.neighbours
        edges = _table(objective, "edges", objective.edges(terrain, graph), neighbours.shape)
        turns = _table(objective, "turns", objective.turns(), (9, 8))
        edges = np.where(neighbours < len(graph), edges, 0.0)
        for what, prices in (("move", edges), ("turn", turns)):
            wrong = prices[~((prices >= 0) & (prices <= LARGEST))]  # nan is wrong, too
            if wrong.size:
                rule = f"a {what} costs 0 to {LARGEST:g}"
                raise ParameterError(f"{what} of objective {objective.name} at {wrong[0]}", rule, "mend the objective")
        most = float(max(edges.max(initial=0.0), turns.max()))
        step = objective.step
        if step is None:
            step = most / 1000 if most > 1e-300 else 1.0  # less than that has no thousandth
        if not (finite_number(step) > 0 and most / float(step) <= 1e6):
            rule = "a whole step is a finite number, a millionth of the dearest move or more"
            raise ParameterError(f"step {shown(step)} of objective {objective.name}", rule, "leave it out")
        return cls(edges, turns, float(step))


def _table(objective: Objective, what: str, given: Any, shape: tuple[int, ...]) -> NDArray[np.float64]:
    if given is None:
        return np.zeros(shape)
    try:
        array = np.asarray(given, np.float64)
    except (TypeError, ValueError) as error:
        raise ParameterError(f"{what} of objective {objective.name}", "they are numbers", "mend it") from error
    if array.shape != shape:
        given = f"{what} of objective {objective.name} of shape {array.shape}"
        raise ParameterError(given, f"here the shape is {shape}", "mend the objective")
    return array


def over_cells(values: NDArray[np.float64], graph: GridGraph) -> NDArray[np.float64]:
    """Price of each move as its length in cells times the mean of its two cells' values.

    Parameters
    ----------
    values : ndarray of float64, shape (rows, cols)
    graph : GridGraph

    Returns
    -------
    ndarray of float64, shape (n, 8)

    Raises
    ------
    ParameterError
        Another shape than the map's.
    """
    shape = (len(graph.moves) // graph.width - 2, graph.width - 2)
    if np.shape(values) != shape:
        given = f"values of shape {np.shape(values)}"
        raise ParameterError(given, f"the map has {shape[0]} x {shape[1]} cells", "give a value for each")
    at = np.append(values[tuple(graph.cells.T)], 0.0)  # the node that stands for none
    prices: NDArray[np.float64] = graph.graph.lengths * (0.5 * (at[:-1, None] + at[graph.graph.neighbours]))
    return prices


def check_objectives(given: Any) -> tuple[Objective, ...]:
    """Two to six objectives of different names, or a `ParameterError`."""
    rule, remedy = "there are 2 to 6 objectives", "give such as [Length(), Risk(field)] of antnav.objectives"
    if isinstance(given, str | Objective) or not isinstance(given, Sequence):
        raise ParameterError(f"objectives {shown(given)}", rule, remedy)
    if not 2 <= len(given) <= 6:
        raise ParameterError(f"{len(given)} objective{'s' * (len(given) != 1)}", rule, remedy)
    for objective in given:
        check_type("objective", objective, Objective, remedy)
        for what in ("name", "unit"):
            check_type(f"{what} of an objective", getattr(objective, what), str, "give a text")
    names = [objective.name for objective in given]
    if len(set(names)) < len(names):
        rule = "objectives have different names, by which tables tell them apart"
        raise ParameterError(f"objectives {', '.join(names)}", rule, "leave out what is there twice, or give names")
    return tuple(given)
