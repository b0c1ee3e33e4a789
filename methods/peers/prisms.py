"""Blocks as three-dimensional programs take them: prisms of thickness one, with x and y of the wall as x and z."""

from __future__ import annotations

from harness.model.assembly import FloatArray


def prism(corners: FloatArray) -> tuple[list[list[float]], list[list[int]]]:
    """The prism over a polygon: its vertices (2k, 3), and its faces as lists of numbers of these.

    Args:
        corners: (k, 2) of the polygon; faces look outward if they run counter-clockwise.
    """
    k = len(corners)
    vertices = [[float(x), side, float(y)] for side in (-0.5, 0.5) for x, y in corners]
    sides = [[j, k + j, k + (j + 1) % k, (j + 1) % k] for j in range(k)]
    return vertices, [list(range(k)), list(range(2 * k - 1, k - 1, -1)), *sides]
