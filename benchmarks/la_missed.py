"""How often `la` misses a lower state that something else finds.

Run as `python -m benchmarks la_missed [WALLS [SECONDS [SEED]]]`: WALLS (300) random walls of ten kinds by turns, of 14
to 40 blocks, until SECONDS (1500) of CPU are spent. The answer at normal effort stands beside that at deep effort, that
of `la-paper` where it is installed, and the states of the mechanisms that `la` finds at friction 5 % lower and higher.
Each of them is a collapse state that any search may find. Another SEED (0) draws other walls.
"""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from benchmarks.walls import arch, courses_of_stones, drawn, pushed, random_wall
from cases.start import STARTS
from cases.useful import irregular_stones
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method_registry import load_method, method_names
from harness.model.result import relative_velocities
from harness.model.wall import Wall
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings

LOWER = 1e-6
"""Relative difference from which a state is lower."""
BLOCKS = range(14, 41)
"""Numbers of free blocks that are taken."""
CLOSE = (0.95, 1.05)
"""Factors on friction of the walls whose mechanisms are tried."""


def _friction(dice: np.random.Generator) -> float:
    return round(float(dice.uniform(0.3, 1.1)), 3)


def _started(kind: str, friction: float, **numbers: Any) -> Wall:
    """A wall of `drystone new`."""
    made: Wall = STARTS[kind](**numbers).model_copy(update={"friction": friction})
    return made


def _running(dice: np.random.Generator) -> Assembly:
    pattern = {
        "type": "running_bond",
        "block_length": 0.4,
        "block_height": round(float(dice.uniform(0.1, 0.4)), 3),
        "count": int(dice.integers(4, 10)),
        "bricks": int(dice.integers(2, 6)),
        "start": str(dice.choice(["half", "full"])),
    }
    return pushed(pattern, _friction(dice))


def _panel(dice: np.random.Generator) -> Assembly:
    """Rows of stones of one to three cells; some reach over two rows."""
    letters, columns = iter(map(chr, itertools.count(0x100))), int(dice.integers(4, 8))
    rows: list[list[str]] = []
    for _ in range(int(dice.integers(4, 9))):
        row: list[str] = []
        while len(row) < columns:
            row += [next(letters)] * int(dice.integers(1, 4))
        rows.append(row[:columns])
    for upper, lower in itertools.pairwise(rows):
        k = int(dice.integers(columns))
        if dice.uniform() < 0.5 and upper.count(upper[k]) == 1 and lower.count(lower[k]) == 1:
            lower[k] = upper[k]
    layout = ["".join(row) for row in rows] + ["#" * columns]
    height = round(float(dice.uniform(0.15, 0.4)), 2)
    return pushed(
        {"type": "panel", "cell_length": 0.3, "cell_height": height, "layout": layout, "fixed": "#"}, _friction(dice)
    )


def _bonded(dice: np.random.Generator) -> Assembly:
    kind = str(dice.choice(["flemish", "english"]))
    length, height = (round(float(dice.uniform(*span)), 3) for span in ((0.5, 1.25), (0.3, 0.8)))
    return build(_started(kind, _friction(dice), length=length, height=height, brick_height=0.1)).assembly


def _ashlar(dice: np.random.Generator) -> Assembly:
    numbers = {"length": round(float(dice.uniform(1.5, 3.0)), 2), "courses": int(dice.integers(4, 9))}
    return build(_started("ashlar", _friction(dice), seed=int(dice.integers(10_000)), **numbers)).assembly


def _facade(dice: np.random.Generator) -> Assembly:
    """One opening in bricks of random proportions."""
    numbers = {
        "brick_length": 0.5,
        "brick_height": round(float(dice.uniform(0.2, 0.4)), 3),
        "opening_width": float(dice.choice([0.5, 0.75, 1.0])),
        "opening_height": 0.8,
        "spandrel_height": 0.3,
    }
    return build(_started("facade", _friction(dice), storeys=1, openings=1, **numbers)).assembly


def _sloping(dice: np.random.Generator) -> Assembly:
    """Stones in courses with inclined head joints, pushed up or down a slope to either side."""
    made = irregular_stones(int(dice.integers(10_000)), float(dice.choice([1.5, 2.0])), int(dice.integers(3, 7)))
    angle = np.radians(float(dice.choice([0.0, 180.0, 30.0, -30.0])))
    loads = {"live": {"body": [{"per_weight": [float(np.cos(angle)), float(np.sin(angle))]}]}}
    data = made.model_dump(exclude_none=True, exclude_unset=True) | {"friction": _friction(dice), "loads": loads}
    return build(Wall.model_validate(data)).assembly


def _pushed_on_top(dice: np.random.Generator) -> Assembly:
    """A coursed wall pushed by a force on one of its upper blocks."""
    wall = random_wall(int(dice.integers(100_000)))
    live, high = np.zeros_like(wall.live), wall.free[np.argsort(wall.centroid[wall.free, 1])[-3:]]
    live[int(dice.choice(high)), 0] = float(wall.weight[wall.free].sum())
    return replace(wall, live=live)


KINDS: dict[str, Callable[[np.random.Generator], Assembly]] = {
    "random courses": lambda dice: random_wall(int(dice.integers(100_000))),
    "Voronoi cells": lambda dice: drawn(int(dice.integers(100_000)), 3, 7),
    "courses of stones": lambda dice: courses_of_stones(int(dice.integers(100_000))),
    "running bond": _running,
    "panel of cells": _panel,
    "Flemish or English bond": _bonded,
    "ashlar": _ashlar,
    "facade with an opening": _facade,
    "inclined stones, pushed on a slope": _sloping,
    "arch or pushed on top": lambda dice: (
        arch(_friction(dice), bool(dice.integers(2)), int(dice.integers(14, 31)))
        if dice.uniform() < 0.3
        else _pushed_on_top(dice)
    ),
}


def walls(kind: str, seed: int) -> Iterator[Assembly]:
    """Walls of a kind that are of the sizes taken and have a live load, without end."""
    for number in itertools.count():
        try:
            wall = KINDS[kind](np.random.default_rng([number, 56 + seed, list(KINDS).index(kind)]))
        except InputError:
            continue
        if wall.n_free in BLOCKS and wall.has_live_load:
            yield wall


@dataclass
class Tally:
    """What was found: walls with a value of `la`, misses as rows, CPU seconds of `la` at normal effort and in all."""

    walls: int = 0
    without: int = 0
    missed: list[str] = field(default_factory=list)
    seconds: float = 0.0


def multiplier(method: Any, wall: Assembly, settings: Any) -> float:
    """The multiplier of an answer; infinite where there is none."""
    value = method.solve(wall, settings).multiplier
    return float("inf") if value is None else float(value)


def close_by(wall: Assembly) -> float:
    """The least multiplier of the mechanisms that `la` finds at close frictions; infinite where forces fit none."""
    motions = []
    for factor in CLOSE:
        answer = LimitAnalysis().solve(replace(wall, friction=factor * wall.friction), SearchSettings())
        if answer.mechanism is not None:
            motions.append(np.column_stack(relative_velocities(wall, answer.mechanism)))
    found = LimitAnalysis().solve_from(wall, SearchSettings(), motions).multiplier if motions else None
    return float("inf") if found is None else float(found)


def run(kind: str, wall: Assembly, number: int, tally: Tally) -> None:
    """Count one wall, and print it where something is lower."""
    start = time.process_time()
    own = multiplier(LimitAnalysis(), wall, SearchSettings())
    tally.seconds += time.process_time() - start
    if own == float("inf"):
        tally.without += 1
        return
    tally.walls += 1
    others = {
        "deep": multiplier(LimitAnalysis(), wall, SearchSettings(effort="deep", bound_seconds=0.0)),
        "friction 5 % off": close_by(wall),
    }
    if "la-paper" in method_names():
        paper = load_method("la-paper")
        others["la-paper"] = multiplier(paper, wall, paper.Settings())
    lower = {name: value for name, value in others.items() if value < own - LOWER * abs(own)}
    if lower:
        said = ", ".join(f"{name} {value:.7f} ({100 * (value / own - 1):+.2f} %)" for name, value in lower.items())
        tally.missed.append(f"| {kind} {number} | {wall.n_free} | {own:.7f} | {said} |")
        print(tally.missed[-1], flush=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the misses and their number."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    count, seconds, seed = (int(a) for a in [*given, *["300", "1500", "0"][len(given) :]])
    sources, tally, began = {kind: walls(kind, seed) for kind in KINDS}, Tally(), time.process_time()
    print("| wall | blocks | `la` | lower |\n|---|---|---|---|")
    for number in range(count):
        if time.process_time() - began > seconds:
            break
        kind = list(KINDS)[number % len(KINDS)]
        run(kind, next(sources[kind]), number // len(KINDS), tally)
        if kind == list(KINDS)[-1]:
            print(f"{tally.walls} walls, {time.process_time() - began:.0f} CPU s", file=sys.stderr, flush=True)
    print(f"missed {len(tally.missed)} of {tally.walls} walls; {tally.without} more have no multiplier")
    print(f"la: {tally.seconds:.0f} CPU s of {time.process_time() - began:.0f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
