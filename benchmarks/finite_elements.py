"""The bench of the gap-spring method: measured values, CPU seconds and peak memory beside the figures to reach.

Run as `python -m benchmarks finite_elements [--full] [bricks ...]`. Without arguments the walls of up to 990 bricks are
run; `--full` adds 2,485 (minutes) and 9,870 (half an hour, at friction 0.4).
Times are CPU seconds of one thread, start-up and compilation apart, with all histories of the default settings.
"""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Sequence

from benchmarks.walls import arch, running_bond
from harness.model.assembly import Assembly
from harness.model.case import read_case, shipped_cases
from methods.fe.gap_springs import GapSprings
from methods.fe.settings import GapSpringsSettings
from methods.springs.warm_up import block_on_halves

WALLS: tuple[tuple[int, int, float, float, float], ...] = (
    (21, 3, 0.65, 13 / 23, 0.05),
    (55, 5, 0.65, 0.5056, 0.12),
    (105, 7, 0.65, 0.4731, 0.24),
    (210, 10, 0.65, 0.4484, 0.56),
    (465, 15, 0.65, 0.4282, 2.3),
    (990, 22, 0.65, 0.4159, 15.7),
    (2485, 35, 0.65, float("nan"), 180.0),
    (9870, 70, 0.4, float("nan"), 1800.0),
)
"""(bricks, bricks of a course, friction, plateau to reach, CPU seconds recorded, to reach again)."""

ARCH = ((0.5, 0.183154), (0.7, 0.239316), (1.0, 0.239316))
ARCH_POINT_LOAD = ((0.5, 0.918185), (0.55, 1.195236), (0.7, 1.430092))
"""(friction, plateau to reach) of the arch under its weight sideways and under a point load."""

PUBLISHED = (("ferris-tin-loi-1", 0.641), ("ferris-tin-loi-2", 0.564), ("ferris-tin-loi-4", 0.264))
"""Cases with the value of a public gap-spring code, to be met within 0.3 %."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    walls = WALLS if "--full" in given else WALLS[:6]
    chosen = {int(a) for a in given if a != "--full"} or {w[0] for w in walls}
    method = GapSprings()
    method.solve(running_bond(10, 5, 0.65), GapSpringsSettings())
    print("case                      value          to reach       CPU s   to reach  events  spread    residual  MB")
    for stiffness, ratio in ((1e2, 0.01), (1e5, 0.5), (1e8, 100.0)):
        settings = GapSpringsSettings(normal_stiffness=stiffness, stiffness_ratio=ratio)
        _line(f"block kn {stiffness:.0e} kt/kn {ratio:g}", block_on_halves((0.6, 0.4)), settings, 0.5 / 1.05, 0.1)
    lobatto = GapSpringsSettings(rule="lobatto", points=3)
    _line("block, Lobatto 3", block_on_halves((0.6, 0.4)), lobatto, 0.5 / 1.075, 0.1)
    for friction in (0.3, 0.4, 0.5, 0.75, 1.0):
        value = friction if friction < 0.6 else 13 / 23
        _line(f"21 bricks mu {friction:g}", running_bond(6, 3, friction), GapSpringsSettings(), value, 0.1)
    for friction, value in ARCH:
        _line(f"arch of 27 mu {friction:g}", arch(friction), GapSpringsSettings(), value, 0.3)
    for friction, value in ARCH_POINT_LOAD:
        _line(f"arch, point load mu {friction:g}", arch(friction, True), GapSpringsSettings(), value, 0.3)
    for name, value in PUBLISHED:
        _line(name, read_case(shipped_cases() / name).assembly, GapSpringsSettings(), value, 0.3)
    for bricks, course, friction, value, seconds in WALLS:
        if bricks in chosen:
            wall = running_bond(2 * course, course, friction)
            _line(f"{bricks} bricks mu {friction:g}", wall, GapSpringsSettings(), value, seconds)
    return 0


def _line(label: str, wall: Assembly, settings: GapSpringsSettings, value: float, seconds: float) -> None:
    """Run one case and print its row."""
    start = time.process_time()
    answer = GapSprings().solve(wall, settings)
    spent = time.process_time() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    found = "none" if answer.multiplier is None else f"{answer.multiplier:.10f}"
    spread, residuals = answer.details.get("spread"), answer.details.get("residuals")
    print(
        f"{label:<25} {found:<14} {value:<14.10f} {spent:<7.2f} {seconds:<9g} {answer.iterations:<7}"
        f" {'-' if spread is None else format(spread, '.1e'):<9}"
        f" {'-' if residuals is None else format(max(residuals.values()), '.0e'):<9} {memory:.0f}"
    )


if __name__ == "__main__":
    sys.exit(main())
