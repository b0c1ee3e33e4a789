"""Compact patterns become explicit blocks, deterministically: running bond, ring, stack, panel."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
import shapely
from pydantic import ValidationError

from harness.model.errors import InputError
from harness.model.fields import Point
from harness.model.pattern_fields import Panel, PatternBase, Ring, RunningBond, Stack
from harness.model.wall import Block


def blocks_of(pattern: PatternBase) -> list[Block]:
    """The blocks a pattern stands for, in order.

    Raises:
        InputError: a panel letter whose cells do not hang together, or enclose a hole.
    """
    if isinstance(pattern, RunningBond):
        return list(_running_bond(pattern))
    if isinstance(pattern, Ring):
        return list(_ring(pattern))
    if isinstance(pattern, Stack):
        return list(_stack(pattern))
    if isinstance(pattern, Panel):
        return list(_panel(pattern))
    raise TypeError(f"unknown pattern {type(pattern).__name__}")


def count_of(pattern: PatternBase) -> int:
    """How many blocks a pattern makes, without making them; for a panel, of which each letter is one, its letters."""
    if isinstance(pattern, RunningBond):
        if pattern.courses is not None:
            return sum(width > 0.0 for course in pattern.courses for width in course) + pattern.base
        assert pattern.count is not None
        assert pattern.bricks is not None
        halves = (pattern.count + (pattern.start == "half")) // 2
        return pattern.count * pattern.bricks + halves + pattern.base
    if isinstance(pattern, Ring):
        return pattern.count + 2 * (pattern.supports == "abutments")
    if isinstance(pattern, Stack):
        return pattern.count + 1
    if isinstance(pattern, Panel):
        return len(set("".join(pattern.layout)) - set(". "))
    raise TypeError(f"unknown pattern {type(pattern).__name__}")


def _block(pattern: PatternBase, name: str, polygon: list[Point], fixed: bool = False) -> Block:
    try:
        return Block(
            id=pattern.prefix + name,
            polygon=polygon,
            unit_weight=pattern.unit_weight,
            thickness=pattern.thickness,
            material=pattern.material,
            fixed=fixed,
            groups=list(pattern.groups),
        )
    except ValidationError as error:
        fault = error.errors()[0]
        reason = str(fault["msg"]).replace("Input should", "it should")
        raise InputError(
            f"the pattern gives it a {fault['loc'][0]} that no block can have: {reason}",
            "Mind the sizes, the origin and the prefix of the pattern",
            f'block "{pattern.prefix[:60]}{name}"',
        ) from None


def _rectangle(left: float, bottom: float, right: float, top: float) -> list[Point]:
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def _course_list(pattern: RunningBond) -> list[list[float]]:
    if pattern.courses is not None:
        return pattern.courses
    assert pattern.count is not None
    assert pattern.bricks is not None
    half = [0.5] + [1.0] * (pattern.bricks - 1) + [0.5]
    full = [1.0] * pattern.bricks
    first, second = (half, full) if pattern.start == "half" else (full, half)
    return [first if number % 2 == 0 else second for number in range(pattern.count)]


def _running_bond(pattern: RunningBond) -> Iterator[Block]:
    courses = _course_list(pattern)
    x0, y0 = pattern.origin
    length, height = pattern.block_length, pattern.block_height
    if pattern.base:
        width = length * max(sum(abs(relative) for relative in course) for course in courses)
        yield _block(pattern, "base", _rectangle(x0, y0 - height, x0 + width, y0), fixed=True)
    for number, course in enumerate(courses):
        # Edges come from one running sum of relative lengths, so that joints of different courses meet exactly.
        edges = [0.0, *itertools.accumulate(abs(relative) for relative in course)]
        bottom, top = y0 + number * height, y0 + (number + 1) * height
        place = 0
        for relative, left, right in zip(course, edges, edges[1:], strict=False):
            if relative > 0.0:
                place += 1
                yield _block(
                    pattern,
                    f"{number + 1}.{place}",
                    _rectangle(x0 + left * length, bottom, x0 + right * length, top),
                )


def _ring(pattern: Ring) -> Iterator[Block]:
    angles = np.radians(np.linspace(pattern.angles[0], pattern.angles[1], pattern.count + 1))
    inner, outer = pattern.inner_radius, pattern.outer_radius

    def on(radius: float, angle: float) -> Point:
        return (
            pattern.origin[0] + radius * math.cos(angle),
            pattern.origin[1] + radius * math.sin(angle),
        )

    def abutment(angle: float, onward: float) -> list[Point]:
        depth = 0.5 * (outer - inner) * onward
        along = (-math.sin(angle) * depth, math.cos(angle) * depth)
        (xi, yi), (xo, yo) = on(inner, angle), on(outer, angle)
        return [(xi, yi), (xo, yo), (xo + along[0], yo + along[1]), (xi + along[0], yi + along[1])]

    sense = math.copysign(1.0, angles[-1] - angles[0])
    if pattern.supports == "abutments":
        yield _block(pattern, "abutment-1", abutment(float(angles[0]), -sense), fixed=True)
    for number in range(pattern.count):
        first, last = float(angles[number]), float(angles[number + 1])
        fixed = pattern.supports == "end_voussoirs" and number in (0, pattern.count - 1)
        yield _block(
            pattern,
            f"v{number + 1}",
            [on(inner, first), on(outer, first), on(outer, last), on(inner, last)],
            fixed=fixed,
        )
    if pattern.supports == "abutments":
        yield _block(pattern, "abutment-2", abutment(float(angles[-1]), sense), fixed=True)


def _stack(pattern: Stack) -> Iterator[Block]:
    x0, y0 = pattern.origin
    left, right = pattern.base or (0.0, pattern.width)
    yield _block(pattern, "base", _rectangle(x0 + left, y0 - pattern.height, x0 + right, y0), fixed=True)
    for number, offset in enumerate(pattern.offsets or [0.0] * pattern.count):
        yield _block(
            pattern,
            str(number + 1),
            _rectangle(
                x0 + offset,
                y0 + number * pattern.height,
                x0 + offset + pattern.width,
                y0 + (number + 1) * pattern.height,
            ),
        )


def _panel(pattern: Panel) -> Iterator[Block]:
    cells: dict[str, list[shapely.Polygon]] = {}
    rows = len(pattern.layout)
    x0, y0 = pattern.origin
    for row in range(rows - 1, -1, -1):
        for column, letter in enumerate(pattern.layout[row]):
            if letter in ". ":
                continue
            xs = [x0 + (column + k) * pattern.cell_length for k in (0, 1)]
            ys = [y0 + (rows - 1 - row + k) * pattern.cell_height for k in (0, 1)]
            cells.setdefault(letter, []).append(shapely.box(xs[0], ys[0], xs[1], ys[1]))
    for letter, boxes in cells.items():
        shape = shapely.unary_union(boxes)
        if not isinstance(shape, shapely.Polygon) or shape.interiors:
            raise InputError(
                "its cells do not form one block without holes",
                "Give every block a letter of its own",
                element=f"panel block {letter!r}",
            )
        outline = shapely.remove_repeated_points(shape.simplify(0.0).exterior)
        ring = [(float(x), float(y)) for x, y in outline.coords[:-1]]
        yield _block(pattern, letter, ring, fixed=letter in pattern.fixed)
