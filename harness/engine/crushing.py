"""The judge's own evaluation of joints that crush, by the stresses of the rectangular stress block.

A joint of area A presses by f_c on a strip along one of its ends, and pulls by f_t on the rest. With F = N + f_t A and
F0 = (f_c + f_t) A the strip is the share F / F0 of the joint, so that the moment about the middle, as a difference of
the end forces, is at most |n1 - n2| <= F (1 - F / F0). Where its ends move apart by o1 and o2 the stresses take the
power of f_c on what closes and of f_t on what opens (Orduna and Lourenco 2003).
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray


def block_excess(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(m,) by how much forces (m, 3) at the worse end of a joint exceed its stress block [force]; zero within it."""
    tension, full = _tension_and_full(assembly)
    compression = forces[:, 0] + forces[:, 1] + tension
    share = np.divide(compression, full, out=np.zeros_like(full), where=full > 0.0)
    borne = np.where(full > 0.0, compression * (1.0 - share), -abs(compression))  # no strength bears no force
    beyond = 0.5 * (abs(forces[:, 0] - forces[:, 1]) - borne)
    return np.where(np.isfinite(assembly.crushing), np.maximum(beyond, 0.0), 0.0)


def block_power(assembly: Assembly, opening: FloatArray) -> FloatArray:
    """(m,) power of the stresses on openings (m, 2) of the ends, closings negative; zero in joints that do not crush.

    The opening varies linearly along the joint: the mean of what closes is o^2 / (2 (o' - o)) where one end closes by
    -o and the other opens by o'.
    """
    tension, full = _tension_and_full(assembly)
    low, high = opening.min(axis=1), opening.max(axis=1)
    one = low**2 / (2.0 * np.where(high > low, high - low, 1.0))
    closing = np.where(high <= 0.0, -0.5 * (low + high), np.where(low < 0.0, one, 0.0))
    crushes = np.isfinite(assembly.crushing)
    taken = 0.5 * tension * (low + high) + np.where(crushes, full, 0.0) * closing
    return np.where(crushes, taken, 0.0)


def block_forces(assembly: Assembly, opening: FloatArray) -> FloatArray:
    """(m, 2) forces (n1, n2) of the stresses on openings (m, 2) of the ends; meaningless in joints that do not crush.

    What closes is pressed: the share p of the joint where one end closes and the other opens, so that its force p F0
    acts at p / 2 from the end that closes.
    """
    tension, full = _tension_and_full(assembly)
    low, high = opening.min(axis=1), opening.max(axis=1)
    turn = high - low
    pressed = np.where(high <= 0.0, 1.0, np.where(low < 0.0, -low / np.where(turn > 0.0, turn, 1.0), 0.0))
    force = np.where(np.isfinite(assembly.crushing), full, 0.0) * pressed
    at_closing, at_other = force * (1.0 - 0.5 * pressed), force * 0.5 * pressed
    first = opening[:, 0] <= opening[:, 1]
    ends = np.column_stack([np.where(first, at_closing, at_other), np.where(first, at_other, at_closing)])
    return np.asarray(ends - 0.5 * tension[:, None])


def _tension_and_full(assembly: Assembly) -> tuple[FloatArray, FloatArray]:
    """(m,) tension f_t A, and (m,) force F0 = (f_c + f_t) A."""
    tension = assembly.constant[:, 0] + assembly.constant[:, 1]
    return tension, assembly.crushing + tension
