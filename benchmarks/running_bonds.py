"""Values and CPU seconds of the families on running bonds: `python -m benchmarks running_bonds [BRICKS ...]`.

Bricks of 0.4 by 0.2, friction 0.65, twice as many courses as bricks a course; without arguments 105, 210, 465 and 990
bricks. `de` is left out above 465, `de-soft` above 210. Of `la` the time after which its value was reached stands too.
Start-up and compilation are apart.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

from benchmarks.limit_analysis import SAME, by_clarabel, first_below, least_time
from benchmarks.walls import running_bond
from harness.model.method import Answer
from harness.model.method_registry import load_method

COURSES = {21: 3, 55: 5, 78: 6, 105: 7, 210: 10, 465: 15, 990: 22, 2485: 35, 4851: 49}
"""Bricks a course of a wall of so many bricks."""
MOST = {"de": 465, "de-soft": 210, "fe": 2485}
"""Bricks above which a method takes minutes."""
METHODS = ("fe", "la-associated", "la", "de", "de-soft")


def described(method: str, answer: Answer) -> str:
    """What stands beside the value: the bracket of distinct elements, when `la` reached its value."""
    if method == "la" and answer.multiplier is not None:
        return f"reached after {first_below(answer, (1.0 + SAME) * answer.multiplier):.2f} s"
    if answer.bracket is None or not method.startswith("de") or answer.multiplier is None:
        return ""
    low, high = answer.bracket
    return f"bracket {100 * (high - low) / high:.2f} %"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    given = [int(a) for a in (sys.argv[1:] if arguments is None else arguments)]
    for name in METHODS:  # compiled code is loaded by walls of more than 200 blocks
        method = load_method(name)
        small = running_bond(6, 3, 0.65) if name.startswith("de") else running_bond(20, 10, 0.65)
        method.solve(small, method.Settings())
    print("| bricks | method | multiplier | CPU s | |\n|---|---|---|---|---|")
    for bricks in given or (105, 210, 465, 990):
        wall = running_bond(2 * COURSES[bricks], COURSES[bricks], 0.65)
        for name in (name for name in METHODS if bricks <= MOST.get(name, bricks)):
            method = load_method(name)
            start = time.process_time()
            answer = method.solve(wall, method.Settings())
            spent = time.process_time() - start
            value = "none" if answer.multiplier is None else f"{answer.multiplier:.7f}"
            print(f"| {bricks} | {name} | {value} | {spent:.2f} | {described(name, answer)} |", flush=True)
        direct, value = least_time(1, by_clarabel, wall)
        print(f"| {bricks} | Clarabel called directly | {value:.7f} | {direct:.2f} | |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
