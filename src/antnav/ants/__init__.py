"""Ants as a planner: presets, and the strategies that make a path of colonies."""
