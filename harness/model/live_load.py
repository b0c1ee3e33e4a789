"""Which way a live load acts, and the wall under the opposite one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.fields import LARGEST
from harness.model.load_fields import BodyForce, Load
from harness.model.loads import times

_LEVEL = 1e-9
"""Part of the greatest live force below which a component is rounding."""


def _right_and_up(case: Case) -> FloatArray:
    """Live forces (n, 2) on the free blocks that carry any: to the right and upwards, as gravity has it."""
    gravity = np.array(case.wall.loads.gravity_per_weight, dtype=float)
    up = -gravity / np.hypot(*gravity) if gravity.any() else np.array([0.0, 1.0])
    forces = case.assembly.live[case.assembly.free, :2]
    found = np.column_stack([forces @ [up[1], -up[0]], forces @ up])
    found[abs(found) <= _LEVEL * abs(found).max(initial=0.0)] = 0.0
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
    turned = times(live, -1.0)
    loads = case.wall.loads.model_copy(update={"live": turned})
    file = case.file.model_copy(update={"references": []})
    wall = case.wall.model_copy(update={"loads": loads})
    origin = f"{Path(case.origin).name} with the live load reversed"
    return replace(case, file=file, wall=wall, origin=origin, argument="")


def with_live_load(case: Case, x: float, y: float) -> Case:
    """The case under a live load of (x, y) times the weight of every free block, in place of its own.

    It has no references and no certificate: what is known of the case holds for the live load of its file.

    Raises:
        InputError: (x, y) is zero, or larger than numbers of the format.
    """
    if x == 0.0 and y == 0.0:
        raise InputError(
            "the live load 0,0 is none", "Give a multiple of the weight, as 1,0 for to the right", "--live"
        )
    if not (abs(x) <= LARGEST and abs(y) <= LARGEST):
        raise InputError(f"the live load {x:g},{y:g} is no pair of numbers up to {LARGEST:g}", "Give one", "--live")
    loads = case.wall.loads.model_copy(update={"live": Load(body=[BodyForce(per_weight=(x, y))])})
    said = f"live load ({x:g}, {y:g}) times the weight"
    file = case.file.model_copy(update={"references": [], "kind": "multiplier", "title": f"{case.file.title}, {said}"})
    return replace(
        case,
        file=file,
        wall=case.wall.model_copy(update={"loads": loads}),
        origin=f"{Path(case.origin).name} with the {said}",
        argument="",
        notes=case.notes if case.wall.loads.live is None else (*case.notes, f"the {said} replaces that of the file"),
    )


def both_signs(case: Case) -> list[Case]:
    """The case and that with the opposite live load, as two load cases of one wall.

    Raises:
        InputError: its live load is not horizontal, or a pressure, which acts one way.
    """
    if not is_horizontal(case):
        raise InputError(
            "its live load is not horizontal, or a pressure: both signs are those of an earthquake",
            "Leave --both-signs out, or say --live 1,0",
            "loads.live",
            case.origin,
        )
    wall = case.wall_id or case.id
    opposite = reversed_live(case)
    ways = [direction_in_words(each) for each in (case, opposite)]
    if ways[0] == ways[1]:  # some of it to the right and some to the left
        ways = ["as given", "reversed"]
    ways = [", ".join(filter(None, (case.load_case, way))) for way in ways]
    return [
        replace(case, wall_id=wall, load_case=ways[0]),
        replace(opposite.called(f"{case.id}-reversed"), wall_id=wall, load_case=ways[1]),
    ]
