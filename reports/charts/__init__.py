"""Charts: lines with axes, and what studies, paths and methods give to draw."""
