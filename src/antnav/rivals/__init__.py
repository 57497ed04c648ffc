"""Planners without ants, to be put beside them: metaheuristics on control points, and a potential field.

>>> from antnav import rivals
>>> result = an.solve(problem, rivals.RIVALS["pso-straight"], seed=7)

Imported on use; `import antnav` does not bring it. The methods `ga`, `pso`, `sa` and `gwo` need the extra `rivals`.
"""

from antnav.rivals.encoding import Encoding, Segments
from antnav.rivals.metaheuristics import Metaheuristic, Method
from antnav.rivals.planning import RIVALS
from antnav.rivals.potential_field import PotentialField
from antnav.rivals.rival import Rival

__all__ = [
    "RIVALS",
    "Encoding",
    "Metaheuristic",
    "Method",
    "PotentialField",
    "Rival",
    "Segments",
]
