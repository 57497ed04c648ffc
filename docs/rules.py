"""The pictures of docs/how-paco-works.md, into docs/images/rules: `nox -s pictures` draws them anew.

What they show is worked out by antnav itself, but for the dead ends, which are drawn as the rules say.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from pathlib import Path as FilePath

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

import antnav as an
from antnav.colony.heuristic import heuristic_weights
from antnav.plot.style import BLUE, FAINT, GREEN, INK, ORANGE, PURPLE, SKY, VERMILLION
from antnav.world.moves import STEPS

Cell = tuple[float, float]  #: (row, col), anywhere between the cells, too
FOLDER = FilePath(__file__).parent / "images" / "rules"
WALL = "#4a4f57"


def panels(count: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """Axes side by side."""
    figure, axes = plt.subplots(1, count, figsize=(width, height), layout="constrained", squeeze=False)
    return figure, list(axes[0])


def box(left: float, right: float, top: float, bottom: float) -> Path:
    """A rectangle."""
    return Path([(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], closed=True)


def draw_map(ax: Axes, cells: np.ndarray, title: str) -> None:
    """Walls dark, lines between cells."""
    rows, cols = cells.shape
    boxes = []
    for row, walls in enumerate(cells):
        edges = np.flatnonzero(np.diff(walls.astype(bool), prepend=False, append=False)) - 0.5
        boxes += [box(left, right, row - 0.5, row + 0.5) for left, right in edges.reshape(-1, 2)]
    ax.add_patch(PathPatch(Path.make_compound_path(*boxes), color=WALL, linewidth=0))
    ax.set(xlim=(-0.5, cols - 0.5), ylim=(rows - 0.5, -0.5), aspect="equal", xticks=[], yticks=[])
    between = [[(-0.5, col - 0.5), (rows - 0.5, col - 0.5)] for col in range(1, cols)]
    between += [[(row - 0.5, -0.5), (row - 0.5, cols - 0.5)] for row in range(1, rows)]
    lines(ax, between, "#dcdfe3", 0.6, zorder=0)
    ax.set_title(title, fontsize=9, color=INK)
    for spine in ax.spines.values():
        spine.set_color(FAINT)


def mark(ax: Axes, cell: Cell, colour: str, marker: str = "o") -> None:
    """A start, a goal, an ant."""
    ax.plot(cell[1], cell[0], marker, color=colour, markersize=7, markeredgecolor=INK, markeredgewidth=0.6, zorder=5)


def line(ax: Axes, cells: Iterable[Cell], colour: str, width: float = 1.4, **style: object) -> None:
    """A way through cells."""
    way = np.array(list(cells), dtype=float)
    ax.plot(way[:, 1], way[:, 0], color=colour, linewidth=width, solid_capstyle="round", **style)


def lines(ax: Axes, ways: Iterable[Iterable[Cell]], colour: str, width: float = 1.0, **style: object) -> None:
    """Many ways as one path, which keeps the file small."""
    line(ax, [point for way in ways for point in (*way, (np.nan, np.nan))], colour, width, **style)


def arrow(of: Cell, to: Cell) -> list[Cell]:
    """A move, as an arrow that ends short of the next cell's centre."""
    begin, move = np.array(of, float), np.subtract(to, of).astype(float)
    tip = begin + 0.8 * move
    back, aside = tip - 0.22 * move / np.hypot(*move), 0.12 * move[::-1] / np.hypot(*move) * (1, -1)
    return [tuple(begin), tuple(tip), tuple(back + aside), tuple(tip), tuple(back - aside)]


def map_of(*rows: str) -> an.GridMap:
    """A map from its drawing."""
    return an.GridMap(np.array([[letter == "#" for letter in row] for row in rows]).astype(np.uint8))


def corner_rules() -> Figure:
    """Every legal move of a small map."""
    grid = map_of(".....", ".#...", "..#..", ".....")
    figure, axes = panels(3, 7, 2.2)
    words = {"forbid": "both cells beside are free", "graze": "one of them is", "allow": "always"}
    for ax, (rule, meaning) in zip(axes, words.items(), strict=True):
        graph = an.Problem.from_cells(grid, (0, 0), (3, 4), corner_rule=rule).graph
        draw_map(ax, grid.cells, f"{rule}: {meaning}")
        half = graph.graph.neighbours[:, :4]  # the other four are the same moves from their other ends
        ends = [(graph.cells[node], graph.cells[half[node, slot]]) for node, slot in np.argwhere(half < len(graph))]
        lines(ax, ends, BLUE)
    return figure


def transition() -> Figure:
    """Probabilities of an ant's next cell before any pheromone, by heuristic."""
    grid = map_of("......", "..#...", "......", ".#....", "......")
    ant, goal = (2, 2), (0, 5)
    problem = an.Problem.from_cells(grid, ant, goal, corner_rule="allow")
    graph = problem.graph
    figure, axes = panels(3, 7.4, 2.5)
    for ax, name in zip(axes, ("edge", "target", "detour"), strict=True):
        draw_map(ax, grid.cells, f"heuristic {name}")
        weights = heuristic_weights(an.npaco(heuristic=name), graph, graph.node(ant), graph.node(goal))
        here = weights[graph.node(ant)]
        for (down, right), share in zip(STEPS, here / here.sum(), strict=True):
            cell = (ant[0] + down, ant[1] + right)
            if share > 0:
                ax.add_patch(Rectangle((cell[1] - 0.5, cell[0] - 0.5), 1, 1, color=SKY, alpha=float(share) ** 0.5))
                ax.text(cell[1], cell[0], f"{100 * share:.0f} %", ha="center", va="center", fontsize=7, color=INK)
        mark(ax, ant, ORANGE)
        mark(ax, goal, PURPLE, "s")
    return figure


def heuristics() -> Figure:
    """Where each heuristic points on a map with a trap."""
    grid = map_of(
        "..........", "..######..", "..#....#..", ".......#..", ".......#..", "..#....#..", "..######..", ".........."
    )
    goal = (4, 9)
    problem = an.Problem.from_cells(grid, (4, 0), goal)
    graph = problem.graph
    figure, axes = panels(3, 8.4, 2.6)
    for ax, name in zip(axes, ("target", "octile", "detour"), strict=True):
        draw_map(ax, grid.cells, name)
        weights = heuristic_weights(an.npaco(heuristic=name), graph, graph.node((4, 0)), graph.node(goal))
        best = graph.graph.neighbours[np.arange(len(graph)), weights.argmax(axis=1)]
        others = np.flatnonzero(np.arange(len(graph)) != graph.node(goal))
        lines(ax, [arrow(graph.cells[node], graph.cells[best[node]]) for node in others], BLUE, 0.8)
        mark(ax, goal, PURPLE, "s")
    return figure


def reward_and_punish() -> Figure:
    """Deposits of eq. (4.1) by rank and iteration, in units of Q / L, fifty ants and iterations."""
    ants = iterations = 50
    deposit = np.zeros((ants, iterations))
    for t in range(1, iterations + 1):
        c = -(-10 * t // iterations)
        deposit[: 11 - c, t - 1] += c
        deposit[ants - c :, t - 1] -= 1.0 if t <= iterations / 2 else 0.2
    figure, (ax,) = panels(1, 6.2, 2.9)
    extent = (0.5, iterations + 0.5, ants + 0.5, 0.5)
    image = ax.imshow(deposit, cmap="RdBu", vmin=-10, vmax=10, extent=extent, aspect="auto", interpolation="nearest")
    ax.set(xlabel="iteration t", ylabel="rank of an arrived ant")
    ax.set_yticks([1, 10, 20, 30, 40, 50])
    bar = figure.colorbar(image, label="deposit, in Q / L")
    bar.outline.set_visible(False)
    return figure


def fading() -> Figure:
    """What eq. (4.2) leaves of an edge into a dead end."""
    figure, (ax,) = panels(1, 4.6, 2.3)
    lost = np.arange(0, 51)
    for share, colour in ((0.05, SKY), (0.2, BLUE), (0.5, INK)):
        left = (1 - share) ** np.ceil(lost / 3)
        ax.step(lost, left, where="post", color=colour, label=f"lambda = {share}")
    ax.set(xlabel="ants lost in that cell", ylabel="pheromone left", xlim=(0, 50), ylim=(0, 1.02))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False, fontsize=8)
    return figure


def deadlock() -> Figure:
    """What becomes of an ant in a dead end."""
    cells = np.array([[1, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0, 1], [0, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0, 0]], dtype=bool)
    way_in = [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4)]
    figure, axes = panels(4, 9.2, 1.9)
    titles = ("death: dies", "backtrack: one step back", "luo: dies, two edges fade", "hybrid: retracts, goes on")
    for ax, title, faded, back in zip(axes, titles, (0, 1, 2, 4), (0, 1, 0, 4), strict=True):
        draw_map(ax, cells, title)
        line(ax, way_in[: 5 - faded], ORANGE, 2)
        if faded:
            line(ax, way_in[4 - faded :], ORANGE, 2, linestyle=(0, (1, 1.5)), alpha=0.6)
        if back:
            lines(ax, [arrow((1.28, 4 - step), (1.28, 3 - step)) for step in range(back)], BLUE)
        if back == 4:
            line(ax, [(1, 0), (2, 0), (3, 1), (3, 4.6)], BLUE, 1.6)
        mark(ax, way_in[-1], VERMILLION, "X")
        mark(ax, way_in[0], GREEN)
    return figure


def decomposition() -> Figure:
    """Stage one from both ends, the auxiliary cell, stage two in both halves."""
    start, goal = an.maps.builtin_query("equiv20")
    problem = an.Problem.from_cells(an.maps.builtin("equiv20"), start, goal, corner_rule="allow")
    steps = list(an.Steps(problem, an.paco(), seed=7))
    figure, axes = panels(3, 8.6, 3.1)
    middle = (start[0] + goal[0]) // 2
    titles = ("stage one: from both ends", "the auxiliary cell", "stage two: two halves")
    for ax, title in zip(axes, titles, strict=True):
        draw_map(ax, problem.grid.cells == an.Cell.OCCUPIED, title)
        mark(ax, start, GREEN)
        mark(ax, goal, PURPLE, "s")
    seen = np.zeros(problem.grid.cells.shape, np.int64)
    for step in an.Steps(problem, an.paco(), seed=7):
        if step.stage != "stage one":
            break
        for colony, colour in zip(step.colonies, (BLUE, PURPLE), strict=True):
            walks = [colony.task.grid_graph.cells[nodes] for nodes in colony.ant_paths()]
            line(axes[0], walks[0], colour, 0.8, alpha=0.6)
            for cells in walks:
                seen[tuple(cells.T)] += 1
    for col in np.flatnonzero(seen[middle]):
        share = float(seen[middle, col] / seen[middle].max())
        axes[1].add_patch(Rectangle((col - 0.5, middle - 0.5), 1, 1, color=BLUE, alpha=0.1 + 0.8 * share, linewidth=0))
    axes[1].axhline(middle, color=FAINT, linewidth=0.8, linestyle="--", zorder=1)
    auxiliary = steps[-1].auxiliary_cell
    assert auxiliary is not None
    for colony, colour in zip(steps[-1].colonies, (BLUE, PURPLE), strict=True):
        assert colony.best_nodes is not None
        line(axes[2], colony.task.grid_graph.cells[colony.best_nodes], colour, 2)
    for ax in axes[1:]:
        mark(ax, auxiliary, ORANGE, "D")
    return figure


DRAWN = (corner_rules, transition, heuristics, reward_and_punish, fading, deadlock, decomposition)


def main(folder: FilePath = FOLDER) -> None:
    """Draw all of them."""
    folder.mkdir(parents=True, exist_ok=True)
    mpl.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "antnav", "font.family": "sans-serif", "font.size": 8})
    mpl.rcParams.update({"path.simplify": True, "axes.edgecolor": FAINT, "savefig.facecolor": "white"})
    for draw in DRAWN:
        figure = draw()
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
        plt.close(figure)
        brief = re.sub(r"\d+\.\d{2,}", lambda number: f"{float(number[0]):.4g}", text.getvalue())
        brief = re.sub(r"\s*\n\s*(?=[LzM])", "", brief)
        (folder / f"{draw.__name__}.svg").write_text(brief, encoding="utf-8")


if __name__ == "__main__":
    mpl.use("svg")
    main()
