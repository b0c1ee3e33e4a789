"""A block that rocks on ground that accelerates, and a column that three programs shook."""

from __future__ import annotations

from typing import Any

import numpy as np

import drystone
from tests.walls import stack, wall_data

WIDTH, HEIGHT, GRAVITY = 0.4, 2.0, 9.81
ALPHA = np.arctan(WIDTH / HEIGHT)
RADIUS = 0.5 * np.hypot(WIDTH, HEIGHT)
P = np.sqrt(0.75 * GRAVITY / RADIUS)
IMPACT = 1.0 - 1.5 * np.sin(ALPHA) ** 2
PULSES = {0.1: 0.851527, 0.2: 0.481959, 0.4: 0.303748, 0.8: 0.226254}
"""Least rectangular pulse [g] that topples the block, by its duration [s]."""


def block(friction: float = 0.9, **more: Any) -> drystone.Wall:
    return drystone.build_wall(wall_data(stack(1, WIDTH, HEIGHT), friction, **({"loads": {}} | more)))


def column() -> drystone.Wall:
    """Seven tapered blocks of equal height and a cap, 5.95 high (the note; Temple of Apollo at Bassae)."""
    top, height = 5.95 - 0.21, 5.95

    def layer(name: str, low: float, high: float, below: float, above: float) -> dict[str, Any]:
        left, right = [[-below / 2, low], [below / 2, low]], [[above / 2, high], [-above / 2, high]]
        return {"id": name, "polygon": left + right}

    width = np.linspace(1.11, 0.9, 8)
    level = np.linspace(0.0, top, 8)
    ground = {"id": "ground", "fixed": True, "polygon": [[-10, -1], [10, -1], [10, 0], [-10, 0]]}
    drums = [layer(str(k + 1), *level[k : k + 2].tolist(), *width[k : k + 2].tolist()) for k in range(7)]
    blocks = [ground, *drums, layer("cap", top, height, 0.9, 0.9)]
    return drystone.build_wall({"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks})
