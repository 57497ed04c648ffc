"""A ROS costmap as a cost field."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike

from antnav.errors import ParameterError, shown
from antnav.files import as_path
from antnav.maps.image import read_gray
from antnav.values import is_whole
from antnav.world.cost import CostField, check_weight, table

#: Costs of costmap_2d: the greatest that only costs, and what nobody has seen.
_DEAREST, _UNKNOWN = 252, 255


def costmap(
    costs: str | os.PathLike[str] | ArrayLike,
    weight: float = 1.0,
    *,
    allow_unknown: bool = False,
    blocked_from: int = 253,
) -> CostField:
    """The costs of a ROS costmap: weight value / 252.

    Parameters
    ----------
    costs : path-like, or array_like of int, shape (rows, cols)
        Values of costmap_2d, row 0 at the top: 0 free to 252, 253 within the robot's inscribed radius, 254 lethal,
        255 unknown. An array (of ROS, flipped: its rows begin at the bottom), or a gray image with these values as its
        pixels, PGM or PNG.
    weight : float
        Cost per metre of the value 252, 0 to 1e9.
    allow_unknown : bool
        Whether unknown cells may be crossed. They cost `weight` then, as nav2's navfn takes them for the dearest.
    blocked_from : {253, 254}
        The least value that blocks. With 254, the value 253 costs `weight`: nav2 leaves that to robots whose footprint
        is no circle.

    Returns
    -------
    CostField
        Values 0 to `weight`, 0 where blocked.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        The image is missing; damaged, coloured or of a lossy format; too large.
    ParameterError
        An array of something else; a number outside its range.

    References
    ----------
    nav2_costmap_2d/cost_values.hpp and `setCostmap` of nav2_navfn_planner, github.com/ros-navigation/navigation2.
    """
    weight = check_weight("weight", weight)
    if not is_whole(blocked_from) or blocked_from not in (253, 254):
        rule = "253 or 254 is the least value that blocks"
        raise ParameterError(f"blocked_from {shown(blocked_from)}", rule, "leave it at 253 for a round robot")
    given = read_gray(as_path(costs)) if isinstance(costs, str | os.PathLike) else costs
    values = table("costmap", given, "iu", "a whole number")
    if values.min() < 0 or values.max() > _UNKNOWN:
        rule = "its values are 0 to 255"
        remedy = "take the raw costmap as unsigned bytes, not the occupancy grid made of it"
        raise ParameterError(f"costmap of {values.min()} to {values.max()}", rule, remedy)
    unknown = values == _UNKNOWN
    blocked = (values >= blocked_from) & ~unknown
    if not allow_unknown:
        blocked |= unknown
    shares = np.minimum(values, _DEAREST) / _DEAREST
    return CostField(np.where(blocked, 0.0, weight * shares), blocked, "costmap")
