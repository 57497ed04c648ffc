"""Benchmarks against published optima, and against what else can be installed."""
