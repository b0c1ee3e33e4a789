"""What each source of collapse states gains: on how many walls it reached the least known, and reached it alone.

Run as `python -m benchmarks la_sources [COUNT [LEAST MOST]]`: the library's walls with a
live load and up to 1,000 interfaces, COUNT (40) coursed and COUNT irregular random walls; with LEAST and MOST COUNT
irregular walls of so many courses and columns alone. A source counts as reaching a value with the descents from it.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.walls import drawn, random_wall
from harness.model.assembly import Assembly
from harness.model.case import read_case
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings

CASES = Path(__file__).parents[1] / "cases"
SAME = 1e-7
"""Relative difference of multipliers that count as equal."""


@dataclass
class Gain:
    """Walls on which a source was begun, led to a state, reached the least known, and reached it alone; CPU seconds."""

    begun: int = 0
    led: int = 0
    reached: int = 0
    alone: int = 0
    seconds: float = 0.0


def walls(count: int, sizes: list[int]) -> Iterator[Assembly]:
    """The walls of the table."""
    if sizes:
        yield from (drawn(seed, *sizes) for seed in range(count))
        return
    for folder in sorted(CASES.iterdir()):
        if (folder / "case.toml").exists():
            wall = read_case(folder).assembly
            if wall.has_live_load and wall.n_interfaces <= 1000:
                yield wall
    for seed in range(count):
        yield random_wall(seed)
        yield drawn(seed)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    count, *sizes = [int(word) for word in (sys.argv[1:] if arguments is None else arguments)] or [40]
    gains: dict[str, Gain] = defaultdict(Gain)
    collapses = 0
    began = time.process_time()
    for wall in walls(count, sizes):
        answer = LimitAnalysis().solve(wall, SearchSettings())
        if answer.multiplier is None or "sources" not in answer.details:
            continue
        collapses += 1
        rows = answer.details["sources"]
        enough = answer.multiplier + SAME * abs(answer.multiplier)
        reached = {row["source"] for row in rows if row["least"] is not None and row["least"] <= enough}
        for row in rows:
            gain = gains[row["source"]]
            gain.begun += 1
            gain.led += row["least"] is not None
            gain.seconds += row["cpu_seconds"]
        for source in reached:
            gains[source].reached += 1
            gains[source].alone += reached == {source}
    print(f"{collapses} walls collapse; {time.process_time() - began:.0f} CPU s in all")
    for source, gain in gains.items():
        print(
            f"| {source} | {gain.begun} | {gain.led} | {gain.reached} | {gain.alone} | {gain.seconds:.1f} |", flush=True
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
