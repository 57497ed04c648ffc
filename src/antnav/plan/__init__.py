"""From a problem and an algorithm to a result: strategies, their wiring, accounts."""
