"""What each step of the friction continuation gains: `python -m benchmarks friction_continuation [COUNT]`.

Of COUNT (40) coursed and COUNT irregular random walls those of up to 30 blocks, on which all steps are tried. Only
central paths and the continuation are searched: with all steps, without each of them, and without any. A step gains
on a wall if the search ends higher without it, and loses if it ends lower.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace

from benchmarks.walls import drawn, random_wall
from harness.model.assembly import Assembly
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.sources import explore
from methods.la.sources.budget import Budget, Sizes
from methods.la.sources.friction_continuation import FrictionContinuation
from methods.la.sources.paths import CentralPath, ReducedFriction
from methods.la.sources.search import Search

LOWER = 1e-7
"""Relative difference from which a multiplier is lower."""


def least(problem: Problem, newton: NewtonMatrix, continuation: tuple[float, ...]) -> float:
    """The least multiplier (scaled) that central paths and a friction continuation lead to, or infinity."""
    search = Search(problem, newton, 0, Budget(replace(Sizes().limits("normal", problem), continuation=continuation)))
    explore(search, [ReducedFriction(), CentralPath(), FrictionContinuation()])
    return search.record.least


def suits(wall: Assembly) -> bool:
    """Whether all steps are tried on a wall, which has a live load."""
    return wall.has_live_load and 2 < wall.n_free <= Sizes().few_blocks


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    count = int([*(sys.argv[1:] if arguments is None else arguments), "40"][0])
    continuations = {"none": ()} | {
        f"without {step:g}": tuple(r for r in Sizes().continuation if r != step) for step in Sizes().continuation
    }
    gains = {name: [0, 0] for name in continuations}
    walls, began = 0, time.process_time()
    for wall in (wall for seed in range(count) for wall in (random_wall(seed), drawn(seed, 3, 5))):
        if not suits(wall):
            continue
        problem = make_problem(wall)
        newton = NewtonMatrix(problem)
        whole = least(problem, newton, Sizes().continuation)
        if whole == float("inf"):
            continue
        walls += 1
        for name, continuation in continuations.items():
            other = least(problem, newton, continuation)
            gains[name][0] += other > whole + LOWER * abs(whole)
            gains[name][1] += other < whole - LOWER * abs(whole)
    print(f"{walls} walls, {time.process_time() - began:.0f} CPU s\n| steps | higher | lower |\n|---|---|---|")
    for name, (higher, lower) in gains.items():
        print(f"| {name} | {higher} | {lower} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
