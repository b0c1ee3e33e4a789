"""Residuals of the motions that `de` measures on the library: `python -m benchmarks measured_motions [--blocks 61]`.

The judge holds a measured motion to 2 % (`harness.engine.measured_motion`): supports at rest, no contact that
penetrates, none under force that opens, none that slips below its friction. Printed are the largest of these residuals
for every wall with a bracket, and how many lie below some limits.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence

from drystone.cli.options import say
from drystone.comparing import compare
from drystone.walls import library_wall
from harness.engine.plan import find_cases
from harness.model.method import Status

_LIMITS = (1e-9, 1e-4, 2e-2)
"""Up to which walls are counted; the last is what the judge tolerates."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a line a wall, and a summary."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks measured_motions", description=__doc__)
    parser.add_argument("--method", default="de")
    parser.add_argument("--blocks", type=int, default=61, help="walls of at most so many free blocks")
    parser.add_argument("--seconds", type=float, default=60.0, help="limit of a run, of wall-clock time")
    asked = parser.parse_args(arguments)
    found: dict[str, float] = {}
    without: Counter[str] = Counter()
    for case in find_cases([], "all", ()):
        if case.wall.load_case_fields or not case.assembly.has_live_load or case.assembly.n_free > asked.blocks:
            continue
        (result,) = compare(library_wall(case.id), [asked.method], seconds=asked.seconds).results
        residuals = {name: value for name, value in result.judge.residuals.items() if name.startswith("motion_")}
        if result.bracket is None or not residuals:
            without[str(result.finding) if result.status is Status.OK else str(result.status)] += 1
            continue
        worst = max(residuals, key=lambda name: residuals[name])
        found[case.id] = residuals[worst]
        size = f"{case.id:<34} {case.assembly.n_free:4d} blocks"
        say(f"{size}  {residuals[worst]:9.2e} {worst:<24} {result.judge.outcome}")
    below = ", ".join(f"{sum(value <= limit for value in found.values())} at most {limit:g}" for limit in _LIMITS)
    largest = max(found.values(), default=0.0)
    say(f"{len(found)} motions of {asked.method}: {below}; largest {largest:.2e}. Without: {dict(without)}.")
