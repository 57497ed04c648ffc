"""pathfinding."""

from __future__ import annotations

from typing import Any

from .task import Peer, Points, Task


class Pathfinding(Peer):
    """A* of pathfinding, written in Python."""

    distribution = "pathfinding"

    def build(self, task: Task) -> Any:
        """Lists of free cells: its own grid serves one query only."""
        return (~task.blocked).astype(int).tolist()

    def solve(self, state: Any, task: Task, seed: int) -> Points | None:
        """Diagonals between two free cells only."""
        from pathfinding.core.diagonal_movement import DiagonalMovement
        from pathfinding.core.grid import Grid
        from pathfinding.core.heuristic import octile
        from pathfinding.finder.a_star import AStarFinder

        grid = Grid(matrix=state)
        finder = AStarFinder(heuristic=octile, diagonal_movement=DiagonalMovement.only_when_no_obstacle)
        path, _ = finder.find_path(grid.node(*task.start[::-1]), grid.node(*task.goal[::-1]), grid)
        return [(node.y, node.x) for node in path] or None
