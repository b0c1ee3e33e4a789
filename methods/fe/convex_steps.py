"""Each step as convex quadratic programmes: `fe-qp`, an independent cross-check for small walls.

With the friction limits c frozen (Tresca), the equilibrium of the gap springs minimises a convex energy:

    min 1/2 sum kn z^2 + 1/2 sum (kt (s - e) + h)^2 / kt + sum c |e| - load'u    with z >= psi |e| - g(u)

where z is the compression and e the frictional part of the slip, which lifts by psi |e| and dissipates c = (mu - psi)
N. OSQP (Stellato et al., 2020) solves it, split as e = e+ - e-, and the limits follow by fixed-point iteration until
they repeat (Haslinger, 1983). They begin where the last two steps lead: limits of the last step can be too low for the
next, and the energy then has no minimum although the wall stands. The step of the multiplier is bisected between the
last step that converged and the first that did not: the answer is that bracket.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from harness.model.method import Answer, Finding, Status
from methods.numerics.vectors import largest
from methods.springs.model.wall_model import WallModel, load_scale
from methods.springs.path.path_record import PathRecord

_LONGER = 1.5
"""Factor on the step after one that settled."""
_FURTHEST = 1e6
"""First steps after which nothing is left to find."""
_KEPT = 100.0
"""First steps beyond which forces are no longer kept while no step fails: OSQP's accuracy is relative to the load."""
_DAMPED = 0.5
"""Share of a change of the limits that is taken where the whole of it does not settle."""
_REPEATED = 1e-5
"""Change of friction limits, in largest loads of a block, at which they count as repeated."""
_NEARER = 0.9
"""Share of the least change so far that a further one must be below to count as nearer."""
_RUNAWAY = 1e6
"""Displacements, in load scales, beyond which there is no minimum."""
_LOST = 0.01
"""Share of the multiplier within which limits that do not settle are taken for the collapse above them."""
_FINE = 1000.0
"""Multiples of `_REPEATED` at which the live load has to stand to the dead load for a bracket to mean anything."""


@dataclass(frozen=True)
class _ConvexResult:
    """The bracket of the multiplier: the last step with equilibrium and the first without; and the work done.

    Attributes:
        lower, upper: the bracket; upper None when no step lost its equilibrium.
        gravity: whether the dead load settled; fall: displacements (N,) along which the energy falls without end, even
            with friction limits as if every joint carried the whole wall.
        forces: gap forces N and T (P,) of the last step that settled with loads not far above the dead load.
        at: the multiplier of `forces`; settles: whether a step little above `upper` has an energy without minimum, and
            not only friction limits that do not settle; fine: whether the limits are exact enough for so small a
            multiplier.
        repeated: change of friction limits, in largest loads of a block, at which they counted as repeated.
    """

    lower: float
    upper: float | None
    record: PathRecord
    programmes: int
    gravity: bool
    forces: tuple[FloatArray, FloatArray] | None = None
    at: float = 0.0
    settles: bool = True
    fine: bool = True
    fall: FloatArray | None = None
    repeated: float = 0.0


class _TrescaProgramme:
    """The quadratic programme of one wall, factorised once by OSQP; unknowns (u, z, e+, e-)."""

    def __init__(self, model: WallModel, accuracy: float) -> None:
        self.model = model
        self.programmes = 0
        self.normal, self.shear = np.zeros(model.n_points), np.zeros(model.n_points)
        self.ray: FloatArray | None = None
        self.without_minimum = False
        n, p = model.n_unknowns, model.n_points
        opening, slip = self._gap_matrices()
        self._opening, self._slip = opening, slip
        kn, kt, lift = sp.diags(model.kn), sp.diags(model.kt), sp.diags(model.psi)
        us = slip.T @ kt
        blocks: list[list[Any]] = [
            [us @ slip, None, -us, us],
            [None, kn, None, None],
            [-us.T, None, kt, -kt],
            [us.T, None, -kt, kt],
        ]
        self._quadratic = sp.csc_matrix(sp.bmat(blocks))
        eye = sp.identity(p)
        rows: list[list[Any]] = [
            [opening, eye, -lift, -lift],
            [None, eye, None, None],
            [None, None, eye, None],
            [None, None, None, eye],
        ]
        self._constraint = sp.csc_matrix(sp.bmat(rows))
        self.n, self.p = n, p
        self._accuracy = accuracy
        self.restart()

    def restart(self) -> None:
        """Set the solver up afresh: a programme without minimum leaves its iterate and its step far away."""
        n, p = self.n, self.p
        import osqp  # with all that it imports, for this method alone

        self._solver = osqp.OSQP()
        self._solver.setup(
            sp.triu(self._quadratic, format="csc"),
            np.zeros(n + 3 * p),
            self._constraint,
            np.concatenate([0.0 - self.model.initial_opening, np.zeros(3 * p)]),
            np.full(4 * p, np.inf),
            verbose=False,
            eps_abs=self._accuracy,
            eps_rel=self._accuracy,
            max_iter=10_000,
            polishing=True,
            adaptive_rho_interval=50,
        )

    def _gap_matrices(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """Sparse (P, N) matrices of the openings and slips."""
        model = self.model
        x = model.position[:, None]
        rows = model.rows[model.interface]
        index = model.unknown[model.interface]
        points = np.repeat(np.arange(model.n_points), 6)
        shape = (model.n_points, model.n_unknowns)
        normal = (1.0 - x) * rows[:, 0] + x * rows[:, 1]
        return (
            sp.csr_matrix((normal.ravel(), (points, index.ravel())), shape=shape),
            sp.csr_matrix((rows[:, 2].ravel(), (points, index.ravel())), shape=shape),
        )

    def solve(self, multiplier: float, limit: FloatArray) -> tuple[FloatArray, FloatArray] | None:
        """Displacements (N,) and compressions (P,) under Tresca limits (P,), or None when OSQP finds no minimum."""
        model = self.model
        h = model.history
        load = model.dead + multiplier * model.live
        linear = np.concatenate([self._slip.T @ h - load, np.zeros(self.p), limit - h, limit + h])
        self._solver.update(q=linear)
        result = self._solver.solve(raise_error=False)
        self.programmes += 1
        self.without_minimum = result.info.status == "dual infeasible"
        self.ray = result.dual_inf_cert[: self.n].copy() if self.without_minimum else None
        if result.info.status not in ("solved", "solved inaccurate") or not np.isfinite(result.x).all():
            self.restart()
            return None
        u = result.x[: self.n]
        sliding = result.x[self.n + self.p : self.n + 2 * self.p] - result.x[self.n + 2 * self.p :]
        self.shear = model.kt * (self._slip @ u - sliding) + h
        lifted = model.psi * (result.x[self.n + self.p : self.n + 2 * self.p] + result.x[self.n + 2 * self.p :])
        self.normal = np.maximum(0.0, -model.kn * (self._opening @ u + model.initial_opening - lifted))
        return u, self.normal

    def forces(self, limit: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gap forces N and T (P,) of the last solution, within the limits (P,) that it was found under."""
        borne = limit + self.model.psi * self.normal
        return self.normal, np.clip(self.shear, -borne, borne)


def bracket_collapse(
    model: WallModel,
    first_step: float,
    resolution: float,
    fixed_points: int,
    accuracy: float = 1e-6,
) -> _ConvexResult:
    """March the multiplier up and bisect the step at which the fixed point is lost.

    Args:
        first_step: first step of the multiplier; resolution: width of the bracket at which to stop, relative.
        fixed_points: Tresca iterations in a row that may bring a step no nearer; accuracy: of OSQP.
    """
    programme = _TrescaProgramme(model, accuracy)
    record = PathRecord()
    limit = _settle(programme, 0.0, np.zeros(model.n_points), fixed_points)
    if limit is None:
        rough = model.law.dissipated(np.full(model.n_points, np.abs(model.dead).sum()))
        limit = _settle(programme, 0.0, rough, 2 * fixed_points, _DAMPED)
    if limit is None:
        programme.solve(0.0, rough)
        return _ConvexResult(0.0, None, record, programme.programmes, False, fall=programme.ray)
    forces = programme.forces(limit)
    if not model.assembly.has_live_load:
        return _ConvexResult(0.0, None, record, programme.programmes, True, forces)
    lower, upper, step, at, falls = 0.0, None, first_step, 0.0, np.inf
    growth = np.zeros(model.n_points)
    while upper is None or upper - lower > resolution * max(abs(upper), 1e-6):
        goal = lower + step if upper is None else 0.5 * (lower + upper)
        ahead = np.maximum(limit + (goal - lower) * growth, 0.0)
        settled = _settle(programme, goal, ahead, fixed_points)
        if settled is None:
            settled = _settle(programme, goal, 2.0 * np.maximum(ahead, limit), 2 * fixed_points, _DAMPED)
        if settled is None:
            upper, falls = goal, goal if programme.without_minimum else falls
        else:
            growth = (settled - limit) / (goal - lower)
            lower, limit = goal, settled
            if goal <= _KEPT * first_step or upper is not None:
                forces, at = programme.forces(limit), goal
            record.add(goal, 0.0, 0, 0)
            step *= _LONGER
        if upper is None and lower > _FURTHEST * first_step:
            break
    settles = upper is None or falls <= upper * (1.0 + _LOST)
    fine = upper is None or upper * largest(model.live) >= _FINE * _REPEATED * largest(model.dead)
    return _ConvexResult(
        lower, upper, record, programme.programmes, True, forces, at, settles, fine, repeated=_REPEATED
    )


def _settle(
    programme: _TrescaProgramme,
    multiplier: float,
    limit: FloatArray,
    count: int,
    share: float = 1.0,
) -> FloatArray | None:
    """Friction limits (P,) that repeat at this multiplier, or None; `share` of each change of the limits is taken.

    The iteration ends without them when `count` programmes in a row bring the change of the limits no tenth lower.
    """
    model = programme.model
    scale = load_scale(model, multiplier)
    least, left = np.inf, count
    while left:
        model.deadline.ask()
        answer = programme.solve(multiplier, limit)
        if answer is None or np.abs(answer[0]).max() > _RUNAWAY * scale:
            programme.without_minimum |= answer is not None
            programme.restart()
            return None
        new = model.law.dissipated(answer[1])
        change = float(np.abs(new - limit).max())
        if change < _REPEATED * share * scale:
            return new
        least, left = (change, count) if change < _NEARER * least else (least, left - 1)
        limit = limit + share * (new - limit)
    return None


def bracket_answer(result: _ConvexResult, forces: FloatArray, details: dict[str, Any]) -> Answer:
    """The answer of steps that only know between which two of them the wall lost its equilibrium.

    Args:
        forces: end forces (m, 3) at `result.at`.
    """
    lower, upper = result.lower, result.upper
    path = {"multiplier": list(result.record.multiplier)}
    if upper is None:
        return Answer(
            Status.OK,
            Finding.UNBOUNDED,
            "every step of the live load found equilibrium",
            forces=forces,
            forces_multiplier=result.at,
            iterations=result.programmes,
            path=path,
            details=details | {"path_status": "unbounded"},
        )
    if not (result.settles and result.fine):
        share = f"{result.repeated:g}"
        doubt = (
            f"friction limits that converge to {share} of the loads are not accurate enough for so small a multiplier"
            if result.settles
            else f"at {upper:.6g} the friction limits do not converge, which is no proof of collapse"
        )
        return Answer(
            Status.NOT_CONVERGED,
            Finding.NONE,
            f"equilibrium is found at {lower:.6g} times the live load; {doubt}",
            iterations=result.programmes,
            path=path,
            details=details | {"path_status": "not_converged", "settled_at": lower},
        )
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"equilibrium is found at {lower:.6g} times the live load and none at {upper:.6g}",
        multiplier=0.5 * (lower + upper),
        bracket=(lower, upper),
        bracket_meaning="last step with equilibrium, first step without",
        forces=forces,
        forces_multiplier=result.at,
        flow="approximate",
        iterations=result.programmes,
        path=path,
        details=details | {"path_status": "bracket"},
    )
