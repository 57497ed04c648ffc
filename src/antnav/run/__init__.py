"""One program on many data: executors, and when to stop."""
