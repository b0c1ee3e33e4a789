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
from scipy.sparse.linalg import SuperLU

from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray
from methods.numerics.failures import SingularMatrix, sparse_lu
from methods.springs.model.factor import SingularTangent
from methods.springs.model.gap_law import STICK, classify, gap_forces
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel
from methods.springs.path.path_record import PathSnapshot

_EXACT = 1e-12
"""Residual at which no more exact state is looked for."""
_ZERO = 1e-13
"""Multipliers up to this share of the load unit are zero to rounding, as of a wall at its limit under the dead load."""
_CORRECTIONS = 4
"""Newton steps with which forces and multiplier are solved for in one set of states."""
_INERTIA = 1e-7
"""Shift of a tangent in which several motions have no stiffness; iteration removes what it leaves."""
_STILL = 1e-6
"""Rates below this share of the fastest are none, where several mechanisms move at once."""

_IDLE = 1e-12
"""Work of the live load on a mechanism, as a share of the sum of its terms' sizes, that is rounding."""

_NOT_UNIQUE = "the plateau is not unique: more than one mechanism moves at once"


@dataclass(frozen=True)
class PlateauState:
    """A pair of forces and mechanism at one multiplier.

    Attributes:
        multiplier: of the live load; work_multiplier: the same from the virtual work of the mechanism.
        forces: (m, 3) end forces [force]; mechanism: (n, 3) block velocities, live power 1.
        residuals: relative defects by name: both, equilibrium, yield, dilatancy, complementarity, work.
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


def finish(model: WallModel, present: PathSnapshot, kept: PathSnapshot | None = None) -> PlateauState | None:
    """The best collapse state of a path that has come to a plateau, or broke off after a mechanism; None if none.

    The state on the last piece is solved for exactly; where that overshoots a breakpoint, or several mechanisms move at
    once, the state as traced, one solved for with some inertia, and the last mechanism kept on the way are tried. Which
    one holds is decided by their residuals alone.
    """
    shots = [present] if kept is None else [present, kept]
    best: PlateauState | None = None
    for shot in shots:
        for way in (solve_last_piece, _as_traced, of_many_mechanisms):
            with suppress(SingularTangent):
                state = way(model, shot)
                if best is None or state.worst < best.worst:
                    best = state
            if best is not None and best.worst <= _EXACT:
                return best
        if best is not None and best.worst <= model.options.collapse.certificate:
            return best
    return None


def worst_residual(model: WallModel, shot: PathSnapshot) -> float:
    """Largest relative residual of forces and velocity of a snapshot, as they are, as a collapse state."""
    return _as_traced(model, shot).worst


def does_no_work(live: FloatArray, velocity: FloatArray) -> bool:
    """Whether the live load does no work on a motion, to rounding."""
    return abs(_share_of_work(live, velocity)) <= _IDLE


def _share_of_work(live: FloatArray, velocity: FloatArray) -> float:
    """Work of the live load on a motion, as a share of the sum of the sizes of its terms."""
    return float(live @ velocity) / (float(abs(live) @ abs(velocity)) or 1.0)


def _as_traced(model: WallModel, shot: PathSnapshot) -> PlateauState:
    """Forces and velocity of a snapshot as they are."""
    return _collapse_state(model, shot.multiplier, shot.opening, shot.trial, shot.state, shot.velocity)


def _collapse_state(
    model: WallModel,
    multiplier: float,
    opening: FloatArray,
    trial: FloatArray,
    state: IntArray,
    velocity: FloatArray,
) -> PlateauState:
    normal, shear = np.empty_like(opening), np.empty_like(opening)
    gap_forces(opening, trial, model.kn, model.mu, model.lift, state, normal, shear)
    assembly = model.assembly
    forces = model.end_forces(normal, shear)
    field = model.block_displacements(velocity)
    live = float(np.sum(assembly.live * field))
    multiplier = 0.0 if abs(multiplier) <= _ZERO * assembly.load_unit else multiplier
    return check(assembly, multiplier, forces, field / (abs(live) or 1.0))


def solve_last_piece(model: WallModel, shot: PathSnapshot) -> PlateauState:
    """Solve for the state and the mechanism of the singular piece. Raises SingularTangent when it is not unique.

    Points that rounding carried a hair across their breakpoint change state, and the piece is solved for again.
    """
    multiplier, state = shot.multiplier, shot.state.copy()
    opening, trial = shot.opening.copy(), shot.trial.copy()
    fastest = int(np.argmax(np.abs(shot.velocity)))
    landed = np.empty_like(state)
    for _ in range(model.options.collapse.rounds):
        tangent = model.tangent(state)
        factor = _bordered(tangent, fastest, model.live)
        multiplier = _corrected(model, factor, fastest, opening, trial, state, multiplier)
        if not np.isfinite(opening + trial).all():
            raise SingularTangent(_NOT_UNIQUE)
        beyond = _beyond_yield(model, opening, trial, state)
        if not beyond.any():
            break
        classify(opening, trial, model.kn, model.mu, model.lift, landed, False)
        state[beyond] = landed[beyond]
    mechanism = factor.solve(-tangent[:, [fastest]].toarray().ravel())
    if not np.isfinite(mechanism).all():
        raise SingularTangent(_NOT_UNIQUE)
    mechanism[fastest] = 1.0
    mechanism *= np.sign(shot.velocity[fastest])
    return _collapse_state(model, multiplier, opening, trial, state, mechanism)


def of_many_mechanisms(model: WallModel, shot: PathSnapshot) -> PlateauState:
    """State and mechanism of a piece on which several motions have no stiffness, so that no system has one solution.

    Points that hardly move in the velocity are held. Some inertia makes the tangents regular, and iteration removes
    what it leaves: v = s (K + s M)^-1 M v ends where K v = 0, and the state in equilibrium beside v.
    Raises SingularTangent where rounding prevails.
    """
    opening_rate, slip_rate = np.empty_like(shot.opening), np.empty_like(shot.trial)

    def strain(motion: FloatArray) -> None:
        model_points = model.unknown, model.rows, model.interface, model.position
        point_strains(*model_points, motion, opening_rate, slip_rate)

    strain(shot.velocity)
    still = np.maximum(abs(opening_rate), abs(slip_rate)) <= _STILL * float(abs(shot.velocity).max())
    held = _regular(model, np.where(still, STICK, shot.state))
    velocity = shot.velocity
    for _ in range(model.options.collapse.rounds):
        velocity = held.solve(_INERTIA * model.inertia * velocity)
        velocity = velocity / (float(abs(velocity).max()) or 1.0)
    factor = _regular(model, shot.state)
    opening, trial, multiplier = shot.opening.copy(), shot.trial.copy(), shot.multiplier
    by_live = factor.solve(model.live)
    beside = model.inertia * velocity
    for _ in range(model.options.collapse.rounds):
        change = factor.solve(model.out_of_balance(opening, trial, shot.state, multiplier))
        rise = -float(beside @ change) / (float(beside @ by_live) or np.inf)
        strain(change + rise * by_live)
        opening, trial, multiplier = opening + opening_rate, trial + model.kt * slip_rate, multiplier + rise
    if not np.isfinite(opening + trial).all() or not np.isfinite(velocity).all():
        raise SingularTangent(_NOT_UNIQUE)
    return _collapse_state(model, multiplier, opening, trial, shot.state, velocity)


def _regular(model: WallModel, state: IntArray) -> SuperLU:
    try:
        return sparse_lu(model.tangent(state, _INERTIA))
    except SingularMatrix as error:
        raise SingularTangent(_NOT_UNIQUE) from error


def _beyond_yield(model: WallModel, opening: FloatArray, trial: FloatArray, state: IntArray) -> BoolArray:
    """(P,) points whose forces in these states are tensile or exceed friction."""
    normal, shear = np.empty_like(opening), np.empty_like(opening)
    gap_forces(opening, trial, model.kn, model.mu, model.lift, state, normal, shear)
    borne = model.law.by_friction(normal)
    return np.asarray(
        (normal < -model.options.collapse.certificate) | (np.abs(shear) > borne + model.options.collapse.certificate)
    )


def _bordered(tangent: sp.csc_matrix, fastest: int, live: FloatArray) -> SuperLU:
    try:
        return sparse_lu(_with_column(tangent, fastest, -live))
    except SingularMatrix as error:
        raise SingularTangent(_NOT_UNIQUE) from error


def _corrected(
    model: WallModel,
    factor: SuperLU,
    fastest: int,
    opening: FloatArray,
    trial: FloatArray,
    state: IntArray,
    multiplier: float,
) -> float:
    """Bring the gaps (changed in place) and the multiplier into equilibrium, the fastest displacement held."""
    opening_rate, slip_rate = np.empty_like(opening), np.empty_like(trial)
    for _ in range(_CORRECTIONS):
        answer = factor.solve(model.out_of_balance(opening, trial, state, multiplier))
        if not np.isfinite(answer).all():
            raise SingularTangent(_NOT_UNIQUE)
        multiplier += float(answer[fastest])
        answer[fastest] = 0.0
        point_strains(model.unknown, model.rows, model.interface, model.position, answer, opening_rate, slip_rate)
        opening += opening_rate
        trial += model.kt * slip_rate
    return multiplier


def _with_column(matrix: sp.csc_matrix, k: int, column: FloatArray) -> sp.csc_matrix:
    """The matrix with its column k replaced."""
    filled = np.flatnonzero(column)
    single = sp.csc_matrix((column[filled], (filled, np.full(len(filled), k))), shape=matrix.shape)
    keep = np.ones(matrix.shape[1])
    keep[k] = 0.0
    return (matrix @ sp.diags(keep) + single).tocsc()


def check(assembly: Assembly, multiplier: float, forces: FloatArray, mechanism: FloatArray) -> PlateauState:
    """Measure how exactly forces and mechanism form a collapse state with the flow of the joints.

    Forces are relative to a mean block weight, rates to the fastest block, or to as much of it as the live load's work
    is of the sum of its terms: rounding of an idle motion is no mechanism. Complementarity is the work of contact
    forces on the motion they ought to have none in, slip with its friction among it, as a share of the work of the live
    load at max(load unit, |multiplier|). What both presses (or lacks friction) and moves counts by the smaller of force
    and rate.

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
    power, share = float(live @ velocity), _share_of_work(live, velocity)
    power = power if share > _IDLE else 0.0
    speed = float(np.abs(velocity * lengths).max()) * min(1.0, max(share, _IDLE)) or 1.0
    law = assembly.law
    opened, slipped = law.rates(rates)[:, :2], np.abs(rates[:, 2])
    slacks, forwards = law.slacks(forces), rates[:, 2] > 0.0
    strength = law.by_friction(forces[:, 0] + forces[:, 1]) + np.where(forwards, law.constant[:, 2], law.constant[:, 3])
    tension = law.constant[:, :2]
    size = max(assembly.load_unit, abs(multiplier))
    against = np.where(forwards, slacks[:, 2], slacks[:, 3])
    pressed = forces[:, :2] + tension
    idle = float(np.abs(pressed * opened).sum() + np.abs(against * rates[:, 2]).sum())
    pressing = np.column_stack([pressed, against]) / scale
    motion = np.abs(np.column_stack([opened, slipped])) / speed
    residuals = {
        "both": float(np.minimum(np.abs(pressing), motion).max()),
        "equilibrium": float(np.abs(balance).max()) / scale,
        "yield": max(0.0, -float(slacks.min())) / scale,
        "dilatancy": max(0.0, -float(opened.min())) / speed,
        "complementarity": idle / (power * size) if power > 0.0 else np.inf,
    }
    # what joints take: n . opening = -(T / 2) opening where they open beyond the lift of their slip, whose own work is
    # -(mu N + c A) |slip| + psi N |slip|
    resists = strength - law.dilatancy * (forces[:, 0] + forces[:, 1])
    taken = float(np.sum(resists * slipped)) + float(np.sum(tension * np.maximum(opened, 0.0)))
    work = float(taken - dead @ velocity) / power if power else float("inf")
    residuals["work"] = abs(work - multiplier) / size if power > 0.0 else 1.0
    return PlateauState(multiplier, work, forces, mechanism, residuals)
