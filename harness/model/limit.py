"""When a wall is at its limit: its multiplier is zero within the accuracy of its data.

Coordinates, friction and loads are written to some digits. What they leave open moves the multiplier of a mechanism, by
virtual work, by that share of the power which the dead load would have on it if nothing cancelled. A multiplier no
larger than this cannot be distinguished from zero: whether such a wall just stands or just falls is not in its
description.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray

WRITTEN = 1e-8
"""Share of the size of a block to which coordinates are meant, and absolute accuracy of friction. Eight digits are more
than drawings and measurements keep; it is ten times what linear programmes round off, so that what one of them decides
by rounding is within it."""

_ROUNDED = 16.0
"""Units in the last place by which coordinates computed in double precision are off. In a national grid they are the
larger part."""


def accuracy(assembly: Assembly) -> float:
    """Accuracy of the coordinates of a wall as a share of the size of a block, and of its friction."""
    points, _ = assembly.corners
    last_place = float(np.finfo(float).eps * abs(points).max(initial=0.0))
    return WRITTEN + _ROUNDED * last_place / assembly.length_scale


def gross_power(assembly: Assembly, mechanism: FloatArray) -> float:
    """Power of the dead load on a mechanism (n, 3) if nothing cancelled: sum of load times fastest speed of a block."""
    dead = np.hypot(*assembly.dead[:, :2].T) + abs(assembly.dead[:, 2]) / assembly.radius
    speed = np.hypot(*mechanism[:, :2].T) + abs(mechanism[:, 2]) * assembly.radius
    return float((dead * speed)[assembly.free].sum())


def smallest_resolved(assembly: Assembly, mechanism: FloatArray) -> float:
    """The multiplier of a mechanism (n, 3) up to which the numbers of the wall allow zero; zero without live work."""
    work = float((assembly.live * mechanism).sum())
    return accuracy(assembly) * gross_power(assembly, mechanism) / work if work > 0.0 else 0.0


def strengthened(assembly: Assembly) -> Assembly:
    """The wall with contacts longer, and friction greater, by half of what its numbers leave open.

    A wall that has no equilibrium even so falls under its dead load.
    """
    share = 0.5 * accuracy(assembly)
    longer = share * assembly.length_scale * assembly.tangent
    return replace(
        assembly,
        end1=assembly.end1 - longer,
        end2=assembly.end2 + longer,
        friction=assembly.friction + share * np.maximum(assembly.friction, 1.0),
    )
