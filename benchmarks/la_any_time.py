"""What `la` answers at limits of 1, 3 and 10 s on large running bonds: `python -m benchmarks la_any_time [METHOD]`.

Every run is isolated and judged as in a comparison. It fails if it takes longer than the limit and a grace, or answers
less than under a shorter limit. Limits are wall-clock seconds, so a busy machine gets less done in them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from harness.engine.pipeline import execute
from harness.engine.run import Limits, Run
from harness.model.case import Case, CaseFile
from harness.model.method import Status
from harness.model.result import Result
from harness.model.wall import Wall

SIZES = ((20, 10), (40, 25), (60, 50), (100, 70))
"""Courses, and bricks of one."""
SECONDS = (1.0, 3.0, 10.0)
GRACE = 0.5
"""Seconds beyond the limit that a run may take, after which it is killed."""
LOWER = 1e-9
"""Relative difference from which a multiplier is lower."""


@dataclass(frozen=True)
class Timed:
    """A run under a limit [s], and the least multiplier under shorter ones, infinite where there was none."""

    blocks: int
    limit: float
    result: Result
    before: float

    @property
    def least(self) -> float:
        """The least multiplier under this limit and shorter ones."""
        return self.before if self.result.multiplier is None else min(self.before, self.result.multiplier)

    @property
    def failed(self) -> bool:
        """Whether it was late, or a shorter limit gave a lower value."""
        value = np.inf if self.result.multiplier is None else self.result.multiplier
        seconds = self.result.wall_seconds
        return seconds is None or seconds > self.limit + GRACE or value > self.before * (1.0 + LOWER)

    @property
    def said(self) -> str:
        """The multiplier and what it is, or the status."""
        if self.result.multiplier is None:
            return self.result.status.value
        bound = self.result.flow == "associated"
        least = (
            "the upper bound" if bound else "so far" if self.result.details.get("stopped_by_limit") else "whole search"
        )
        accepted = "" if self.result.status is Status.OK else f", {self.result.status.value}"
        return f"{self.result.multiplier:.6g} ({least}{accepted})"


def case_of(courses: int, bricks: int) -> Case:
    """A running bond of so many courses, pushed sideways by its own weight."""
    wall = {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": 0.65,
        "pattern": {
            "type": "running_bond",
            "block_length": 0.4,
            "block_height": 0.175,
            "count": courses,
            "bricks": bricks,
        },
        "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
    }
    name = f"bond-{courses}-{bricks}"
    return Case(CaseFile(id=name, title=name, source="benchmarks.la_any_time"), Wall.model_validate(wall), "wall.json")


def timed(
    sizes: Sequence[tuple[int, int]] = SIZES, limits: Sequence[float] = SECONDS, method: str = "la"
) -> Iterator[Timed]:
    """Every wall under every limit."""
    for courses, bricks in sizes:
        case = case_of(courses, bricks)
        blocks = case.assembly.n_free  # The wall is expanded before the clock starts.
        least = np.inf
        for limit in limits:
            (result,) = execute([Run(case, method, {}, Limits(limit))], None, 1)
            run = Timed(blocks, limit, result, least)
            least = run.least
            yield run


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table of a method, `la` unless another is named; how many runs failed."""
    method, *_ = [*(sys.argv[1:] if arguments is None else arguments), "la"]
    print("| blocks | limit s | answer | s | CPU s |\n|---|---|---|---|---|")
    failed = 0
    for run in timed(method=method):
        failed += run.failed
        spent = f"{run.result.wall_seconds:.2f} | {run.result.cpu_seconds:.2f}"
        print(f"| {run.blocks} | {run.limit:g} | {run.said} | {spent} |", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
