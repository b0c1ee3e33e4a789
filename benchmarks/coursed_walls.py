"""Walls that nobody chose: `fe` on random coursed walls, held to the associated maximum and to its own check.

Run as `python -m benchmarks coursed_walls [COUNT]`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

from benchmarks.walls import random_wall
from harness.model.method import Status
from harness.model.method_registry import load_method
from methods.fe.answers import SPREAD
from methods.fe.gap_springs import GapSprings
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.options import CollapseTolerances

ABOVE = 1e-6
"""Relative: how far a plateau may lie above the associated maximum, for the accuracy of the linear programme."""


@dataclass
class Tally:
    """What was found on the walls run so far; lists hold seeds."""

    blocks: list[int] = field(default_factory=list)
    plateaus: int = 0
    without: list[int] = field(default_factory=list)
    above: list[int] = field(default_factory=list)
    wide: list[int] = field(default_factory=list)
    lost: list[int] = field(default_factory=list)
    worst: float = 0.0
    spread: float = 0.0


def run(seed: int, tally: Tally) -> None:
    """Solve the wall of one seed and count it."""
    wall = random_wall(seed)
    tally.blocks.append(wall.n_free)
    answer = GapSprings().solve(wall, GapSpringsSettings())
    if answer.status is not Status.OK or answer.multiplier is None:
        tally.without.append(seed)
        return
    tally.plateaus += 1
    associated = load_method("la-associated")
    bound = associated.solve(wall, associated.Settings()).multiplier
    if bound is not None and answer.multiplier > bound * (1.0 + ABOVE):
        tally.above.append(seed)
    tally.worst = max(tally.worst, *answer.details["residuals"].values())
    spread = answer.details["spread"] or 0.0
    tally.spread = max(tally.spread, spread)
    if spread > SPREAD:
        tally.wide.append(seed)
    if any(history["plateau"] is None for history in answer.details["histories"]):
        tally.lost.append(seed)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the counts; 1 if a wall breaks a rule."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count = int(given[0]) if given else 400
    tally, start = Tally(), time.process_time()
    for seed in range(count):
        run(seed, tally)
    print(
        f"{count} walls of {min(tally.blocks)} to {max(tally.blocks)} blocks in {time.process_time() - start:.0f} CPU s"
    )
    print(f"plateaus: {tally.plateaus}; without one: {tally.without or 'none'}")
    print(f"above the associated maximum: {tally.above or 'none'}")
    print(f"worst residual of a collapse state: {tally.worst:.1e} (certificate {CollapseTolerances().certificate:g})")
    print(f"largest spread of the histories: {100.0 * tally.spread:.2f} %")
    print(f"spread above {100.0 * SPREAD:g} %: {tally.wide or 'none'}")
    print(f"walls with a history that reached no plateau: {tally.lost or 'none'}")
    return int(bool(tally.above) or tally.worst > CollapseTolerances().certificate)


if __name__ == "__main__":
    sys.exit(main())
