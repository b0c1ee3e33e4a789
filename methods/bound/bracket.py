"""The bracket of the least collapse multiplier: windows, each with its relaxation, until the bound meets the state."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import FloatArray
from methods.bound.dual import DualBound
from methods.bound.equations import Equations
from methods.bound.halpern import Splitting, carried_over
from methods.bound.relaxation import Relaxation
from methods.bound.slack_bounds import SlackProgramme
from methods.bound.tuning import STEPS, WINDOWS


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


@dataclass
class Bracket:
    """What is known of the least multiplier.

    Attributes:
        lower: no collapse state has a smaller multiplier, to rounding; upper: multiplier of a collapse state.
        windows: lower ends of the windows, in order.
        iterations: of the splitting.
        proofs: of the windows, in order.
    """

    lower: float
    upper: float
    windows: list[float] = field(default_factory=list)
    iterations: int = 0
    proofs: list[WindowProof] = field(default_factory=list)

    @property
    def closed(self) -> bool:
        """Whether both ends agree to `Windows.closed`."""
        return self.lower >= self.upper * (1.0 - WINDOWS.closed)


Certify = Callable[[WindowProof, float], float]
"""What exact arithmetic leaves of the bound of a window, and how much of it is needed."""


def bracket(
    equations: Equations, upper: float, seconds: float, lower: float = 0.0, certify: Certify | None = None
) -> Bracket:
    """The bracket that this much CPU time gives.

    Args:
        equations: the scaled wall, which stands under its dead load.
        upper: scaled multiplier of a collapse state, above zero.
        seconds: of CPU time; a window whose slacks are being bounded is finished.
        lower: a bound that is known.
        certify: asked after every window; the next begins at what it leaves of the bound.
    """
    search = _Search(equations, Bracket(lower, upper), time.process_time() + seconds, certify)
    while not search.found.closed and time.process_time() < search.until:
        if not search.window():
            break
    return search.found


class _Search:
    """The windows of one bracket, with what each hands to the next."""

    def __init__(self, equations: Equations, found: Bracket, until: float, certify: Certify | None) -> None:
        self.equations, self.found, self.until, self._certify = equations, found, until, certify
        self._began = time.process_time()
        self._slacks = SlackProgramme(equations)
        self._runs: dict[str, Splitting] = {}
        self._relaxation: Relaxation | None = None
        self._size = np.inf
        self._size_products: FloatArray | None = None

    def window(self) -> bool:
        """Bound the multipliers of one window, or go on with the last one; whether another may gain more."""
        found, last = self.found, self._relaxation is not None and self._is_last(self._relaxation)
        unfinished = self._relaxation is not None and not np.isfinite(self._size)
        if not last and not unfinished and not self._build():
            found.lower = found.upper
            return False
        before = found.lower
        if not np.isfinite(self._size):
            self._bound_size()
        if not np.isfinite(self._size):
            return True
        stalled = self._bound_multiplier()
        if self._certify is not None and found.lower > before:
            needed = found.lower - WINDOWS.below * (found.upper - found.lower)
            found.lower = min(found.lower, max(before, self._certify(found.proofs[-1], needed)))
        return found.lower - before > 1e-3 * (found.upper - before) or not (stalled and last)

    def _is_last(self, relaxation: Relaxation) -> bool:
        return self.found.upper - relaxation.low < WINDOWS.narrow * self.found.upper

    def _build(self) -> bool:
        """Build the relaxation of the present bracket; False if no forces within yield exist in it."""
        found, old = self.found, self._relaxation
        high = found.upper * (1.0 + WINDOWS.above)
        low = found.lower
        bounds = self._slacks.bounds(low, high)
        if bounds is None:
            return False
        new = Relaxation(self.equations, low, high, bounds)
        costs: dict[str, FloatArray] = {"size": new.size_cost(), "multiplier": new.multiplier_cost()}
        for name, cost in costs.items():
            run = Splitting(new, cost, STEPS[name].first, STEPS[name].least)
            if old is not None and self._runs[name].iterate.size:
                run.step = self._runs[name].step
                run.iterate = carried_over(new, old, self._runs[name].iterate, run.step)
            self._runs[name] = run
        self._relaxation, self._size = new, np.inf
        found.windows.append(low)
        return True

    def _bound_size(self) -> None:
        """Bound the size of this window's mechanisms, to within `Windows.size` times the relaxation's own value."""
        spent = time.process_time() - self._began

        def stop(bound: DualBound | None, primal: float) -> bool:
            if bound is None:
                return False
            size = bound.greatest_size()
            if size < self._size:
                self._size, self._size_products = size, bound.products
            return self._size < WINDOWS.size * max(abs(bound.value), 1e-9)

        self._run("size", max(5.0, 0.25 * spent), stop)

    def _bound_multiplier(self) -> bool:
        """Bound the multipliers of this window; whether the relaxation has no more to give."""
        found, relaxation = self.found, self._runs["multiplier"].relaxation
        start, last = found.lower, self._is_last(relaxation)
        agreeing = 0

        def stop(bound: DualBound | None, primal: float) -> bool:
            nonlocal agreeing
            if bound is None:
                return False
            before, gap = found.lower, found.upper - found.lower
            self._keep(relaxation, bound)
            gained = found.lower > start + WINDOWS.gain * (found.upper - start)
            fast = found.lower > before + WINDOWS.gain * gap
            if found.lower >= found.upper * (1.0 - WINDOWS.finished) or (gained and not fast and not last):
                return True
            close = 0.05 * (found.upper - found.lower)
            ends = (relaxation.low + primal - found.lower, primal - bound.value)
            agreeing += found.lower > start and max(map(abs, ends)) < close
            return agreeing >= 5

        self._run("multiplier", np.inf, stop)
        return agreeing >= 5

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
        run.run(min(self.until, time.process_time() + seconds), stop)
        self.found.iterations += run.iterations - before
        run.step = max(run.step, STEPS[name].later)
