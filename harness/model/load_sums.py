"""Loads added and multiplied by factors."""

from __future__ import annotations

from harness.model.fields import Point
from harness.model.wall import Load


def times(load: Load, factor: float) -> Load:
    """A load multiplied by a factor."""
    if factor == 1.0:
        return load
    return load.model_copy(
        update={
            "body": [each.model_copy(update={"per_weight": _scaled(each.per_weight, factor)}) for each in load.body],
            "points": [each.model_copy(update={"force": _scaled(each.force, factor)}) for each in load.points],
            "pressures": [each.model_copy(update={"factor": factor * each.factor}) for each in load.pressures],
            "fills": [each.model_copy(update={"factor": factor * each.factor}) for each in load.fills],
        }
    )


def together(*loads: Load) -> Load:
    """All of some loads at once."""
    return Load(
        body=[each for load in loads for each in load.body],
        points=[each for load in loads for each in load.points],
        pressures=[each for load in loads for each in load.pressures],
        fills=[each for load in loads for each in load.fills],
    )


def _scaled(vector: Point, factor: float) -> Point:
    return factor * vector[0], factor * vector[1]
