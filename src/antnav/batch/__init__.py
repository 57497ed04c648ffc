"""Many queries: side by side on any executor, in order, from files and into files."""
