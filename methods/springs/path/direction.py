"""Along which velocity the path goes on in a set of states, and at which rate of the multiplier.

The straight piece of a path is a velocity v with a rate of the multiplier l such that K v = l live, up to a factor.
When a gap point changes state at a breakpoint, K turns into K + a b' and, with K w = m live - a,

    v' = (1 - b'w) v + (b'v) w,   l' = (1 - b'w) l + (b'v) m,

which keeps b'v' = b'v: the breakpoint function that was crossed moves on into the new cell (Katzenelson, 1965; Eaves
and Scarf, 1976), so that a path cannot turn back on itself, and nothing is divided by 1 - b'w, which vanishes at limit
points. On soft pieces the tangent itself is nearly singular. There the fastest displacement is held by a pin, a spring,
and one more for each further soft motion, K + sum e e', and the factor of that is used to solve K v = l live with the
first of them held (bordering; Keller, 1977). Velocities, rates of the multiplier and of the gaps are then refined to
twice the working precision.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.vectors import combine, largest
from methods.springs.model.exact_rates import exact_gap_rates
from methods.springs.model.factor import Change, Factor, SingularTangent, refactor_any
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel

_SURE_RATE = 1e-6
"""Rate of a breakpoint function, over the fastest velocity, from which its sign in a new direction is beyond doubt."""
_SOFT_VELOCITY = 1e4
"""Multiple of the first piece's velocity, at the same rate of the multiplier, above which the fastest displacement has
a pin."""
_SOFT_RESPONSE = 1e8
"""The same of the response of the wall with pins to the live load, which shows a further soft motion."""
_HELD = 1e-3
"""Share of the fastest displacement below which the pin no longer holds the motion, and is moved."""
_DEFECT = 1e-7
"""Share of the live load above which a velocity is refined, and the tangent factorised afresh when that no longer
helps. On pieces with pins it is of the forces over a motion as long as the displacements."""
_SOFT_ACCEPTED = 1e-4
"""The same on pieces with pins when refinement no longer helps."""
_CONTRACTION = 0.5
"""Share of the defect before it that a step must leave at most, or refinement no longer helps."""
_REFINEMENTS = 8
"""Steps of refinement, at most."""
_DOUBLED = 1e6
"""Displacements (dimensionless) above which gap rates of pieces with pins are measured in doubled precision: up to
there their rounding changes no force by more than 1e-9."""
_PIVOT = 1e8
"""|1 + b'y|, or its inverse, above which a change would cost digits."""


@dataclass
class _UnitResponse:
    """The displacements value + tail (N,) that a unit force at a pin causes in the wall with pins."""

    border: int
    value: FloatArray
    tail: FloatArray


class PathDirection:
    """A velocity and the rates that follow from it, with the factorised tangent they are found from.

    Attributes:
        velocity: (N,) v; tail: (N,) its small part beyond working precision; speed: rate l of the multiplier.
        opening_rate, trial_rate: (P,) rates of g and tau.
        bordered: the displacements that have a pin in the factor, the fastest first.
        fine: whether rates are measured in doubled precision.
        elastic: size of v / l on the first piece of the path, with which soft pieces are compared.
        options: of the model.
    """

    def __init__(self, model: WallModel, factor: Factor) -> None:
        self.model, self.factor, self.options = model, factor, model.options
        self.velocity, self.tail, self.speed = np.zeros(model.n_unknowns), np.zeros(model.n_unknowns), 1.0
        self.opening_rate, self.trial_rate = np.empty(model.n_points), np.empty(model.n_points)
        self.bordered: list[int] = []
        self.response = self.velocity
        self.unit_responses: list[_UnitResponse] = []
        self.fine = False
        self.elastic = 0.0
        self.live_size = largest(model.live)

    @property
    def size(self) -> float:
        """The fastest velocity, in multiples of the first piece's at the same rate of the multiplier."""
        fastest = largest(self.velocity)
        return fastest / max(abs(self.speed) * self.elastic, 1e-300) if self.elastic else 0.0

    def solve_anew(self, state: IntArray, extent: float, crossed: tuple[Change, float] | None = None) -> None:
        """Factorise the tangent in these states and solve for the velocity; it keeps its sense.

        Args:
            state: (P,) states; extent: largest displacement so far, over which force rates must not matter.
            crossed: the change of state just made, and the rate b'v at which its breakpoint was met, if it was.

        Raises:
            SingularTangent: the tangent is singular, or the velocity cannot be refined.
        """
        before, rising = self.velocity, self.speed
        for careful in (False, True):
            self.velocity, self.speed = before, rising
            self._solve_pinned(state, careful)
            if self.refine(state, extent):
                if crossed is not None and self._leads_back(*crossed):
                    self.velocity, self.tail, self.speed = -self.velocity, -self.tail, -self.speed
                    self.measure()
                return
            if self.factor.careful:
                break
        raise SingularTangent("the direction of the path was lost to rounding")

    def _solve_pinned(self, state: IntArray, careful: bool) -> None:
        """Solve for the velocity, its fastest displacement with a pin where the piece turns out to be soft."""
        for _ in range(self.options.pins):
            before, rising = self.velocity, self.speed
            self.bordered = [int(np.argmax(np.abs(before)))] if self.size > _SOFT_VELOCITY else []
            self._factorise(state, careful)
            self._solve(before, rising)
            if self._is_pinned_right():
                return

    def _is_pinned_right(self) -> bool:
        """Whether a soft piece has a pin, where it moves."""
        if not self.bordered:
            return self.size <= _SOFT_VELOCITY
        return bool(abs(self.velocity[self.bordered[0]]) >= _HELD * largest(self.velocity))

    def _factorise(self, state: IntArray, careful: bool) -> None:
        """Factorise the tangent, and where one with pins is still soft, pin the softest motion as well.

        One without any stiffness left that the live load works on gets a pin first: whatever the load does, the wall
        moves along it. Others without stiffness stay on their regularisation.
        """
        while True:
            refactor_any(self.factor, state, careful, self.bordered)
            self.response = self.factor.solve(self.model.live)
            softest = int(np.argmax(np.abs(self.response)))
            if (
                not self.bordered
                or not self._is_soft()
                or softest in self.bordered
                or len(self.bordered) == self.options.pins
            ):
                break
            self.bordered.insert(0 if self.factor.is_regularised else len(self.bordered), softest)
        self.unit_responses = [self._unit_response(border, state) for border in self.bordered[1:]]

    def _is_soft(self) -> bool:
        """Whether the response to the live load shows a soft motion without a pin."""
        return largest(self.response) > _SOFT_RESPONSE * self.elastic

    def solve_first(self, state: IntArray) -> None:
        """Solve for the velocity with the factor as it stands, the multiplier rising."""
        self.bordered, self.unit_responses = [], []
        self.response = self.factor.solve(self.model.live)
        self._solve(self.velocity, 1.0)
        if not self.refine(state, 0.0):
            raise SingularTangent("the direction of the path was lost to rounding")

    def _solve(self, before: FloatArray, rising: float) -> None:
        """v and l from the factor: l = 1, or v_e = 1 at the pin, with the sense of the velocity before."""
        self.tail = np.zeros_like(before)
        if not self.bordered:
            self.velocity, self.speed, sense = self.response.copy(), 1.0, rising
            if not self.elastic:
                self.elastic = largest(self.velocity)
        else:
            one = np.zeros_like(before)
            one[self.bordered[0]] = 1.0
            self.velocity, self.speed = self._hold(self.factor.solve(one), 1.0)
            sense = float(before[self.bordered[0]])
        if sense < 0.0:
            self.velocity, self.speed = -self.velocity, -self.speed

    def _leads_back(self, change: Change, rate: float) -> bool:
        """Whether the velocity leads back, beyond rounding, over the breakpoint just crossed with a rate b'v."""
        index, _, b = self.model.change(*change)
        along = float(b @ self.velocity[index])
        return abs(along) > _SURE_RATE * largest(self.velocity) and along * rate < 0.0

    def _hold(self, x: FloatArray, held: float = 0.0) -> tuple[FloatArray, float]:
        """Add m responses to the live load and shapes of the pins to x, so that the springs of the pins carry nothing.

        Returns:
            The sum (N,), whose displacement at the first pin is `held`, and m.
        """
        if not self.bordered:
            return x, 0.0
        try:
            share = self._share(x, held)
        except np.linalg.LinAlgError as error:
            raise SingularTangent("the bordered motions are not independent") from error
        if not np.isfinite(share).all():
            raise SingularTangent("the live load does not act on the motion")
        out = x + share[0] * self.response
        for part, shape in zip(share[1:], self.unit_responses, strict=True):
            out += part * shape.value
        return out, float(share[0])

    def _share(self, x: FloatArray, held: float) -> FloatArray:
        """How much of the response and of each shape, (1 + shapes,), to add to x."""
        if not self.unit_responses:
            return np.array([(held - x[self.bordered[0]]) / self.response[self.bordered[0]]])
        basis = [self.response, *(shape.value for shape in self.unit_responses)]
        system = np.array([values[self.bordered] for values in basis]).T
        for j, shape in enumerate(self.unit_responses, start=1):
            system[:, j] += shape.tail[self.bordered]
            system[j, j] = (shape.value[self.bordered[j]] - 1.0) + shape.tail[self.bordered[j]]
        right = -x[self.bordered]
        right[0] += held
        return np.linalg.solve(system, right)

    def balance(self, right: FloatArray) -> tuple[FloatArray, float]:
        """x (N,) and m with K x - m live = right: m = 0, or x = 0 at the first pin."""
        return self._hold(self.factor.solve(right))

    def _unit_response(self, border: int, state: IntArray) -> _UnitResponse:
        """The displacements that a unit force at a pin causes."""
        one = np.zeros(self.model.n_unknowns)
        one[border] = 1.0
        shape = _UnitResponse(border, self.factor.solve(one), np.zeros_like(one))
        self._refine(shape, state, 2)
        return shape

    def _refine(self, shape: _UnitResponse, state: IntArray, rounds: int) -> None:
        """Refine a shape, whose pin's spring carries all but a tiny share of the force, to twice working precision."""
        for _ in range(rounds):
            self.rates(shape.value, shape.tail)
            defect = self.model.out_of_balance(self.opening_rate, self.trial_rate, state, 0.0, 0.0)
            for border in self.bordered:
                defect[border] += (float(border == shape.border) - shape.value[border]) - shape.tail[border]
            shape.value, shape.tail = _sum(shape.value, shape.tail + self.factor.solve(defect))

    def update(self, change: Change, crossing: float, state: IntArray, extent: float) -> bool:
        """Turn onto the next piece.

        Args:
            change: the point that changes state, already changed in `state`; crossing: rate b'v of its breakpoint
                function.

        Returns:
            False where the tangent must be factorised afresh; velocity and rate of the multiplier are near then.
        """
        index, _, b = self.model.change(*change)
        y = self.factor.solve_change(change)
        along = float(b @ y[index])
        w, rate = self._hold(-y)
        keep = 1.0 - float(b @ w[index])
        combine(self.velocity, keep, crossing, w)
        self.speed = keep * self.speed + crossing * rate
        self.tail *= keep
        unit = largest(self.velocity) if self.bordered else abs(self.speed)
        if unit > 0.0:
            self.velocity /= unit
            self.tail /= unit
            self.speed /= unit
        if self.factor.count >= self.factor.capacity - 1 or not 1.0 / _PIVOT < abs(1.0 + along) < _PIVOT:
            return False
        if not self._is_pinned_right():
            return False
        self.factor.update(y, index, b, 1.0 + along)
        if self.bordered:
            self.response -= y * (float(b @ self.response[index]) / (1.0 + along))
            if self._is_soft() and len(self.bordered) < self.options.pins:
                return False
            for shape in self.unit_responses:
                shape.value -= y * (float(b @ shape.value[index]) / (1.0 + along))
                shape.tail -= y * (float(b @ shape.tail[index]) / (1.0 + along))
                self._refine(shape, state, 1)
        return self.refine(state, extent, strict=True) and not self._leads_back(change, crossing)

    def refine(self, state: IntArray, extent: float, strict: bool = False) -> bool:
        """Measure the gap rates, and refine the velocity while K v = l live is not met. False: it stays bent.

        A defect of a soft piece that refinement no longer lowers is borne, unless it is to be strictly straight.
        """
        self.fine = bool(self.unit_responses) or (bool(self.bordered) and extent > _DOUBLED)
        self.measure()
        if self.bordered:
            enough, bearable = _DEFECT / extent, (_DEFECT if strict else _SOFT_ACCEPTED) / extent
        else:
            enough = bearable = _DEFECT * self.live_size * abs(self.speed)
        previous = np.inf
        for count in range(_REFINEMENTS):
            defect = self.model.out_of_balance(self.opening_rate, self.trial_rate, state, self.speed, 0.0)
            worst = largest(defect)
            if worst <= enough and (count > 0 or not self.factor.is_regularised):
                return True
            if not worst < _CONTRACTION * previous:
                return worst <= bearable
            previous = worst
            correction, rate = self.balance(defect)
            self.speed += rate
            if self.fine:
                self.velocity, self.tail = _sum(self.velocity, self.tail + correction)
            else:
                self.velocity += correction
            self.measure()
        return worst <= bearable

    def measure(self) -> None:
        """The gap rates along the velocity."""
        self.rates(self.velocity, self.tail if self.fine else None)

    def rates(self, velocity: FloatArray, tail: FloatArray | None = None) -> None:
        """The gap rates along a velocity (N,), in doubled precision when its small part `tail` is given."""
        model = self.model
        kinematics = model.unknown, model.rows, model.interface, model.position
        if tail is not None:
            exact_gap_rates(*kinematics, model.kt, velocity, tail, self.opening_rate, self.trial_rate)
            return
        point_strains(*kinematics, velocity, self.opening_rate, self.trial_rate)
        self.trial_rate *= model.kt


def _sum(value: FloatArray, tail: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The sum rounded, and what the rounding left over where the tail is the smaller part (Dekker, 1971)."""
    total = value + tail
    return total, tail - (total - value)
