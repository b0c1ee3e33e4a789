"""The equilibrium path traced exactly, kink by kink.

In a fixed set of states the response is linear: K du = dlambda live. The path is therefore a chain of straight
pieces; at each kink one gap point changes state, the tangent changes by a rank-one term a b', and the new piece is

    d' = d - y (b'd) / (1 + b'y),   y = K^-1 a,   dlambda' = dlambda sign(1 + b'y),

which keeps the crossed kink function moving into the new cell (Katzenelson, 1965; Eaves and Scarf, 1976): dlambda has
the sign of det K, up to one sign for the whole path, so a path cannot turn back on itself by rounding. A tangent that
turns singular gives the null direction y; when nothing stops the motion along it, it is the collapse mechanism.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.fe.block_lu import MANY
from methods.fe.exact_rates import exact_gap_rates
from methods.fe.factor import Change, Factor, SingularTangent
from methods.fe.gap_law import OPEN, SLIP_PLUS, STICK, gap_forces
from methods.fe.kinks import advance, coming_kinks, live_rate, next_kink, strain_rates
from methods.fe.newton import load_scale
from methods.fe.path_record import PathEnd, PathRecord, Snapshot
from methods.fe.tolerances import (
    BENT,
    BLIND,
    CROOKED,
    DRIFT,
    ELASTIC,
    FAR,
    FREE,
    GLANCE,
    ILL,
    LARGE,
    LOOK,
    LOST,
    NEARLY_FREE,
    NOISE,
    RIGID,
    SINGULAR,
    STEEP,
    TIE,
)
from methods.fe.wall_model import WallModel, point_strains


class Tracer:
    """A point on the path and the straight piece that leads on from it.

    Attributes:
        u, multiplier, state: where the path is; history: (P,) frozen-in shears h.
        direction: (N,) du/dlambda of the present piece; sign: whether lambda grows (+1) or falls (-1) along it.
        orientation: sign times that of the determinant, the same along the whole path.
        a, b, index: the change of state, with which the tangent turned singular at a plateau.
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
    ) -> None:
        self.model = model
        self.factor = factor
        self.u = u.copy()
        self.multiplier = multiplier
        self.history = history
        self.state = state.copy()
        self.sign = 1.0
        self.resting = self.fragile = self.held = False
        self.scale = load_scale(model, multiplier)
        self.last_point, self.last_old = -1, OPEN
        self.worst_residual = 0.0
        self.live_size = float(np.abs(model.live).max())
        p = model.n_points
        self.opening, self.trial = np.empty(p), np.empty(p)
        self.opening_rate, self.trial_rate = np.empty(p), np.empty(p)
        self.a, self.b, self.index = np.zeros(6), np.zeros(6), model.unknown[0]
        self.direction, self.tail = np.zeros_like(u), np.zeros_like(u)
        self.easy = True
        self.first_size = np.inf
        point_strains(model.unknown, model.rows, model.interface, model.position, u, self.opening, self.trial)
        self.trial *= model.kt
        self.trial += history
        self.n_open = int(np.count_nonzero(state == OPEN))
        self.n_slip = int(np.count_nonzero(state >= SLIP_PLUS))
        self.orientation = 0.0
        if factorised:
            self.direction = factor.solve(model.live)
            self.orientation = factor.sign
            self._straighten()
        else:
            self.refresh()
        self.first_size = float(np.abs(self.direction).max())
        self.first_displacement = float(np.abs(u).max()) + 1.0
        self.kept: Snapshot | None = None

    def refresh(self) -> None:
        """Factorise afresh, remove the drift of the gaps and recompute the direction (which keeps its sign)."""
        self._refactor(careful=False)
        if not self._straighten():
            if not self.factor.careful:
                self._refactor(careful=True)
                if self._straighten():
                    return
            self._rest_blindly()

    def _refactor(self, careful: bool) -> None:
        self.factor.refactor(self.state, careful=careful)
        self.orientation = self.orientation or self.factor.sign
        self.sign = self.orientation * self.factor.sign
        residual = self._out_of_balance()
        worst = float(np.abs(residual).max()) / self.scale
        self.worst_residual = max(self.worst_residual, worst)
        for _ in range(2):
            if worst < 1e-14:
                break
            correction = self.factor.solve(residual)
            self.tail[:] = 0.0
            self._rates(correction, self.tail)
            self._advance(correction, 1.0)
            residual = self._out_of_balance()
            previous, worst = worst, float(np.abs(residual).max()) / self.scale
            if worst >= previous:
                self._advance(correction, -1.0)
                break
        if min(worst, self.worst_residual) > LOST:
            raise SingularTangent("the path was lost to rounding")
        self.direction = self.factor.solve(self.model.live)
        self.resting = self.fragile = False

    def _rest_blindly(self) -> None:
        """Take a direction beyond the reach of double precision for the null vector that it is close to."""
        size = float(np.abs(self.direction).max())
        if size <= BLIND * self.first_size:
            return
        velocity = self.direction * (self.sign / size)
        rates = self.opening_rate.copy(), self.trial_rate.copy()
        self._rates(velocity)
        if self.is_mechanism():
            self._rest(velocity)
            self.held = False
        else:
            self.opening_rate[:], self.trial_rate[:] = rates

    def _out_of_balance(self) -> FloatArray:
        return self.model.out_of_balance(self.opening, self.trial, self.state, self.multiplier)

    def _rates(self, direction: FloatArray, tail: FloatArray | None = None) -> None:
        """Gap rates along a direction, in doubled precision when its small part `tail` is given."""
        model = self.model
        kinematics = model.unknown, model.rows, model.interface, model.position
        if tail is not None:
            exact_gap_rates(*kinematics, model.kt, direction, tail, self.opening_rate, self.trial_rate)
            return
        point_strains(*kinematics, direction, self.opening_rate, self.trial_rate)
        self.trial_rate *= model.kt

    def _straighten(self, look: bool = True) -> bool:
        """Measure the gap rates of the direction, and refine it while K d = live is not met. False: it stays bent.

        Without `look` a direction of moderate size is taken to be straight.
        """
        size = float(np.abs(self.direction).max())
        self.easy = size < FREE * self.first_size
        if self.easy:
            self._rates(self.direction)
            if not look:
                return True
        else:
            self.tail[:] = 0.0
            self._rates(self.direction, self.tail)
        previous = np.inf
        for _ in range(4):
            defect = self.model.out_of_balance(self.opening_rate, self.trial_rate, self.state, 1.0, 0.0)
            worst = float(np.abs(defect).max())
            if worst <= BENT * self.live_size:
                return True
            if not worst < 0.5 * previous:
                return worst <= CROOKED * self.live_size
            previous = worst
            correction = self.factor.solve(defect)
            if self.easy:
                self.direction += correction
                self._rates(self.direction)
            else:
                self.tail += correction
                self._rates(self.direction, self.tail)
        return worst <= CROOKED * self.live_size

    def along(self) -> FloatArray:
        """(N,) the velocity along the present piece: the null vector where the tangent is singular."""
        return self.direction if self.resting else self.sign * self.direction

    def settle_on(self, velocity: FloatArray) -> None:
        """Take a velocity (N,) found by other means for the direction of motion at a constant multiplier."""
        scaled = velocity / np.abs(velocity).max()
        self._rates(scaled)
        self._rest(scaled)

    def commit(self) -> FloatArray:
        """The history h = T - kt s (P,) after the present shears are frozen in."""
        model = self.model
        normal, shear = np.empty_like(self.trial), np.empty_like(self.trial)
        gap_forces(self.opening, self.trial, model.kn, model.mu, self.state, normal, shear)
        return shear - (self.trial - self.history)

    def is_mechanism(self, share: float = ELASTIC) -> bool:
        """Whether no force changes along the present piece (rates as last measured, within a share of the fastest)."""
        strain, elastic = strain_rates(self.opening_rate, self.trial_rate, self.model.kt, self.state)
        return elastic <= share * strain

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
            Why the stretch ended. At PLATEAU the tracer holds the singular piece and `along` is the mechanism.
        """
        try:
            while record.events < max_events:
                end = self._piece(record, target, turn, note)
                if end is not None:
                    return end
        except SingularTangent:
            return PathEnd.BREAKDOWN
        return PathEnd.EVENTS

    def _piece(self, record: PathRecord, target: float, turn: float, note: int) -> PathEnd | None:
        """Follow one straight piece and change the state at its end."""
        model = self.model
        velocity = self.along()
        if not self.resting and self.sign < 0.0:
            np.negative(self.opening_rate, out=self.opening_rate)
            np.negative(self.trial_rate, out=self.trial_rate)
        step, point, new = next_kink(
            self.opening,
            self.trial,
            self.opening_rate,
            self.trial_rate,
            model.kn,
            model.mu,
            self.state,
            TIE * self.scale,
            1e-8 if self.resting else 1e-11,
            np.inf if self.easy or self.resting else NOISE * self.live_size,
            self.last_point,
            self.last_old,
        )
        speed = 0.0 if self.resting else self.sign
        if speed > 0.0 and self.multiplier + step >= target and target < np.inf:
            self._advance(velocity, target - self.multiplier)
            self.multiplier = target
            self._note(record, 1)
            return PathEnd.TARGET
        if point < 0:
            if self.is_mechanism():
                return PathEnd.PLATEAU
            if self.resting:
                return PathEnd.BREAKDOWN
            return PathEnd.UNBOUNDED if speed > 0.0 else PathEnd.RUNS_DOWN
        if self._is_collapse(velocity, step):
            return PathEnd.PLATEAU
        self._advance(velocity, step)
        self.multiplier += speed * step
        record.events += 1
        self._note(record, note)
        if self.multiplier < record.peak - turn * max(abs(record.peak), 1e-3):
            return PathEnd.TURNED_DOWN
        self._flip(point, new)
        return None

    def _is_collapse(self, velocity: FloatArray, step: float) -> bool:
        """Whether the piece is a mechanism that goes on so far that the next kink is of no interest.

        Mechanisms that stop earlier are kept: each is an exact collapse state at its multiplier, and the last one
        stands for the plateau when rounding ends the path among displacements of 1e13 times the elastic ones.
        """
        speed = float(np.abs(velocity).max())
        if not self.resting and speed < NEARLY_FREE * self.first_size:
            return False
        size = float(np.abs(self.u).max())
        if step * speed < 1e-3 * size or not self.is_mechanism() or live_rate(self.model.live, velocity) <= 0.0:
            return False
        self.kept = Snapshot(
            self.multiplier, self.opening.copy(), self.trial.copy(), self.state.copy(), velocity / speed
        )
        return step * speed > FAR * size or size > LARGE * self.first_displacement

    def _advance(self, velocity: FloatArray, step: float) -> None:
        advance(self.u, self.opening, self.trial, velocity, self.opening_rate, self.trial_rate, step)

    def _note(self, record: PathRecord, note: int) -> None:
        if self.multiplier > record.peak:
            record.peak = self.multiplier
        elif record.first_limit is None and self.multiplier < record.peak * (1.0 - 1e-9):
            record.first_limit = record.peak
        if record.events % note == 0:
            record.add(self.multiplier, live_rate(self.model.live, self.u), self.n_slip, self.n_open)

    def _flip(self, point: int, new: int) -> None:
        """Change one state, and turn the direction onto the next piece."""
        old = int(self.state[point])
        index, a, b = self.model.change(point, old, new)
        crossing = self._kink_rate(point, old, new)
        if not (self.resting or self.fragile or self.factor.foresees((point, old, new))):
            self.factor.foresee(self._coming((point, old, new)))
        self.state[point] = new
        self.n_open += (new == OPEN) - (old == OPEN)
        self.n_slip += (new >= SLIP_PLUS) - (old >= SLIP_PLUS)
        self.last_point, self.last_old = point, old
        if self.resting and not self.held:
            self.refresh()
            self._orient(index, b, crossing)
            return
        if self.resting or self.fragile:
            self._leave_held(index, a, b, crossing)
            return
        y = self.factor.solve_change((point, old, new))
        along = float(b @ y[index])
        denominator = 1.0 + along
        if abs(denominator) < ILL:
            y = self._hold(index, a, b)
            along = float(b @ y[index])
            denominator = 1.0 + along
            if abs(denominator) < ILL and self._rests(y, along, crossing, abs(denominator)):
                return
        self.fragile = abs(denominator) < ILL
        if self.fragile:
            self.direction -= y * (self.sign * crossing / denominator)
            self.sign *= float(np.sign(denominator))
            self.tail[:] = 0.0
            self._rates(self.direction, self.tail)
            return
        if not 1.0 / STEEP < abs(denominator) < STEEP:
            self.refresh()
            self._orient(index, b, crossing)
        elif self.factor.count >= self.factor.capacity - 1 or self._drifted():
            self.refresh()
        else:
            self.direction -= y * (self.sign * crossing / denominator)
            self.factor.update(y, index, b, denominator)
            self.sign = self.orientation * self.factor.sign
            if not self._straighten(look=self.factor.count % GLANCE == 0):
                if self.factor.count > 1 or not self.factor.careful:
                    self.refresh()
                else:
                    self._rest_blindly()
                self._orient(index, b, crossing)

    def _coming(self, change: Change) -> list[Change]:
        """A change of state, then those that would follow it first if the direction stayed as it is."""
        model = self.model
        points, targets = np.empty(MANY - 1, dtype=np.int64), np.empty(MANY - 1, dtype=np.int64)
        gaps = self.opening, self.trial, self.opening_rate, self.trial_rate
        found = coming_kinks(*gaps, model.kn, model.mu, self.state, points, targets)
        coming = zip(points[:found].tolist(), targets[:found].tolist(), strict=True)
        return [change, *((p, int(self.state[p]), new) for p, new in coming if p != change[0])]

    def _hold(self, index: IntArray, a: FloatArray, b: FloatArray) -> FloatArray:
        """y = K^-1 a again, from a fresh factor of the tangent before the change just made, which is held apart."""
        new = int(self.state[self.last_point])
        self.state[self.last_point] = self.last_old
        self.factor.refactor(self.state)
        self.state[self.last_point] = new
        self.direction = self.factor.solve(self.model.live)
        self.a, self.b, self.index, self.held = a, b, index, True
        return self.factor.solve_sparse(index, a)

    def _drifted(self) -> bool:
        """Whether the out-of-balance force has grown enough to factorise afresh (looked at every few changes)."""
        if self.factor.count % LOOK:
            return False
        return float(np.abs(self._out_of_balance()).max()) > DRIFT * self.scale

    def _kink_rate(self, point: int, old: int, new: int) -> float:
        """b'v of a change of state and the velocity v whose gap rates were last measured."""
        model = self.model
        pressed = model.kn[point] * self.opening_rate[point]
        if OPEN in (old, new):
            return float(pressed)
        slip = new if old == STICK else old
        return float(self.trial_rate[point] + (1.0 if slip == SLIP_PLUS else -1.0) * model.mu[point] * pressed)

    def _orient(self, index: IntArray, b: FloatArray, crossing: float) -> None:
        """Turn a null vector to where it moves the kink function just crossed on into the new cell."""
        if self.resting and float(b @ self.direction[index]) * crossing < 0.0:
            self.direction = -self.direction
            np.negative(self.opening_rate, out=self.opening_rate)
            np.negative(self.trial_rate, out=self.trial_rate)

    def _rests(self, y: FloatArray, along: float, crossing: float, denominator: float) -> bool:
        """Turn onto the null vector y when the new tangent is singular: the multiplier rests while the wall moves."""
        velocity = y * (np.sign(crossing) * np.sign(along) / np.abs(y).max())
        self._null_rates(velocity)
        if denominator > SINGULAR and not self.is_mechanism(RIGID):
            return False
        self._rest(velocity)
        return True

    def _null_rates(self, velocity: FloatArray) -> None:
        """Gap rates along a null vector in doubled precision, refined by the regular tangent that the factor holds."""
        self.tail[:] = 0.0
        self._rates(velocity, self.tail)
        for _ in range(2):
            defect = self.model.out_of_balance(self.opening_rate, self.trial_rate, self.state, 0.0, 0.0)
            self.tail += self.factor.solve(defect)
            self._rates(velocity, self.tail)

    def _rest(self, velocity: FloatArray) -> None:
        """Move along a null vector whose gap rates have just been measured; a mechanism changes no force at all."""
        self.resting, self.fragile = True, False
        self.direction = velocity
        if self.is_mechanism():
            self.opening_rate[self.state != OPEN] = 0.0
            self.trial_rate[self.state == STICK] = 0.0

    def _leave_held(self, index: IntArray, a: FloatArray, b: FloatArray, crossing: float) -> None:
        """Turn onto the next piece from a singular or fragile one, whose change (a1, b1) the factor does not hold yet.

        K + a1 b1' + a b' is singular when the matrix S = [[1 + b1'y1, b1'y], [b'y1, 1 + b'y]] is; with S c = 0 its
        null vector is c1 y1 + c2 y, and K + a b' is its regular neighbour.
        """
        first = self.factor.solve_sparse(self.index, self.a)
        y = self.factor.solve_sparse(index, a)
        held, reach = 1.0 + float(self.b @ first[self.index]), float(self.b @ y[self.index])
        back, denominator = float(b @ first[index]), 1.0 + float(b @ y[index])
        determinant = abs(held * denominator - reach * back)
        bound = 1.0 + abs(reach * back)
        if determinant < 1e-8 * bound and abs(denominator) > ILL and abs(back) > ILL:
            null = first * (denominator / back) - y
            velocity = null * (np.sign(crossing) / np.abs(null).max())
            self._null_rates(velocity)
            if determinant < SINGULAR * bound or self.is_mechanism(RIGID):
                self._rest(velocity)
                self.factor.update(y, index, b, denominator)
                return
        if abs(denominator) < ILL and abs(reach) < ILL:
            y = self._hold(index, a, b)
            along = float(b @ y[index])
            if self._rests(y, along, crossing, abs(1.0 + along)):
                return
            self.refresh()
        elif not self._change_both(index, b, y, first, denominator, back):
            self.refresh()
        self._orient(index, b, crossing)

    def _change_both(
        self, index: IntArray, b: FloatArray, y: FloatArray, first: FloatArray, denominator: float, back: float
    ) -> bool:
        """Update the factor by the change (a, b) and then by the held one; False where that would cost digits."""
        if self.factor.count > self.factor.capacity - 3 or not 1.0 / STEEP < abs(denominator) < STEEP:
            return False
        held = first - y * (back / denominator)
        remaining = 1.0 + float(self.b @ held[self.index])
        if not 1.0 / STEEP < abs(remaining) < STEEP:
            return False
        self.factor.update(y, index, b, denominator)
        self.factor.update(held, self.index, self.b, remaining)
        self.direction = self.factor.solve(self.model.live)
        self.sign = self.orientation * self.factor.sign
        self.resting = self.fragile = False
        return self._straighten()
