"""Tours: many stops, one trip."""
