"""Checks of input that can be computed with and was hardly meant: an angle as friction, units, vanishing loads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import islice

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import MOST_NAMED, Hints, first_few
from harness.model.friction_fields import Friction
from harness.model.load_fields import Load
from harness.model.pressure_fields import Earth, Fill, Passive, Water
from harness.model.units import KILONEWTONS, METRES, unit_weight_in_kn_m3
from harness.model.wall import Block, Wall

_LONGEST = 200
"""Letters of a name that a sentence repeats."""
_GREATEST_FRICTION = 2.0
"""Coefficient beyond which an angle in degrees is likelier: stone on stone has .4 to .8, 2 is a face of 63 degrees."""
_NO_SLIDING = 100.0
"""Coefficient from which on a file says in so many words that no joint slides, as Heyman supposed."""
_SMALLEST_ANGLE = 2.0
"""Angle [degrees] below which a coefficient is likelier: .65 degrees is .011, and wet ice has .03."""
_UNIT_WEIGHTS = (5.0, 35.0)
"""Unit weights of masonry [kN/m3]: pumice and adobe have 6 and more, basalt 30."""
_LOAD_UNIT_WEIGHTS = (0.1, 35.0)
"""Unit weights of water, earth and fill [kN/m3]: light fill of foam has 0.2."""
_STRENGTHS = {"cohesion": (2, 0.0, 1e4), "tensile strength": (3, 0.0, 1e4), "compressive strength": (4, 100.0, 5e5)}
"""Column of the joint laws, least and greatest value [kN/m2]: glue of resin bears 10 N/mm2, earth crushes under 0.3 and
granite under 300. Little cohesion or tension is that of poor mortar."""
_N_PER_MM2 = 1000.0
"""A newton on a square millimetre, in which strengths are tabled [kN/m2]."""
_GREATEST_GRAVITY = 5.0
"""Multiple of the weight beyond which an acceleration in m/s2 is likelier: g is 9.8, factors of dead load below 2."""
SIZES = (0.05, 250.0)
"""Extent of a wall [m]: a model on a tilting table has 0.1 and more, the highest masonry stands 170 high."""
_THICKNESSES = (0.005, 250.0)
"""Thickness of a block out of plane [m]: plates of a model have 0.01, a long dam is as thick as the highest is wide."""
_SMALL_BLOCK = 1e-3
"""Size of a block in extents of the wall below which it is worth a warning."""
_STRONGEST_BAR = 1e5
"""Yield force of a tie or prop in dead loads beyond which the judge cannot tell its rounding from work."""
_SMALL_LOAD = 1e-6
"""Share of the live load in the dead load, or the other way round, below which one of them is hardly meant."""


def thickness_of(block: Block, wall: Wall) -> float:
    """Thickness of a block out of plane [length]: its own, the wall's, or one metre."""
    if block.thickness is not None:
        return block.thickness
    return wall.thickness if wall.thickness is not None else wall.units.metre


def input_warnings(wall: Wall, blocks: list[Block], assembly: Assembly, laws: FloatArray) -> list[str]:
    """Sentences about frictions, strengths, unit weights, sizes and loads of a wall that were hardly meant.

    Args:
        wall, blocks, assembly: the wall; laws: (m, 6) what `JointLaws` has of its joints.
    """
    return [
        *_friction_slips(wall, assembly),
        *_strength_slips(wall, laws),
        *_rule_slips(wall, blocks, assembly),
        *_unit_weight_slips(wall, blocks),
        *_size_slips(wall, blocks, assembly),
        *_load_slips(assembly),
        *_gravity_slips(wall),
        *_bar_slips(assembly),
        *_field_slips(wall),
    ]


def _friction_slips(wall: Wall, assembly: Assembly) -> list[str]:
    sentences = []
    odd = (assembly.friction > _GREATEST_FRICTION) & (assembly.friction < _NO_SLIDING)
    if odd.any():
        value = float(assembly.friction[odd][0])
        meant = ""
        if value < 90.0:
            tangent = f"{math.tan(math.radians(value)):.3f}".lstrip("0")
            meant = f': an angle? {value:g} degrees is {tangent}; write "friction_angle": {value:g}'
        sentences.append(f"friction is {value:g} in {odd.sum()} of {assembly.n_interfaces} interfaces{meant}")
    angles = [wall.friction_angle]
    if isinstance(wall.friction, Friction):
        angles += [wall.friction.friction_angle, *(rule.friction_angle for rule in wall.friction.rules)]
    if isinstance(wall.interfaces, list):
        angles += [interface.friction_angle for interface in wall.interfaces]
    small = [angle for angle in angles if angle is not None and 0.0 < angle < _SMALLEST_ANGLE]
    if small:
        sentences.append(
            f"friction_angle is {small[0]:g} degrees, a coefficient of {math.tan(math.radians(small[0])):.2g}: a "
            f'coefficient? Write "friction": {small[0]:g}'
        )
    return sentences


def _strength_slips(wall: Wall, laws: FloatArray) -> list[str]:
    """Strengths of joints that no masonry has: mostly they are in N/mm2."""
    if wall.units.dimensionless:
        return []
    name = f"{wall.units.force}/{wall.units.length}2"
    per_unit = KILONEWTONS[wall.units.force] / METRES[wall.units.length] ** 2
    sentences = []
    for what, (column, least, most) in _STRENGTHS.items():
        given = laws[:, column]
        odd = np.isfinite(given) & (given > 0.0) & ((given * per_unit < least) | (given * per_unit > most))
        if not odd.any():
            continue
        value = float(given[odd][0])
        range_ = f"at most {most / per_unit:g}" if least == 0.0 else f"{least / per_unit:g} to {most / per_unit:g}"
        remedy = "the unit?"
        if least <= value * _N_PER_MM2 <= most:
            remedy = f"if it is meant in N/mm2, write {value * _N_PER_MM2 / per_unit:g}"
        sentences.append(
            f"the {what} is {value:g} {name} in {odd.sum()} of {len(odd)} interfaces, and masonry has {range_} {name}: "
            f"{remedy}"
        )
    return sentences


def plastic_strength(assembly: Assembly) -> tuple[str, ...]:
    """The warning of questions whose answers count strength that mortar loses; none where joints have no such."""
    plastic = int((assembly.constant.any(axis=1) & ~assembly.brittle).sum())
    if not plastic:
        return ()
    return (
        f"cohesion or tensile strength of {plastic} of {assembly.n_interfaces} joints counts as plastic: never lost, "
        'however far a joint opens or slips. Mortar is brittle: ask with "after": "residual", or without both, too, '
        "and rely on the less favourable answer",
    )


def _rule_slips(wall: Wall, blocks: list[Block], assembly: Assembly) -> list[str]:
    """Rules of friction that no interface meets."""
    if not isinstance(wall.friction, Friction):
        return []
    pairs = {
        frozenset((blocks[a].material, blocks[b].material))
        for a, b in zip(assembly.block_a.tolist(), assembly.block_b.tolist(), strict=True)
    }
    touching = {
        frozenset((assembly.block_ids[a], assembly.block_ids[b]))
        for a, b in zip(assembly.block_a.tolist(), assembly.block_b.tolist(), strict=True)
    }
    joints = set(assembly.joint)
    unknown, idle = _unknown_in_rules(wall.friction, wall, blocks), []
    for number, rule in enumerate(wall.friction.rules):
        met = (
            (rule.joint is not None and rule.joint in joints)
            or (rule.materials is not None and frozenset(rule.materials) in pairs)
            or (rule.between is not None and frozenset(rule.between) in touching)
        )
        if not met and number not in unknown:
            idle.append(f"friction.rules[{number}]")
    doubts = [f"{first_few(idle, 5)}: no interface is of this kind, so the rule does nothing"] if idle else []
    return [*unknown_in_rules(wall, blocks), *doubts]


def unknown_in_rules(wall: Wall, blocks: Sequence[Block]) -> list[str]:
    """Sentences about friction of materials that no block is of, and of joints not there; the first, and a count.

    "bed" and "head" are names of every wall, and a rule for them may stand where there is none.
    """
    if not isinstance(wall.friction, Friction):
        return []
    unknown = _unknown_in_rules(wall.friction, wall, blocks)
    hints = {kind: Hints(known) for kind, known in _names_of_rules(wall, blocks).items()}
    sentences = []
    for number, (kind, name) in islice(unknown.items(), MOST_NAMED):
        hint = hints[kind].of(name) or f"There are: {hints[kind].there(8)}"
        what = "no block is of the material" if kind == "material" else "no joint has the name"
        sentences.append(f'friction.rules[{number}]: {what} "{name[:_LONGEST]}", so the rule does nothing. {hint}')
    more = len(unknown) - len(sentences)
    return sentences + [f"friction.rules: {more:,} more do nothing for the same reason"] * (more > 0)


def _names_of_rules(wall: Wall, blocks: Sequence[Block]) -> dict[str, set[str]]:
    """The names of materials and of joints that a rule may give."""
    given = wall.interfaces if isinstance(wall.interfaces, list) else wall.interfaces.given
    named = {"bed", "head"} | {interface.joint for interface in given if interface.joint is not None}
    return {"material": {block.material for block in blocks}, "joint": named}


def _unknown_in_rules(friction: Friction, wall: Wall, blocks: Sequence[Block]) -> dict[int, tuple[str, str]]:
    """By number of the rule, "material" or "joint" and the name that is not there."""
    known = _names_of_rules(wall, blocks)
    unknown = {}
    for number, rule in enumerate(friction.rules):
        names = [("material", name) for name in rule.materials or ()]
        names += [("joint", rule.joint)] if rule.joint is not None else []
        for kind, name in names:
            if name not in known[kind]:
                unknown[number] = (kind, name)
    return unknown


def _unit_weight_slips(wall: Wall, blocks: list[Block]) -> list[str]:
    units = wall.units
    if units.dimensionless:
        return []
    name = units.unit_weight_name
    per_unit = unit_weight_in_kn_m3(name)
    odd: dict[float, str] = {}
    for block in blocks:
        given = block.unit_weight if block.unit_weight is not None else wall.unit_weight
        if given is None or block.weight is not None or block.fixed or given == 0.0:
            continue
        if not _UNIT_WEIGHTS[0] <= given * per_unit <= _UNIT_WEIGHTS[1]:
            odd.setdefault(given, block.id)
    if not odd:
        return []
    value, block_id = next(iter(odd.items()))
    converted = f"{value:g} {name}" + (f", which is {value * per_unit:.4g} kN/m3" if name != "kN/m3" else "")
    remedy = "the unit?"
    if units.unit_weight is None and _UNIT_WEIGHTS[0] <= value <= _UNIT_WEIGHTS[1]:
        remedy = 'if it is meant per cubic metre, add "unit_weight": "kN/m3" to units'
    elif _UNIT_WEIGHTS[0] <= value * KILONEWTONS["kg"] <= _UNIT_WEIGHTS[1]:
        remedy = 'if it is a density, add "unit_weight": "kg/m3" to units'
    elif value == 1.0 and not wall.units_declared:
        remedy = 'if the wall has no units, say "units": {"length": "1", "force": "1"}'
    return [
        f'the unit weight of block "{block_id}" is {converted}, and masonry has {_UNIT_WEIGHTS[0]:g} to '
        f"{_UNIT_WEIGHTS[1]:g} kN/m3: {remedy}"
    ]


def _size_slips(wall: Wall, blocks: list[Block], assembly: Assembly) -> list[str]:
    free = [polygon for polygon, still in zip(assembly.polygons, assembly.fixed, strict=True) if not still]
    points = np.concatenate(free)
    extent = float(np.max(np.ptp(points, axis=0)))
    sentences = []
    if not wall.units.dimensionless:
        metres = extent * METRES[wall.units.length]
        if not SIZES[0] <= metres <= SIZES[1]:
            shown = f"{metres / 1000.0:.3g} km" if metres > 1000.0 else f"{metres:.3g} m"
            given = f"{extent:g} {wall.units.length}" + ("" if wall.units_declared else ", no units being declared")
            sentences.append(f"the wall is {shown} across ({given}): the unit of length?")
        sentences += _thickness_slips(wall, blocks)
    begins = np.cumsum([0, *(len(polygon) for polygon in free[:-1])])
    sizes = (np.maximum.reduceat(points, begins) - np.minimum.reduceat(points, begins)).max(axis=1)
    small = np.flatnonzero(sizes < _SMALL_BLOCK * extent)
    if len(small):
        names = [name for name, still in zip(assembly.block_ids, assembly.fixed, strict=True) if not still]
        sentences.append(
            f"{len(small)} block(s) are a thousand times smaller than the wall, or smaller still: a coordinate? "
            f"{first_few([names[k] for k in small.tolist()], 5)}"
        )
    return sentences


def _thickness_slips(wall: Wall, blocks: list[Block]) -> list[str]:
    """Sentences about free blocks that are hardly as thick as they are said to be."""
    metre = METRES[wall.units.length]
    thickness = {block.id: thickness_of(block, wall) for block in blocks if not block.fixed}
    odd = [name for name, given in thickness.items() if not _THICKNESSES[0] <= given * metre <= _THICKNESSES[1]]
    if not odd:
        return []
    given, named = f"{thickness[odd[0]]:g} {wall.units.length}", first_few([f'"{name}"' for name in odd], 1)
    return [f"block {named}: the thickness is {given}: the unit of length?"]


def _load_slips(assembly: Assembly) -> list[str]:
    dead = float(np.abs(assembly.dead[:, :2]).sum())
    live = float(np.abs(assembly.live[:, :2]).sum())
    if 0.0 < live < _SMALL_LOAD * dead:
        return [
            f"the live load is {live / dead:.1g} of the dead load, and a multiplier as large as the inverse: units, or "
            "a weight too large?"
        ]
    if 0.0 < dead < _SMALL_LOAD * live:
        return [f"the dead load is {dead / live:.1g} of the live load: units, or a weight too small?"]
    return []


def _gravity_slips(wall: Wall) -> list[str]:
    multiple = math.hypot(*wall.loads.gravity_per_weight)
    if multiple <= _GREATEST_GRAVITY:
        return []
    return [f"loads.gravity is {multiple:.3g} times the weight of every block: an acceleration? The weight is [0, -1]"]


def _bar_slips(assembly: Assembly) -> list[str]:
    """Sentences about bars that are hardly meant to yield."""
    bars = assembly.bars
    borne = np.maximum(bars.greatest, -bars.least) / assembly.force_scale
    strong = np.flatnonzero(borne > _STRONGEST_BAR).tolist()
    if not strong:
        return []
    return [
        f"{first_few([bars.names[k] for k in strong], 5)}: bears up to {borne.max():.2g} times the dead load, and "
        f"methods may find no answer beyond {_STRONGEST_BAR:g} times: give what it can bear"
    ]


def _field_slips(wall: Wall) -> list[str]:
    """Sentences about levels, unit weights and friction angles of water, earth and fill."""
    found: list[tuple[str, Water | Earth | Fill | Passive]] = []
    sentences = []
    for kind, load in (("dead", wall.loads.dead), ("live", wall.loads.live or Load())):
        for number, pressure in enumerate(load.pressures):
            place = f"loads.{kind}.pressures[{number}]"
            beside = pressure.water or pressure.earth
            if beside is not None:
                found.append((place, beside))
                if min(pressure.start[1], pressure.end[1]) >= beside.level:
                    sentences.append(f"{place} lies nowhere below its level {beside.level:g}, so it does nothing")
        for number, fill in enumerate(load.fills):
            place = f"loads.{kind}.fills[{number}]"
            found += [(place, field) for field in (fill, fill.passive) if field is not None]
    name = wall.units.unit_weight_name
    for place, field in found:
        weight = 0.0 if isinstance(field, Passive) else field.unit_weight
        least, most = _LOAD_UNIT_WEIGHTS
        if weight and not wall.units.dimensionless and not least <= weight * unit_weight_in_kn_m3(name) <= most:
            shown = f"{weight:g} {name}"
            sentences.append(f"{place} has a unit weight of {shown}, and not {least:g} to {most:g} kN/m3: the unit?")
        angle = None if isinstance(field, Water | Fill) else field.friction_angle
        if angle and angle < _SMALLEST_ANGLE:
            sentences.append(
                f"{place} has a friction_angle of {angle:g} degrees: an angle in radians, or a coefficient?"
            )
    return sentences[:MOST_NAMED]
