"""What many load cases of one wall cost in multiples of one: `python -m benchmarks load_cases [METHOD ...]`.

Figures are CPU seconds of `drystone compare` with all it starts, so that a busy machine does not change them: of a wall
under one of its load cases and under 20, with a report and without. The load cases push it sideways and lift it.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.overhead import command_cost
from harness.engine.threads import pin

COUNT = 20
TARGET = 3.0
"""Greatest ratio that is aimed at."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    given = sys.argv[1:] if arguments is None else arguments
    pin()
    print(f"{'method':<16} {'report':<7} {'one [s]':>8} {f'{COUNT} [s]':>8} {'ratio':>6}")
    for method in given or ["la-associated"]:
        for report in (True, False):
            one, many = (_cost(method, count, report=report) for count in (1, COUNT))
            shown = "yes" if report else "no"
            print(f"{method:<16} {shown:<7} {one:>8.2f} {many:>8.2f} {many / one:>6.2f}", flush=True)
    print(f"aim: a ratio below {TARGET:g}")
    return 0


def _cost(method: str, count: int, *, report: bool) -> float:
    """CPU seconds of a comparison of so many load cases."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "wall.json").write_text(json.dumps(wall_under(count)), encoding="utf-8")
        words = ["compare", "wall.json", "--methods", method, "--fresh", *([] if report else ["--no-report"])]
        return command_cost(folder, *words)


def wall_under(count: int, courses: int = 9, bricks: int = 10) -> dict[str, Any]:
    """A wall of running bond, of 94 bricks unless said otherwise, under so many load cases."""
    cases = {f"push-{k + 1}": {"live": {"body": [{"per_weight": [1.0, 0.02 * (k % COUNT)]}]}} for k in range(count)}
    pattern = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": courses, "bricks": bricks}
    return {"format": "wall/1", "unit_weight": 20.0, "friction": 0.65, "pattern": pattern, "load_cases": cases}


if __name__ == "__main__":
    sys.exit(main())
