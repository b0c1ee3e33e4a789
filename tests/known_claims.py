"""What an answer about a wall of known truth claims: its state, its values, and loads to cook it with."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer, Finding
from tests.known_walls import Item

Rng = np.random.Generator
TOLERANCE = 1e-9
SLACK = 1e-6
"""Relative; a thousand times the tolerance, since a state within it may be that of a wall as different."""


def base(rng: Rng, item: Item) -> Answer:
    """A right answer to begin with, with forces and a mechanism, if need be of nothing."""
    wall = item.wall
    answer = item.states[rng.integers(len(item.states))]
    forces = answer.forces if answer.forces is not None else np.zeros((wall.n_interfaces, 3))
    mechanism = answer.mechanism if answer.mechanism is not None else rng.normal(size=(wall.n_blocks, 3))
    flow = str(rng.choice(["non-associated", "associated"]))
    return replace(answer, forces=np.array(forces), mechanism=np.where(wall.fixed[:, None], 0.0, mechanism), flow=flow)


def claim(answer: Answer, finding: Finding, multiplier: float | None = None, **more: Any) -> Answer:
    """An answer made to say something else."""
    changed: dict[str, Any] = {"finding": finding, "multiplier": multiplier, "forces_multiplier": None, "bracket": None}
    return replace(answer, **(changed | more))


def collapse(rng: Rng, item: Item) -> float:
    """A multiplier that no state has, near or far."""
    true = item.greatest if item.greatest is not None and np.isfinite(item.greatest) else 0.5
    return float(true * (1.0 + rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-5.0, 0.5)))


def magnitude(rng: Rng, low: float, high: float) -> float:
    return float(10.0 ** rng.uniform(low, high))


def loads(wall: Assembly, multiplier: float) -> FloatArray:
    return wall.dead + multiplier * wall.live


def any_claim(rng: Rng, item: Item, answer: Answer, multiplier: float) -> Answer:
    """A claim that rests on forces: a collapse, a bracket, or that it stands."""
    match rng.integers(3):
        case 0:
            return claim(answer, Finding.COLLAPSES, multiplier)
        case 1:
            width = magnitude(rng, -9.0, 0.0)
            bracket = (multiplier, multiplier + width)
            return claim(answer, Finding.COLLAPSES, multiplier, flow="approximate", bracket=bracket)
        case _:
            return claim(answer, Finding.STANDS)
