"""The judge of least and greatest reactions: forces and mechanism that prove each other, by sums over blocks alone.

Forces in equilibrium with the dead load, within yield, show a reaction that is possible: the work R of the contact
forces on the motion of the supports. A dilatant mechanism in which the supports move as prescribed (backwards for the
greatest) bounds all reactions by virtual work: dead work less dissipation. Where the two are equal neither can be
better. Residuals are relative: of virtual work to the dead load times the fastest vertex of the supports.
"""

from __future__ import annotations

import numpy as np

from harness.engine.bar_checks import dissipated_by_bars
from harness.engine.judge_decision import UNCOUNTABLE, countable, said_of
from harness.engine.judge_law import beyond_lift, dissipated_by_friction, dissipated_by_strength
from harness.engine.residuals import block_sums, force_residuals, power
from harness.model.assembly import Assembly, FloatArray
from harness.model.followed import SupportPath
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
    if not all(countable(each) for each in (reaction, forces, mechanism, tensions)):
        return said_of(tolerance, False, UNCOUNTABLE)
    beyond_prestress = tensions - bars.prestress if len(bars) else None
    sense = -1.0 if greatest else 1.0
    work = work_scale(assembly, reaction)
    opening, slip = relative_velocities(assembly, mechanism)
    beyond = beyond_lift(assembly, opening, slip)
    shown = reaction_of(assembly, forces, tensions)
    taken = dissipated_by_strength(assembly, beyond, slip) + dissipated_by_bars(assembly, mechanism)
    on_supports = np.where(assembly.fixed[:, None], bars.generalised(bars.prestress, assembly.centroid), 0.0)
    bound = sense * (power(assembly.dead + on_supports, mechanism) - taken)
    residuals = force_residuals(assembly, forces, 0.0, beyond=beyond_prestress)
    residuals |= _of_motion(assembly, mechanism, sense, beyond) | {
        "reaction": abs(shown - reaction) / work,
        "virtual_work": abs(bound - reaction) / work,
    }
    what = "greatest" if greatest else "least"
    return held(residuals, tolerance, f"Forces and mechanism of the {what} reaction were")


def judge_plateau(
    assembly: Assembly,
    path: SupportPath,
    *,
    gives_way: bool,
    tolerance: float,
    extremes: tuple[float, float],
) -> Judgement:
    """Whether a constant reaction belongs to a mechanism that moving supports drive, by the flow of the joints.

    Forces and mechanism are held to equilibrium, yield, and the work of each other: where no joint closes below the
    lift of its slip and no force exceeds yield, the prescribed motion does the work R of the dead load less what
    friction and strength take only if nothing opens under force or slips below its strength. So no motion beside the
    mechanism changes R.

    Args:
        assembly: the wall with its `support_motion`, without ties and props.
        path: of the reaction R, with its mechanism and the displacement from which it is said to be constant.
        gives_way: whether the supports move as prescribed; else backwards.
        tolerance: the largest residual that is acceptable.
        extremes: least and greatest R of associated flow; no reaction of the path lies outside.
    """
    forces, mechanism, begins = path.forces, path.mechanism, path.constant_from
    if mechanism is None or begins is None:
        return said_of(tolerance, None, "Its reaction is not said to be constant.")
    if not all(countable(each) for each in (path.reaction, forces, mechanism)):
        return said_of(tolerance, False, UNCOUNTABLE)
    sense, reaction, constant = 1.0 if gives_way else -1.0, float(path.reaction[-1]), path.displacement >= begins
    work = work_scale(assembly, reaction)
    opening, slip = relative_velocities(assembly, mechanism)
    opening = beyond_lift(assembly, opening, slip, "non-associated")
    taken = dissipated_by_friction(assembly, forces, slip, "non-associated")
    taken += dissipated_by_strength(assembly, opening, slip)
    low, high = extremes
    residuals = force_residuals(assembly, forces, 0.0) | _of_motion(assembly, mechanism, sense, opening)
    residuals |= {
        "reaction": abs(power(block_sums(assembly, forces), assembly.support_motion) - reaction) / work,
        "virtual_work": abs(sense * (power(assembly.dead, mechanism) - taken) - reaction) / work,
        "extremes": max(0.0, low - float(path.reaction.min()), float(path.reaction.max()) - high) / work,
        "constant": float(abs(path.reaction[constant] - reaction).max(initial=0.0)) / work,
        "plateau": float(not (begins >= 0.0 and constant.any())),
    }
    return held(residuals, tolerance, "Forces and mechanism of the constant reaction were")


def judge_held(
    assembly: Assembly,
    reaction: float,
    forces: FloatArray,
    tensions: FloatArray,
    *,
    tolerance: float,
    extremes: tuple[float, float],
) -> Judgement:
    """Whether forces show that a reaction is possible, on the wall as drawn: equilibrium, yield, and their own work.

    Args:
        assembly: the wall with its `support_motion`.
        reaction: work R on the motion of the supports; extremes: least and greatest R of associated flow.
        forces: (m, 3) contact forces [force]; tensions: (k,) of the ties and props, prestress included [force].
        tolerance: the largest residual that is acceptable.
    """
    bars, work = assembly.bars, work_scale(assembly, reaction)
    low, high = extremes
    residuals = force_residuals(assembly, forces, 0.0, beyond=tensions - bars.prestress if len(bars) else None)
    residuals |= {
        "reaction": abs(reaction_of(assembly, forces, tensions) - reaction) / work,
        "extremes": max(0.0, low - reaction, reaction - high) / work,
    }
    return held(residuals, tolerance, f"Forces at the reaction {reaction:.6g} were")


def reaction_of(assembly: Assembly, forces: FloatArray, tensions: FloatArray) -> float:
    """Work of contact forces (m, 3) and of tensions (k,), prestress included, on the motion of the supports."""
    on_blocks = block_sums(assembly, forces) + assembly.bars.generalised(tensions, assembly.centroid)
    return float(power(on_blocks, assembly.support_motion))


def work_scale(assembly: Assembly, reaction: float) -> float:
    """What the work of a reaction is compared with: the dead load on the prescribed motion, or the work if greater."""
    speed = fastest_vertex(assembly, assembly.support_motion) or 1.0
    return max(assembly.force_scale * speed, abs(reaction))


def _of_motion(assembly: Assembly, mechanism: FloatArray, sense: float, opening: FloatArray) -> dict[str, float]:
    """Residuals of a mechanism that moving supports drive.

    Args:
        assembly: with its `support_motion`; mechanism: (n, 3).
        sense: 1 where the supports move as prescribed, -1 where they move backwards.
        opening: (m, 2) rates that are not to be negative.
    """
    supports = np.where(assembly.fixed[:, None], mechanism - sense * assembly.support_motion, 0.0)
    speed = fastest_vertex(assembly, assembly.support_motion) or 1.0
    fastest = max(fastest_vertex(assembly, mechanism), speed)
    return {
        "supports": fastest_vertex(assembly, supports) / speed,
        "interpenetration": max(0.0, float((-opening).max(initial=0.0))) / fastest,
    }


def held(residuals: dict[str, float], tolerance: float, what: str) -> Judgement:
    """Accepted where every residual is within the tolerance; what was checked stands before the verb."""
    failed = [f"{name} {value:.3g}" for name, value in residuals.items() if not value <= tolerance]
    said = f"; not within {tolerance:.3g}: {', '.join(failed)}." if failed else f" and hold within {tolerance:.3g}."
    sentence = f"{what} recomputed from the equilibrium of the blocks{said}"
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=not failed, sentence=sentence)
