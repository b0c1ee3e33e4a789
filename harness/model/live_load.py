"""Which way a live load acts, and the wall under the opposite one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.case import Case

LEVEL = 1e-9
"""Part of the greatest live force below which a component is rounding."""


def _right_and_up(case: Case) -> FloatArray:
    """Live forces (n, 2) on the free blocks that carry any: to the right and upwards, as gravity has it."""
    gravity = np.array(case.wall.loads.gravity_per_weight, dtype=float)
    up = -gravity / np.hypot(*gravity) if gravity.any() else np.array([0.0, 1.0])
    forces = case.assembly.live[case.assembly.free, :2]
    found = np.column_stack([forces @ [up[1], -up[0]], forces @ up])
    found[abs(found) <= LEVEL * abs(found).max(initial=0.0)] = 0.0
    return np.asarray(found[found.any(axis=1)])


def is_horizontal(case: Case) -> bool:
    """Whether there is a live load and all of it is horizontal, as that of an earthquake; a pressure acts one way."""
    if case.wall.loads.live is not None and case.wall.loads.live.pressures:
        return False
    forces = _right_and_up(case)
    return len(forces) > 0 and not forces[:, 1].any()


def direction_in_words(case: Case) -> str:
    """Which way the live load acts: "to the right", "downwards", at an angle, or several; empty without one."""
    forces = _right_and_up(case)
    if not len(forces):
        return ""
    ways = forces / np.hypot(forces[:, 0], forces[:, 1])[:, None]
    if abs(ways - ways[0]).max() > 1e-6:
        return "in several directions"
    x, y = ways[0]
    if min(abs(x), abs(y)) > 1e-6:
        return f"at {np.degrees(np.arctan2(y, x)):.4g}° from the right, counter-clockwise"
    return ("to the right" if x > 0.0 else "to the left") if abs(x) > abs(y) else "upwards" if y > 0.0 else "downwards"


def reversed_live(case: Case) -> Case:
    """The case with the opposite live load: another wall, of which no reference is known."""
    live = case.wall.loads.live
    assert live is not None
    turned = live.model_copy(
        update={
            "body": [each.model_copy(update={"per_weight": _minus(each.per_weight)}) for each in live.body],
            "points": [each.model_copy(update={"force": _minus(each.force)}) for each in live.points],
            "pressures": [each.model_copy(update={"factor": -each.factor}) for each in live.pressures],
        }
    )
    loads = case.wall.loads.model_copy(update={"live": turned})
    file = case.file.model_copy(update={"references": []})
    wall = case.wall.model_copy(update={"loads": loads})
    return replace(case, file=file, wall=wall, origin=f"{Path(case.origin).name} with the live load reversed")


def _minus(vector: tuple[float, float]) -> tuple[float, float]:
    return -vector[0], -vector[1]
