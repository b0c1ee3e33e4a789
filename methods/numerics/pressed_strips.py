"""Walls whose joints crush, as walls whose joints are set in: what any method of joints that do not crush can solve.

A joint of length L, tension T and F0 = f_c A + T that bears F = n1 + n2 + T presses by f_c on a strip along one of its
ends, of the share a = F / F0 of its length (Orduna and Lourenco 2003). The force of the strip acts in its middle, so
that at this F the limits n_i + T/2 >= F^2 / (2 F0) of the stress block are those of a joint that does not crush and
whose ends are set in by a L / 2. The share follows from forces, and the forces from the shares: they are found in turn.
What that leads to is a state of the stress blocks in forces alone, since a joint that is set in turns about the middle
of its strip and one that crushes about its inner edge; `methods.numerics.pressed_state` makes it exact in both.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray


def pressed_shares(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(m,) shares F / F0 of the joints that contact forces (m, 3) press; zero where a joint does not crush."""
    tension = assembly.constant[:, 0] + assembly.constant[:, 1]
    share = (forces[:, 0] + forces[:, 1] + tension) / (assembly.crushing + tension)
    return np.where(np.isfinite(assembly.crushing), np.maximum(share, 0.0), 0.0)


def set_in(assembly: Assembly, share: FloatArray) -> Assembly:
    """The wall whose joints do not crush, and whose ends are in the middles of strips of these shares (m,), below 1."""
    along = 0.5 * share[:, None] * (assembly.end2 - assembly.end1)
    never = np.full(assembly.n_interfaces, np.inf)
    return replace(assembly, end1=assembly.end1 + along, end2=assembly.end2 - along, crushing=never)


def at_ends(share: FloatArray, forces: FloatArray) -> FloatArray:
    """The contact forces (m, 3) of a wall that is set in, as forces on the ends of its whole joints."""
    near, far = 1.0 - 0.5 * share, 0.5 * share
    first, second, shear = forces.T
    return np.column_stack([near * first + far * second, far * first + near * second, shear])
