"""Walls that nobody chose: `fe` on random coursed walls, held to the associated maximum and to its own check.

Run as `python -m methods.fe.random_walls [COUNT]`. Wall k is drawn from seed k: 3 to 10 courses of 3 to 8 block
lengths, blocks of 0.5 to 1.25 lengths, height 0.3 to 0.75 of the length, friction 0.3 to 1.1.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Status, load_method
from harness.model.wall import Wall
from methods.fe.adapter import GapSprings
from methods.fe.answers import WIDE
from methods.fe.settings import GapSpringsSettings
from methods.springs.plateau import CERTIFICATE

ABOVE = 1e-6
"""Relative: how far a plateau may lie above the associated maximum, for the accuracy of the linear programme."""


def random_wall(seed: int) -> Assembly:
    """The random coursed wall of this seed."""
    generator = np.random.default_rng(seed)
    length = float(generator.integers(3, 9))
    courses = []
    for _ in range(int(generator.integers(3, 11))):
        widths: list[float] = []
        while length - sum(widths) > 0.0:
            width = min(float(generator.choice([0.5, 0.75, 1.0, 1.25])), length - sum(widths))
            widths.append(width)
        courses.append(widths)
    wall = {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": round(float(generator.uniform(0.3, 1.1)), 3),
        "pattern": {
            "type": "running_bond",
            "block_length": 0.4,
            "block_height": round(0.4 * float(generator.uniform(0.3, 0.75)), 3),
            "courses": courses,
        },
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    return build(Wall.model_validate(wall), f"random wall {seed}").assembly


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
    if spread > WIDE:
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
    print(f"worst residual of a collapse state: {tally.worst:.1e} (certificate {CERTIFICATE:g})")
    print(f"largest spread of the histories: {100.0 * tally.spread:.2f} %")
    print(f"spread above {100.0 * WIDE:g} %: {tally.wide or 'none'}")
    print(f"walls with a history that reached no plateau: {tally.lost or 'none'}")
    return int(bool(tally.above) or tally.worst > CERTIFICATE)


if __name__ == "__main__":
    sys.exit(main())
