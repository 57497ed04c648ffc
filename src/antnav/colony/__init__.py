"""The ants: their parts, parameters, kernels, and the colony that runs them."""
