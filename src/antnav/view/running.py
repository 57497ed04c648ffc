"""A run in a panel of a page."""

from __future__ import annotations

import numpy as np

from antnav.ants.algorithm import Algorithm
from antnav.errors import AntnavError, ParameterError
from antnav.planner.planner import Planner
from antnav.plot.ants import Watched
from antnav.view.packet import Packet
from antnav.world.problem import Problem

#: Bytes that the colonies of a run may take.
MOST_MEMORY = 400_000_000


class Run(Watched):
    """One panel: see `Watched`."""

    def __init__(self, problem: Problem, algorithm: Planner, seed: int) -> None:
        _check_memory(algorithm, problem.grid.cells.size)
        super().__init__(problem, algorithm, seed)
        self._told = 0  #: rows
        self._refusal = ""  #: what it said when it could not go on

    @property
    def done(self) -> bool:
        """Whether there is a result, or none to come."""
        return super().done or bool(self._refusal)

    def advance(self, count: int, seconds: float) -> None:
        """See `Watched`; what cannot be, such as jump point search among costs, is told in words."""
        try:
            super().advance(count, seconds)
        except AntnavError as error:
            self._refusal = f"{error.given}: {error.rule}; {error.remedy}."

    def frame(self, panel: int, optimum: float) -> Packet:
        """What is seen of it now, and what its iterations have brought since the last frame."""
        seen = self.seen(optimum)
        rows, first, self._told = self.rows[self._told :], self._told, len(self.rows)
        packet = Packet(
            {
                "is": "frame",
                "panel": panel,
                "iteration": seen.iteration,
                "stage": seen.stage,
                "auxiliary": seen.auxiliary,
                "done": seen.done,
                "rows": rows,
                "first": first,
                "words": [self._refusal] if self._refusal else seen.words,
                "ants": seen.ants,
                "bests": [len(cells) for cells in seen.bests],
                "cost": seen.cost if np.isfinite(seen.cost) else None,
            }
        )
        packet.add("walks", seen.walks.astype(np.uint16))
        packet.add("best", np.concatenate([np.empty((0, 2), np.int32), *seen.bests]).astype(np.uint16))
        packet.add("dead", seen.dead.astype(np.uint16))
        for side, shades in enumerate(seen.heat):
            packet.add(f"heat{side}", shades)
        return packet


def _check_memory(algorithm: Planner, cells: int) -> None:
    """Refuse a run whose arrays would be too large, before they are made.

    Raises
    ------
    ParameterError
    """
    if not isinstance(algorithm, Algorithm):
        return
    colonies = max(algorithm.colonies, algorithm.decomposition.pieces if algorithm.decomposition else 1, 2)
    needed = colonies * (cells * (5 * algorithm.ants + 200) + 64 * algorithm.iterations)
    if needed > MOST_MEMORY:
        given = f"{algorithm.ants} ants, {algorithm.iterations} iterations on {cells} cells"
        rule = f"they need {needed / 1e6:.0f} MB, and a panel has {MOST_MEMORY / 1e6:.0f}"
        raise ParameterError(given, rule, "choose fewer ants or colonies, or a smaller map")
