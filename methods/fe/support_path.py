"""The path of a wall whose supports move: the reaction against a displacement that is imposed step by step.

The displacement d of the supports strains the joints on them by d q while the free blocks rest, so it enters the gaps
of their points: g = C u + d q, and K v = -(internal forces of q) along a piece of the path. The law of the gaps is that
of `fe` without updates of the plastic slip, so that a state of equilibrium depends on d alone and not on the steps to
it. In small displacements the wall becomes a mechanism that the supports drive; from there on no force changes, and the
reaction is that of the support that gives way, or that pushes where the displacement is imposed backwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.followed import SupportPath, path_answer
from harness.model.method import Answer, Solver
from harness.model.result import fastest_vertex
from methods.fe.settings import GapSpringsSettings, SupportPathSettings
from methods.springs.model.factor import Factor, SingularTangent, make_factor, refactor_any
from methods.springs.model.gap_law import OPEN, SLIP_PLUS
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel, build_model, load_scale
from methods.springs.path.breakpoints import next_breakpoint, strain_rates
from methods.springs.rest.equilibrium import equilibrium, gravity_state
from methods.springs.rest.newton import Equilibrium

_FIRST = 0.05
"""Step, in displacements of a gap spring under the mean weight of a block: the wall is still elastic then."""
_LONGER = 1.3
"""Factor on the next step."""
_STEADY = 10.0
"""Multiple of the displacement of a mechanism, or of the largest gap or slip at rest if that is more, up to which the
reaction has to stay the same where gaps still change their states on it."""
_SAME = 1e-7
"""To this share of the dead load, a hundred times what equilibria that are found by relaxation leave out of balance."""
_NOISE = 1e-9
"""Gap rates below this share of the speed of the supports count as zero on the plateau, as do rates of breakpoint
functions below this share of the fastest gap rate: the tangent is solved to 1e-12 or so of them."""


@dataclass(frozen=True, eq=False)
class _ImposedMotion:
    """What a unit displacement of the supports does to the gaps (P,): openings, and slips times kt."""

    model: WallModel
    opening: FloatArray
    trial: FloatArray

    @classmethod
    def of(cls, model: WallModel, sense: float) -> _ImposedMotion:
        assembly = model.assembly
        strains = sense * assembly.support_strains / fastest_vertex(assembly, assembly.support_motion)
        joint, along = model.interface[: model.n_contacts], model.position[: model.n_contacts]
        opening = (1.0 - along) * strains[joint, 0] + along * strains[joint, 1]
        slip = np.concatenate([strains[joint, 2], strains[model.cohesive, 2]])
        return cls(model, np.concatenate([opening, np.zeros(len(model.cohesive))]), model.kt * slip)

    def at(self, displacement: float) -> WallModel:
        """The wall with its supports displaced."""
        return replace(self.model, initial_opening=self.model.initial_opening + displacement * self.opening)

    def history(self, start: FloatArray, displacement: float) -> FloatArray:
        """The history h (P,) with which the slips of the supports count."""
        return start + displacement * self.trial


def support_path(
    assembly: Assembly,
    gives_way: bool,
    settings: GapSpringsSettings,
    most: int = 80,
) -> SupportPath | str:
    """Impose the motion of the supports from rest under the dead load until the reaction is constant.

    Args:
        assembly: with `support_motion`, without ties, props and compressive strength.
        gives_way: whether the supports move as prescribed; else backwards.
        settings: of the springs.
        most: steps of the displacement. A plateau that is not reached at `_LONGER` to the power of 80 first steps, some
            1e9 times the elastic displacement, is beyond the digits of the gaps.

    Returns:
        The path, or why there is none.

    Raises:
        ValueError: no block can move.
    """
    model = build_model(assembly, settings)
    factor = make_factor(model)
    gravity = gravity_state(model, factor)
    if not gravity.found:
        return "The gap springs find no equilibrium under the dead load."
    imposed = _ImposedMotion.of(model, 1.0 if gives_way else -1.0)
    points, last, reason = _followed(imposed, factor, gravity, most)
    if last is None:
        return _path(points, None, None, reason)
    return _path(points, last.mechanism(gives_way), last.point.displacement - last.length_behind(_NOISE), "")


def _followed(
    imposed: _ImposedMotion, factor: Factor, gravity: Equilibrium, most: int
) -> tuple[list[_ImposedPoint], _Piece | None, str]:
    """The points up to the plateau, the mechanism there, and why there is none where that is None."""
    model, kept, step = imposed.model, 0, _FIRST
    assembly = model.assembly
    same = _SAME * assembly.force_scale * fastest_vertex(assembly, assembly.support_motion)
    points, last = [_ImposedPoint(0.0, model, gravity)], None
    largest = points[0].largest_strain
    for _ in range(most):
        point = _imposed(imposed, factor, gravity, points[-1], step)
        if not point.rest.found:
            place = point.displacement * model.displacement
            return points, None, f"No equilibrium was found at the displacement {place:.6g}."
        points.append(point)
        if last is not None and abs(point.reaction - last.point.reaction) > same:
            last = None
        piece = _Piece.at(imposed, factor, point)
        if piece is None or not piece.is_mechanism():
            piece = _Piece.between(imposed, points[-2], point)
        if piece.is_mechanism() and piece.is_last(_NOISE):
            return points, piece, ""
        if piece.is_mechanism() and last is None:
            last, kept = piece, len(points)
        if last is not None and point.displacement > _STEADY * max(largest, last.point.displacement):
            return points[:kept], last, ""
        step *= _LONGER
    return points, None, f"The reaction still changes after {most} steps."


@dataclass(frozen=True, eq=False)
class _ImposedPoint:
    """The wall with its supports displaced (dimensionless), in equilibrium."""

    displacement: float
    model: WallModel
    rest: Equilibrium

    @property
    def forces(self) -> FloatArray:
        """(m, 3) contact forces [force]."""
        rest = self.rest
        return self.model.end_forces(*self.model.forces(rest.u, rest.history, rest.state))

    @property
    def largest_strain(self) -> float:
        """The largest opening, overlap or slip of a gap: slips that turn back first go back as far."""
        opening, slip = self.model.strains(self.rest.u)
        return float(max(abs(opening).max(), abs(slip + self.rest.history / self.model.kt).max()))

    @property
    def reaction(self) -> float:
        """Work of the contact forces on the prescribed motion."""
        return float((self.model.assembly.support_strains * self.forces).sum())


def _imposed(
    imposed: _ImposedMotion, factor: Factor, gravity: Equilibrium, last: _ImposedPoint, step: float
) -> _ImposedPoint:
    """The point one step further, which may not be in equilibrium."""
    displacement = last.displacement + step
    moved, history = imposed.at(displacement), imposed.history(gravity.history, displacement)
    return _ImposedPoint(displacement, moved, equilibrium(moved, factor, last.rest.u, 0.0, history))


@dataclass(frozen=True, eq=False)
class _Piece:
    """A straight piece of the path: gaps (P,), their rates by the displacement, and the velocity (N,) of the wall."""

    point: _ImposedPoint
    gaps: tuple[FloatArray, FloatArray]
    rates: tuple[FloatArray, FloatArray]
    velocity: FloatArray

    @classmethod
    def at(cls, imposed: _ImposedMotion, factor: Factor, point: _ImposedPoint) -> _Piece | None:
        """The piece on which a point lies, None where the wall moves on it while the supports rest."""
        model, rest = point.model, point.rest
        pull = model.out_of_balance(imposed.opening, imposed.trial, rest.state, 0.0, dead=0.0)
        try:
            refactor_any(factor, rest.state)
            velocity = factor.solve(pull)
            if factor.is_regularised:  # refined until none of the pull is borne by the regularisation
                tangent = model.tangent(rest.state)
                for _ in range(model.options.collapse.rounds):
                    velocity += factor.solve(pull - tangent @ velocity)
        except SingularTangent:
            return None
        return cls.along(imposed, point, velocity)

    @classmethod
    def between(cls, imposed: _ImposedMotion, last: _ImposedPoint, point: _ImposedPoint) -> _Piece:
        """The chord from the last point: where several motions have no stiffness the tangent does not choose."""
        step = point.displacement - last.displacement
        return cls.along(imposed, point, (point.rest.u - last.rest.u) / step)

    @classmethod
    def along(cls, imposed: _ImposedMotion, point: _ImposedPoint, velocity: FloatArray) -> _Piece:
        """The piece through a point along a velocity (N,)."""
        model, rest = point.model, point.rest
        opening_rate, slip_rate = np.empty(model.n_points), np.empty(model.n_points)
        point_strains(model.unknown, model.rows, model.interface, model.position, velocity, opening_rate, slip_rate)
        rates = opening_rate + imposed.opening, model.kt * slip_rate + imposed.trial
        opening, slip = model.strains(rest.u)
        return cls(point, (opening, model.kt * slip + rest.history), rates, velocity)

    def is_mechanism(self) -> bool:
        """Whether no force changes along it, no gap closes, and no slip goes back, from where it would stick again."""
        model, state = self.point.model, self.point.rest.state
        strain, elastic = strain_rates(*self.rates, model.kt, model.lift, state)
        fastest = max(strain, 1.0)  # the speed of the supports: where the wall goes with them nothing strains
        rounding = model.options.elastic * fastest
        parting = self.rates[0] - model.lift * abs(self.rates[1])
        onward = np.where(state == SLIP_PLUS, 1.0, -1.0) * self.rates[1] / model.kt
        least = min(parting[state == OPEN].min(initial=0.0), onward[state >= SLIP_PLUS].min(initial=0.0))
        return elastic <= rounding and bool(least >= -rounding)

    def is_last(self, noise: float) -> bool:
        """Whether no gap changes its state ahead."""
        return self._length(1.0, noise) == np.inf

    def length_behind(self, noise: float) -> float:
        """How far the piece reaches back, not beyond the point of rest under the dead load."""
        return min(self._length(-1.0, noise), self.point.displacement)

    def _length(self, way: float, noise: float) -> float:
        """Displacement up to the next breakpoint ahead (1) or behind (-1)."""
        model, state = self.point.model, self.point.rest.state
        opening_rate, trial_rate = (np.where(abs(rate) > noise, way * rate, 0.0) for rate in self.rates)
        near = model.options.breakpoints.force * load_scale(model, 0.0)
        return next_breakpoint(
            *self.gaps, opening_rate, trial_rate, model.kn, model.mu, model.lift, state, near, noise, np.inf, -1, OPEN
        )[0]

    def mechanism(self, gives_way: bool) -> FloatArray:
        """(n, 3) motion of all blocks along it, with the supports as prescribed or backwards."""
        model = self.point.model
        prescribed = model.assembly.support_motion
        motion = model.block_displacements(self.velocity)
        motion *= fastest_vertex(model.assembly, prescribed) / model.displacement
        return motion + (prescribed if gives_way else -prescribed)


def _path(
    points: list[_ImposedPoint], mechanism: FloatArray | None, constant_from: float | None, reason: str
) -> SupportPath:
    """The path through some points, the last of which is its end."""
    model = points[0].model
    states = [point.rest.state for point in points]
    return SupportPath(
        displacement=np.array([point.displacement for point in points]) * model.displacement,
        reaction=np.array([point.reaction for point in points]),
        slipping=np.array([np.count_nonzero(state >= SLIP_PLUS) for state in states]),
        opened=np.array([np.count_nonzero(state == OPEN) for state in states]),
        forces=points[-1].forces,
        mechanism=mechanism,
        constant_from=None if constant_from is None else constant_from * model.displacement,
        reason=reason,
    )


class ReactionPaths(Solver):
    """The reaction of supports against the displacement that is imposed on them (`fe-reaction`)."""

    def solve(self, assembly: Assembly, settings: SupportPathSettings) -> Answer:
        """The path, as details; the forces are those at its end."""
        return path_answer(support_path(assembly, settings.gives_way, settings))
