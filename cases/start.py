"""Walls to start from, made of the few numbers a person knows: what `drystone new` writes.

Courses are laid by one function for every bond; openings cut them, and a lintel spans each. Lengths in m, kN.
"""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from cases.matera import Masonry, matera_wall
from cases.recipe import push, wall
from cases.useful import buttress as stepped_buttress
from cases.useful import irregular_stones
from harness.model.errors import InputError, of_those_there
from harness.model.wall import Wall

_CLOSER = 0.25
"""Least length of a stone as a part of a whole one: a quarter bat, the smallest that masons lay."""

Openings = Sequence[tuple[float, float]]


def _running(course: int) -> tuple[float, tuple[float, ...]]:
    return 1.0, (0.5 * (course % 2),)


def _flemish(course: int) -> tuple[float, tuple[float, ...]]:
    return 1.5, (0.0, 1.0) if course % 2 else (0.25, 0.75)


def _english(course: int) -> tuple[float, tuple[float, ...]]:
    return (1.0, (0.0,)) if course % 2 else (0.5, (0.25,))


_BONDS: dict[str, Callable[[int], tuple[float, tuple[float, ...]]]] = {
    "running": _running,
    "flemish": _flemish,
    "english": _english,
}
"""Period of the head joints of a course (from 1) and where they lie in it, in lengths of a whole brick."""


def laid(bond: str, course: int, left: float, right: float) -> list[float]:
    """Head joints of a course of a bond from `left` to `right`, both ends included [lengths of a brick].

    Joints that would leave less than a closer at an end are left out.

    Raises:
        InputError: an unknown bond.
    """
    if bond not in _BONDS:
        raise InputError(f'no bond is called "{bond}"', of_those_there(bond, _BONDS))
    period, places = _BONDS[bond](course)
    first, last = math.floor(left / period) - 1, math.ceil(right / period) + 1
    joints = sorted(period * number + place for number in range(first, last + 1) for place in places)
    inside = [joint for joint in joints if left + _CLOSER - 1e-9 <= joint <= right - _CLOSER + 1e-9]
    return [left, *inside, right]


def _blocks(
    bond: str, course: int, parts: Openings, brick: tuple[float, float], bottom: float | None = None
) -> Iterator[dict[str, Any]]:
    length, height = brick
    low = (course - 1) * height if bottom is None else bottom
    number = 0
    for left, right in parts:
        for start, end in itertools.pairwise(laid(bond, course, left, right)):
            number += 1
            yield _box(f"{course}.{number}", start * length, low, end * length, low + height)


def _box(name: str, left: float, bottom: float, right: float, top: float, **more: Any) -> dict[str, Any]:
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    return {"id": name, "polygon": [(round(x, 9), round(y, 9)) for x, y in corners], **more}


def _standing(title: str, blocks: list[dict[str, Any]], width: float, *, friction: float, thickness: float) -> Wall:
    ground = _box("ground", 0.0, -0.3, width, 0.0, fixed=True)
    return wall(
        title,
        units={"length": "m", "force": "kN"},
        unit_weight=20.0,
        thickness=thickness,
        friction=friction,
        blocks=[ground, *blocks],
        loads=push(),
    )


def bonded(
    bond: str, length: float, height: float, brick: tuple[float, float], friction: float, thickness: float
) -> Wall:
    """A plain wall of a bond, of whole courses as near to `height` as they come.

    Raises:
        InputError: a wall smaller than a brick.
    """
    courses, bricks = round(height / brick[1]), round(2.0 * length / brick[0]) / 2.0
    if courses < 1 or bricks < 1.0:
        raise InputError("the wall is smaller than one brick", "Give a greater length and height")
    blocks = [block for course in range(1, courses + 1) for block in _blocks(bond, course, [(0.0, bricks)], brick)]
    return _standing(
        f"Wall of {courses} courses in {bond} bond", blocks, bricks * brick[0], friction=friction, thickness=thickness
    )


def running_bond(
    length: float = 3.0, height: float = 2.0, brick_length: float = 0.5, brick_height: float = 0.2,
    friction: float = 0.6, thickness: float = 0.3,
) -> Wall:  # fmt: skip
    """A wall of running bond."""
    return bonded("running", length, height, (brick_length, brick_height), friction, thickness)


def flemish(
    length: float = 2.5, height: float = 1.5, brick_length: float = 0.25, brick_height: float = 0.075,
    friction: float = 0.6, thickness: float = 0.25,
) -> Wall:  # fmt: skip
    """A wall of Flemish bond: headers and stretchers by turns, a header on the middle of every stretcher."""
    return bonded("flemish", length, height, (brick_length, brick_height), friction, thickness)


def english(
    length: float = 2.5, height: float = 1.5, brick_length: float = 0.25, brick_height: float = 0.075,
    friction: float = 0.6, thickness: float = 0.25,
) -> Wall:  # fmt: skip
    """A wall of English bond: courses of stretchers and courses of headers by turns."""
    return bonded("english", length, height, (brick_length, brick_height), friction, thickness)


def ashlar(
    length: float = 4.0, courses: int = 8, course_height: float = 0.35, seed: int = 1, friction: float = 0.6,
    thickness: float = 0.5,
) -> Wall:  # fmt: skip
    """Squared stones of random length in level courses, no head joint upon a head joint."""
    dice = random.Random(seed)
    blocks: list[dict[str, Any]] = []
    below: list[float] = []
    for course in range(1, courses + 1):
        joints = [0.0]
        while joints[-1] < length - 2.0 * course_height:
            place = round(joints[-1] + dice.uniform(1.0, 2.0) * course_height, 3)
            if place > length - 0.5 * course_height:
                break
            if any(abs(place - joint) < 0.15 * course_height for joint in below):
                place = round(place + 0.3 * course_height, 3)
            joints.append(place)
        joints.append(length)
        below = joints[1:-1]
        for number, (left, right) in enumerate(itertools.pairwise(joints), start=1):
            low = (course - 1) * course_height
            blocks.append(_box(f"{course}.{number}", left, low, right, low + course_height))
    return _standing(f"Wall of ashlar (seed {seed})", blocks, length, friction=friction, thickness=thickness)


def irregular(length: float = 3.0, courses: int = 8, seed: int = 7) -> Wall:
    """Stones of random length and inclined sides in courses of random height."""
    return irregular_stones(seed, length, courses)


def facade(
    storeys: int = 2, openings: int = 2, bond: str = "running", brick_length: float = 0.25, brick_height: float = 0.075,
    opening_width: float = 1.0, opening_height: float = 1.2, pier_width: float = 0.75, spandrel_height: float = 0.9,
    friction: float = 0.6, thickness: float = 0.25,
) -> Wall:  # fmt: skip
    """A facade: openings side by side in every storey, each under a lintel that rests on half a brick at both sides."""
    brick = (brick_length, brick_height)
    wide, pier = (max(1, round(2.0 * size / brick_length)) / 2.0 for size in (opening_width, pier_width))
    high, plain = (max(1, round(size / brick_height)) for size in (opening_height, spandrel_height))
    if storeys < 1 or openings < 0 or pier < 1.5:
        raise InputError("a facade has at least one storey, and piers of one and a half bricks", "Give greater numbers")
    total = openings * wide + (openings + 1) * pier
    holes = [(pier + k * (pier + wide), (k + 1) * (pier + wide)) for k in range(openings)]
    lintels = [(left - 0.5, right + 0.5) for left, right in holes]
    blocks: list[dict[str, Any]] = []
    course = 0
    for _ in range(storeys):
        for kind in ["plain"] * plain + ["open"] * high + ["lintel"]:
            course += 1
            cut = {"plain": [], "open": holes, "lintel": lintels}[kind]
            blocks += _blocks(bond, course, _between(cut, total), brick)
            if kind == "lintel":
                low = (course - 1) * brick_height
                blocks += [
                    _box(
                        f"{course}.lintel-{number}", left * brick_length, low, right * brick_length, low + brick_height
                    )
                    for number, (left, right) in enumerate(lintels, start=1)
                ]
    for _ in range(max(1, plain // 2)):
        course += 1
        blocks += _blocks(bond, course, [(0.0, total)], brick)
    return _standing(
        f"Facade: storeys {storeys}, openings in each {openings}, {bond} bond", blocks, total * brick_length,
        friction=friction, thickness=thickness,
    )  # fmt: skip


def _between(cut: Openings, total: float) -> list[tuple[float, float]]:
    edges = [0.0, *itertools.chain.from_iterable(cut), total]
    return list(zip(edges[::2], edges[1::2], strict=True))


def arch(span: float = 4.0, thickness: float = 0.6, voussoirs: int = 15, friction: float = 0.7) -> Wall:
    """A semicircular arch on abutments that do not move."""
    return _ring("Semicircular arch", 0.5 * span, thickness, voussoirs, (180.0, 0.0), friction, push())


def bridge(
    span: float = 6.0, rise: float = 1.5, thickness: float = 0.6, voussoirs: int = 21, friction: float = 0.7
) -> Wall:
    """A segmental arch under a vertical force at quarter span; fill and spandrels are not modelled.

    Raises:
        InputError: a rise greater than half the span.
    """
    if not 0.0 < rise <= 0.5 * span:
        raise InputError(
            f"the rise {rise:g} of a span {span:g} is no segment of a circle", "Give at most half the span"
        )
    radius = (0.25 * span * span + rise * rise) / (2.0 * rise)
    half = math.degrees(math.asin(min(1.0, 0.5 * span / radius)))
    angle = math.degrees(math.asin(0.25 * span / (radius + thickness)))
    number = math.floor((half - angle) / (2.0 * half) * voussoirs) + 1
    at = (-(radius + thickness) * math.sin(math.radians(angle)), (radius + thickness) * math.cos(math.radians(angle)))
    made = _ring("Bridge", radius, thickness, voussoirs, (90.0 + half, 90.0 - half), friction, {})
    names = [f"v{k}" for k in range(1, voussoirs + 1)]
    from harness.model.build import build

    named = build(made).assembly
    free = [named.block_ids[i] for i in named.free]
    block = free[number - 1] if len(free) == len(names) else free[0]
    chord = named.polygons[named.block_ids.index(block)]
    # The loaded point lies on the upper chord of the voussoir, which is straight and below the arc.
    upper = sorted(chord.tolist(), key=lambda point: math.hypot(*point))[-2:]
    share = (at[0] - upper[0][0]) / (upper[1][0] - upper[0][0])
    point = [upper[0][axis] + share * (upper[1][axis] - upper[0][axis]) for axis in (0, 1)]
    loads = {"live": {"points": [{"block": block, "at": point, "force": [0.0, -1.0]}]}}
    return Wall.model_validate(made.document() | {"loads": loads})


def _ring(
    title: str, radius: float, thickness: float, count: int, angles: tuple[float, float], friction: float,
    loads: dict[str, Any],
) -> Wall:  # fmt: skip
    return wall(
        f"{title} of {count} voussoirs",
        units={"length": "m", "force": "kN"},
        unit_weight=24.0,
        friction=friction,
        pattern={
            "type": "ring", "inner_radius": radius, "outer_radius": radius + thickness, "count": count,
            "angles": angles,
        },
        loads=loads,
    )  # fmt: skip


def portal(
    width: float = 2.6, drums: int = 3, drum_width: float = 0.6, drum_height: float = 0.8, friction: float = 0.6
) -> Wall:
    """Two piers of drums under a lintel of one stone."""
    stack = {"type": "stack", "width": drum_width, "height": drum_height, "count": drums}
    top = drums * drum_height
    return wall(
        f"Portal: two piers of {drums} stones and a lintel",
        units={"length": "m", "force": "kN"},
        unit_weight=24.0,
        thickness=0.6,
        friction=friction,
        pattern=[
            stack | {"prefix": "left-"},
            stack | {"prefix": "right-", "origin": (round(width - drum_width, 9), 0.0)},
        ],
        blocks=[_box("lintel", 0.0, top, width, top + 0.5)],
        loads=push(),
    )


def buttress() -> Wall:
    """A wall with a stepped buttress under the thrust of a vault."""
    return stepped_buttress()


def _two_leaf(
    courses: int = 12, leaf: float = 0.25, cavity: float = 0.15, through: int = 4, course_height: float = 0.25
) -> Wall:
    """The section of a wall of two leaves with a through stone in the first and every `through`-th course above it."""
    total = round(2.0 * leaf + cavity, 9)
    rows = [
        [total] if (number % through == 0 or number == courses - 1) else [leaf, -cavity, leaf]
        for number in range(courses)
    ]
    return wall(
        "Section of a two-leaf wall with through stones",
        units={"length": "m", "force": "kN"},
        unit_weight=22.0,
        friction=0.6,
        pattern={"type": "running_bond", "block_length": 1.0, "block_height": course_height, "courses": rows},
        loads=push(),
    )


def stack(count: int = 5, width: float = 0.5, height: float = 0.4, friction: float = 0.6) -> Wall:
    """Equal blocks one upon the other."""
    return wall(
        f"Stack of {count} blocks",
        units={"length": "m", "force": "kN"},
        unit_weight=24.0,
        friction=friction,
        pattern={"type": "stack", "width": width, "height": height, "count": count},
        loads=push(),
    )


def matera(
    courses: int = 10, face: float = 0.41, cavity: float = 0.3, friction: float = 0.6, voussoirs: int = 12
) -> Wall:
    """A two-faced wall of Matera under half a vault."""
    masonry = Masonry(courses=courses, face=face, cavity=cavity, friction=friction, voussoirs=voussoirs)
    return matera_wall(masonry, "Wall of Matera under half a vault")


MAY_BE_ZERO = ("friction", "openings", "seed")
"""Numbers of walls that may be zero; all others are lengths and counts above it."""
STARTS: dict[str, Callable[..., Wall]] = {
    "running-bond": running_bond,
    "ashlar": ashlar,
    "flemish": flemish,
    "english": english,
    "irregular": irregular,
    "arch": arch,
    "bridge": bridge,
    "portal": portal,
    "facade": facade,
    "buttress": buttress,
    "two-leaf": _two_leaf,
    "stack": stack,
    "matera": matera,
}
"""Every kind of wall that `drystone new` makes."""
