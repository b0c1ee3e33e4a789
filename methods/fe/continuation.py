"""The equilibrium path traced exactly, kink by kink.

In a fixed set of states the response is linear: K du = dlambda live. The path is therefore a chain of straight
pieces; at each kink one gap point changes state, the tangent changes by a rank-one term a b', and the new piece is

    d' = d - y (b'd) / (1 + b'y),   y = K^-1 a,   dlambda' = dlambda sign(1 + b'y),

which keeps the crossed kink function moving into the new cell (Katzenelson, 1965; Eaves and Scarf, 1976). A tangent
that turns singular gives the null direction y; when nothing stops the motion along it, it is the collapse mechanism.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.fe.factor import Factor, SingularTangent
from methods.fe.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, flip_vectors
from methods.fe.kinks import next_kink
from methods.fe.newton import load_scale
from methods.fe.wall_model import WallModel, point_strains

ILL = 1e-7
"""|1 + b'y| below which the tangent counts as nearly singular: the piece is followed, then factorised afresh."""
TIE = 1e-12
"""How far a kink may be overrun by the choice among near ties (share of the load scale)."""
ELASTIC = 1e-8
"""Elastic force rates below this share of the strain rates count as zero: the direction is a mechanism."""


class PathEnd(StrEnum):
    """Why a stretch of path ended."""

    TARGET = "target"
    PLATEAU = "plateau"
    UNBOUNDED = "unbounded"
    RUNS_DOWN = "runs_down"
    TURNED_DOWN = "turned_down"
    EVENTS = "events"
    BREAKDOWN = "breakdown"


@dataclass
class PathRecord:
    """Multiplier against live displacement, with the limit points passed."""

    multiplier: list[float] = field(default_factory=list)
    displacement: list[float] = field(default_factory=list)
    slipping: list[int] = field(default_factory=list)
    open: list[int] = field(default_factory=list)
    peak: float = -np.inf
    peak_displacements: FloatArray | None = None
    first_limit: float | None = None
    events: int = 0

    def add(self, multiplier: float, displacement: float, slipping: int, n_open: int) -> None:
        """Append one point of the path."""
        self.multiplier.append(multiplier)
        self.displacement.append(displacement)
        self.slipping.append(slipping)
        self.open.append(n_open)


class Tracer:
    """A point on the path and the straight piece that leads on from it.

    Attributes:
        u, multiplier, state: where the path is; history: (P,) frozen-in shears h.
        direction: (N,) du/dlambda of the present piece; sign: whether lambda grows (+1), falls (-1) or rests (0).
        flip: (a, b, index) of the last change of state, with which the tangent turned singular at a plateau.
    """

    def __init__(
        self, model: WallModel, factor: Factor, u: FloatArray, multiplier: float, history: FloatArray, state: IntArray
    ) -> None:
        self.model = model
        self.factor = factor
        self.u = u.copy()
        self.multiplier = multiplier
        self.history = history
        self.state = state.copy()
        self.sign = 1.0
        self.ill = False
        self.scale = load_scale(model, multiplier)
        self.last_point, self.last_old = -1, OPEN
        self.worst_residual = 0.0
        p = model.n_points
        self.opening, self.trial = np.empty(p), np.empty(p)
        self.opening_rate, self.trial_rate = np.empty(p), np.empty(p)
        self._a, self._b = np.empty(6), np.empty(6)
        self.a, self.b, self.index = self._a, self._b, model.unknown[0]
        self.n_open = int(np.count_nonzero(state == OPEN))
        self.n_slip = int(np.count_nonzero(state >= SLIP_PLUS))
        self._refresh()

    def _refresh(self) -> None:
        """Factorise afresh, remove the drift of u and recompute the direction (which keeps its sign)."""
        self.factor.refactor(self.state)
        residual = self.model.residual(self.u, self.multiplier, self.history, self.state)
        self.worst_residual = max(self.worst_residual, float(np.abs(residual).max()) / self.scale)
        correction = self.factor.solve(residual)
        if np.abs(correction).max() <= 1e-6 * (1.0 + np.abs(self.u).max()):
            self.u += correction
        self._measure_gaps()
        self.direction = self.factor.solve(self.model.live)
        self.ill = False

    def _measure_gaps(self) -> None:
        model = self.model
        point_strains(model.unknown, model.rows, model.interface, model.position, self.u, self.opening, self.trial)
        self.trial *= model.kt
        self.trial += self.history

    def _rates(self, direction: FloatArray) -> None:
        model = self.model
        point_strains(
            model.unknown, model.rows, model.interface, model.position, direction, self.opening_rate, self.trial_rate
        )
        self.trial_rate *= model.kt

    def along(self) -> FloatArray:
        """(N,) the velocity along the present piece: the null vector where the tangent is singular."""
        return self.direction if self.ill else self.sign * self.direction

    def is_mechanism(self) -> bool:
        """Whether no force changes along the present piece (rates as last measured)."""
        closed, stick = self.state != OPEN, self.state == STICK
        strain = max(np.abs(self.opening_rate).max(), np.abs(self.trial_rate / self.model.kt).max())
        elastic = max(
            np.abs(self.opening_rate[closed]).max(initial=0.0),
            np.abs((self.trial_rate / self.model.kt)[stick]).max(initial=0.0),
        )
        return bool(elastic <= ELASTIC * strain)

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
            Why the stretch ended. At PLATEAU the tracer holds the singular piece and the flip that led to it.
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
        self._rates(velocity)
        fastest = max(np.abs(self.opening_rate).max(), np.abs(self.trial_rate).max())
        least = fastest * (1e-8 if self.ill else 1e-11)
        step, point, new = next_kink(
            self.opening,
            self.trial,
            self.opening_rate,
            self.trial_rate,
            model.kn,
            model.mu,
            self.state,
            TIE * self.scale,
            least,
            self.last_point,
            self.last_old,
        )
        speed = 0.0 if self.ill else self.sign
        if speed > 0.0 and self.multiplier + step >= target and target < np.inf:
            self._advance(velocity, target - self.multiplier)
            self.multiplier = target
            self._note(record, 1)
            return PathEnd.TARGET
        if point < 0:
            if self.is_mechanism():
                return PathEnd.PLATEAU
            if self.ill:
                return PathEnd.BREAKDOWN
            return PathEnd.UNBOUNDED if speed > 0.0 else PathEnd.RUNS_DOWN
        self._advance(velocity, step)
        self.multiplier += speed * step
        if self.state[point] == OPEN:
            new = SLIP_PLUS if self.trial[point] >= 0.0 else SLIP_MINUS
        record.events += 1
        self._note(record, note)
        if self.multiplier < record.peak - turn * max(abs(record.peak), 1e-3):
            return PathEnd.TURNED_DOWN
        self._flip(point, new)
        return None

    def _advance(self, velocity: FloatArray, step: float) -> None:
        self.u += step * velocity
        self.opening += step * self.opening_rate
        self.trial += step * self.trial_rate

    def _note(self, record: PathRecord, note: int) -> None:
        if self.multiplier > record.peak:
            record.peak = self.multiplier
        elif record.first_limit is None and self.multiplier < record.peak * (1.0 - 1e-9):
            record.first_limit = record.peak
        if record.events % note == 0:
            record.add(self.multiplier, float(self.model.live @ self.u), self.n_slip, self.n_open)

    def _flip(self, point: int, new: int) -> None:
        """Change one state, and turn the direction onto the next piece."""
        model = self.model
        old = int(self.state[point])
        k = model.interface[point]
        x = model.position[point]
        rows = model.rows[k]
        row_n = (1.0 - x) * rows[0] + x * rows[1]
        flip_vectors(row_n, rows[2], model.kn[point], model.kt[point], model.mu[point], old, new, self._a, self._b)
        index, a, b = model.unknown[k], self._a.copy(), self._b.copy()
        crossing = float(b @ self.along()[index])
        self.state[point] = new
        self.n_open += (new == OPEN) - (old == OPEN)
        self.n_slip += (new >= SLIP_PLUS) - (old >= SLIP_PLUS)
        self.last_point, self.last_old = point, old
        if self.ill:
            self._refresh()
            self.sign = 1.0 if float(b @ self.direction[index]) * crossing > 0.0 else -1.0
            return
        y = self.factor.solve_sparse(index, a)
        denominator = 1.0 + float(b @ y[index])
        self.a, self.b, self.index = a, b, index
        if abs(denominator) < ILL:
            self.ill = True
            size = np.abs(y).max()
            along = float(b @ y[index])
            self.direction = y * (np.sign(crossing) * np.sign(along) / size)
            self._nudge_ill(y, denominator, crossing)
            return
        self.direction -= y * (float(b @ self.direction[index]) / denominator)
        self.sign *= 1.0 if denominator > 0.0 else -1.0
        if self.factor.count >= self.factor.capacity - 1:
            self._refresh()
        else:
            self.factor.update(y, index, b, denominator)

    def _nudge_ill(self, y: FloatArray, denominator: float, crossing: float) -> None:
        """Keep a nearly singular piece honest: when it is no mechanism it is followed with its own small lambda rate."""
        self._rates(self.direction)
        if self.is_mechanism():
            return
        self._refresh()
        self.sign = 1.0 if float(self.b @ self.direction[self.index]) * crossing > 0.0 else -1.0
