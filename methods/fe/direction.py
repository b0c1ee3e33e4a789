"""Along which velocity the path goes on in a set of states, and at which rate of the multiplier.

The straight piece of a path is a velocity v with a rate of the multiplier l such that K v = l live, up to a factor.
When a gap point changes state at a kink, K turns into K + a b' and, with K w = m live - a,

    v' = (1 - b'w) v + (b'v) w,   l' = (1 - b'w) l + (b'v) m,

which keeps b'v' = b'v: the kink function that was crossed moves on into the new cell (Katzenelson, 1965; Eaves and
Scarf, 1976), so that a path cannot turn back on itself, and nothing is divided by 1 - b'w, which vanishes at limit
points. On soft pieces the tangent itself is nearly singular. There the fastest displacement is pinned by a spring,
K + e e', whose factor is used to solve K v = l live with v_e held (bordering; Keller, 1977), and velocities, rates of
the multiplier and of the gaps are refined to twice the working precision.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.fe.exact_rates import exact_gap_rates
from methods.fe.factor import Change, Factor, SingularTangent
from methods.fe.tolerances import BENT, CAREFUL, CROOKED, FREE, SOFT, STEEP, STRAIGHT, WEAK
from methods.fe.wall_model import WallModel, point_strains

FREELY = -1
"""The pin of a tangent that is not pinned."""


class Direction:
    """A velocity and the rates that follow from it, with the factorised tangent they are found from.

    Attributes:
        velocity: (N,) v; tail: (N,) its small part beyond working precision; speed: rate l of the multiplier.
        opening_rate, trial_rate: (P,) rates of g and tau.
        pin: the displacement that is pinned in the factor, or FREELY.
        elastic: size of v / l on the first piece of the path, with which soft pieces are compared.
    """

    def __init__(self, model: WallModel, factor: Factor, elastic: float = 0.0) -> None:
        self.model, self.factor = model, factor
        self.velocity, self.tail, self.speed = np.zeros(model.n_unknowns), np.zeros(model.n_unknowns), 1.0
        self.opening_rate, self.trial_rate = np.empty(model.n_points), np.empty(model.n_points)
        self.pin = FREELY
        self.response = self.velocity
        self.elastic = elastic
        self.live_size = float(np.abs(model.live).max())

    @property
    def size(self) -> float:
        """The fastest velocity, in multiples of the first piece's at the same rate of the multiplier."""
        fastest = float(np.abs(self.velocity).max())
        return fastest / max(abs(self.speed) * self.elastic, 1e-300) if self.elastic else 0.0

    def solve_anew(self, state: IntArray, extent: float) -> None:
        """Factorise the tangent in these states and solve for the velocity; it keeps its sense.

        Args:
            state: (P,) states; extent: largest displacement so far, over which force rates must not matter.

        Raises:
            SingularTangent: the tangent is singular, or the velocity cannot be refined.
        """
        before, rising = self.velocity, self.speed
        self.pin = int(np.argmax(np.abs(before))) if self.size > FREE else FREELY
        for careful in (False, True):
            self.factor.refactor(state, pin=self.pin, careful=careful)
            self._solve(before, rising)
            if self.straighten(state, extent):
                return
            if self.factor.careful:
                break
        raise SingularTangent("the direction of the path was lost to rounding")

    def solve_first(self, state: IntArray) -> None:
        """Solve for the velocity with the factor as it stands, the multiplier rising."""
        self.pin = FREELY
        self._solve(self.velocity, 1.0)
        if not self.straighten(state, 0.0):
            raise SingularTangent("the direction of the path was lost to rounding")

    def _solve(self, before: FloatArray, rising: float) -> None:
        """v and l from the factor: l = 1, or v_e = 1 at the pin, with the sense of the velocity before."""
        self.tail = np.zeros_like(before)
        self.response = self.factor.solve(self.model.live)
        if self.pin == FREELY:
            self.velocity, self.speed = self.response.copy(), 1.0
            if not self.elastic:
                self.elastic = float(np.abs(self.velocity).max())
            sense = rising
        else:
            one = np.zeros_like(before)
            one[self.pin] = 1.0
            held = self.factor.solve(one)
            reach = float(self.response[self.pin])
            if reach == 0.0:
                raise SingularTangent("the live load does not act on the motion")
            self.speed = (1.0 - float(held[self.pin])) / reach
            self.velocity = self.speed * self.response + held
            sense = float(before[self.pin])
        if sense < 0.0:
            self.velocity, self.speed = -self.velocity, -self.speed

    def balance(self, right: FloatArray) -> tuple[FloatArray, float]:
        """x (N,) and m with K x - m live = right: m = 0, or x_e = 0 at the pin."""
        x = self.factor.solve(right)
        if self.pin == FREELY:
            return x, 0.0
        share = -float(x[self.pin] / self.response[self.pin])
        return x + share * self.response, share

    def turn(self, change: Change, crossing: float, state: IntArray, extent: float, look: bool) -> bool:
        """Turn onto the next piece.

        Args:
            change: the point that changes state, already changed in `state`; crossing: rate b'v of its kink function.
            look: whether straightness is looked at while it is not pinned.

        Returns:
            False where the tangent must be factorised afresh; velocity and rate of the multiplier are near then.
        """
        index, _, b = self.model.change(*change)
        y = self.factor.solve_change(change)
        along = float(b @ y[index])
        if self.pin == FREELY:
            w, rate = -y, 0.0
        else:
            rate = float(y[self.pin] / self.response[self.pin])
            w = rate * self.response - y
        keep = 1.0 - float(b @ w[index])
        self.velocity = keep * self.velocity + crossing * w
        self.speed = keep * self.speed + crossing * rate
        self.tail *= keep
        unit = abs(self.speed) if self.pin == FREELY else float(np.abs(self.velocity).max())
        if unit > 0.0:
            self.velocity /= unit
            self.tail /= unit
            self.speed /= unit
        if self.factor.count >= self.factor.capacity - 1 or not 1.0 / STEEP < abs(1.0 + along) < STEEP:
            return False
        if self.size > FREE if self.pin == FREELY else abs(self.velocity[self.pin]) < WEAK:
            return False
        self.factor.update(y, index, b, 1.0 + along)
        if self.pin != FREELY:
            self.response -= y * (float(b @ self.response[index]) / (1.0 + along))
        elif not look:
            self.measure()
            return True
        return self.straighten(state, extent)

    def straighten(self, state: IntArray, extent: float) -> bool:
        """Measure the gap rates, and refine the velocity while K v = l live is not met. False: it stays bent."""
        self.measure()
        if self.pin == FREELY:
            enough, bearable = BENT * self.live_size * abs(self.speed), CROOKED * self.live_size * abs(self.speed)
        else:
            enough, bearable = STRAIGHT / extent, SOFT / extent
        previous = np.inf
        for _ in range(CAREFUL):
            defect = self.model.out_of_balance(self.opening_rate, self.trial_rate, state, self.speed, 0.0)
            worst = float(np.abs(defect).max())
            if worst <= enough:
                return True
            if not worst < 0.5 * previous:
                return worst <= bearable
            previous = worst
            correction, rate = self.balance(defect)
            self.speed += rate
            if self.pin == FREELY:
                self.velocity += correction
            else:
                self.tail += correction
            self.measure()
        return worst <= bearable

    def measure(self) -> None:
        """The gap rates along the velocity, in doubled precision where it is pinned."""
        self.rates(self.velocity, None if self.pin == FREELY else self.tail)

    def rates(self, velocity: FloatArray, tail: FloatArray | None = None) -> None:
        """The gap rates along a velocity (N,), in doubled precision when its small part `tail` is given."""
        model = self.model
        kinematics = model.unknown, model.rows, model.interface, model.position
        if tail is not None:
            exact_gap_rates(*kinematics, model.kt, velocity, tail, self.opening_rate, self.trial_rate)
            return
        point_strains(*kinematics, velocity, self.opening_rate, self.trial_rate)
        self.trial_rate *= model.kt
