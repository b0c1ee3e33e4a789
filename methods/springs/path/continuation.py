"""The equilibrium path traced exactly, breakpoint by breakpoint (Katzenelson 1965; Eaves and Scarf 1976).

In a fixed set of states the response is linear, K v = l fL, and the path is a chain of straight pieces; at each
breakpoint one gap point changes its state and the direction is updated (`direction.py`). A piece at constant multiplier
that no breakpoint ends, K v = 0 with fL.v > 0, is the collapse mechanism.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import COLUMNS
from methods.numerics.joint_loops import shear_limit
from methods.numerics.vectors import largest
from methods.springs.model.breaking import joints_at_strength
from methods.springs.model.factor import Change, Factor, SingularTangent
from methods.springs.model.gap_law import OPEN, SLIP_PLUS, STICK, gap_forces, slip_compression
from methods.springs.model.wall_model import WallModel, load_scale
from methods.springs.path.breakpoints import advance, coming_breakpoints, live_rate, next_breakpoint, strain_rates
from methods.springs.path.direction import PathDirection
from methods.springs.path.path_record import PathEnd, PathRecord, PathSnapshot, PathStep
from methods.springs.path.plateau import worst_residual
from methods.springs.rest.newton import Equilibrium

_RATE = 1e-11
"""Rates of breakpoint functions below this share of the fastest gap rate count as zero."""
_SOFT_RATE = 1e-7
"""The same on pieces with pins, as forces over a motion as long as the displacements so far."""
_BALANCE_EVERY = 8
"""Rank-one changes of a factor between two looks at the out-of-balance force."""
_REMOVED = 1e-9
"""Out-of-balance force, as a share of the load scale, above which equilibrium is found again."""
_ROUNDING = 1e-14
"""The same below which there is nothing to correct."""
_CORRECTIONS = 2
"""Steps of a correction at most."""
_LOST = 1e-5
"""Out-of-balance force at which the path counts as lost."""
_LEAST_MOTION = 1e-3
"""Share of the present displacement by which a mechanism moves before its next breakpoint, to be looked at."""
_FAR = 1e4
"""Multiple of the present displacement that a mechanism moves before its next breakpoint as the collapse."""
_GROWTH = 1.1
"""Of the displacements from one check to the next."""
_CONFIRMED = 1e10
"""Displacements, in multiples of the first, at which a mechanism that passes its check is the collapse."""


class PathFollower:
    """A point on the path and the straight piece that leads on from it.

    Attributes:
        u, multiplier, state: where the path is; history: (P,) frozen-in shears h.
        opening, trial: (P,) g and tau there; largest: the largest displacement.
        direction: of the present piece.
        certificate: largest residual of a mechanism that ends the path; options: of the model.
        kept: the last mechanism on the way that is an exact collapse state but for rounding; kept_holds: whether its
            residuals pass the certificate; looked_at: the extent where they were last looked at.
    """

    def __init__(
        self,
        model: WallModel,
        factor: Factor,
        u: FloatArray,
        multiplier: float,
        history: FloatArray,
        state: IntArray,
        factorised: bool = False,
        certificate: float | None = None,
    ) -> None:
        self.model = model
        self.factor = factor
        self.options = model.options
        self.certificate = self.options.collapse.certificate if certificate is None else certificate
        self.u = u.copy()
        self.multiplier = multiplier
        self.history = history
        self.state = state.copy()
        self.scale = load_scale(model, multiplier)
        self.last_point, self.last_old = -1, OPEN
        self.worst_residual = 0.0
        self.opening, self.trial = model.strains(u)
        self.trial *= model.kt
        self.trial += history
        self.n_open = int(np.count_nonzero(state == OPEN))
        self.n_slip = int(np.count_nonzero(state >= SLIP_PLUS))
        self.largest = largest(self.u)
        self.first_displacement = self.largest + 1.0 + largest(model.initial_opening)
        self.kept: PathSnapshot | None = None
        self.kept_holds, self.looked_at = False, 0.0
        self.turns: set[tuple[int, int, float]] = set()
        self.direction = PathDirection(model, factor)
        if factorised:
            self.direction.solve_first(self.state)
        else:
            self.refresh()

    @classmethod
    def from_rest(
        cls, model: WallModel, factor: Factor, rest: Equilibrium, certificate: float | None = None
    ) -> PathFollower:
        """The path that goes on from a state of equilibrium."""
        return cls(model, factor, rest.u, rest.multiplier, rest.history, rest.state, certificate=certificate)

    @classmethod
    def from_forces(
        cls, model: WallModel, factor: Factor, multiplier: float, forces: FloatArray, certificate: float | None = None
    ) -> PathFollower:
        """The path from contact forces as they stand, instead of from gravity; gap points at the ends of interfaces.

        Forces in equilibrium within yield, whatever found them, are what the springs carry while nothing has moved yet.
        From there the wall is led to a mechanism like any other. Joints of dry stone carry some such forces that nobody
        knows.

        Args:
            model: the wall; factor: its tangent.
            multiplier: of the live load that the forces are in equilibrium with.
            forces: (m, 3) end forces n1, n2, s [force] within yield; the shear is shared out as the compression is.
            certificate: largest residual of a mechanism that ends the path; None for that of the options.
        """
        ends = np.maximum(forces[:, :2] / model.force, model.options.breakpoints.force)
        share = (forces[:, 2] / model.force / ends.sum(axis=1))[model.interface]
        normal = np.where(model.position == 0.0, ends[model.interface, 0], ends[model.interface, 1])
        loaded = replace(model, initial_opening=-normal / model.kn)
        u, state = np.zeros(model.n_unknowns), np.full(model.n_points, STICK)
        return cls(loaded, factor, u, multiplier, -share * normal, state, certificate=certificate)

    @property
    def extent(self) -> float:
        """The largest displacement so far (dimensionless, never zero)."""
        return max(self.largest, self.first_displacement)

    def present(self) -> PathSnapshot:
        """The point and the velocity along the present piece."""
        return PathSnapshot(self.multiplier, self.opening, self.trial, self.state, self.direction.velocity)

    def load_step(self) -> PathStep:
        """The point, kept whole."""
        return PathStep(self.multiplier, self.u.copy(), self.opening.copy(), self.trial.copy(), self.state.copy())

    def may_commit(self) -> bool:
        """Whether a commit changes anything, and the factor is that of the tangent itself."""
        return self.n_slip > 0 and not (self.direction.bordered or self.model.dilates)

    def refresh(self, crossed: tuple[Change, float] | None = None) -> None:
        """Factorise afresh, solve for the direction again, on over the breakpoint crossed, and remove the drift."""
        self.direction.solve_anew(self.state, self.extent, crossed)
        self._remove_drift()

    def _remove_drift(self) -> None:
        """Bring the gaps back into equilibrium, along no soft piece; the rates are measured again where they move.

        Raises:
            SingularTangent: they stay out of it.
        """
        residual = self._out_of_balance()
        worst = largest(residual) / self.scale
        self.worst_residual = max(self.worst_residual, worst)
        moved = False
        for _ in range(_CORRECTIONS):
            if worst < _ROUNDING:
                break
            correction, rate = self.direction.balance(residual)
            self.direction.rates(correction, np.zeros_like(correction))
            moved = True
            self._advance(correction, rate, 1.0)
            residual = self._out_of_balance()
            previous, worst = worst, largest(residual) / self.scale
            if worst >= previous:
                self._advance(correction, rate, -1.0)
                break
        if moved:
            self.direction.measure()
        if min(worst, self.worst_residual) > _LOST:
            raise SingularTangent("the path was lost to rounding")

    def _out_of_balance(self) -> FloatArray:
        return self.model.out_of_balance(self.opening, self.trial, self.state, self.multiplier)

    def at_strength(self) -> IntArray:
        """The brittle joints (k,) that have reached their strength here."""
        within = self.options.breakpoints.broken * self.scale
        return joints_at_strength(self.model, self.opening, self.trial, self.state, within)

    def commit(self) -> FloatArray:
        """The history h = T - kt s (P,) after the present shears are frozen in; that of before where slips lift."""
        model = self.model
        if model.dilates:
            return self.history
        normal, shear = np.empty_like(self.trial), np.empty_like(self.trial)
        gap_forces(self.opening, self.trial, model.kn, model.mu, model.lift, self.state, normal, shear)
        return model.updated(shear - (self.trial - self.history), self.history)

    def is_mechanism(self) -> bool:
        """Whether no force changes along the present piece (rates of forces negligible beside the fastest)."""
        way = self.direction
        strain, elastic = strain_rates(way.opening_rate, way.trial_rate, self.model.kt, self.model.lift, self.state)
        return elastic <= self.options.elastic * strain

    def _goes_on(self) -> bool:
        """Whether a piece that rises stays in equilibrium as far as a mechanism moves that is the collapse.

        The states are those of the displacements there, not those of the piece, on which rates that are rounding of a
        soft motion do not count.
        """
        model, way = self.model, self.direction
        if way.speed <= 0.0:
            return False
        reach = _FAR * max(abs(self.multiplier) / way.speed, self.extent / largest(way.velocity))
        u, multiplier = self.u + reach * way.velocity, self.multiplier + reach * way.speed
        residual = model.residual(u, multiplier, self.history, model.states(u, self.history))
        return largest(residual) <= _LOST * load_scale(model, multiplier)

    def run(
        self, record: PathRecord, max_events: int, target: float = np.inf, turn: float = np.inf, note: int = 1
    ) -> PathEnd:
        """Follow the path.

        Args:
            record: receives every `note`-th point of the path.
            max_events: changes of state after which the tracing is given up.
            target: multiplier at which to stop when it is passed upwards.
            turn: share of the peak by which the path may fall before it is reported as turned down.

        Returns:
            Why the stretch ended. At PLATEAU the velocity of `direction` is the mechanism; at BROKEN a brittle joint
            has reached its strength.
        """
        if self.model.assembly.breaks and len(self.at_strength()):
            return PathEnd.BROKEN
        try:
            while record.events < max_events:
                self.model.deadline.ask()
                end = self._piece(record, target, turn, note)
                if end is not None:
                    return end
        except SingularTangent:
            return PathEnd.BREAKDOWN
        return PathEnd.EVENTS

    def _piece(self, record: PathRecord, target: float, turn: float, note: int) -> PathEnd | None:
        """Follow one straight piece and change the state at its end."""
        model, way = self.model, self.direction
        step, point, new = next_breakpoint(
            self.opening,
            self.trial,
            way.opening_rate,
            way.trial_rate,
            model.kn,
            model.mu,
            model.lift,
            self.state,
            self.options.breakpoints.force * self.scale,
            _RATE,
            _SOFT_RATE * self.scale / self.extent if way.bordered else np.inf,
            self.last_point,
            self.last_old,
        )
        reach = (target - self.multiplier) / way.speed if way.speed > 0.0 and target < np.inf else np.inf
        ahead = min(step, reach)
        if self._is_collapse(ahead):
            return PathEnd.PLATEAU
        if ahead == np.inf:
            if self.is_mechanism():
                return PathEnd.PLATEAU
            if way.bordered and not self._goes_on():
                return PathEnd.BREAKDOWN
            return PathEnd.UNBOUNDED if way.speed > 0.0 else PathEnd.RUNS_DOWN
        if reach <= step:
            self._advance(way.velocity, way.speed, reach)
            self.multiplier = target
            self._note(record, 1)
            return PathEnd.TARGET
        self._advance(way.velocity, way.speed, step)
        if model.assembly.breaks and len(self.at_strength()):
            return PathEnd.BROKEN
        record.events += 1
        self._note(record, note, (point, int(self.state[point]), new))
        if self.multiplier < record.peak - turn * max(abs(record.peak), 1e-3):
            return PathEnd.TURNED_DOWN
        rising = way.speed > 0.0
        self._flip(point, new)
        return PathEnd.TURNED_DOWN if rising and way.speed < 0.0 and self._turned_before() else None

    def _turned_before(self) -> bool:
        """Whether the path turned down here before: from a commit, where many breakpoints meet, it may loop."""
        turn = self.last_point, self.last_old, float(f"{self.multiplier:.11g}")
        known = turn in self.turns
        self.turns.add(turn)
        return known

    def _is_collapse(self, step: float) -> bool:
        """Whether the piece is a mechanism that goes on so far that the next breakpoint is of no interest.

        No gap may close on it. Mechanisms that stop earlier are kept: each is an exact collapse state at its
        multiplier, and the last one that passes its check stands for the plateau when rounding ends the path. Among
        displacements of 1e10 times the elastic ones it is the plateau.
        """
        model, way = self.model, self.direction
        if not way.bordered:
            return False
        size, fastest = self.extent, largest(way.velocity)
        ahead = step * fastest
        if ahead < _LEAST_MOTION * size or not self.is_mechanism() or live_rate(model.live, way.velocity) <= 0.0:
            return False
        parting = way.opening_rate - model.lift * abs(way.trial_rate)
        if parting[self.state == OPEN].min(initial=0.0) < -self.options.elastic * fastest:
            return False
        if ahead > _FAR * size:
            return True
        if size < _GROWTH * self.looked_at:
            return False
        self.looked_at = size
        holds = worst_residual(model, self.present()) <= self.certificate
        if holds or not self.kept_holds:
            self.kept, self.kept_holds = deepcopy(self.present()), holds
        return holds and size > _CONFIRMED * self.first_displacement

    def _advance(self, velocity: FloatArray, speed: float, step: float) -> None:
        way = self.direction
        gaps = self.opening, self.trial, way.opening_rate, way.trial_rate
        self.largest = advance(self.u, velocity, *gaps, step)
        self.multiplier += speed * step

    def _note(self, record: PathRecord, note: int, change: Change | None = None) -> None:
        if self.multiplier > record.peak:
            record.peak = self.multiplier
        elif record.first_limit is None and self.multiplier < record.peak * (1.0 - 1e-9):
            record.first_limit = record.peak
        if record.events % note == 0:
            bars = self.model.bar_tensions(self.trial)
            of_joint = None if change is None else (self.model.interface_of(change[0]), *change[1:])
            record.add(self.multiplier, live_rate(self.model.live, self.u), self.n_slip, self.n_open, bars, of_joint)
        record.keep(self.load_step)

    def _flip(self, point: int, new: int) -> None:
        """Change one state, and turn onto the next piece."""
        old = int(self.state[point])
        change, crossing = (point, old, new), self._breakpoint_rate(point, old, new)
        if not self.factor.foresees(change):
            self.factor.foresee(self._coming(change))
        self.state[point] = new
        self.n_open += (new == OPEN) - (old == OPEN)
        self.n_slip += (new >= SLIP_PLUS) - (old >= SLIP_PLUS)
        self.last_point, self.last_old = point, old
        if not self.direction.update(change, crossing, self.state, self.extent):
            self.refresh((change, crossing))
        elif self._drifted():
            self._remove_drift()

    def _coming(self, change: Change) -> list[Change]:
        """A change of state, then those that would follow it first if the direction stayed as it is."""
        model, way = self.model, self.direction
        points, targets = np.empty(COLUMNS - 1, dtype=np.int64), np.empty(COLUMNS - 1, dtype=np.int64)
        gaps = self.opening, self.trial, way.opening_rate, way.trial_rate
        found = coming_breakpoints(*gaps, model.kn, model.mu, model.lift, self.state, points, targets)
        coming = zip(points[:found].tolist(), targets[:found].tolist(), strict=True)
        return [change, *((p, int(self.state[p]), new) for p, new in coming if p != change[0])]

    def _drifted(self) -> bool:
        """Whether the out-of-balance force has grown enough to factorise afresh (looked at every few changes)."""
        if self.factor.count % _BALANCE_EVERY:
            return False
        return largest(self._out_of_balance()) > _REMOVED * self.scale

    def _breakpoint_rate(self, point: int, old: int, new: int) -> float:
        """b'v of a change of state and the velocity v of the present piece."""
        model, way = self.model, self.direction
        slip = old if new in (OPEN, STICK) else new
        kn, mu, opening, trial = model.kn[point], model.mu[point], way.opening_rate[point], way.trial_rate[point]
        if OPEN in (old, new):
            sign = 1.0 if slip == SLIP_PLUS else -1.0
            return float(-slip_compression(opening, trial, kn, mu, model.lift[point], sign))
        limit = shear_limit(mu, kn * opening)
        return float(trial + (limit if slip == SLIP_PLUS else -limit))
