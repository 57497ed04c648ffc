"""Many stops, one trip.

The best order of eight stops, there and back, for a robot of 25 cm radius, and one curve through all of them.
"""

import antnav as an

grid = an.maps.builtin("warehouse")
stops = [
    (18.0, 6.0),
    (4.0, 5.0),
    (10.0, 12.0),
    (2.0, 14.0),
    (26.0, 15.0),
    (24.0, 6.5),
    (12.0, -1.8),
    (7.5, 9.0),
    (17.2, 14.0),
]
tour = an.tour(grid, (1.0, 1.0), stops, return_to_start=True, radius=0.25, goal_tolerance=0.8)

an.plot_tour(tour, trajectory=tour.trajectory(max_curvature=2.0))
