"""Compiled code, and nothing above it: ants, searches on grids, straightening, walks of the rivals."""
