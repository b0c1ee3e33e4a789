"""Walls whose joints have strength: what is given, plastic and residual values side by side."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.comparison import CaseResults
from harness.model.envelope import safe_size
from harness.model.method import Status
from harness.model.result import Result, plastic_and_residual_of, size_of
from reports.labels import numbers


def least_residual(item: CaseResults) -> tuple[float, Result] | None:
    """The least multiplier of a wall without the cohesion and tensile strength of its joints, and who found it.

    Of the main methods of families that neither give upper bounds nor measure; 0 if it falls. None of dry joints, and
    where no such answer was accepted; infinite where nothing makes the wall collapse.
    """
    found = [
        (size, result)
        for result in _reliable(item)
        if result.status is Status.OK
        and (pair := plastic_and_residual_of(result)) is not None
        and (size := size_of(pair[1])) is not None
    ]
    return min(found, key=lambda pair: pair[0], default=None)


def least_safe(item: CaseResults) -> tuple[float, Result] | None:
    """As `least_residual`, of the multipliers with the strength of the joints and without the lower one."""
    found = [(size, result) for result in _reliable(item) if (size := safe_size(result, residual=True)) is not None]
    return min(found, key=lambda pair: pair[0], default=None)


def _reliable(item: CaseResults) -> list[Result]:
    """Answers of the main methods that neither give upper bounds nor measure, but for rejected ones."""
    return [
        result
        for result in item.mains
        if not (result.traits.bounds_above or result.traits.brackets) and result.judge.accepted is not False
    ]


def strength_text(assembly: Assembly, unit: str) -> str:
    """The ranges of c A, T = f_t A and f_c A of the joints [force], and how many have any; empty if none."""
    parts = []
    if assembly.strong:
        cohesion, tension = assembly.constant[:, 2], 2.0 * assembly.constant[:, 0]
        joints = _number(~assembly.law.dry)
        brittle = f", of which brittle {_number(assembly.brittle)}" if assembly.breaks else ""
        parts.append(f"cohesion c A {_range(cohesion, unit)}, tension T {_range(tension, unit)}; {joints}{brittle}")
    if assembly.crushes:
        finite = np.isfinite(assembly.crushing)
        parts.append(f"crushing force f_c A {_range(assembly.crushing[finite], unit)}; {_number(finite)}")
    return "; ".join(parts)


def _number(joints: BoolArray) -> str:
    number = int(joints.sum())
    return "all interfaces" if number == len(joints) else f"{number} of {len(joints)} interfaces"


def _range(values: FloatArray, unit: str) -> str:
    least, greatest = (numbers.given(float(value), 4) for value in (values.min(), values.max()))
    return numbers.quantity(float(values.max()), unit, 4) if least == greatest else f"{least} to {greatest} {unit}"
