"""When a wall has fallen, and when its motion has died, by geometry and energy."""

from __future__ import annotations

from collections import deque

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray, polygon_area

_TURNED = np.pi / 3.0
"""A block that has turned so far has tipped over: one that rocks turns back from less than atan(b / h)."""
_DROPPED = 0.5
"""A block has dropped off its seat whose centroid is so much of its size, the square root of its area, too low."""
_SLOW = 1e-3
"""Speed of a wall at rest [sqrt(size x gravity)]: a fall over a millionth of the size makes more."""
_STILL = 1e-4
"""Displacement within `patience` of a wall at rest, in sizes of a block."""


def fallen_blocks(assembly: Assembly, places: FloatArray) -> BoolArray:
    """(n,) blocks that have tipped over or dropped off their seats.

    Args:
        assembly: the wall as drawn.
        places: (n, 3) displacements of the centroids [length] and rotations [rad].
    """
    sizes = np.sqrt([polygon_area(polygon) for polygon in assembly.polygons])
    return np.asarray((abs(places[:, 2]) > _TURNED) | (-places[:, 1] > _DROPPED * sizes))


def below_supports(assembly: Assembly, places: FloatArray) -> BoolArray:
    """(n,) blocks that lie wholly below all supports, where nothing can stop their fall; places as `fallen_blocks`."""
    ground = min(float(assembly.polygons[i][:, 1].min()) for i in np.flatnonzero(assembly.fixed))
    return np.asarray((assembly.centroid[:, 1] + places[:, 1] + assembly.radius < ground) & ~assembly.fixed)


def patience(assembly: Assembly) -> float:
    """Time for which a wall at rest has to be still: 4 / p, p^2 = 3 g / (4 R) [sqrt(length_scale / gravity)].

    R is half the diagonal of the free blocks together. A block balanced on its edge, which falls as exp(p t), moves off
    within this time by 27 times (cosh 4) its distance from the balance.
    """
    corners, block = assembly.corners
    radius = 0.5 * float(np.hypot(*np.ptp(corners[~assembly.fixed[block]], axis=0)))
    return 4.0 / float(np.sqrt(0.75 * assembly.length_scale / radius))


class Stillness:
    """Whether a wall has been at rest for long enough.

    Args:
        count: states that have to follow each other at rest.
        size: of a block [length].
    """

    def __init__(self, count: int, size: float) -> None:
        self._states: deque[FloatArray] = deque(maxlen=max(count, 2))
        self._size = size

    def lasts(self, places: FloatArray, speed: float) -> bool:
        """Take notice of a state: places (n, 3), and largest speed of a block [sqrt(size x gravity)]."""
        if not speed < _SLOW:
            self._states.clear()
            return False
        self._states.append(places * [1.0, 1.0, self._size])
        if len(self._states) < (self._states.maxlen or 0):
            return False
        return bool(np.ptp(np.array(self._states), axis=0).max(initial=0.0) < _STILL * self._size)
