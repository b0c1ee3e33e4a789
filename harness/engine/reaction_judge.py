"""The judge of least and greatest reactions: forces and mechanism that prove each other, by sums over blocks alone.

Forces in equilibrium with the dead load, within yield, show a reaction that is possible: the work R of the contact
forces on the motion of the supports. A dilatant mechanism in which the supports move as prescribed (backwards for the
greatest) bounds all reactions by virtual work: dead work less dissipation. Where the two are equal neither can be
better. Residuals are relative: of virtual work to the dead load times the fastest vertex of the supports.
"""

from __future__ import annotations

import numpy as np

from harness.engine.bar_checks import dissipated_by_bars
from harness.engine.residuals import block_sums, dissipated_by_strength, force_residuals, power
from harness.model.assembly import Assembly, FloatArray
from harness.model.result import Judgement, fastest_vertex, relative_velocities


def judge_reaction(
    assembly: Assembly,
    reaction: float,
    forces: FloatArray,
    mechanism: FloatArray,
    *,
    greatest: bool,
    tolerance: float,
    tensions: FloatArray | None = None,
) -> Judgement:
    """Whether a reaction is the least or the greatest that there is.

    Args:
        assembly: the wall with its `support_motion`.
        reaction: work R on the motion of the supports.
        forces: (m, 3) contact forces [force]; mechanism: (n, 3) motion of all blocks.
        greatest: whether it is claimed to be the greatest; then the supports of the mechanism move backwards.
        tolerance: the largest residual that is acceptable.
        tensions: (k,) of the ties and props, prestress included [force]; None: they bear their prestress alone.
    """
    bars = assembly.bars
    tensions = bars.prestress if tensions is None else tensions
    beyond_prestress = tensions - bars.prestress if len(bars) else None
    sense = -1.0 if greatest else 1.0
    supports = np.where(assembly.fixed[:, None], mechanism - sense * assembly.support_motion, 0.0)
    speed = fastest_vertex(assembly, assembly.support_motion) or 1.0
    fastest = max(fastest_vertex(assembly, mechanism), speed)
    work = assembly.force_scale * speed
    opening, slip = relative_velocities(assembly, mechanism)
    beyond = opening - (assembly.friction * abs(slip))[:, None]
    on_blocks = block_sums(assembly, forces) + bars.generalised(tensions, assembly.centroid)
    shown = power(on_blocks, assembly.support_motion)
    taken = dissipated_by_strength(assembly, beyond, slip) + dissipated_by_bars(assembly, mechanism)
    on_supports = np.where(assembly.fixed[:, None], bars.generalised(bars.prestress, assembly.centroid), 0.0)
    bound = sense * (power(assembly.dead + on_supports, mechanism) - taken)
    residuals = force_residuals(assembly, forces, 0.0, beyond=beyond_prestress) | {
        "supports": fastest_vertex(assembly, supports) / speed,
        "interpenetration": max(0.0, float((-beyond).max(initial=0.0))) / fastest,
        "reaction": abs(shown - reaction) / max(work, abs(reaction)),
        "virtual_work": abs(bound - reaction) / max(work, abs(reaction)),
    }
    failed = [f"{name} {value:.3g}" for name, value in residuals.items() if not value <= tolerance]
    what = "greatest" if greatest else "least"
    sentence = f"Forces and mechanism of the {what} reaction were checked from block sums"
    sentence += (
        f"; not within {tolerance:.3g}: {', '.join(failed)}." if failed else f" and hold within {tolerance:.3g}."
    )
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=not failed, sentence=sentence)
