"""The question and the answer's shape: maps, moves, problems, paths."""
