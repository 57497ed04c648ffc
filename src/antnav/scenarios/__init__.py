"""Scenarios: what happens on a map while a robot drives, and the replay of it with any replanner."""

from antnav.scenarios.named import named
from antnav.scenarios.scenario import Event, Scenario

__all__ = ["Event", "Scenario", "named"]
