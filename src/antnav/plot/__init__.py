"""Pictures of maps and results, films of replays: data first, drawing second.

Pictures need matplotlib, the extra ``antnav[plot]``; films do not.

Every drawing function takes ``ax=None`` and returns the Axes; without one it opens a pyplot figure. `save_picture` does
without pyplot, so it works on servers and in threads.
"""

from antnav.plot.animation import Animation, animate
from antnav.plot.curves import plot_convergence
from antnav.plot.data import Convergence, Heat, convergence, heat, map_colours
from antnav.plot.figure import plot_front, plot_result, save_picture
from antnav.plot.map import plot_map, plot_path
from antnav.plot.replay import plot_replay, save_film

__all__ = [
    "Animation",
    "Convergence",
    "Heat",
    "animate",
    "convergence",
    "heat",
    "map_colours",
    "plot_convergence",
    "plot_front",
    "plot_map",
    "plot_path",
    "plot_replay",
    "plot_result",
    "save_film",
    "save_picture",
]
