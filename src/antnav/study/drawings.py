"""Drawings: the figures of a report, each with its name, title and caption."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

from antnav.report import pictures, statistics
from antnav.report.section import Drawing
from antnav.study import figures, series
from antnav.study.groups import Groups
from antnav.study.paper import SWAPPED
from antnav.study.record import Record
from antnav.world.problem import Problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FOUR = ("paco", "npaco", "dai", "traditional")  #: Of the paper's Figures 7-9.
#: Of its Figures 5 and 6: its own two rules and Luo's, all else equal, and beside them the whole of Luo's algorithm.
RULES = {
    "npaco": "npaco, the paper's two rules",
    SWAPPED: "npaco, Luo's two rules",
    "luo": "luo, the whole preset",
}
LONGEST_NAME = 60  #: Letters of a label in a file name.


LINES_NOTE = (
    "Lines are means over the runs that have a path by then, drawn where at least half have one; they may rise when a "
    "further run finds its first. Bands are the quartiles of all runs, open at the top while more than a quarter have "
    "no path."
)
STAGES_NOTE = "PACO's second stage starts anew with the sum of its two halves, so its line may rise there."


def paper_figures(groups: Groups, problems: Mapping[str, Problem]) -> list[Drawing]:
    """Figures 5-9 of the paper, as far as the records hold what they show."""
    found: list[Drawing] = []
    both = {label: group for label, group in groups.items() if "npaco" in group and SWAPPED in group}
    if both:
        caption = (
            "The same colony with the paper's pheromone rule and deadlock strategy (eq. (4.1), hybrid) and with Luo's "
            "(the iteration's best and worst path, death and eq. (4.2)); nothing else differs. "
        )
        if any("luo" in group for group in both.values()):
            caption += (
                "The preset luo, a reconstruction of the whole algorithm, stands beside them: its transition rule and "
                "its initial pheromone are others too, so it is not the paper's comparison. "
            )
        for number, name, draw, what in (
            (5, "best_length", figures.draw_convergence, "Best length by iteration"),
            (6, "lost_ants", figures.draw_lost, "Lost ants by iteration"),
        ):
            title = f"Figure {number}. {what}: the paper's two rules against Luo's"
            note = LINES_NOTE if number == 5 else "Lines are means over runs, bands the quartiles."
            found.append(Drawing(f"figure_{number}_{name}", title, caption + note, _row(draw, both, RULES)))
    for number, (label, group) in enumerate(groups.items(), 7):
        title = f"Figure {number}. Convergence and best paths on {label}"
        caption = (
            "Left: best length by iteration. Right: the best path of each algorithm, side by side where they share "
            f"cells; the star is the auxiliary cell of PACO's best run. {LINES_NOTE} {STAGES_NOTE}"
        )
        found.append(
            Drawing(
                f"figure_{number}_{file_name(label)}", title, caption, _pair(label, group, FOUR, problems.get(label))
            )
        )
    return found


RIVALS_NOTE = (
    " An iteration is a walk of all ants; of a metaheuristic, as many cost evaluations as its population has members; "
    "of a potential field, a random walk. So the axis compares ants with ants only."
)


def study_figures(groups: Groups, problems: Mapping[str, Problem], rivals: Collection[str] = ()) -> list[Drawing]:
    """Convergence and best paths of any study, a figure for each map; `rivals` are the labels of those without ants."""
    found = []
    for number, (label, group) in enumerate(groups.items(), 1):
        names = series.leaders(group)
        caption = "Left: best length by iteration. Right: the best path of each algorithm. " + LINES_NOTE
        if any(name in rivals for name in names):
            caption += RIVALS_NOTE
        if len(names) < len(group):
            caption += f" Shown: {series.choice_of_leaders(group)}."
        title = f"Convergence and best paths on {label}"
        found.append(
            Drawing(
                f"convergence_{number}_{file_name(label)}",
                title,
                caption,
                _pair(label, group, names, problems.get(label)),
            )
        )
    return found


def gap_figure(groups: Groups) -> Drawing:
    """Gaps of all runs, a panel for each map."""
    caption = (
        "Each mark is a run; boxes are quartiles with the median, whiskers reach to 1.5 times the interquartile range."
    )
    return Drawing("gaps", "Gaps to the optimum", caption, lambda: _gap_panels(groups))


def rank_figure(found: statistics.Ranks, order: Sequence[str]) -> Drawing:
    """The critical-difference diagram of the ranks."""

    def figure() -> Figure:
        sheet = pictures.new_figure(*figures.ranks_size(found))
        figures.draw_ranks(sheet.add_subplot(), found, order)
        return sheet

    caption = (
        f"Mean ranks over {found.blocks} blocks, 1 the best. Algorithms that share a bar do not differ at "
        f"{100 * statistics.ALPHA:.0f} % by Nemenyi's test; those that share none do."
    )
    return Drawing("critical_difference", "Critical-difference diagram", caption, figure)


def sweep_figures(groups: Groups, shown: Sequence[series.Plane]) -> list[Drawing]:
    """Heat maps of the mean gap, one for each plane and map."""
    return [
        _sweep_figure(number, label, [run for runs in group.values() for run in runs], plane)
        for number, (plane, (label, group)) in enumerate(product(shown, groups.items()), 1)
    ]


def _sweep_figure(number: int, label: str, runs: Sequence[Record], plane: series.Plane) -> Drawing:
    axes = [plane.x, *([plane.y] if plane.y else [])]
    caption = "Mean gap to the optimum in per cent, of the runs with a path; below it the share of runs without one."
    if plane.averaged:
        caption += f" Averaged over {', '.join(plane.averaged)}."
    data = series.sweep_grid(runs, plane)

    def figure() -> Figure:
        sheet = pictures.new_figure(*figures.sweep_size(data))
        figures.draw_sweep(sheet.add_subplot(), data, plane.x, plane.y, f"{plane.name} on {label}")
        return sheet

    return Drawing(
        f"sweep_{number}_{file_name(' '.join((label, plane.name, *axes)))}",
        f"Mean gap of {plane.name} on {label} over {' and '.join(axes)}",
        caption,
        figure,
    )


def file_name(label: str) -> str:
    """A label as part of a file name, not of all of it: two labels may give the same."""
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in label)[:LONGEST_NAME]


def _row(draw: Any, groups: Groups, words: Mapping[str, str]) -> Callable[[], Figure]:
    """A panel for each map, with the algorithms that `words` has names for."""

    def figure() -> Figure:
        sheet = pictures.new_figure(3.9 * len(groups), 3.9)
        axes = sheet.subplots(1, len(groups), squeeze=False)[0]
        for ax, (label, group) in zip(axes, groups.items(), strict=True):
            draw(ax, group, list(words), label, words)
        return sheet

    return figure


def _pair(
    label: str, group: Mapping[str, Sequence[Record]], names: Sequence[str], problem: Problem | None
) -> Callable[[], Figure]:
    def figure() -> Figure:
        if problem is None:
            sheet = pictures.new_figure(6.0, 4.6)
            figures.draw_convergence(sheet.add_subplot(), group, names, label)
            return sheet
        sheet = pictures.new_figure(11.0, 6.0)
        left, right = sheet.subplots(1, 2)
        figures.draw_convergence(left, group, names, f"{label}: convergence")
        figures.draw_paths(right, problem, group, names, f"{label}: best paths")
        return sheet

    return figure


def _gap_panels(groups: Groups) -> Figure:
    most = max(len(group) for group in groups.values())
    sheet = pictures.new_figure(7.0, (0.36 * most + 1.1) * len(groups))
    axes = sheet.subplots(len(groups), 1, squeeze=False)[:, 0]
    for ax, (label, group) in zip(axes, groups.items(), strict=True):
        figures.draw_gaps(ax, group, label)
    return sheet
