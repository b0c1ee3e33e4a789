"""Walls of irregular blocks that nobody chose: `la` beside the springs' plateau and the associated maximum.

Run as `python -m benchmarks irregular_walls [count [least [most]]]`: so many walls, of
`least` to `most` courses and columns (3 to 8). Central paths alone end above the plateau of `fe` on one such wall in
eight.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

from benchmarks.walls import drawn
from harness.model.method_registry import load_method
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings

SAME = 1e-7
"""Relative difference of multipliers that count as equal."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the counts; 1 if a least known multiplier is above the plateau or the associated maximum."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count, *sizes = [int(word) for word in given] or [200]
    springs = load_method("fe")
    blocks: list[int] = []
    above: list[int] = []
    below = equal = 0
    spent = 0.0
    for seed in range(count):
        wall = drawn(seed, *sizes)
        plateau = springs.solve(wall, springs.Settings()).multiplier
        start = time.process_time()
        least = LimitAnalysis().solve(wall, SearchSettings()).multiplier
        spent += time.process_time() - start
        greatest = AssociatedLimitAnalysis().solve(wall, AssociatedSettings()).multiplier
        if least is None or plateau is None or greatest is None:
            continue
        blocks.append(wall.n_free)
        slack = SAME * plateau
        if least > min(plateau + slack, greatest + slack):
            above.append(seed)
        below += least < plateau - slack
        equal += abs(least - plateau) <= slack
    if not blocks:
        print(f"{count} walls, none of which all three methods have a multiplier for")
        return 0
    span = f"{min(blocks)} to {max(blocks)} blocks"
    print(f"{count} walls; {len(blocks)} of them, of {span}, have a multiplier of all three methods")
    print(f"least known below the plateau: {below}; equal: {equal}; above it or the maximum: {above or 'none'}")
    print(f"la: {spent:.0f} CPU s")
    return int(bool(above))


if __name__ == "__main__":
    sys.exit(main())
