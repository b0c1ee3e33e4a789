"""Friction, dilatancy and strength of every joint of a wall: those of the most particular rule that holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from harness.model.friction_fields import Friction, FrictionRule, coefficient_of, is_brittle, stresses_of
from harness.model.wall import Block, Interface, Wall


@dataclass(frozen=True, eq=False)
class JointLaws:
    """(m, 6) of the joints: friction, dilatancy, cohesion, tensile, compressive strength [force/length^2], brittle."""

    given: FloatArray

    @property
    def friction(self) -> FloatArray:
        """(m,) coefficients of friction."""
        return np.ascontiguousarray(self.given[:, 0])

    @property
    def dilatancy(self) -> FloatArray:
        """(m,) coefficients by which a slip lifts."""
        return np.ascontiguousarray(self.given[:, 1])

    @property
    def strong(self) -> bool:
        """Whether any joint has cohesion, tensile or compressive strength."""
        return bool(self.given[:, 2:4].any() or np.isfinite(self.given[:, 4]).any())

    @property
    def brittle(self) -> BoolArray:
        """(m,) joints with a cohesion or tensile strength that they lose."""
        return np.asarray((self.given[:, 5] != 0.0) & self.given[:, 2:4].any(axis=1))

    def constant(self, area: FloatArray) -> FloatArray:
        """(m, 4) constant parts T/2, T/2, c A, c A of the yield slacks of joints with areas A (m,), T = f_t A."""
        cohesion, tension = area * self.given[:, 2], area * self.given[:, 3]
        return np.column_stack([0.5 * tension, 0.5 * tension, cohesion, cohesion])

    def crushing(self, area: FloatArray) -> FloatArray:
        """(m,) forces f_c A at which joints with areas A (m,) crush, infinite where they do not."""
        finite = np.isfinite(self.given[:, 4])
        return np.where(finite, area * np.where(finite, self.given[:, 4], 0.0), np.inf)


def laws_of_joints(
    wall: Wall, interfaces: list[Interface], joints: tuple[str, ...], blocks: list[Block], index: dict[str, int]
) -> JointLaws:
    """Friction, dilatancy and strength of the interfaces."""
    rules = _rules_by_selector(wall.friction.rules) if isinstance(wall.friction, Friction) else {}
    given = [
        _law(wall, interface, joint, blocks, index, rules) for interface, joint in zip(interfaces, joints, strict=True)
    ]
    return JointLaws(np.array(given, dtype=float).reshape(-1, 6))


def _rules_by_selector(rules: Sequence[FrictionRule]) -> dict[tuple[str, ...], FrictionRule]:
    """Rules by what they hold for: of several for the same, the last."""
    found: dict[tuple[str, ...], FrictionRule] = {}
    for rule in rules:
        if rule.between is not None:
            found["between", *sorted(rule.between)] = rule
        elif rule.joint is not None:
            found["joint", rule.joint] = rule
        elif rule.materials is not None:
            found["materials", *sorted(rule.materials)] = rule
    return found


def _law(
    wall: Wall,
    interface: Interface,
    joint: str,
    blocks: list[Block],
    index: dict[str, int],
    rules: dict[tuple[str, ...], FrictionRule],
) -> tuple[float, float, float, float, float, bool]:
    """Friction, dilatancy, strengths, whether these are brittle: all from the most particular that holds."""
    if interface.friction is not None or interface.friction_angle is not None:
        friction = coefficient_of(interface.friction, interface.friction_angle)
        return friction, interface.dilatancy or 0.0, *stresses_of(interface), is_brittle(interface)
    if not isinstance(wall.friction, Friction):
        return float(coefficient_of(wall.friction, wall.friction_angle)), 0.0, *stresses_of(wall), is_brittle(wall)
    materials = sorted(blocks[index[block_id]].material for block_id in interface.between)
    for selector in (("between", *sorted(interface.between)), ("joint", joint), ("materials", *materials)):
        if selector in rules:
            rule = rules[selector]
            return rule.coefficient, rule.dilatancy or 0.0, *stresses_of(rule), is_brittle(rule)
    general = wall.friction
    return float(general.coefficient), general.dilatancy or 0.0, *stresses_of(general), is_brittle(general)
