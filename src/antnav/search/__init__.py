"""Exact search: the optimum, large maps in short, windows of a path."""
