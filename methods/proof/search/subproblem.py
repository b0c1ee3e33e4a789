"""Collapse states, distinguished by contacts without slack or without a rate, and by normal forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np


@dataclass(frozen=True)
class AtContact:
    """Division of states at a contact 4 p + k: those without slack there, and those without a rate."""

    contact: int


@dataclass(frozen=True)
class AtNormalForce:
    """Division of states at a normal force of an interface: those with at most so much, and those with at least."""

    interface: int
    normal: float


Division = AtContact | AtNormalForce


@dataclass(frozen=True)
class Subproblem:
    """Collapse states of some contacts without slack and some without a rate, and some normal forces within limits.

    Attributes:
        tight: contacts 4 p + k whose slack is zero; still: whose rate is zero.
        normal: {interface: (least, greatest normal force)}, zero and inf where there is no such limit.
    """

    tight: frozenset[int] = frozenset()
    still: frozenset[int] = frozenset()
    normal: Mapping[int, tuple[float, float]] = field(default_factory=dict)

    def halves(self, at: Division) -> tuple[Subproblem, Subproblem]:
        """The two cases of a division, which hold every state of this one."""
        if isinstance(at, AtContact):
            return replace(self, tight=self.tight | {at.contact}), replace(self, still=self.still | {at.contact})
        least, greatest = self.normal.get(at.interface, (0.0, np.inf))
        sides = ((least, min(at.normal, greatest)), (max(at.normal, least), greatest))
        first, second = (replace(self, normal={**self.normal, at.interface: side}) for side in sides)
        return first, second

    def limits(self) -> list[tuple[int, int, float]]:
        """(interface, side, limit) of normal forces, sorted: side * (N - limit) >= 0."""
        found = []
        for p, (least, greatest) in sorted(self.normal.items()):
            found += [(p, 1, least)] if least > 0.0 else []
            found += [(p, -1, greatest)] if greatest < np.inf else []
        return found
