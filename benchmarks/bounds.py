"""Irregular walls of 6 to 12 blocks: how many brackets of the least multiplier close, and are certified, in a time.

Run as `python -m benchmarks.bounds [count [seconds [first]]]`, with OPENBLAS_NUM_THREADS=1. A line a wall: seed,
blocks, interfaces, least state known, certified bound, their relative distance, CPU seconds of search and bound.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from harness.model.assembly import Assembly
from harness.model.method import Finding
from methods.bound.tuning import WINDOWS
from methods.la.adapter import LimitAnalysis
from methods.la.irregular_walls import irregular_wall
from methods.la.problem import make_problem
from methods.la.settings import SearchSettings
from methods.la.window_certificate import certified_bracket


def small_wall(seed: int) -> Assembly:
    """The irregular wall of a seed: 2 to 4 columns in 3 courses, friction from 0.3 to 1.0."""
    generator = np.random.default_rng([seed, 7])
    return irregular_wall(seed, int(generator.integers(2, 5)), 3, round(float(generator.uniform(0.3, 1.0)), 3))


def certified(seed: int, seconds: float) -> float | None:
    """Relative distance of the certified bound below the least state known, printed with the rest; None without any."""
    wall = small_wall(seed)
    began = time.process_time()
    known = LimitAnalysis().solve(wall, SearchSettings())
    searched = time.process_time()
    if known.finding is not Finding.COLLAPSES or not known.multiplier or known.mechanism is None:
        print(f"{seed:4d} {wall.n_free:3d} {wall.n_interfaces:3d}  {known.finding}", flush=True)
        return None
    document = certified_bracket(make_problem(wall), known.multiplier, known.mechanism, seconds)[1]
    bound = float(Fraction(document["bound"])) if document is not None else 0.0
    gap = 1.0 - bound / known.multiplier
    spent = f"{searched - began:6.1f} {time.process_time() - searched:6.1f}"
    print(
        f"{seed:4d} {wall.n_free:3d} {wall.n_interfaces:3d} {known.multiplier:.9f} {bound:.9f} {gap:.1e} {spent}",
        flush=True,
    )
    return gap


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line a wall and the counts."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count, seconds, first = (float(word) for word in [*given, *["100", "60", "0"][len(given) :]])
    gaps = [certified(seed, seconds) for seed in range(int(first), int(first + count))]
    known = [gap for gap in gaps if gap is not None]
    closed, within = sum(gap <= WINDOWS.proved for gap in known), sum(gap <= 0.01 for gap in known)
    print(f"{len(known)} walls collapse; {closed} are closed and certified within {seconds:g} s, {within} to 1 %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
