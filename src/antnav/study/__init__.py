"""Repeated runs: what to run, a store that survives, statistics, tables, figures, reports."""
