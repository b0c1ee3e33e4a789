"""Measured values and CPU seconds of limit analysis beside the figures that prototypes reached.

Run as `python -m benchmarks limit_analysis`; `--full` adds the largest walls. Seconds are CPU time of the solver,
without process start.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

from benchmarks.walls import bond
from harness.model.method import Answer
from methods.la.associated_adapter import AssociatedLimitAnalysis
from methods.la.core.search_settings import AssociatedSettings, SearchSettings
from methods.la.search_adapter import LimitAnalysis

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
        start = time.process_time()
        associated = AssociatedLimitAnalysis().solve(assembly, AssociatedSettings())
        middle = time.process_time()
        least = LimitAnalysis().solve(assembly, SearchSettings())
        end = time.process_time()
        residuals = least.details.get("residuals", {})
        value = float("nan") if least.multiplier is None else least.multiplier
        asked = float("nan") if least_known == "none" else float(least_known)
        print(
            f"n {assembly.n_free:5d}  m {assembly.n_interfaces:6d}  mu {friction:.2f}  "
            f"associated {measured(associated)} ({associated_known}) {middle - start:7.2f} s  "
            f"least known {measured(least)} ({least_known}) {end - middle:7.2f} s, "
            f"known after {first_below(least, (1.0 + SAME) * value):6.2f} s, within 1 % of it after "
            f"{first_below(least, 1.01 * value):6.2f} s, of the bracket {first_below(least, 1.01 * asked):6.2f} s  "
            f"largest residual {max(residuals.values(), default=float('nan')):.0e}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
