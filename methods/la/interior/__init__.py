"""The interior point on the complementarity system of collapse, and the paths that are followed with it."""
