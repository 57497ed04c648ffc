"""A browser view: maps that are drawn on, ants that walk on them, one iteration at a time."""
