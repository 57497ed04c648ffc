"""Trajectories: the curve that a robot drives along a path, checked before it is handed out."""
