"""Walls that just stand or just fall, against closed forms: `python -m benchmarks knife_edge [--methods la,fe,de]`.

Each kind has a quantity at which it just stands, and is set off it by a share of 10^-k, to either side. Well above what
the numbers of a wall tell (`harness.model.limit`) the multiplier is that of the closed form, or the wall falls; well
below, it is at its limit for every method. A measured bracket is right where its ends leave room for the closed form.

The kinds: a block on an incline (friction against slope), harmonic stacks past a table edge (overhang against that of
the harmonic series), and a block that a wedge carries against a wall (friction against the angle of the wedge).
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from drystone.cli.options import say
from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding
from harness.model.method_registry import load_method, prepared
from harness.model.result import Judgement, Result
from harness.model.wall import Wall

METHODS = ("la", "la-associated", "fe", "fe-newton", "de", "de-soft")
RESOLVED, UNRESOLVED = (2, 3, 4, 5, 6), (9, 10, 12)
"""Powers k of the shares 10^-k that the numbers of a wall tell from none, and that they do not."""
EXACT = 1e-6
"""Relative accuracy of multipliers that are exact: near the limit of a wall they lose up to five digits of it."""
AT_REST = 2e-6
"""What a measured load may leave out of balance, as a part of the dead load: twice the residual of a rest."""


@dataclass(frozen=True)
class Edge:
    """A wall near its limit.

    Attributes:
        name: its kind and the share by which it is set off.
        wall: it.
        multiplier: by closed form, below zero where the wall falls; None where it is at its limit.
    """

    name: str
    wall: Assembly
    multiplier: float | None


def incline(degrees: float, share: float) -> tuple[dict[str, Any], float]:
    """A block on a slope, friction off tan(slope) by a share; pushed down the slope it slides at tan(phi - slope)."""
    slope = math.radians(degrees)
    friction = math.tan(slope) * (1.0 + share)

    def turned(x: float, y: float) -> list[float]:
        return [x * math.cos(slope) + y * math.sin(slope), y * math.cos(slope) - x * math.sin(slope)]

    blocks = [
        _block("slope", [turned(-2.0, -1.0), turned(4.0, -1.0), turned(4.0, 0.0), turned(-2.0, 0.0)], fixed=True),
        _block("block", [turned(0.0, 0.0), turned(2.0, 0.0), turned(2.0, 0.5), turned(0.0, 0.5)]),
    ]
    return _wall(blocks, friction, {"body": [{"per_weight": [1, 0]}]}), math.tan(math.atan(friction) - slope)


def harmonic(count: int, share: float) -> tuple[dict[str, Any], float]:
    """Blocks 1 long past a table edge, overhangs 1/2, 1/4, 1/6... from the top off by a share; pressed at the tip.

    The part above a bed tips about the end of what bears it: the least of these multipliers.
    """
    height = 0.3
    ends = [0.0]
    for k in range(count, 0, -1):
        ends.append(ends[-1] + (1.0 + share) / (2.0 * k))
    blocks = [_block("table", [[-4.0, -1.0], [0.0, -1.0], [0.0, 0.0], [-4.0, 0.0]], fixed=True)]
    for k, end in enumerate(ends[1:]):
        low, top = k * height, (k + 1) * height
        blocks.append(_block(str(k + 1), [[end - 1.0, low], [end, low], [end, top], [end - 1.0, top]]))
    tip = [ends[-1], count * height]
    weight = 20.0 * height
    multipliers = [
        weight * sum(edge - (end - 0.5) for end in ends[k + 1 :]) / (ends[-1] - edge)
        for k, edge in enumerate(ends[:-1])
    ]
    live = {"points": [{"block": str(count), "at": tip, "force": [0, -1]}]}
    return _wall(blocks, 0.5, live), min(multipliers)


def wedge(degrees: float, share: float) -> tuple[dict[str, Any], float]:
    """A block that a wedge carries against a wall; friction off that which just keeps the wedge from being driven out.

    With phi at wall, wedge and floor the wedge needs a pull of w tan phi - W tan(angle - 2 phi): the weight W of the
    block drives it out, its own weight w keeps it.
    """
    angle = math.radians(degrees)
    rise = math.tan(angle)
    toe = 0.2
    wedge_area, block_area = 3.0 * toe + 0.5 * 3.0 * 3.0 * rise, 2.0 * 2.0 + 0.5 * 2.0 * 2.0 * rise

    def pull(friction: float) -> float:
        phi = math.atan(friction)
        return 20.0 * (wedge_area * friction - block_area * math.tan(angle - 2.0 * phi))

    low, high = 0.0, rise
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pull(middle) < 0.0 else (low, middle)
    friction = high * (1.0 + share)
    top = toe + 2.0 * rise + 2.0
    blocks = [
        _block("wall", [[-1.0, 1.5 * toe], [0.0, 1.5 * toe], [0.0, top + 1.0], [-1.0, top + 1.0]], fixed=True),
        _block("floor", [[-1.0, -1.0], [8.0, -1.0], [8.0, 0.0], [-1.0, 0.0]], fixed=True),
        _block("wedge", [[0.0, 0.0], [3.0, 0.0], [3.0, toe + 3.0 * rise], [0.0, toe]]),
        _block("block", [[0.0, toe], [2.0, toe + 2.0 * rise], [2.0, top], [0.0, top]]),
    ]
    live = {"points": [{"block": "wedge", "at": [2.0, rise], "force": [1, 0]}]}
    return _wall(blocks, friction, live), pull(friction)


def _block(name: str, polygon: list[list[float]], **more: Any) -> dict[str, Any]:
    return {"id": name, "polygon": polygon, **more}


def _wall(blocks: list[dict[str, Any]], friction: float, live: dict[str, Any]) -> dict[str, Any]:
    return {"format": "wall/1", "unit_weight": 20, "friction": friction, "blocks": blocks, "loads": {"live": live}}


KINDS = {
    "incline of 20 degrees": lambda share: incline(20.0, share),
    "incline of 40 degrees": lambda share: incline(40.0, share),
    "one block past an edge": lambda share: harmonic(1, share),
    "harmonic stack of 4": lambda share: harmonic(4, share),
    "harmonic stack of 12": lambda share: harmonic(12, share),
    "wedge of 50 degrees": lambda share: wedge(50.0, share),
}
"""Walls by kind, each a description and a multiplier by the share it is set off its limit."""


def edges(kind: str, resolved: Sequence[int] = RESOLVED, unresolved: Sequence[int] = UNRESOLVED) -> Iterator[Edge]:
    """Walls of a kind at its limit and off it to either side, by shares 10^-k that are resolved and that are not."""
    yield _edge(kind, 0.0, resolved=False)
    for powers, by_form in ((resolved, True), (unresolved, False)):
        for power in powers:
            for sign in (1.0, -1.0):
                yield _edge(kind, sign * 10.0**-power, resolved=by_form)


def _edge(kind: str, share: float, resolved: bool) -> Edge:
    described, multiplier = KINDS[kind](share)
    wall = build(Wall.model_validate(described)).assembly
    return Edge(f"{kind}, {share:+.0e}", wall, multiplier if resolved else None)


def verdict(edge: Edge, result: Result, judged: Judgement) -> str:
    """ "right", "undecided" (no finding, or one that is not shown), "rejected" by the judge, or "wrong"."""
    if judged.accepted is False:
        return "rejected"
    if result.finding is Finding.NONE or judged.accepted is None:
        return "undecided"
    if edge.multiplier is None:
        return "right" if result.finding is Finding.AT_LIMIT else "wrong"
    if edge.multiplier < 0.0:
        return "right" if result.finding is Finding.FALLS else "wrong"
    if result.finding is not Finding.COLLAPSES or result.multiplier is None:
        return "wrong"
    if not result.traits.brackets or result.bracket is None:
        return "right" if abs(result.multiplier - edge.multiplier) <= EXACT * edge.multiplier else "wrong"
    slack = result.traits.accuracy * edge.multiplier + AT_REST * edge.wall.load_unit
    return "right" if result.bracket[0] - slack <= edge.multiplier <= result.bracket[1] + slack else "wrong"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what every method finds of every wall, and how many are right; 1 if any is wrong."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks knife_edge", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--methods", default=",".join(METHODS))
    names = parser.parse_args(arguments).methods.split(",")
    methods = {name: prepared(load_method(name)) for name in names}
    counts: dict[str, Counter[str]] = {name: Counter() for name in names}
    for kind in KINDS:
        for edge in edges(kind):
            expected = "at its limit" if edge.multiplier is None else f"{edge.multiplier:.6g}"
            said = []
            for name, method in methods.items():
                result, judged = answered(method, edge.wall)
                found = verdict(edge, result, judged)
                counts[name][found] += 1
                value = f"{result.multiplier:.6g}" if result.finding is Finding.COLLAPSES else str(result.finding)
                said.append(f"{name} {value}" + ("" if found == "right" else f" ({found})"))
            say(f"{edge.name:<34} {expected:>14} | {'; '.join(said)}")
    for name, count in counts.items():
        say(f"{name:<20} {', '.join(f'{number} {what}' for what, number in sorted(count.items()))}")
    return int(any(count["wrong"] for count in counts.values()))
