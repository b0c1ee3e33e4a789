"""Geometry: extents, centres of pressure, lines of thrust and displaced blocks."""
