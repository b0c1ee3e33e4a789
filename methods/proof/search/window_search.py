"""Windows on the multiplier one after another, each with its relaxation, until the bound meets the state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

import numpy as np

from harness.model.assembly import FloatArray
from methods.proof.search.dividing import division_of
from methods.proof.search.dual import DualBound
from methods.proof.search.equations import Equations
from methods.proof.search.halpern import Splitting, carried_over
from methods.proof.search.options import CLOSED, NARROW
from methods.proof.search.rate_bounds import RateProgramme, RateProof
from methods.proof.search.relaxation import Relaxation
from methods.proof.search.slack_bounds import SlackBounds, SlackProgramme
from methods.proof.search.subproblem import Division, Subproblem

_GAIN = 0.3
"""Part of the bracket that one window must gain before the next is built, and the last half of its time to go on with
it."""
_SIZE = 2.5
"""Bound of the size of mechanisms, in that which its relaxation comes to, that is good enough."""
_ABOVE = 1e-9
"""Relative distance of the window's upper end above the state, so that rounding does not cut it off."""
_BELOW = 1e-2
"""Part of the bracket that a certificate may lose to rounding before it takes more digits."""
_FINISHED = 5e-7
"""Relative distance at which a window ends: less than `CLOSED`, because a certificate loses some."""
_PATIENCE = 12_000
"""Iterations in which the bracket is to lose `_GAIN` of itself; else its states are divided."""
_WORTH = 0.1
"""Part of the bracket that a window must gain for the next not to be of a half of its states."""
_SHARE = 0.5
"""Share of the iterations of a window that takes the place of `_PATIENCE` where it is more."""
_LEAST_WEIGHT = 0.3
"""Of a rate in the size of mechanisms, the greatest price being one. A smaller one loses less to the price, but the
size may then be unbounded."""
_NEWEST_WEIGHT = 0.25
"""Share of the weights that the last check has, since prices change from one to the next."""


@dataclass(frozen=True, eq=False)
class WindowProof:
    """What proves the bound of one window, in floats.

    Attributes:
        relaxation: of the window.
        size, multiplier: multipliers of its products that bound the size of mechanisms, and the multiplier.
        greatest: size of mechanisms that they leave; bound: multiplier below which they leave no collapse state.
    """

    relaxation: Relaxation
    size: FloatArray
    multiplier: FloatArray
    greatest: float
    bound: float


class Stop(StrEnum):
    """What ended the search for a bracket before it closed, as a clause."""

    TIME = "the time was over"
    SIZE = "the time was over before the size of the mechanisms of a window was bounded"
    SPACE = "a certificate of more windows would be larger than is checked"
    LOST = "a process that worked on a part of the states ended without a result"
    DECIDED = "the states with the least bound have no contact left at which to divide them"


@dataclass
class Bracket:
    """What is known of the least multiplier.

    Attributes:
        lower: no collapse state has a smaller multiplier, to rounding; upper: multiplier of a collapse state.
        windows: lower ends of the windows, in order.
        iterations: of the splitting.
        proofs: of the windows, in order.
        branches: divisions of windows that had no more to give; not covered by `proofs`.
        stopped: what ended the search; None where it closed the bracket.
        refused: why there is no certificate of a window, empty where there is one of each.
    """

    lower: float
    upper: float
    windows: list[float] = field(default_factory=list)
    iterations: int = 0
    proofs: list[WindowProof] = field(default_factory=list)
    branches: int = 0
    stopped: Stop | None = None
    refused: str = ""

    @property
    def in_floats(self) -> float:
        """The bound to rounding, which a certificate may have lowered in `lower`."""
        return min(self.upper, max([self.lower, *(proof.bound for proof in self.proofs)]))

    @property
    def closed(self) -> bool:
        """Whether both ends agree to `CLOSED`."""
        return self.lower >= self.upper * (1.0 - CLOSED)


class Certify(Protocol):
    """What exact arithmetic leaves of that which a search finds."""

    def has_room(self, processes: int = 1) -> bool:
        """Whether what these find in one window each fits into a certificate that is checked."""

    def window(self, proof: WindowProof, needed: float) -> float:
        """The bound after a window, of which so much is needed."""

    def part(self, at: Division, first: bool) -> Certify | None:
        """The same for the first or the second half of a division; None if there is none for parts."""

    def slacks(self, bounds: SlackBounds) -> None:
        """Take note of slacks and normal forces of a part."""

    def statics(self, velocities: FloatArray) -> float:
        """The bound after velocities that bound the multiplier of a part."""

    def rates(self, proofs: list[RateProof]) -> float:
        """The bound after virtual forces that show something of the mechanisms of a part."""


class WindowSearch:
    """The windows of one bracket, with what each hands to the next.

    In a case, virtual work decides more contacts before the relaxation is built.
    """

    def __init__(
        self,
        equations: Equations,
        slacks: SlackProgramme,
        found: Bracket,
        until: float,
        certify: Certify | None = None,
        case: Subproblem = Subproblem(),
    ) -> None:
        self.equations, self.found, self.until, self.case = equations, found, until, case
        self._slacks, self._certify, self._options = slacks, certify, equations.options
        self._rates: RateProgramme | None = None
        self._made_by: Division | None = None
        self._made_at = found.lower
        self._began = equations.options.clock()
        self._runs: dict[str, Splitting] = {}
        self._relaxation: Relaxation | None = None
        self._slow = False
        self._size = np.inf
        self._size_products: FloatArray | None = None
        self._weights: FloatArray | None = None
        self._gaps: list[tuple[float, float]] = []

    @property
    def unbounded(self) -> bool:
        """Whether the size of the mechanisms of the last window is not bounded yet."""
        return self._relaxation is not None and not np.isfinite(self._size)

    def has_room(self, processes: int = 1) -> bool:
        """Whether what these find in one window each fits into the certificate, if there is to be one."""
        return self._certify is None or self._certify.has_room(processes)

    def parts(self, at: Division, rates: RateProgramme) -> list[WindowSearch]:
        """The searches of both halves of the states of this one, which begin where this one is.

        Args:
            at: where they are divided.
            rates: the programme that decides more, which all parts share.
        """
        parts = []
        for case, first in zip(self.case.halves(at), (True, False), strict=True):
            certify = None if self._certify is None else self._certify.part(at, first)
            known = Bracket(self.found.lower, self.found.upper)
            part = type(self)(self.equations, self._slacks, known, self.until, certify, case)
            part._runs, part._rates, part._weights = dict(self._runs), rates, self._weights
            part._made_by = at
            parts.append(part)
        return parts

    def become(self, after: WindowSearch) -> None:
        """Stand where a copy of this search came to. What certifies it stays the same object, which others hold."""
        certify = self._certify
        if certify is not None:
            vars(certify).update(vars(after._certify))
        vars(self).update(vars(after) | {"_certify": certify})

    def division(self) -> Division | None:
        """Where the states of this search are best divided; None if every contact is decided."""
        gained = self.found.lower - self._made_at > _WORTH * (self.found.upper - self._made_at)
        return division_of(self._runs["multiplier"], None if gained else self._made_by)

    def window(self) -> bool:
        """Bound the multipliers of one window, or go on with the last one; whether another may gain more."""
        found, last = self.found, self._relaxation is not None and self._is_last(self._relaxation)
        if not last and not self.unbounded and not self._build():
            return False
        before = found.lower
        if not np.isfinite(self._size):
            self._bound_size()
        if not np.isfinite(self._size):
            return self._rates is None
        stalled = self._bound_multiplier()
        if self._certify is not None and found.lower > before:
            needed = found.lower - _BELOW * (found.upper - found.lower)
            found.lower = min(found.lower, max(before, self._certify.window(found.proofs[-1], needed)))
        if self._slow and found.lower - before < _GAIN * (found.upper - before):
            return False
        return found.lower - before > _WORTH * (found.upper - before) or (last and not stalled)

    def _is_last(self, relaxation: Relaxation) -> bool:
        return self.found.upper - relaxation.low < NARROW * self.found.upper

    def _build(self) -> bool:
        """Build the relaxation of the present bracket; False if no state is left in it that is not bounded."""
        found, high = self.found, self.found.upper * (1.0 + _ABOVE)
        self._gaps = [(self.equations.options.clock(), found.upper - found.lower)]
        bounds = self._slack_bounds(high, self.case)
        if bounds is not None and self._rates is not None:
            bounds = self._tightened(self._rates, high, bounds)
        low = found.lower
        if bounds is None or found.closed:
            return False
        new = Relaxation(self.equations, low, high, bounds, self.case, self._weights)
        costs: dict[str, FloatArray] = {"size": new.size_cost(), "multiplier": new.multiplier_cost()}
        for name, cost in costs.items():
            steps = self._options.size if name == "size" else self._options.multiplier
            run = Splitting(new, cost, steps.first, (steps.least, steps.most))
            before = self._runs.get(name)
            if before is not None and before.iterate.size:
                run.step = before.step if steps.kept else run.step
                run.iterate = carried_over(new, run.step, before)
            self._runs[name] = run
        self._relaxation, self._size = new, np.inf
        found.windows.append(low)
        return True

    def _slack_bounds(self, high: float, case: Subproblem) -> SlackBounds | None:
        """Bounds of the slacks of the present bracket; None, and the bound raised, if it leaves no forces."""
        bounds = self._slacks.bounds(self.found.lower, high, case)
        part = self._certify if self._rates is not None else None
        if bounds is None:
            self._raise(np.inf, None if part is None else part.statics(self._slacks.excluding()))
        elif part is not None:
            part.slacks(bounds)
        return bounds

    def _tightened(self, rates: RateProgramme, high: float, bounds: SlackBounds) -> SlackBounds | None:
        """Decide contacts by virtual work and raise the bound by statics alone."""
        found: SlackBounds | None = bounds
        while found is not None:
            before = self.case
            decided, proofs = rates.decided(high, found, before)
            certified = None if self._certify is None else self._certify.rates(proofs)
            if decided is None:
                self._raise(np.inf, certified)
                return None
            self.case = decided
            self._slacks.window(self.found.lower, high, decided)
            least, velocities = self._slacks.multiplier()
            self._raise(least, None if self._certify is None else self._certify.statics(velocities))
            if decided.tight == before.tight or self.found.closed:
                return found
            found = self._slack_bounds(high, decided)
        return None

    def _raise(self, least: float, certified: float | None) -> None:
        """Raise the bound to what a programme found, and no more than exact arithmetic leaves of it."""
        found, least = self.found, least - self._options.rounding.tolerance
        found.lower = max(found.lower, min(found.upper, least if certified is None else min(least, certified)))

    def _bound_size(self) -> None:
        """Bound the size of this window's mechanisms, to within `Windows.size` times the relaxation's own value."""
        spent = self.equations.options.clock() - self._began

        def stop(bound: DualBound | None, primal: float) -> bool:
            if bound is None:
                return False
            size = bound.greatest_size()
            if size < self._size:
                self._size, self._size_products = size, bound.products
            return self._size < _SIZE * max(abs(bound.value), 1e-9)

        self._run("size", max(5.0, 0.25 * spent), stop)

    def _bound_multiplier(self) -> bool:
        """Bound the multipliers of this window; whether the relaxation has no more to give."""
        found, run = self.found, self._runs["multiplier"]
        relaxation, run.size = run.relaxation, self._size
        start, last = found.lower, self._is_last(relaxation)
        agreeing, mark, since = 0, found.upper - found.lower, run.iterations
        self._slow = False

        def stop(bound: DualBound | None, primal: float) -> bool:
            nonlocal agreeing, mark, since
            if found.upper - found.lower < (1.0 - _GAIN) * mark:
                mark, since = found.upper - found.lower, run.iterations
            self._slow = run.iterations - since > max(_PATIENCE, _SHARE * run.iterations)
            if bound is None or self._slow:
                return self._slow
            self._weigh(bound)
            self._keep(relaxation, bound)
            gained = found.lower > start + _GAIN * (found.upper - start)
            fast = self._gains(found.upper - found.lower)
            if found.lower >= found.upper * (1.0 - _FINISHED) or (gained and not fast and not last):
                return True
            close = 0.05 * (found.upper - found.lower)
            ends = (relaxation.low + primal - found.lower, primal - bound.value)
            agreeing += found.lower > start and max(map(abs, ends)) < close
            return agreeing >= 5

        self._run("multiplier", np.inf, stop)
        return agreeing >= 5

    def _gains(self, gap: float) -> bool:
        """Whether the gap of the bracket, now this, has lost `Windows.gain` in the last half of the window's time."""
        now = self.equations.options.clock()
        self._gaps.append((now, gap))
        half = 0.5 * (self._gaps[0][0] + now)
        earlier = next(gap for when, gap in reversed(self._gaps) if when <= half)
        return gap < (1.0 - _GAIN) * earlier

    def _weigh(self, bound: DualBound) -> None:
        """Let the size of the next window's mechanisms weigh rates as duals price them, so that a few do not pay for
        all."""
        prices = np.append(bound.prices, bound.lift_price)
        if prices.max() > 0.0:
            weights = np.maximum(prices / prices.max(), _LEAST_WEIGHT)
            share = _NEWEST_WEIGHT
            self._weights = weights if self._weights is None else (1 - share) * self._weights + share * weights

    def _keep(self, relaxation: Relaxation, bound: DualBound) -> None:
        """Raise the bound to what the dual of this window proves, and keep the dual."""
        found, lower = self.found, relaxation.low + bound.of(self._size)
        if lower <= found.lower or self._size_products is None:
            return
        if found.proofs and found.proofs[-1].relaxation is relaxation:
            found.proofs.pop()
        found.proofs.append(WindowProof(relaxation, self._size_products, bound.products, self._size, lower))
        found.lower = min(lower, found.upper)

    def _run(self, name: str, seconds: float, stop: Callable[[DualBound | None, float], bool]) -> None:
        run, before = self._runs[name], self._runs[name].iterations
        run.run(min(self.until, self.equations.options.clock() + seconds), stop)
        self.found.iterations += run.iterations - before
