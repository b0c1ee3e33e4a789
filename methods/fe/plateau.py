"""The finish: forces and mechanism of the plateau, and their check as an exact collapse state.

In the last cell the tangent K is singular with null vector v. The fastest displacement k of v is held and the
multiplier takes its place among the unknowns: K with column k replaced by -live is regular, and solves both for the
state on the plateau (residual on the right) and for the mechanism (minus column k of K on the right, v_k = 1).
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from harness.model.assembly import Assembly, FloatArray, IntArray
from methods.fe.continuation import Tracer
from methods.fe.factor import SingularTangent
from methods.fe.gap_law import equivalent_end_forces, gap_forces
from methods.fe.path_record import Snapshot
from methods.fe.wall_model import point_strains

CERTIFICATE = 1e-8
"""Largest relative residual at which a final state counts as an exact collapse state."""


@dataclass(frozen=True)
class CollapseState:
    """A pair of forces and mechanism at one multiplier.

    Attributes:
        multiplier: of the live load; work_multiplier: the same from the virtual work of the mechanism.
        forces: (m, 3) end forces [force]; mechanism: (n, 3) block velocities, live power 1.
        residuals: relative defects by name: equilibrium, yield, dilatancy, complementarity, work.
    """

    multiplier: float
    work_multiplier: float
    forces: FloatArray
    mechanism: FloatArray
    residuals: dict[str, float]

    @property
    def worst(self) -> float:
        """Largest of the residuals."""
        return max(self.residuals.values())


def finish(tracer: Tracer) -> CollapseState | None:
    """The best collapse state of a tracer that has come to a plateau, or broke off after a mechanism; None if none.

    The state on the last piece is solved for exactly; where that overshoots a kink, the state as traced and the last
    mechanism kept on the way are tried. Which one holds is decided by their residuals alone.
    """
    present = Snapshot(tracer.multiplier, tracer.opening, tracer.trial, tracer.state, tracer.along())
    candidates: list[CollapseState] = []
    with suppress(SingularTangent):
        candidates.append(_solve_last_piece(tracer, present))
    candidates.append(_as_traced(tracer, present))
    if tracer.kept is not None:
        candidates.append(_as_traced(tracer, tracer.kept))
        if candidates[-1].worst > CERTIFICATE:
            with suppress(SingularTangent):
                candidates.append(_solve_last_piece(tracer, tracer.kept))
    for state in candidates:
        if state.worst <= CERTIFICATE:
            return state
    return None


def _as_traced(tracer: Tracer, shot: Snapshot) -> CollapseState:
    """Forces and velocity of a snapshot as they are."""
    return _collapse_state(tracer, shot.multiplier, shot.opening, shot.trial, shot.state, shot.velocity)


def _collapse_state(
    tracer: Tracer,
    multiplier: float,
    opening: FloatArray,
    trial: FloatArray,
    state: IntArray,
    velocity: FloatArray,
) -> CollapseState:
    model = tracer.model
    normal, shear = np.empty_like(opening), np.empty_like(opening)
    gap_forces(opening, trial, model.kn, model.mu, state, normal, shear)
    assembly = model.assembly
    forces = model.force * equivalent_end_forces(model.position, model.interface, normal, shear, assembly.n_interfaces)
    field = model.block_displacements(velocity)
    live = float(np.sum(assembly.live * field))
    return check(assembly, multiplier, forces, field / (abs(live) or 1.0))


def _solve_last_piece(tracer: Tracer, shot: Snapshot) -> CollapseState:
    """Solve for the state and the mechanism of the singular piece. Raises SingularTangent when it is not unique."""
    model = tracer.model
    multiplier = shot.multiplier
    opening, trial = shot.opening.copy(), shot.trial.copy()
    opening_rate, slip_rate = np.empty_like(opening), np.empty_like(trial)
    fastest = int(np.argmax(np.abs(shot.velocity)))
    tangent = model.tangent(shot.state)
    column = tangent[:, [fastest]].toarray().ravel()
    try:
        factor = splu(_with_column(tangent, fastest, -model.live))
    except RuntimeError as error:
        raise SingularTangent("the plateau is not unique: more than one mechanism moves at once") from error
    for _ in range(4):
        answer = factor.solve(model.out_of_balance(opening, trial, shot.state, multiplier))
        if not np.isfinite(answer).all():
            raise SingularTangent("the plateau is not unique: more than one mechanism moves at once")
        multiplier += float(answer[fastest])
        answer[fastest] = 0.0
        point_strains(model.unknown, model.rows, model.interface, model.position, answer, opening_rate, slip_rate)
        opening += opening_rate
        trial += model.kt * slip_rate
    mechanism = factor.solve(-column)
    mechanism[fastest] = 1.0
    mechanism *= np.sign(shot.velocity[fastest])
    return _collapse_state(tracer, multiplier, opening, trial, shot.state, mechanism)


def _with_column(matrix: sp.csc_matrix, k: int, column: FloatArray) -> sp.csc_matrix:
    """The matrix with its column k replaced."""
    filled = np.flatnonzero(column)
    single = sp.csc_matrix((column[filled], (filled, np.full(len(filled), k))), shape=matrix.shape)
    keep = np.ones(matrix.shape[1])
    keep[k] = 0.0
    return (matrix @ sp.diags(keep) + single).tocsc()


def check(assembly: Assembly, multiplier: float, forces: FloatArray, mechanism: FloatArray) -> CollapseState:
    """Measure how exactly forces and mechanism form a non-associated collapse state (zero dilatancy).

    Args:
        multiplier: of the live load; forces: (m, 3) end forces [force]; mechanism: (n, 3) block velocities.
    """
    matrix = assembly.kinematic_matrix
    dead, live = assembly.free_loads()
    velocity = mechanism[assembly.free].ravel()
    scale = assembly.force_scale / assembly.n_free
    lengths = np.tile([1.0, 1.0, assembly.length_scale], assembly.n_free)
    balance = (matrix.T @ forces.ravel() + dead + multiplier * live) / lengths
    rates = (matrix @ velocity).reshape(-1, 3)
    speed = float(np.abs(velocity * lengths).max()) or 1.0
    total = forces[:, 0] + forces[:, 1]
    slack = assembly.friction * total - np.abs(forces[:, 2])
    power = float(live @ velocity)
    residuals = {
        "equilibrium": float(np.abs(balance).max()) / scale,
        "yield": max(0.0, -float(forces[:, :2].min()), -float(slack.min())) / scale,
        "dilatancy": max(0.0, -float(rates[:, :2].min())) / speed,
        "complementarity": max(
            float(np.abs(forces[:, :2] * rates[:, :2]).max()), float(np.abs(slack * rates[:, 2]).max())
        )
        / (scale * speed),
        "direction": max(0.0, float((forces[:, 2] * rates[:, 2]).max())) / (scale * speed),
    }
    # power of the contact forces is friction only: n . opening = 0, s slip = -mu (n1 + n2) |slip|
    friction_work = float(np.sum(assembly.friction * total * np.abs(rates[:, 2])))
    work = float(friction_work - dead @ velocity) / power if power else float("inf")
    residuals["work"] = abs(work - multiplier) / max(1.0, abs(multiplier)) if power > 0.0 else 1.0
    return CollapseState(multiplier, work, forces, mechanism, residuals)
