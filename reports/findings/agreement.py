"""How far two methods agree on one wall: multiplier, velocity fields, interface states, blocks that move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly, FloatArray, polygon_area
from harness.model.comparison import CaseResults
from harness.model.method import Status
from harness.model.ranges import Range, differences, range_of
from harness.model.result import Result, normalised_mechanism, relative_velocities
from reports.geometry import shapes
from reports.memo import memo

_SAME_JOINT, _SAME_MEASURED = 1e-3, 0.05
"""Relative velocity, of the fastest vertex, by which a joint moves in two mechanisms that are called the same: blocks
at rest move slower than the first (`shapes.moving`), and measured velocity fields scatter by as much as the second,
which a drawing hardly shows."""


@dataclass(frozen=True)
class Agreement:
    """Two methods on one wall.

    Attributes:
        first, second: names of the methods.
        difference: multiplier of the second over that of the first, less one; of a measured bracket the nearest end,
            and 0 where the other lies within.
        within: whether one of the two is a measured bracket and the other lies within it.
        cosine: of the two velocity fields, 1 where they are the same motion.
        other_joints: how many joints move otherwise, as `other_joints` counts them.
        same_state: share of interfaces in the same state.
        only_first, only_second: ids of blocks that move in one and not in the other.
    """

    first: str
    second: str
    difference: float | None
    cosine: float | None
    other_joints: int | None
    same_state: float | None
    only_first: list[str]
    only_second: list[str]
    within: bool = False

    @property
    def same_mechanism(self) -> bool:
        """Whether every joint moves alike in both; not of fields of which one is at rest or is not there."""
        return self.other_joints == 0


def mains(item: CaseResults) -> list[Result]:
    """The main method of every family that gave an answer, in the paper's order."""
    return [result for result in item.mains if result.status is Status.OK]


def spread(item: CaseResults) -> Range | None:
    """How far the multipliers of the families lie from each other, as a share of the lowest: least and most possible.

    None where fewer than two families give a collapse multiplier that the judge does not reject.
    """
    known = [
        ends
        for r in mains(item)
        if r.finding.has_multiplier and r.judge.accepted is not False and (ends := range_of(r)) is not None
    ]
    return differences(known) if len(known) > 1 else None


def _difference(first: Result, second: Result) -> tuple[float | None, bool]:
    """The second multiplier over the first, less one, between the nearest ends; and whether a bracket holds both."""
    one, other = range_of(first), range_of(second)
    if one is None or other is None or min(*one, *other) <= 0.0:
        return None, False
    if other[0] <= one[1] and one[0] <= other[1]:
        return 0.0, one[0] < one[1] or other[0] < other[1]
    return (other[0] / one[1] if other[0] > one[1] else other[1] / one[0]) - 1.0, False


@memo
def measure_of(assembly: Assembly) -> FloatArray:
    """(n, 3) weights of (ux, uy, omega) in the inner product of areas; zero on fixed blocks.

    The integral of v1.v2 over a block is A (u1.u2) + J omega1 omega2, with the polar moment J about its centroid.
    """
    measure = np.zeros((assembly.n_blocks, 3))
    for block in assembly.free:
        polygon = assembly.polygons[block]
        measure[block, :2] = polygon_area(polygon)
        measure[block, 2] = _polar_moment(polygon, assembly.centroid[block])
    return measure


def velocity_cosine(measure: FloatArray, first: FloatArray, second: FloatArray) -> float | None:
    """Cosine of two velocity fields (n, 3) in the inner product of `measure_of`; None if one of them is at rest."""
    u, v = np.asarray(first, float), np.asarray(second, float)
    norm = float((measure * u * u).sum()) * float((measure * v * v).sum())
    if norm <= 0.0:
        return None
    return float((measure * u * v).sum() / np.sqrt(norm))


def other_joints(assembly: Assembly, first: Result, second: Result) -> int | None:
    """How many joints open or slide otherwise in the mechanism of a second result, scaled to fit that of the first.

    A cosine does not show whether two mechanisms are the same: one block of thousands that moves otherwise leaves it
    at 1, and what measured velocity fields scatter lowers it. None where one of them is at rest or has no mechanism.
    """
    if first.mechanism is None or second.mechanism is None:
        return None
    motions = []
    for result in (first, second):
        opening, slip = relative_velocities(
            assembly, normalised_mechanism(assembly, np.asarray(result.mechanism, dtype=float))
        )
        motions.append(np.column_stack([opening, slip]))
    own, other = motions
    square = float((other * other).sum())
    if not square or not own.any():
        return None
    scale = max(float((own * other).sum()) / square, 0.0)
    measured = "approximate" in (first.flow, second.flow)
    apart = abs(own - scale * other).max(axis=1)
    return int((apart > (_SAME_MEASURED if measured else _SAME_JOINT)).sum())


def _polar_moment(polygon: FloatArray, centroid: FloatArray) -> float:
    x, y = (polygon - centroid).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    return float(abs((cross * (x * x + x * x1 + x1 * x1 + y * y + y * y1 + y1 * y1)).sum()) / 12.0)


def agreement(assembly: Assembly, first: Result, second: Result, measure: FloatArray | None = None) -> Agreement:
    """How far two results agree; None where one of them lacks what is compared."""
    measure = measure_of(assembly) if measure is None else measure
    difference, within = _difference(first, second)
    cosine, same = None, None
    only_first: list[str] = []
    only_second: list[str] = []
    if first.mechanism is not None and second.mechanism is not None:
        u, v = np.asarray(first.mechanism, float), np.asarray(second.mechanism, float)
        cosine = velocity_cosine(measure, u, v)
        moves, moves_too = shapes.moving(assembly, u), shapes.moving(assembly, v)
        only_first = [assembly.block_ids[i] for i in np.flatnonzero(moves & ~moves_too)]
        only_second = [assembly.block_ids[i] for i in np.flatnonzero(moves_too & ~moves)]
    if first.states and second.states and "approximate" not in (first.flow, second.flow):
        same = float(np.mean([a == b for a, b in zip(first.states, second.states, strict=True)]))
    return Agreement(
        first.method,
        second.method,
        difference,
        cosine,
        other_joints(assembly, first, second),
        same,
        only_first,
        only_second,
        within,
    )
