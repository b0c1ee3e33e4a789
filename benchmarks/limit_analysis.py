"""Measured values and CPU seconds of limit analysis beside the figures that prototypes reached.

Run as `python -m benchmarks limit_analysis`; `--full` adds the largest walls. Seconds are CPU time of the solver,
without process start. The associated programme stands beside Clarabel called directly, the least time of a few each.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import clarabel  # type: ignore[import-untyped]
import numpy as np
import scipy.sparse as sp

from benchmarks.walls import bond
from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings

BRICKS = (6, 3, 0.2)
WALLS: tuple[tuple[tuple[int, int, float], float, str, str], ...] = (
    (BRICKS, 0.65, ".584461", ".5579978"),
    (BRICKS, 0.75, ".622318", ".5519524"),
    (BRICKS, 0.85, ".690766", ".5375880"),
    (BRICKS, 1.0, ".979073", ".5339130"),
    ((6, 5, 0.175), 0.65, ".642859", ".6389818"),
    ((10, 5, 0.175), 0.65, ".579999", ".5574159"),
    ((14, 7, 0.175), 0.65, ".540900", ".5156315"),
    ((20, 11, 0.175), 0.65, ".503216", ".4844"),
    ((28, 16, 0.175), 0.65, ".474130", ".4622"),
)
LARGE: tuple[tuple[tuple[int, int, float], float, str, str], ...] = (
    ((40, 30, 0.175), 0.65, ".452420", ".4463"),
    ((100, 70, 0.175), 0.65, ".42676", "none"),
)


SAME = 1e-6
"""Relative difference below which two multipliers count as the same value."""


def least_time(repeats: int, made: Callable[[Assembly], Any], wall: Assembly) -> tuple[float, Any]:
    """The least CPU seconds of a few repeats [s], and what was made of a wall."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        found = made(wall)
        times.append(time.process_time() - start)
    return min(times), found


def within_yield(friction: FloatArray) -> sp.csr_matrix:
    """The sparse (4m, 3m) matrix of the slacks n1, n2, mu (n1 + n2) + s, mu (n1 + n2) - s of forces (n1, n2, s)."""
    base, own, one = 3 * np.arange(len(friction)), 4 * np.arange(len(friction)), np.ones(len(friction))
    rows = np.concatenate([own, own + 1, *[own + 2] * 3, *[own + 3] * 3])
    columns = np.concatenate([base, base + 1, *[base, base + 1, base + 2] * 2])
    values = np.concatenate([one, one, friction, friction, one, friction, friction, -one])
    return sp.csr_matrix((values, (rows, columns)))


def by_clarabel(assembly: Assembly) -> float:
    """The greatest multiplier of statics by Clarabel at its default tolerances, its programme set up each time."""
    m, (dead, live) = assembly.n_interfaces, assembly.free_loads()
    forces = sp.csc_matrix(sp.vstack([assembly.kinematic_matrix.T, -within_yield(assembly.friction)]))
    loads = sp.csc_matrix(np.append(live, np.zeros(4 * m))[:, None])
    rows = sp.csc_matrix(sp.hstack([forces, loads]))
    cost = np.append(np.zeros(3 * m), -1.0)
    cones = [clarabel.ZeroConeT(len(dead)), clarabel.NonnegativeConeT(4 * m)]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    none = sp.csc_matrix((3 * m + 1, 3 * m + 1))
    right = np.append(-dead, np.zeros(4 * m))
    return float(clarabel.DefaultSolver(none, cost, rows, right, cones, settings).solve().x[-1])


def by_la_associated(assembly: Assembly) -> Answer:
    """The answer of `la-associated`, which tells whether the wall stands too, with its mechanism and a gap of 1e-12."""
    return AssociatedLimitAnalysis().solve(assembly, AssociatedSettings())


def measured(answer: Answer) -> str:
    """The multiplier, or how the run ended."""
    return f"{answer.multiplier:.7f}" if answer.multiplier is not None else answer.status.value


def first_below(answer: Answer, multiplier: float) -> float:
    """CPU seconds of the search after which the least known was at most this multiplier; NaN if it never was."""
    if answer.multiplier is None:
        return float("nan")
    pairs = zip(answer.path["cpu_seconds"], answer.path["multiplier"], strict=True)
    return next((second for second, known in pairs if known <= multiplier), float("nan"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    walls = WALLS + (LARGE if "--full" in (sys.argv[1:] if arguments is None else arguments) else ())
    print("limit analysis: values and CPU seconds; the figures to reach stand in brackets")
    for (courses, bricks, height), friction, associated_known, least_known in walls:
        assembly = bond(courses, bricks, friction, height)
        repeats = 5 if assembly.n_interfaces <= 2000 else 1
        own, associated = least_time(repeats, by_la_associated, assembly)
        direct, _ = least_time(repeats, by_clarabel, assembly)
        middle = time.process_time()
        least = LimitAnalysis().solve(assembly, SearchSettings())
        end = time.process_time()
        residuals = least.details.get("residuals", {})
        value = float("nan") if least.multiplier is None else least.multiplier
        asked = float("nan") if least_known == "none" else float(least_known)
        print(
            f"n {assembly.n_free:5d}  m {assembly.n_interfaces:6d}  mu {friction:.2f}  "
            f"associated {measured(associated)} ({associated_known}) {own:7.3f} s, {own / direct:.1f} times Clarabel  "
            f"least known {measured(least)} ({least_known}) {end - middle:7.2f} s, "
            f"reached after {first_below(least, (1.0 + SAME) * value):6.2f} s, within 1 % of it after "
            f"{first_below(least, 1.01 * value):6.2f} s, of the bracket {first_below(least, 1.01 * asked):6.2f} s  "
            f"largest residual {max(residuals.values(), default=float('nan')):.0e}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
