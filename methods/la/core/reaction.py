"""Least and greatest reaction of supports that move: limit analysis with the reaction as the load.

Supports move by u_s, which strains the joints on them by q = C_s u_s while the free blocks rest. The contact forces do
the work R = q.r on it, which for a unit motion is the reaction along it. Programmes and their dual mechanisms u are

    min or max q.r  s.t.  C' r + f0 = 0, S r + s0 >= 0;     C u +- q = S' g, g >= 0, R = +-(f0.u - s0.g)

The least reaction is that of a support that gives way, the greatest that of one that pushes against its prescribed
motion. Ties and props are
further joints in them; the prestress of one on a moving support does work on its motion besides.

Sources: Portioli and Cascini (2016); Iannuzzo et al. (2018).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.bars import tensions, with_bars_as_joints
from methods.la.core.problem import make_problem
from methods.la.core.vertex_programmes import force_programme


@dataclass(frozen=True)
class ExtremeReaction:
    """A reaction of moving supports, forces and mechanism that prove it.

    Attributes:
        reaction: work R of the contact forces on the motion of the supports; a force where they move by one.
        forces: (m, 3) contact forces [force]; tensions: (k,) of ties and props, prestress included [force].
        mechanism: (n, 3) motion of all blocks, for the greatest reaction with the supports moving backwards.
    """

    reaction: float
    forces: FloatArray
    tensions: FloatArray
    mechanism: FloatArray


def extreme_reaction(assembly: Assembly, greatest: bool, parted: BoolArray | None = None) -> ExtremeReaction | str:
    """The greatest or least reaction of the moving supports under dead load, or how the programme ended without one.

    Args:
        assembly: with `support_motion`; greatest: which of the two.
        parted: (m, 2) ends of joints that bear nothing and may close, of a wall without bars; None: all bear.

    Raises:
        ValueError: no support with a joint, a tie or a prop moves.
    """
    bars, m = assembly.bars, assembly.n_interfaces
    assembly = with_bars_as_joints(assembly)
    strains = assembly.support_strains
    if not np.any(strains):
        raise ValueError("no support with a joint, a tie or a prop moves: support_motion is zero there")
    problem = make_problem(assembly)
    found = force_programme(problem).extreme_work(strains, greatest, parted)
    if isinstance(found, str):
        return found
    forces = problem.to_forces(found[0])
    mechanism = -assembly.support_motion if greatest else assembly.support_motion.copy()
    mechanism[assembly.free] = problem.velocities_of_blocks(found[1])
    reaction = float((strains * forces).sum())
    if len(bars):
        reaction += float((bars.generalised(bars.prestress, assembly.centroid) * assembly.support_motion).sum())
    return ExtremeReaction(reaction, forces[:m], tensions(bars, forces), mechanism)
