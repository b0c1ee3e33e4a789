"""Drawings: display lists of walls, mechanisms and forces, and the SVG of them."""
