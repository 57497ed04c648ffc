"""Builders of cost fields: what each cell of a map costs to cross, on top of 1 per metre. They add: `a + b`."""

from antnav.costs.array import array
from antnav.costs.clearance import clearance
from antnav.costs.costmap import costmap
from antnav.costs.inflation import inflation
from antnav.costs.keepout import keepout
from antnav.costs.slope import slope
from antnav.costs.speed import speed
from antnav.world.cost import CostField

__all__ = ["CostField", "array", "clearance", "costmap", "inflation", "keepout", "slope", "speed"]
