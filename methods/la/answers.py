"""Findings turned into answers: scaled states back into forces, mechanisms and sentences."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import first_few
from harness.model.method import Answer, Finding, Status
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.programmes import KinematicSolution
from methods.la.core.state import CollapseState, local_residuals, residuals
from methods.la.core.vertex_programmes import badly_scaled, standing
from methods.la.interior.interior_starting_point import phase_one_forces
from methods.numerics.statics import dilatant_mechanism

LOCAL_RESIDUAL = 1e-8
"""Residual at a block or joint, relative to the forces and speeds there, of a state that is returned."""

NO_MOTION = "The live load does no work on any mechanism: it cannot make the wall collapse."
NO_STATE = "Statics allows any live load, and the search found no collapse state under zero dilatancy either."


def collapse_answer(
    problem: Problem,
    state: CollapseState,
    sentence: str,
    tolerance: float,
    iterations: int,
    details: dict[str, Any],
    bracket: tuple[float, float] | None = None,
    bracket_meaning: str = "",
) -> Answer:
    """The answer of a collapse state, or not_converged if it fails the method's own check."""
    found = residuals(problem, state)
    multiplier = problem.to_multiplier(state.multiplier)
    details = {**details, "residuals": found}
    failed = {name: value for name, value in found.items() if not value <= tolerance}
    if failed:
        shown = ", ".join(f"{name} {value:.2g}" for name, value in failed.items())
        return not_converged(
            f"The best state, near multiplier {multiplier:.6g}, is not accurate enough: {shown}", iterations, details
        )
    blocks = _inexact_blocks(problem, state)
    if blocks:
        return not_converged(
            f"The best state, near multiplier {multiplier:.6g}, is not accurate enough at {first_few(blocks, 8)}, "
            "whose loads or velocities are small compared with those of the others.",
            iterations,
            details,
        )
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        sentence,
        multiplier=multiplier,
        bracket=bracket,
        bracket_meaning=bracket_meaning,
        forces=problem.to_forces(state.forces),
        forces_multiplier=multiplier,
        mechanism=problem.to_mechanism(state.velocities),
        flow="associated" if state.associated else "non-associated",
        iterations=iterations,
        details=details,
    )


def _inexact_blocks(problem: Problem, state: CollapseState) -> list[str]:
    """Names of the blocks at which a state is wrong by more than `LOCAL_RESIDUAL` of what acts there."""
    assembly = problem.assembly
    equilibrium, tension, closing = local_residuals(problem, state)
    wrong = np.zeros(assembly.n_blocks, dtype=bool)
    wrong[assembly.free] = equilibrium > LOCAL_RESIDUAL
    joints = (tension > LOCAL_RESIDUAL) | (closing > LOCAL_RESIDUAL)
    wrong[assembly.block_a[joints]] = wrong[assembly.block_b[joints]] = True
    return [assembly.block_ids[i] for i in np.flatnonzero(wrong & ~assembly.fixed)]


def not_converged(sentence: str, iterations: int = 0, details: dict[str, Any] | None = None) -> Answer:
    """The answer of a run that ended without a result."""
    return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, iterations=iterations, details=details or {})


def unbounded_answer(sentence: str, iterations: int = 0, details: dict[str, Any] | None = None) -> Answer:
    """The answer for a live load that cannot make the wall collapse."""
    return Answer(Status.OK, Finding.UNBOUNDED, sentence, iterations=iterations, details=details or {})


def dead_load_answer(problem: Problem, newton: NewtonMatrix, has_live_load: bool) -> Answer | None:
    """Falls with its mechanism, or stands if there is no live load; None if there is a live load to study."""
    if has_live_load and not badly_scaled(problem) and phase_one_forces(problem, newton) is not None:
        return None
    found = standing(problem)
    if isinstance(found, str):
        # Near the limit forces have no vertex to rounding, and a mechanism has.
        shown = None if has_live_load else dilatant_mechanism(problem.assembly, problem.assembly.dead, exact=True)
        if shown is not None:
            return falls_answer(problem.assembly, shown)
        return not_converged(f"Whether the wall stands under its dead load was not decided: the programme was {found}.")
    if isinstance(found, KinematicSolution):
        return falls_answer(problem.assembly, problem.to_mechanism(found.velocities))
    if has_live_load:
        return None
    return Answer(
        Status.OK,
        Finding.STANDS,
        "Under its dead load the wall has an equilibrium within yield; no live load is given.",
        forces=problem.to_forces(found.forces),
        forces_multiplier=0.0,
        iterations=found.iterations,
    )


def falls_answer(assembly: Assembly, motion: FloatArray) -> Answer:
    """Falls under its dead load, by a dilatant mechanism (n, 3) on which the dead load does positive work."""
    number = moving_blocks(assembly, motion)
    return Answer(
        Status.OK,
        Finding.FALLS,
        f"The wall falls under its dead load by a mechanism of {number} {'block' if number == 1 else 'blocks'}: "
        "no equilibrium within yield exists, whatever the flow rule.",
        mechanism=motion,
        flow="associated",
        details={"dead_work": float((assembly.dead * motion).sum())},
    )


def moving_blocks(assembly: Assembly, mechanism: FloatArray) -> int:
    """Blocks whose velocity is more than rounding."""
    speed = abs(mechanism * np.array([1.0, 1.0, assembly.length_scale])).max(axis=1)
    return int((speed > 1e-9 * speed.max(initial=0.0)).sum())
