"""A curve that a robot drives.

The path on cells, and the curve of bounded curvature that a robot of 25 cm radius follows, checked against the
walls.
"""

import antnav as an

walls = an.maps.builtin("warehouse")
grid = walls.inflated(0.25 + 0.03, strict=True)
result = an.solve(an.Problem(grid, start=(1.0, 1.0), goal=(18.0, 6.0)), an.astar())
drive = result.trajectory(radius=0.25, margin=0.03, max_curvature=1.5, max_speed=0.8)

an.plot_result(result, trajectory=drive, panels="map")
