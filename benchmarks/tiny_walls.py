"""Tiny walls whose least multiplier is known by going through all states: whether the lower bound passes it.

Run as `python -m benchmarks tiny_walls [count [first]]`: columns of two blocks, blocks on two halves of a joint, and
two or three irregular blocks, once with windows first and once with cases only. It prints every
wall whose bound passes or whose windows do not close, and the counts.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

import numpy as np

from benchmarks.walls import irregular_wall
from harness.model.assembly import Assembly
from methods.la.certify.window_certificate import certifier_of, equations_of
from methods.la.core.problem import make_problem
from methods.proof.search.bracket import bracket
from methods.proof.search.options import PROVED
from tests.bound.by_cases import in_cases
from tests.enumeration import least_by_enumeration
from tests.la.bodies import stack

SECONDS = 1.0
"""CPU seconds for a bracket; most close within a tenth of it."""
SHAPES = ((2, 1), (1, 2), (3, 1), (1, 3))
"""Columns and courses of irregular blocks."""
AGREES = 1e-6
"""Relative tolerance of enumeration, whose linear programmes round at 1e-7 and less."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the counts; 1 if a bound passes the least multiplier."""
    given = [int(word) for word in (sys.argv[1:] if arguments is None else arguments)]
    count, first = [*given, *[500, 0][len(given) :]]
    began = time.process_time()
    passed, closed, known = [], np.zeros(2, dtype=int), 0
    for seed in range(first, first + count):
        wall = _wall(seed)
        least = least_by_enumeration(wall)
        if not np.isfinite(least):
            continue
        known += 1
        problem = make_problem(wall)
        upper = least / problem.unit_multiplier
        windows = bracket(equations_of(problem), upper, SECONDS, certify=certifier_of(problem))
        cases = in_cases(problem, 1.1 * upper, SECONDS)
        lower = np.array([windows.lower, cases.lower]) / upper
        closed += lower >= 1.0 - PROVED
        if lower.max() > 1.0 + AGREES:
            passed.append(seed)
        if lower.max() > 1.0 + AGREES or lower[0] < 1.0 - PROVED:
            row = f"{seed:4d} {wall.n_free} blocks, {wall.n_interfaces} interfaces, least {least:.9f}, bounds over it"
            print(f"{row} {lower[0]:.9f} {lower[1]:.9f}", flush=True)
    print(
        f"{known} of {count} walls collapse; the bound passes the least multiplier on {len(passed)}; windows below it "
        f"close {closed[0]}, cases from a tenth above it come to it on {closed[1]}; {time.process_time() - began:.0f} s"
    )
    return 1 if passed else 0


def _wall(seed: int) -> Assembly:
    draw = np.random.default_rng([seed, 43])
    friction = float(draw.uniform(0.1, 1.5))
    if seed % 2:
        return irregular_wall(seed, *SHAPES[int(draw.integers(len(SHAPES)))], friction)
    blocks = int(draw.integers(1, 3))
    sizes = draw.uniform([0.2, 0.1], [1.5, 1.0], (blocks, 2))
    return stack(list(sizes[:, 0]), list(sizes[:, 1]), friction, 1 if blocks == 2 else 2)


if __name__ == "__main__":
    sys.exit(main())
