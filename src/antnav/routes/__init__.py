"""Several routes where one is not enough: cheap ones that truly differ."""
