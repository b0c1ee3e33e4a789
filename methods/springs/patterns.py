"""The smallest wall with every state of a contact, which the warm-up of compiled loops solves; it needs no case."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly


def block_on_halves(friction: tuple[float, float]) -> Assembly:
    """The block of Baggio and Trovalusci (1995): L x L/2 on two contact halves with different friction, L = 1."""
    base = np.array([[0.0, -0.5], [1.0, -0.5], [1.0, 0.0], [0.0, 0.0]])
    block = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]])
    end1, end2 = np.array([[0.0, 0.0], [0.5, 0.0]]), np.array([[0.5, 0.0], [1.0, 0.0]])
    return Assembly(
        name="block on two halves",
        block_ids=("base", "block"),
        polygons=(base, block),
        centroid=np.array([[0.5, -0.25], [0.5, 0.25]]),
        weight=np.array([0.0, 1.0]),
        fixed=np.array([True, False]),
        block_a=np.array([0, 0]),
        block_b=np.array([1, 1]),
        end1=end1,
        end2=end2,
        face1=end1,
        face2=end2,
        normal=np.array([[0.0, 1.0], [0.0, 1.0]]),
        friction=np.array(friction),
        dilatancy=np.zeros(2),
        joint=("bed", "bed"),
        dead=np.array([[0.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
        live=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
    )
