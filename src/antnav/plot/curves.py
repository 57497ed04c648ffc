"""The lengths by iteration as curves, beside the exact optimum."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from antnav.planner.plan import Status
from antnav.planner.result import Result
from antnav.plot.data import Convergence, convergence
from antnav.plot.style import BLUE, FAINT, INK, ORANGE, VERMILLION, axes_for, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAND = "#e3e6ea"  #: Behind the iterations of stage one.


def plot_convergence(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the lengths by iteration: best so far, best and mean of each iteration, the exact optimum, the gap.

    The scale fits the best lengths; where the mean leaves the picture, the legend states its range. The stages of a
    divided problem are marked, and no line joins them: in stage two the lengths are sums over the parts.

    Parameters
    ----------
    result : Result
    ax : Axes, optional
        Where to draw; default: a new pyplot figure.

    Raises
    ------
    ParameterError
        matplotlib is not installed.
    """
    ax = axes_for(ax, (6.0, 4.6))
    data = convergence(result)
    ax.set_title("Convergence", loc="left", fontsize=9, color=INK)
    ax.set_xlabel("iteration", color=INK)
    where = " on the graph of regions" if data.estimated else ""
    ax.set_ylabel(f"{data.quantity}{where} (cells)", color=INK)
    ax.tick_params(labelsize=8, color=FAINT)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    if not len(data.iteration):
        near = "one cell" if len(result.path or ()) == 1 else "in one region"
        reasons = {Status.UNREACHABLE: "no path exists", Status.FOUND: f"start and goal are {near}"}
        reason = reasons.get(result.status, "the run was stopped before")
        walks = result.algorithm.ants or result.status is not Status.FOUND
        _say(ax, f"no ant walked:\n{reason}" if walks else f"{result.algorithm.name} has no iterations")
        ax.set(xticks=[], yticks=[])
        return ax
    handles = [*_draw_lengths(ax, data), *_draw_ends(ax, data), *_draw_stages(ax, data)]
    _scale(ax, data)
    if not np.isfinite(data.best).any():
        _say(ax, "no ant arrived" if not np.isfinite(data.iteration_best).any() else "no path was completed")
    legend_below(ax, handles)
    return ax


def _say(ax: Axes, text: str) -> None:
    ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", color=FAINT)


def _draw_lengths(ax: Axes, data: Convergence) -> list[Any]:
    """The three curves, each stage by itself."""
    dots: dict[str, Any] = {"linewidth": 0.6}
    dashes: dict[str, Any] = {"linewidth": 0.6}
    if len(data.iteration) <= 200:  # beyond that marks and dashes run together
        dots = {"marker": ".", "markersize": 4.5, "linestyle": "none"}
        dashes = {"linewidth": 1.2, "linestyle": (0, (4, 1.5))}
    handles: list[Any] = []
    for part in data.stages:
        at = data.iteration[part]
        curves = [
            ax.plot(at, data.mean[part], color=ORANGE, zorder=2, **dashes, **_lonely(data.mean[part]))[0],
            ax.plot(at, data.iteration_best[part], color=BLUE, zorder=3, **dots)[0],
            ax.stairs(
                data.best[part], np.append(at - 0.5, at[-1] + 0.5), baseline=None, color=VERMILLION, lw=2, zorder=4
            ),
        ]
        handles = curves[::-1]
    labels = ["best so far", "best of the iteration", "mean of the arrived ants"]
    if np.isfinite(data.mean).any() and np.nanmax(data.mean) > _top(data):
        labels[2] += f" ({np.nanmin(data.mean):.1f} to {np.nanmax(data.mean):.1f})"
    shown = []
    for handle, label, values in zip(handles, labels, (data.best, data.iteration_best, data.mean), strict=True):
        handle.set_label(label)
        if np.isfinite(values).any():
            shown.append(handle)
    return shown


def _lonely(values: NDArray[np.float64]) -> dict[str, Any]:
    """Marks for values between two gaps, which a line does not show."""
    gaps = np.isnan(np.pad(values, 1, constant_values=np.nan))
    lonely = np.flatnonzero(gaps[:-2] & ~gaps[1:-1] & gaps[2:])
    return {"marker": ".", "markersize": 3, "markevery": lonely.tolist()} if lonely.size else {}


def _draw_ends(ax: Axes, data: Convergence) -> list[Any]:
    """The optimum as a line, the length of the returned path as a mark on the right."""
    handles: list[Any] = []
    if math.isfinite(data.optimum):
        handles.append(
            ax.axhline(data.optimum, color=INK, lw=1.1, ls=(0, (1, 1.2)), label=f"exact optimum: {data.optimum:.4f}")
        )
    if math.isfinite(data.length):
        handles += ax.plot(
            [data.iteration[-1] + 0.5],
            [data.length],
            marker="D",
            markersize=6.5,
            color=VERMILLION,
            markeredgecolor=INK,
            markeredgewidth=0.8,
            linestyle="none",
            clip_on=False,
            zorder=5,
            label=f"path returned: {data.length:.4f}",
        )
    return handles


def _draw_stages(ax: Axes, data: Convergence) -> list[Any]:
    """The band of stage one, and what the lengths of either stage mean."""
    from matplotlib.patches import Patch

    if not data.stage_one:
        return []
    ax.axvspan(0.5, data.stage_one + 0.5, color=BAND, linewidth=0, zorder=0)
    bands = [Patch(facecolor=BAND, edgecolor=INK, linewidth=0.5, label="stage one: better of two colonies")]
    if data.divided:
        ax.axvline(data.stage_one + 0.5, color=FAINT, linewidth=0.8, zorder=1)
        bands.append(Patch(facecolor="white", edgecolor=INK, linewidth=0.5, label="stage two: sum over the parts"))
    return bands


def _top(data: Convergence) -> float:
    """Upper end of the lengths' scale: all best lengths fit."""
    known = [values[np.isfinite(values)] for values in (data.best, data.iteration_best, np.array([data.length]))]
    low = data.optimum if math.isfinite(data.optimum) else 0.0
    highest = max((float(values.max()) for values in known if values.size), default=1.3 * low)
    return max(highest + 0.08 * (highest - low), 1.02 * low, low + 1e-9)


def _scale(ax: Axes, data: Convergence) -> None:
    """Limits of both axes, and the gap to the optimum on the right."""
    from matplotlib.ticker import MaxNLocator

    ax.set_xlim(0.5, data.iteration[-1] + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    low, high = data.optimum, _top(data)
    if not 0 < low < math.inf:
        return  # a file may lack the optimum
    ax.set_ylim(low - 0.06 * (high - low), high)
    to_percent_and_back = (lambda length: 100 * (length / low - 1), lambda percent: low * (1 + percent / 100))
    gap = ax.secondary_yaxis("right", functions=to_percent_and_back)
    gap.set_ylabel("gap to the optimum (%)", color=INK)
    gap.tick_params(labelsize=8, color=FAINT)
