"""What the panels have in common: colours, axes, titles, fine print, legends."""

from __future__ import annotations

import contextlib
import os
import sys
import textwrap
from typing import TYPE_CHECKING, Any

from antnav.errors import ParameterError, check_type
from antnav.markup import printable
from antnav.planner.plan import Status, StoppedBy
from antnav.planner.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.legend import Legend

#: Okabe & Ito 2008: told apart by all kinds of colour vision.
BLUE, ORANGE, VERMILLION, GREEN, PURPLE, YELLOW = "#0072B2", "#E69F00", "#D55E00", "#009E73", "#CC79A7", "#F0E442"
SKY = "#56B4E9"
INK, FAINT = "#26292e", "#6b7077"


def require_matplotlib() -> None:
    """Raise the error that names the extra where matplotlib is not installed.

    With a window system in `MPLBACKEND` that it does not know, as Jupyter sets one for all its children, matplotlib
    cannot be imported. Files need no window, so it is told afterwards.
    """
    backend = None if "matplotlib" in sys.modules else os.environ.pop("MPLBACKEND", None)
    try:
        import matplotlib
    except ImportError as error:
        raise ParameterError("a picture", "matplotlib is not installed", 'pip install "antnav[plot]"') from error
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    if backend:
        with contextlib.suppress(ValueError):
            matplotlib.rcParams["backend"] = backend


def axes_for(ax: Axes | None, size: tuple[float, float]) -> Axes:
    """The axes given, or those of a new pyplot figure of this size in inches."""
    require_matplotlib()
    if ax is not None:
        from matplotlib.axes import Axes

        check_type("ax", ax, Axes, "give one, such as plt.figure().add_subplot(), or None")
        return ax
    from matplotlib import pyplot as plt

    return plt.figure(figsize=size, layout="constrained").add_subplot()


def title_of(result: Result) -> str:
    """Two lines: what was solved by what, and with which outcome."""
    grid = result.problem.grid
    place = printable(grid.name) or f"{grid.rows} x {grid.cols} cells"
    ending = "" if result.stopped_by is StoppedBy.SCHEDULE else f" (stopped: {result.stopped_by})"
    if result.status is Status.UNREACHABLE:
        outcome = "unreachable: no path leads from start to goal"
    elif result.path is None:
        outcome = f"no ant arrived in {result.iterations} iterations{ending}"
    else:
        metres = f", {result.length_m:.3f} m" if grid.resolution != 1 else ""
        priced = "" if result.problem.objective.plain else f", cost {result.cost:.4f}"
        outcome = f"{result.length:.4f} cells{metres}{priced}, gap {100 * result.gap:.2f} %, {result.status}{ending}"
    return f"{printable(result.algorithm.name)} on {place}, seed {result.seed}\n{outcome}"


def fine_print(result: Result, width: int) -> str:
    """What must travel with the picture: the certainty of the algorithm, and the result's notes."""
    lines = [f"Certainty: {printable(str(result.algorithm.certainty), 300)}"]
    lines += [f"Note: {printable(note, 300)}" for note in result.notes]
    return "\n".join(textwrap.fill(line, width) for line in lines)


def legend_below(ax: Axes, handles: list[Any]) -> Legend:
    """A legend below the axes, where it hides nothing."""
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.transforms import ScaledTranslation

    labels = [str((handle[0] if isinstance(handle, tuple) else handle).get_label()) for handle in handles]
    below_labels = ax.transAxes + ScaledTranslation(0, -36 / 72, ax.figure.dpi_scale_trans)
    return ax.legend(
        handles,
        labels,
        handler_map={tuple: HandlerTuple(ndivide=None, pad=0)},
        loc="upper center",
        bbox_to_anchor=(0.5, 0),
        bbox_transform=below_labels,
        borderaxespad=0,
        ncols=2 if len(max(labels, key=len, default="")) > 25 else 3,
        frameon=False,
        fontsize=8,
        alignment="left",
        columnspacing=1.4,
    )
