"""Walls of irregular blocks that nobody chose: `la` beside the springs' plateau and the associated maximum.

Run as `python -m methods.la.irregular_walls [count [least [most]]]`, with OPENBLAS_NUM_THREADS=1: so many walls, of
`least` to `most` courses and columns (3 to 8). Central paths alone end above the plateau of `fe` on one such wall in
eight.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial import Voronoi

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import load_method
from harness.model.wall import Wall
from methods.la.adapter import AssociatedLimitAnalysis, LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings

WIDTH, HEIGHT = 3.0, 2.0
SAME = 1e-7
"""Relative difference of multipliers that count as equal."""


def irregular_wall(seed: int, columns: int, courses: int, friction: float) -> Assembly:
    """Voronoi cells of disturbed courses, pushed sideways, on a fixed block."""
    row, column = np.divmod(np.arange(columns * courses), columns)
    places = np.column_stack([column + 0.25 + 0.5 * (row % 2), row + 0.5])
    places += np.random.default_rng(seed).uniform(-0.35, 0.35, places.shape)
    seeds = np.clip(places / [columns, courses], 0.03, 0.97) * [WIDTH, HEIGHT]
    images = [seeds * [-1, 1], seeds * [1, -1], [2 * WIDTH, 0] + seeds * [-1, 1], [0, 2 * HEIGHT] + seeds * [1, -1]]
    cells = Voronoi(np.vstack([seeds, *images]))
    corners = [cells.vertices[cells.regions[cells.point_region[k]]].round(9) for k in range(len(seeds))]
    base = [[-1, -0.5], [WIDTH + 1, -0.5], [WIDTH + 1, 0], [-1, 0]]
    blocks: list[dict[str, Any]] = [{"id": "base", "polygon": base, "fixed": True}]
    blocks += [{"id": f"b{k}", "polygon": corner.tolist()} for k, corner in enumerate(corners)]
    wall = {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": friction,
        "blocks": blocks,
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    return build(Wall.model_validate(wall), f"irregular wall {seed}").assembly


def drawn(seed: int, least: int = 3, most: int = 8) -> Assembly:
    """The wall of a seed: courses and columns from `least` to `most`, friction from 0.3 to 1.0."""
    generator = np.random.default_rng([seed, 1])
    columns, courses = (int(count) for count in generator.integers(least, most + 1, 2))
    return irregular_wall(seed, columns, courses, round(float(generator.uniform(0.3, 1.0)), 3))


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
