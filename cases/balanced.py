"""Walls whose balance others have worked out: overhanging stacks, blocks and columns on slopes, thrusts of an arch.

Stacks without friction: M. Paterson and U. Zwick, Overhang, American Mathematical Monthly 116, 2009. Columns on a
stepped slope: R. E. Goodman and J. W. Bray, Toppling of rock slopes, ASCE conference on rock engineering, 1976.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import cases.recipe as r
from cases.recipe import STATICS, Recipe, Remarks, push, recipe, reference, wall
from harness.model.wall import Wall

_OVERHANG = "M. Paterson and U. Zwick, Overhang, American Mathematical Monthly 116 (2009) 19-44, arXiv 0710.2357"
_STABILITY = ("published", "stability")
_THIN = 0.3
"""Height of a brick of length one."""


def _stack(title: str, courses: Sequence[Sequence[float]], edge: float = 0.0) -> Wall:
    """Bricks of length one without friction, by the middles of those of each course, on a table that ends at `edge`."""
    blocks: list[dict[str, object]] = [
        {"id": "table", "polygon": [(-4.0, -1.0), (edge, -1.0), (edge, 0.0), (-4.0, 0.0)], "fixed": True}
    ]
    for number, middles in enumerate(courses):
        low, high = round(number * _THIN, 12), round((number + 1) * _THIN, 12)
        for place, middle in enumerate(middles):
            left, right = round(middle - 0.5, 12), round(middle + 0.5, 12)
            polygon = [(left, low), (right, low), (right, high), (left, high)]
            blocks.append({"id": f"{number + 1}.{place + 1}", "polygon": polygon})
    return wall(title, unit_weight=20.0, friction=0.0, blocks=blocks)


def _stands(inside: bool) -> str:
    return "stands" if inside else "falls"


def _stacks() -> Iterator[Recipe]:
    """Stacks with counterweights just inside and outside their limit; a diamond that stands and one that does not."""
    best = (15.0 - 4.0 * math.sqrt(2.0)) / 8.0
    four = ((0.021446604750187,), (-0.646768184887956, best - 0.5), (-0.042571638624519,))
    for factor in (0.998, 1.002):
        word = _stands(factor < 1.0)
        yield _of_stack(
            f"overhang-best-4-{word}",
            _stack(
                f"Four bricks at {factor} of their greatest overhang: {word}",
                [[factor * middle - 0.001 * (factor < 1.0) for middle in course] for course in four],
            ),
            word,
            f"{_OVERHANG}: the greatest overhang of four bricks is (15 - 4 sqrt 2) / 8 = {best:.5f}",
            "One of two bricks on the lowest is the counterweight. All middles are scaled, and moved in by .001.",
        )

    # The lowest brick reaches 1/2 beyond the table, those above it 2/3 beyond its ends, the highest lies on both.
    for factor in (0.998, 1.002):
        word = _stands(factor < 1.0)
        middle, reach = 0.5 * factor - 0.5, 2.0 / 3.0 * factor
        yield _of_stack(
            f"overhang-two-wings-{word}",
            _stack(
                f"Two wings of 2/3 on a brick, at {factor} of the limit: {word}",
                [[middle], [middle - reach, middle + reach], [middle]],
            ),
            word,
            f"{STATICS}: the highest brick presses each wing by W / 2 at its end; overhang 1/2 + 2/3 = 7/6",
            "An exercise of textbooks (Halliday and Resnick): four bricks reach 7/6 of a length.",
        )

    for size, word in ((4, "stands"), (5, "falls")):
        widths = [*range(1, size + 1), *range(size - 1, 0, -1)]
        yield _of_stack(
            f"diamond-{size}-{word}",
            _stack(
                f"Diamond of {size * size} bricks: {word}",
                [[place - 0.5 * (width - 1) for place in range(width)] for width in widths],
                edge=1.0,
            ),
            word,
            f"{_OVERHANG}: diamonds stand to size 4 and burst from size 5 on",
            f"Courses of one to {size} bricks and back to one, on the middle of the lowest brick's whole length.",
        )

    widths = [1, 2, 3, 2, 3, 4, 3, 4, 3, 4, *itertools.chain.from_iterable([(5, 4)] * 3), 5, *[6, 5] * 4, 6]
    assert sum(widths) == 111
    courses = [[place - 0.5 * (width - 1) for place in range(width)] for width in widths]
    for edge in (0.01, -0.01):
        word = _stands(edge > 0.0)
        yield _of_stack(
            f"overhang-3-{word}",
            _stack(
                f"A stack of 111 bricks that reaches {3.0 - edge:g} lengths beyond the table: {word}", courses, edge
            ),
            word,
            f"{_OVERHANG}: a parabolic stack of 111 bricks reaches three lengths beyond the table",
            "A parabolic stack balances on the edge of the table; the edge is moved by .01.",
        )


def _of_stack(name: str, content: Wall, word: str, source: str, summary: str) -> Recipe:
    references = r.finding(word, source, f"{content.title}.")
    return recipe(name, content, references, Remarks(_OVERHANG, summary, _STABILITY, kind="stability"))


def _slopes() -> Iterator[Recipe]:
    """A block on a plane in each of its four regimes: it stands, slides, topples, or does both."""
    rules = (
        ("stands", 10.0, 40.0, 42.0, "tan alpha < mu and tan alpha < b / h"),
        ("slides", 5.0, 40.0, 20.0, "tan alpha > mu and tan alpha < b / h"),
        ("topples", 25.0, 25.0, 40.0, "tan alpha < mu and tan alpha > b / h"),
        ("slides-and-topples", 25.0, 40.0, 20.0, "tan alpha > mu and tan alpha > b / h"),
    )
    for name, height, slope, angle, rule in rules:
        word = "stands" if name == "stands" else "falls"
        content = wall(
            f"Block of 10 x {height:g} m on a plane of {slope:g} degrees, friction of {angle:g} degrees: {word}",
            unit_weight=20.0,
            friction=round(math.tan(math.radians(angle)), 12),
            blocks=[
                {
                    "id": "plane",
                    "polygon": _turned([(-20.0, -10.0), (30.0, -10.0), (30.0, 0.0), (-20.0, 0.0)], -slope),
                    "fixed": True,
                },
                {"id": "block", "polygon": _turned([(0.0, 0.0), (10.0, 0.0), (10.0, height), (0.0, height)], -slope)},
            ],
        )
        references = r.finding(word, f"{STATICS}: {rule}", f"{content.title}.")
        summary = (
            "One of the four regimes of a block on a plane, which rock engineers draw over its slope and slenderness."
        )
        remarks = Remarks(STATICS, summary, ("closed-form", "stability"), kind="stability")
        yield recipe(f"plane-{name}", content, references, remarks)


def _turned(polygon: Sequence[tuple[float, float]], degrees: float) -> list[tuple[float, float]]:
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(round(x * cosine - y * sine, 12), round(x * sine + y * cosine, 12)) for x, y in polygon]


def _thrusts() -> Iterator[Recipe]:
    """The least and the greatest thrust of a semicircle, by a springer on a smooth plane that a dead force holds."""
    count, inner, outer, held = 20, 0.9, 1.1, 0.2
    values = {"least": 0.1542448387, "greatest": 0.2553105847}

    def ray(number: int, radius: float) -> tuple[float, float]:
        angle = math.pi * number / count
        return round(radius * math.cos(angle), 12), round(radius * math.sin(angle), 12)

    stones = [[ray(k, inner), ray(k, outer), ray(k + 1, outer), ray(k + 1, inner)] for k in range(count)]
    weight = count * 0.5 * (outer**2 - inner**2) * math.sin(math.pi / count)
    low, end = -0.2, 1.3
    blocks: list[dict[str, object]] = [
        {"id": "springer", "polygon": [(0.7, low), (end, low), (end, 0.0), (0.7, 0.0)]},
        {"id": "plane", "polygon": [(0.5, 2 * low), (1.5, 2 * low), (1.5, low), (0.5, low)], "fixed": True},
        {"id": "ground", "polygon": [(-end, low), (-0.7, low), (-0.7, 0.0), (-end, 0.0)], "fixed": True},
    ]
    blocks += [{"id": str(k + 1), "polygon": stone} for k, stone in enumerate(stones)]
    for name, thrust in values.items():
        out = 1.0 if name == "least" else -1.0
        content = wall(
            f"The {name} thrust of a semicircular arch of {count} voussoirs",
            units={"force": "1"},
            unit_weight=1.0,
            friction={"default": 2.0, "rules": [{"between": ["springer", "plane"], "value": 0.0}]},
            blocks=blocks,
            loads={
                "dead": {
                    "points": [{"block": "springer", "at": (1.0, low / 2), "force": (round(-held * weight, 12), 0.0)}]
                },
                "live": {
                    "points": [{"block": "springer", "at": (1.0, low / 2), "force": (out * round(weight, 12), 0.0)}]
                },
            },
        )
        value = abs(held - thrust)
        source = f"linear programme for the force at a springing (tests/cases/test_thrusts.py): {name} H = {thrust} W"
        requirement = (
            f"The springer, held by {held:g} W, moves {'out' if out > 0 else 'in'} when the thrust is the {name}."
        )
        references = [
            reference(
                "thrust",
                "exact",
                round(value, 10),
                ("la", "la-associated", "fe"),
                source,
                requirement,
                tolerance=2e-10,
                tolerance_reason="the source prints ten digits",
                gate=True,
            ),
            r.of_de("thrust-de", round(value, 10), source, requirement),
        ]
        summary = "R = 1, t = 0.2. The live load is a force of the weight of the arch on the springer."
        yield recipe(f"arch-thrust-{name}", content, references, Remarks(source, summary, ("closed-form",)))


def _columns_on_a_slope() -> Iterator[Recipe]:
    """Sixteen columns on a stepped slope of 60 degrees, of Goodman and Bray's limit equilibrium."""
    source = "R. E. Goodman and J. W. Bray, Toppling of rock slopes, ASCE 1976: their recursion, computed for this wall"
    content = wall(
        "Stepped slope of 16 columns, friction 0.85, pushed out of the slope",
        unit_weight=25.0,
        friction=0.85,
        blocks=_columns(),
        loads=push(-1.0),
    )
    references = [
        reference(
            "recursion",
            "published",
            0.0643,
            ["de"],
            source,
            "The recursion puts each force at the top of a column and lets all joints slide.",
            tolerance=0.0064,
            tolerance_reason="the place of the forces is an assumption of the recursion: a tenth of the value",
            gate=False,
        ),
        reference(
            "self-stress",
            "bound",
            0.0,
            ["la"],
            "a state of self-stress: the columns hold and slide at any small push",
            "The least collapse state of limit analysis without dilatancy is at zero, which says nothing of the slope.",
            relation="at_most",
            tolerance=1e-9,
            tolerance_reason=r.ROUND_OFF_REASON,
            gate=False,
        ),
    ]
    summary = "The example of rock engineers. docs/factor.md says why the least collapse state is of no use here."
    yield recipe("toppling-columns-16", content, references, Remarks(source, summary, ("published",)))


def _columns() -> list[dict[str, object]]:
    """Columns 10 m wide on steps of one metre, 4 to 40 m high, and the slope below them."""
    heights = (4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 34, 28, 22, 16, 10, 4)
    blocks: list[dict[str, object]] = []
    steps: list[tuple[float, float]] = []
    for number, height in enumerate(heights):
        left, low = 10.0 * number, 1.0 * number
        steps += [(left, low), (left + 10.0, low)]
        corners = [(left, low), (left + 10.0, low), (left + 10.0, low + height), (left, low + height)]
        blocks.append({"id": str(number + 1), "polygon": _turned(corners, 30.0)})
    under = [(-20.0, 0.0), (-20.0, -30.0), (180.0, -30.0), (180.0, 15.0)]
    slope = [under[3], *reversed(steps), *under[:3]]
    return [*blocks, {"id": "slope", "polygon": _turned(slope[::-1], 30.0), "fixed": True}]


def recipes() -> Iterator[Recipe]:
    """Every wall of this module."""
    for family in (_stacks, _slopes, _thrusts, _columns_on_a_slope):
        yield from family()
