"""Several goals that conflict: fronts of paths, and methods that find them."""

from antnav.fronts.auto import Auto
from antnav.fronts.colonies import Colonies
from antnav.fronts.exact import Exact
from antnav.fronts.front import Front
from antnav.fronts.method import Method
from antnav.fronts.nsga2 import Nsga2
from antnav.fronts.p_aco import PAco
from antnav.fronts.pareto import METHODS, pareto
from antnav.fronts.sweep import Sweep

__all__ = ["METHODS", "Auto", "Colonies", "Exact", "Front", "Method", "Nsga2", "PAco", "Sweep", "pareto"]
