"""A pheromone rule that antnav does not have: docs/extend.md and notebook 3 check it and compare it."""

import antnav as an


@an.register.pheromone(version="1.0")
def near_best(
    ants,
    wide=an.parameter(4.0, least=0.01, most=100, sane=(1, 10), symbol="w_0"),
    narrow=an.parameter(0.5, least=0.01, most=100, sane=(0.1, 2), symbol="w_T"),
    gain=an.parameter(3.0, least=0.01, most=100, sane=(1, 10), symbol="g"),
):
    """Every arrived ant, g Q / L (w / (w + L - L*))^6, and the best so far, g Q / L*; w falls from w_0 to w_T."""
    width = wide + (narrow - wide) * ants.t / ants.iterations
    costs = ants.costs[ants.order[: ants.arrived]]
    nearness = width / (width + costs - ants.best)
    ants.amounts[: ants.arrived] = gain * ants.q / costs * nearness**6
    if ants.best_steps > 0:
        ants.amounts[-1] = gain * ants.q / ants.best
