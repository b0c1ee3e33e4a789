"""What proves that a wall moves: the one object from which every distinct-element method takes that claim.

A wall that has not come to rest may still do so: it creeps, relaxes slowly, or its contacts chatter. None of that is a
fall. A measured field of velocities shows one in either of three ways.

*Virtual work*: the loads do work on the field, and also on it once it is made admissible for dilatant flow. Then no
forces within yield bear them (Farkas' lemma; D. C. Drucker, Coulomb friction, plasticity and limit loads, 1954),
whatever the history, and the multiplier of the loads lies above that of the mechanism.

*Power*: the motion goes on, and the loads give it more than friction at yield takes under the normal forces that were
measured with it, and more than contacts that part or penetrate under force account for. A wall that slides may move
below the associated maximum, where virtual work shows nothing; what is left out of balance then only accelerates it.

*Travel*: a block has moved by a stated share of a block's size, along which the loads did positive work.

Everything else is undecided, and never the upper end of a bracket.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from methods.numerics.statics import admissible_forces, dilatant_mechanism, greatest_multiplier


class MotionProof(StrEnum):
    """What shows that a wall moves."""

    VIRTUAL_WORK = "virtual work"
    POWER = "power"
    TRAVEL = "travel"


@dataclass(frozen=True)
class Trend:
    """When a motion counts as one that goes on.

    Attributes:
        alike: least cosine between the mean fields of two quarters of a hold; chatter changes the field altogether.
        left: least share of the speed that remains when what slows it down is followed to its end. A wall on its way to
            rest keeps nothing, one on its way to a steady motion all that it then has: half parts the two.
        steady: change of the speed from one check, or quarter, to the next below which rounding decides its sign.
        checks: checks in a row with no more change than that that make a field worth asking about.
        followed: part of the work of an order after which an even decay is no longer followed: long thin arches come to
            rest within it; a wall that creeps would use all of it.
    """

    alike: float = 0.9
    left: float = 0.5
    steady: float = 3e-3
    checks: int = 4
    followed: float = 0.02

    def goes_on(self, fields: Sequence[FloatArray]) -> bool:
        """Whether the motion of the last of three fields (each (n, 3), means over equal times) will go on.

        Speeds along the last field that approach a limit geometrically give it by their differences (Aitken).
        """
        first, second, last = fields
        size = float(np.sum(last * last))
        if not size > 0.0:
            return False
        along = float(np.sum(second * last))
        if along < self.alike * float(np.linalg.norm(second)) * np.sqrt(size):
            return False
        loss = along / size - 1.0
        before = float(np.sum(first * last)) / size - along / size
        if loss <= 0.0:
            return True
        if before <= loss:
            return loss <= self.steady
        ratio = loss / before
        return 1.0 - loss * ratio / (1.0 - ratio) >= self.left


@dataclass(frozen=True, eq=False)
class HeldMotion:
    """A motion that was shown.

    Attributes:
        proof: what shows it.
        field: (n, 3) the measured velocities or displacements [length, length, radian].
    """

    proof: MotionProof
    field: FloatArray


@dataclass(frozen=True, eq=False)
class StaticLimit:
    """The multipliers that statics bears on a wall: there no dilatant mechanism gains work (Farkas' lemma).

    Contact forces within yield form a convex set, so what bears the dead load and the greatest multiplier bears every
    multiplier between them. Both programmes are solved when first asked, once a wall.
    """

    assembly: Assembly

    def bears(self, multiplier: float) -> bool:
        """Whether contact forces within yield are known to balance the dead load and this multiple of the live load."""
        return not self.assembly.strong and 0.0 <= multiplier <= self._greatest

    @cached_property
    def _greatest(self) -> float:
        """The greatest multiplier of statics; minus infinity where the dead load is not borne or none is greatest."""
        found = greatest_multiplier(self.assembly)
        borne = found is not None and admissible_forces(self.assembly, self.assembly.dead) is not None
        return found[0] if found is not None and borne else -np.inf


def by_virtual_work(assembly: Assembly, load: FloatArray, field: FloatArray, near: float = 0.3) -> HeldMotion | None:
    """The motion, where the loads do work on the field, and on it made admissible for dilatant flow; else None.

    A field on which they lose work is no fall yet, however near to a mechanism that proves one.

    Args:
        assembly: the wall.
        load: (n, 3) loads on the blocks [force, force, moment].
        field: (n, 3) velocities or small displacements [length, length, radian].
        near: how far the admissible mechanism may be from the measured one, as a share of its greatest speed. It says
            whose motion is shown; that no forces bear the load is true of any mechanism.
    """
    size = _size(assembly, field)
    if not (np.isfinite(size) and size > 0.0 and _power(assembly, load, field) > 0.0):
        return None
    found = dilatant_mechanism(assembly, load, field / size, near)
    return None if found is None else HeldMotion(MotionProof.VIRTUAL_WORK, field)


def by_power(assembly: Assembly, load: FloatArray, field: FloatArray, forces: FloatArray) -> HeldMotion | None:
    """The motion, where the loads give more power than friction, bars and contacts can take; else None.

    A bar that does not yield yet may bear more, so it takes its yield force in the sense in which it moves, and never
    less than what was measured.

    Args:
        assembly: the wall.
        load, field: as for `by_virtual_work`; the field of a motion that goes on (`Trend`).
        forces: (m, 3) contact forces (n1, n2, s) measured with it [force].
    """
    rates = (assembly.kinematic_matrix @ field[assembly.free].ravel()).reshape(-1, 3)
    given = _power(assembly, load, field)
    least, greatest = assembly.law.shear_range(np.maximum(forces[:, :2], assembly.law.least_normal))
    against = np.where(rates[:, 2] < 0.0, greatest, -least)
    lift = np.where(assembly.is_bar, 0.0, assembly.dilatancy) * np.abs(rates[:, 2])
    against = np.where(assembly.is_bar, np.maximum(against, np.abs(forces[:, 2])), against)
    friction = float(np.sum(against * np.abs(rates[:, 2])) - np.sum(lift * forces[:, :2].sum(axis=1)))
    contacts = float(np.sum(np.abs(forces[:, :2] * (rates[:, :2] - lift[:, None]))))
    return HeldMotion(MotionProof.POWER, field) if given - friction - contacts > 0.0 else None


def by_travel(assembly: Assembly, load: FloatArray, travelled: FloatArray, reach: float) -> HeldMotion | None:
    """The motion, where a block has moved by so many length scales and the loads did work; else None.

    Args:
        assembly: the wall.
        load: as for `by_virtual_work`.
        travelled: (n, 3) displacements under this load [length, length, radian].
        reach: in length scales.
    """
    far = float(np.abs(travelled[:, :2]).max(initial=0.0)) >= reach * assembly.length_scale
    return HeldMotion(MotionProof.TRAVEL, travelled) if far and _power(assembly, load, travelled) > 0.0 else None


def _power(assembly: Assembly, load: FloatArray, field: FloatArray) -> float:
    """Power of the loads on the free blocks, or their work on displacements [force x length]."""
    return float(np.sum(load[assembly.free] * field[assembly.free]))


def _size(assembly: Assembly, field: FloatArray) -> float:
    """Largest speed of a field, a rotation counting times the length scale [length]."""
    return float(np.abs(field * [1.0, 1.0, assembly.length_scale]).max(initial=0.0))
