"""What is given of a wall, in a few words each: for the head of its section, its figures and its appendix."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly
from harness.model.case import Case
from harness.model.interfaces import limits_of
from harness.model.live_load import direction_in_words
from harness.model.method import Finding
from harness.model.result import Result
from harness.model.result_texts import bound_in_words
from harness.model.wall import Detection
from reports.geometry import shapes
from reports.labels import labels, numbers


def friction_text(assembly: Assembly) -> str:
    """The coefficients of friction: all of them where they are few, else their range."""
    frictions = sorted({round(float(mu), 9) for mu in assembly.friction})
    if len(frictions) <= 4:
        return ", ".join(numbers.given(mu, 4) for mu in frictions)
    return f"{numbers.given(frictions[0], 4)} to {numbers.given(frictions[-1], 4)}"


def given_in_words(case: Case) -> str:
    """Friction and live load of a wall, for the head of a drawing."""
    way = direction_in_words(case)
    return f"tan φ = {friction_text(case.assembly)}, {f'live load {way}' if way else 'no live load'}"


def wall_summary(case: Case) -> list[tuple[str, str]]:
    """Names and values: blocks, interfaces, friction, size, weight, live load, units, gravity where it is unusual."""
    assembly, units = case.assembly, case.wall.units
    weight = float(assembly.weight[assembly.free].sum())
    extent = shapes.extent(assembly)
    found = [
        ("Blocks", f"{assembly.n_free} free, {int(assembly.fixed.sum())} fixed"),
        ("Supports", _few([assembly.block_ids[k] for k in np.flatnonzero(assembly.fixed)])),
        ("Interfaces", str(assembly.n_interfaces)),
        ("Contact found within", _detection_text(case)),
        ("Friction tan φ", friction_text(assembly)),
        ("Size", f"{numbers.given(extent.width, 4)} × {numbers.given(extent.height, 4)} {units.length}"),
        ("Weight of free blocks", numbers.quantity(weight, units.force, 4)),
        ("Live load", direction_in_words(case) or "none: only stability is analysed"),
        ("Units", case.wall.units_sentence),
    ]
    if case.wall.loads.gravity_per_weight != (0.0, -1.0):
        x, y = case.wall.loads.gravity_per_weight
        found.append(("Gravity", f"({numbers.given(x, 4)}, {numbers.given(y, 4)}) times the weight"))
    return found


def _detection_text(case: Case) -> str:
    """The tolerances within which two faces were taken to touch."""
    joints, unit = case.wall.interfaces, case.wall.units.length
    if not isinstance(joints, Detection):
        return "none: the file lists the joints"
    found = limits_of(joints, case.assembly.length_scale)
    gap, overlap = (f"{numbers.given(value, 3)} {unit}" for value in (found.gap, found.overlap))
    return f"gap {gap}, overlap {overlap}, angle {numbers.given(float(np.degrees(found.angle)), 3)}°"


def _few(names: list[str]) -> str:
    return ", ".join(names) if len(names) <= 6 else f"{', '.join(names[:5])} and {len(names) - 5} more"


def value_in_words(result: Result) -> str:
    """The value as the method vouches for it: a number, or its bracket where it knows no more than that."""
    if result.finding is not Finding.COLLAPSES or result.multiplier is None:
        return labels.FINDING[result.finding]
    if result.flow == "approximate" and result.bracket is not None:
        return numbers.interval(result.bracket) + result.width_in_words
    return numbers.multiplier(result.multiplier) + bound_in_words(result)
