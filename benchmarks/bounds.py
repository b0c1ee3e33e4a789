"""Small walls that chance draws: how many brackets of the least multiplier close, and are certified, in a time.

Run as `python -m benchmarks bounds [count [seconds [first [kind]]]]`; kinds are irregular walls of 6 to 12 blocks,
courses of stones and arches. A line a wall: seed,
blocks, interfaces, least state known, bound to rounding and how far it is below, relatively, certified bound and how
far, CPU seconds of search and bound, divisions of windows.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from benchmarks.walls import courses_of_stones, irregular_wall, small_arch
from harness.model.assembly import Assembly
from harness.model.method import Finding
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.problem import make_problem
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.proof.search.options import PROVED


def small_wall(seed: int) -> Assembly:
    """The irregular wall of a seed: 2 to 4 columns in 3 courses, friction from 0.3 to 1.0."""
    generator = np.random.default_rng([seed, 7])
    return irregular_wall(seed, int(generator.integers(2, 5)), 3, round(float(generator.uniform(0.3, 1.0)), 3))


KINDS = {"irregular": small_wall, "courses": courses_of_stones, "arches": small_arch}


def gaps(seed: int, seconds: float, wall: Assembly) -> tuple[float, float] | None:
    """Relative distances of the bound to rounding and of the certified one below the least state known, printed.

    None where no state is known.
    """
    began = time.process_time()
    known = LimitAnalysis().solve(wall, SearchSettings())
    searched = time.process_time()
    if known.finding is not Finding.COLLAPSES or not known.multiplier or known.mechanism is None:
        print(f"{seed:4d} {wall.n_free:3d} {wall.n_interfaces:3d}  {known.finding}", flush=True)
        return None
    problem = make_problem(wall)
    found, document = certified_bracket(problem, known.multiplier, known.mechanism, seconds)
    proved = float(Fraction(document["bound"])) if document is not None else 0.0
    bound = max(found.lower * problem.unit_multiplier, proved)
    gap, proved_gap = 1.0 - bound / known.multiplier, 1.0 - proved / known.multiplier
    spent = f"{searched - began:6.1f} {time.process_time() - searched:6.1f}"
    print(
        f"{seed:4d} {wall.n_free:3d} {wall.n_interfaces:3d} {known.multiplier:.9f} "
        f"{bound:.9f} {gap:8.1e}  {proved:.9f} {proved_gap:8.1e} {spent} {found.branches:4d}",
        flush=True,
    )
    return gap, proved_gap


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line a wall and the counts."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count, seconds, first, kind = [*given, *["100", "60", "0", "irregular"][len(given) :]]
    seeds = range(int(first), int(first) + int(count))
    every = [gaps(seed, float(seconds), KINDS[kind](seed)) for seed in seeds]
    known = [pair for pair in every if pair is not None]
    closed, certified = (sum(gap <= PROVED for gap in each) for each in zip(*known, strict=True))
    within = sum(gap <= 0.01 for gap, _ in known)
    print(
        f"{len(known)} walls collapse; within {seconds} s {closed} are closed to rounding, {certified} of them "
        f"certified, {within} to 1 %"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
