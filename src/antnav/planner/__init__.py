"""What a planner is, what it is asked and what it answers."""
