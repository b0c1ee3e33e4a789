"""Loads of a wall as generalised forces of its blocks, added and multiplied."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.bars import Bars
from harness.model.errors import InputError
from harness.model.fields import Point
from harness.model.fill import fill_forces
from harness.model.input_checks import thickness_of
from harness.model.laid import Laid
from harness.model.load_fields import BodyForce, Load, Loads
from harness.model.passive import passive_bars
from harness.model.pressure import outlines_of, pressure_forces
from harness.model.pressure_fields import Fill, Pressure
from harness.model.wall import Block, Wall

_MOST_PAIRS = 20_000_000
"""Pairs of a load and a block, or a face, that it may act on."""


def dead_load(loads: Loads, laid: Laid) -> FloatArray:
    """Gravity and what is dead besides it; a file of the time when a dead load stood for gravity is refused.

    Raises:
        InputError: the dead load presses every block down by a multiple of its weight and gravity is not spoken of.
    """
    gravity = BodyForce(per_weight=loads.gravity_per_weight)
    if loads.gravity is None and loads.dead.body:
        multiples = generalised_load(Load(body=loads.dead.body), replace(laid, weight=np.ones(len(laid.blocks))))
        if bool(np.all(multiples[~laid.fixed, 1] < 0.0)):
            raise InputError(
                "the dead load presses every block down by a multiple of its weight, and gravity acts besides",
                'Leave it out; or say in loads "gravity": false if it stands for gravity, or true if it does not',
                "loads.dead.body",
            )
    whole = Load(body=[gravity, *loads.dead.body], points=loads.dead.points)
    return generalised_load(whole, laid)


def generalised_load(load: Load, laid: Laid) -> FloatArray:
    """Generalised forces (n, 3) of a load whose names are known to be of the wall."""
    generalised = np.zeros((len(laid.blocks), 3))
    for body in load.body:
        chosen = laid.named(body)
        where = slice(None) if chosen is None else chosen
        generalised[where, :2] += laid.weight[where, None] * np.array(body.per_weight)
    if load.points:
        k = np.array([laid.index[point.block] for point in load.points])
        arm = np.array([point.at for point in load.points]) - laid.centroids[k]
        force = np.array([point.force for point in load.points])
        moment = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        np.add.at(generalised, k, np.column_stack([force, moment]))
    generalised[laid.fixed] = 0.0
    return generalised


def check_pairs(load: Load, blocks: Sequence[Block]) -> None:
    """Refuse loads that act on so many blocks each, or are sought among so many faces, that their sum takes minutes.

    Raises:
        InputError: how many there are.
    """
    members = Counter(group for block in blocks for group in block.groups)
    pairs = sum(
        members[body.group] if body.group is not None else len(blocks if body.blocks is None else body.blocks)
        for body in load.body
    )
    on_faces = len(load.pressures) + len(load.fills)
    faces = on_faces * sum(len(block.polygon) for block in blocks)
    for count, what, remedy in (
        (pairs, f"{len(load.body):,} body forces act on {pairs:,} blocks in all", "Add up those on the same blocks"),
        (
            faces,
            f"{on_faces:,} pressures and fills are sought among {faces:,} faces in all",
            "Give longer segments",
        ),
    ):
        if count > _MOST_PAIRS:
            raise InputError(f"{what}, and at most {_MOST_PAIRS:,} are summed up", remedy, "loads")


def with_pressures(wall: Wall, laid: Laid, assembly: Assembly) -> Assembly:
    """The assembly with the pressures and fills of the wall added to its loads.

    Raises:
        InputError: part of a pressure lies on no face, or on faces of two blocks; a fill loads none; or one of them
            names no free block.
    """
    thickness = [thickness_of(block, wall) for block in laid.blocks]
    outlines = outlines_of(laid.polygons)
    sums = {}
    for kind, load in (("dead", wall.loads.dead), ("live", wall.loads.live or Load())):
        total = getattr(assembly, kind).copy()
        for number, pressure in enumerate(load.pressures):
            place = f"loads.{kind}.pressures[{number}]"
            total += pressure_forces(
                pressure,
                _loaded_by(pressure, laid, place),
                outlines,
                laid.centroids,
                thickness,
                wall.units.unit_weight_factor,
                laid.size,
                place,
            )
        for number, fill in enumerate(load.fills):
            place = f"loads.{kind}.fills[{number}]"
            total += fill_forces(
                fill,
                _loaded_by(fill, laid, place),
                outlines,
                laid.centroids,
                thickness,
                wall.units.unit_weight_factor,
                place,
            )
        sums[kind] = total
    return replace(assembly, **sums)


def fill_as_bars(wall: Wall, laid: Laid, support_motion: FloatArray, number: int) -> Bars:
    """What a dead fill of the wall that resists bears, as bars from a fixed block, one that does not settle if any.

    Raises:
        InputError: it lies beside no face, or names no free block.
    """
    fill, place = wall.loads.dead.fills[number], f"loads.dead.fills[{number}]"
    assert fill.passive is not None, "only fill that resists is asked about"
    rests = laid.fixed & ~np.any(support_motion, axis=1)
    return passive_bars(
        fill,
        fill.passive,
        _loaded_by(fill, laid, place),
        laid,
        [thickness_of(block, wall) for block in laid.blocks],
        wall.units.unit_weight_factor,
        int(np.argmax(rests if rests.any() else laid.fixed)),
        f"fill {number + 1}",
        place,
    )


def _loaded_by(load: Pressure | Fill, laid: Laid, place: str) -> BoolArray:
    """(n,) blocks that a load on faces may act on.

    Raises:
        InputError: none.
    """
    named = laid.named(load)
    found = ~laid.fixed if named is None else ~laid.fixed & np.isin(np.arange(len(laid.blocks)), named)
    if not found.any():
        raise InputError("it names no free block", 'Name one, or leave "blocks" and "group" out', place)
    return found


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
