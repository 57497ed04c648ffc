"""Maps that change: a plan that is kept, mended and improved, and exact replanners beside it."""
