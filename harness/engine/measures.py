"""What a residual of forces is relative to: the loads that act, so that no contact force of any size hides one.

Contact forces that balance each other alone (self-stress) may be as large as one likes and say nothing of the loads.
So what acts on a block counts up to the loads of its component, and a block does not pass on what it cannot explain:

F        sum of the magnitudes of load and contact forces on a block, at most the loads of its component
own      its own load; that of a block without load is the smallest of its component
small    the least of F and `_PASSED_ON` x own: what an unbalanced force or a violation of yield is measured by
rounding an unbalanced force within `ROUNDING` F, and within `OF_OWN` x own, is measured by F alone: light blocks
         that bear heavy ones are in equilibrium to the digits of the heavy ones
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.bars import Bars
from harness.model.components import components_of

UNLOADED = 1e-6
"""Share of the largest sum of its component by which a block without load is measured at least.

Rounding leaves forces of 1e-16 to 1e-14 of that sum (measured on walls with weightless blocks), which then count as
1e-10 to 1e-8."""
_PASSED_ON = 1e3
"""Forces on a block, in its own loads, up to which its equilibrium is held to them.

Distinct elements hold equilibrium to a millionth: so a thousandth of a block's own load may be unbalanced at most."""
ROUNDING = 4e-15
"""Share of the forces on a block that is rounding: two dozen units in the last place."""
OF_OWN = 2e-3
"""Share of a block's own load up to which rounding of the forces on it is let pass: weights that differ by 1e12."""
NO_LOAD = 1e-13
"""Share of the loads of its component up to which a load is none: rounding of a multiplier that is zero."""
_EXACTLY = 1e3
"""Contact forces, in loads of the component, from which on their sums are made in fractions.

Below it rounding of the sums is 1e-13 of the loads, a thousandth of the strictest tolerance."""


@dataclass(frozen=True, eq=False)
class Measures:
    """What acts on every block (n,) under a multiplier and contact forces [force]; see this module's docstring.

    Attributes:
        loads: magnitude of the loads of its component.
        own: of its own load.
        contact: sum of the magnitudes of the contact forces on it.
        acting: F.
    """

    loads: FloatArray
    own: FloatArray
    contact: FloatArray
    acting: FloatArray

    @classmethod
    def of(
        cls, assembly: Assembly, forces: FloatArray, multiplier: float, beyond: FloatArray | None = None
    ) -> Measures:
        """Those of contact forces (m, 3), and of bars beyond their prestress (k,), with dead + multiplier x live."""
        own = magnitudes(assembly, assembly.dead) + magnitudes(assembly, multiplier * assembly.live)
        contact = np.zeros(assembly.n_blocks)
        size = abs(forces).sum(axis=1)
        np.add.at(contact, assembly.block_a, size)
        np.add.at(contact, assembly.block_b, size)
        if beyond is not None:
            np.add.at(contact, assembly.bars.block_a, abs(beyond))
            np.add.at(contact, assembly.bars.block_b, abs(beyond))
        total = own + contact
        loads, acting = total.copy(), total.copy()
        for part in components_of(assembly):
            free = part.blocks[~assembly.fixed[part.blocks]]
            unloaded = free[own[free] == 0.0]
            acting[unloaded] = np.maximum(acting[unloaded], UNLOADED * total[part.blocks].max(initial=0.0))
            whole = float(own[free].sum())
            if whole > 0.0:
                counted = own[free] > NO_LOAD * whole
                own[free[~counted]] = own[free[counted]].min()
                loads[free] = whole
                acting[free] = np.minimum(acting[free], whole)
        return cls(loads, own, contact, np.where(acting > 0.0, acting, 1.0))

    def relative(self, amount: FloatArray, acting: FloatArray, own: FloatArray) -> FloatArray:
        """Amounts (k,) of force, relative to what is small where they arise (k,)."""
        rounding = amount <= np.minimum(ROUNDING * acting, OF_OWN * own)
        small = np.where(own > 0.0, np.minimum(acting, _PASSED_ON * own), acting)
        return np.asarray(amount / np.where(rounding, acting, small))

    def immense(self, assembly: Assembly) -> IntArray:
        """Indices (k,) of the free blocks whose contact forces are immense beside the loads of their component."""
        return np.flatnonzero(~assembly.fixed & (self.contact > _EXACTLY * self.loads))


def magnitudes(assembly: Assembly, load: FloatArray) -> FloatArray:
    """(n,) magnitudes of loads (n, 3): force and moment / largest radius [force]."""
    return np.asarray(np.hypot(load[:, 0], load[:, 1]) + abs(load[:, 2]) / assembly.radius)


def between(assembly: Assembly, scale: FloatArray, joined: Assembly | Bars | None = None) -> FloatArray:
    """The smaller (m,) of a measure (n,) of the two blocks of every interface, of the free one where one is fixed.

    Or of every bar (k,), where `joined` is the bars.
    """
    joined = joined or assembly
    movable = np.where(assembly.fixed, np.inf, scale)
    smaller = np.minimum(movable[joined.block_a], movable[joined.block_b])
    both = np.minimum(scale[joined.block_a], scale[joined.block_b])
    return np.where(np.isfinite(smaller), smaller, both)


def exact_sum(
    assembly: Assembly, forces: FloatArray, multiplier: float, block: int, beyond: FloatArray | None = None
) -> FloatArray:
    """Load and contact forces (fx, fy, moment about the centroid) on a block, summed in fractions and rounded once.

    The two normal forces act at the contact points; the shear acts half at each, along the line that joins them.

    Args:
        assembly: the wall; forces: (m, 3) contact forces (n1, n2, s) [force]; multiplier: of the live load; block: its
            index; beyond: (k,) tensions of bars beyond their prestress [force].
    """
    total = [
        Fraction(dead) + Fraction(multiplier) * Fraction(live)
        for dead, live in zip(assembly.dead[block].tolist(), assembly.live[block].tolist(), strict=True)
    ]
    centre = _fractions(assembly.centroid[block])
    for p in np.flatnonzero((assembly.block_a == block) | (assembly.block_b == block)):
        sign = 1 if assembly.block_b[p] == block else -1
        first, second, shear = _fractions(forces[p])
        normal, tangent = _fractions(assembly.normal[p]), _fractions(assembly.tangent[p])
        for point, compression in ((assembly.end1[p], first), (assembly.end2[p], second)):
            x, y = (sign * (compression * n + shear / 2 * t) for n, t in zip(normal, tangent, strict=True))
            arm = [a - c for a, c in zip(_fractions(point), centre, strict=True)]
            total = [total[0] + x, total[1] + y, total[2] + arm[0] * y - arm[1] * x]
    bars = assembly.bars
    tensions = np.zeros(len(bars)) if beyond is None else beyond
    for k in np.flatnonzero((bars.block_a == block) | (bars.block_b == block)):
        starts = bars.block_a[k] == block
        pull = Fraction(float(tensions[k])) * (1 if starts else -1)
        x, y = (pull * part for part in _fractions(bars.axis[k]))
        arm = [a - c for a, c in zip(_fractions((bars.end1 if starts else bars.end2)[k]), centre, strict=True)]
        total = [total[0] + x, total[1] + y, total[2] + arm[0] * y - arm[1] * x]
    return np.array([float(value) for value in total])


def _fractions(values: FloatArray) -> list[Fraction]:
    return [Fraction(value) for value in values.tolist()]
