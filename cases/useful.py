"""Walls a user would start from: openings, a portal, irregular stones, a buttress, a flying arch, two leaves.

Dimensions are round numbers of our own. What is known of them are our own values of this release.
"""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator

import cases.recipe as r
from cases.recipe import Recipe, Remarks, push, recipe, wall
from harness.model.wall import Wall

OWN = "Drystone 0.1, dimensions of our own"


def _opening_with_lintel() -> Wall:
    """A wall of running bond with a window under a lintel."""
    whole, halves = [1.0] * 5, [0.5, 1.0, 1.0, 1.0, 1.0, 0.5]
    return wall(
        "Wall with a window under a lintel",
        unit_weight=20.0,
        thickness=0.5,
        friction=0.6,
        pattern={
            "type": "running_bond",
            "block_length": 0.6,
            "block_height": 0.3,
            "courses": [
                halves,
                whole,
                halves,
                [1.0, 1.0, -1.0, 1.0, 1.0],
                [0.5, 1.0, 0.5, -1.0, 0.5, 1.0, 0.5],
                [1.0, 1.0, -1.0, 1.0, 1.0],
                [0.5, 1.0, 2.0, 1.0, 0.5],
                whole,
                halves,
            ],
        },
        loads=push(),
    )


def portal() -> Wall:
    """Two piers of three drums under a lintel of one stone."""
    return wall(
        "Portal: two piers of three stones and a lintel",
        unit_weight=24.0,
        thickness=0.6,
        friction=0.6,
        pattern=[
            {"type": "stack", "prefix": "left-", "width": 0.6, "height": 0.8, "count": 3},
            {"type": "stack", "prefix": "right-", "origin": (2.0, 0.0), "width": 0.6, "height": 0.8, "count": 3},
        ],
        blocks=[{"id": "lintel", "polygon": [(0.0, 2.4), (2.6, 2.4), (2.6, 2.9), (0.0, 2.9)]}],
        loads=push(),
    )


def irregular_stones(seed: int = 7, length: float = 3.0, courses: int = 8) -> Wall:
    """Stones of random length and inclined sides in courses of random height with flat beds.

    Args:
        seed: of the stones; the same seed gives the same wall.
        length: of the wall [m].
        courses: number of courses.
    """
    dice = random.Random(seed)
    blocks: list[dict[str, object]] = [
        {"id": "ground", "polygon": [(0.0, -0.3), (length, -0.3), (length, 0.0), (0.0, 0.0)], "fixed": True}
    ]
    bottom = 0.0
    below: list[float] = []
    for number in range(1, courses + 1):
        top = round(bottom + dice.uniform(0.22, 0.36), 3)
        joints = [(0.0, 0.0)]
        while joints[-1][0] < length - 0.75:
            foot = round(joints[-1][0] + dice.uniform(0.3, 0.65), 3)
            if any(abs(foot - head) < 0.02 for head in below):
                foot = round(foot + 0.05, 3)  # no joint upon a joint: masons avoid it, and slivers spoil the numbers
            joints.append((foot, round(foot + dice.uniform(-0.05, 0.05), 3)))
        joints.append((length, length))
        below = [head for _, head in joints[1:-1]]
        for place, ((foot1, head1), (foot2, head2)) in enumerate(itertools.pairwise(joints), start=1):
            polygon = [(foot1, bottom), (foot2, bottom), (head2, top), (head1, top)]
            blocks.append({"id": f"{number}.{place}", "polygon": polygon})
        bottom = top
    return wall(
        f"Wall of irregular stones with flat beds (seed {seed})",
        metadata={"seed": seed},
        unit_weight=22.0,
        thickness=0.6,
        friction=0.6,
        blocks=blocks,
        loads=push(),
    )


def buttress() -> Wall:
    """A wall of one stone's thickness with a stepped buttress, pushed towards it at the top by a vault's thrust."""
    widths = [3.0, 3.0, 2.5, 2.5, 2.0, 2.0, 1.5, 1.5, 1.0, 1.0]
    courses = []
    for number, width in enumerate(widths):
        if width <= 1.0:
            courses.append([width])
        else:
            first = (0.4 if number % 2 == 0 else 0.6) * width
            courses.append([round(first, 9), round(width - first, 9)])
    return wall(
        "Wall with a stepped buttress under the thrust of a vault",
        unit_weight=22.0,
        friction=0.6,
        pattern={
            "type": "running_bond",
            "block_length": 0.5,
            "block_height": 0.4,
            "courses": courses,
        },
        loads={
            "dead": {
                "points": [{"block": "10.1", "at": (0.25, 4.0), "force": (0.0, -15.0)}],
            },
            "live": {"points": [{"block": "10.1", "at": (0.0, 3.8), "force": (1.0, 0.0)}]},
        },
    )


def _flying_arch() -> Wall:
    """A quarter-circle flyer of six stones from a pier to a wall that does not move; the ground is tilted outward."""
    inner, outer, angle = 2.0, 2.4, 75.0
    cosine, sine = math.cos(math.radians(180.0 - angle)), math.sin(math.radians(180.0 - angle))
    head = [(inner * cosine, inner * sine), (outer * cosine, outer * sine)]
    wall_face = [(round(x, 9), round(y + 3.0, 9)) for x, y in head]
    return wall(
        "Flying arch between a pier and a wall",
        unit_weight=22.0,
        friction=0.7,
        pattern=[
            {"type": "stack", "prefix": "pier-", "origin": (-2.8, 0.0), "width": 1.2, "height": 0.5, "count": 6},
            {
                "type": "ring",
                "prefix": "flyer-",
                "origin": (0.0, 3.0),
                "inner_radius": inner,
                "outer_radius": outer,
                "count": 6,
                "angles": (180.0, 180.0 - angle),
                "supports": "none",
            },
        ],
        blocks=[
            {
                "id": "wall",
                "polygon": [*wall_face, (0.2, wall_face[1][1]), (0.2, wall_face[0][1])],
                "fixed": True,
            }
        ],
        loads=push(-1.0),
    )


def _two_leaf_section() -> Wall:
    """The section of a wall of two leaves with a through stone in every fourth course, tilted."""
    headers, leaf1, leaf2 = [3.0], [1.0, -0.6, 1.4], [1.4, -0.6, 1.0]
    return wall(
        "Section of a two-leaf wall with through stones",
        unit_weight=22.0,
        friction=0.6,
        pattern={
            "type": "running_bond",
            "block_length": 0.25,
            "block_height": 0.25,
            "courses": [headers, leaf1, leaf2, leaf1, headers, leaf2, leaf1, leaf2, headers, leaf1, leaf2, headers],
        },
        loads=push(),
    )


TABLE: tuple[tuple[str, Wall, float, float, float, str], ...] = (
    (
        "opening-lintel",
        _opening_with_lintel(),
        0.4977573925,
        0.4751008967,
        0.4775080877,
        "A window of one brick's width and three courses, under a lintel of two bricks.",
    ),
    (
        "portal",
        portal(),
        0.25,
        0.25,
        0.25,
        "Two piers and a lintel: the smallest frame. The piers rock together below the lintel.",
    ),
    (
        "irregular-wall",
        irregular_stones(),
        0.5011333984,
        0.4625950495,
        0.4625950495,
        "Stones of random length with inclined head joints in courses of random height: rubble with flat beds.",
    ),
    (
        "buttress",
        buttress(),
        119 / 12,
        119 / 12,
        119 / 12,
        "The live load is a unit force at the head of the wall, so the multiplier is in kN a metre.",
    ),
    (
        "flying-arch",
        _flying_arch(),
        0.2905156935,
        0.2905156935,
        0.2905156935,
        "A flyer leans on a pier; the ground is tilted away from the wall it props.",
    ),
    (
        "two-leaf-section",
        _two_leaf_section(),
        0.2227450980,
        0.2227450980,
        0.2227450980,
        "Two leaves with a gap between them and through stones: the section engineers draw of an old wall.",
    ),
)
"""Name, wall, associated maximum, least collapse state known, FE plateau, summary."""


def recipes() -> Iterator[Recipe]:
    """A folder for each wall of the table."""
    for name, content, associated, least, plateau, summary in TABLE:
        references = [
            r.reference(
                "la-associated",
                "regression",
                associated,
                ["la-associated"],
                OWN,
                f"The associated maximum is {associated:.6f}.",
                tolerance=float(f"{1e-6 * max(1.0, associated):.2g}"),
                tolerance_reason="accuracy of the linear programme",
                gate=True,
            ),
            r.reference(
                "la-least-known",
                "regression",
                least,
                ["la"],
                OWN,
                f"LA finds a collapse state at least as low as {least:.6f}.",
                relation="at_most",
                tolerance=float(f"{1e-6 * max(1.0, least):.2g}"),
                tolerance_reason="accuracy of an exact collapse state",
                gate=True,
            ),
            r.reference(
                "fe-plateau",
                "regression",
                plateau,
                ["fe"],
                OWN,
                f"FE finds {plateau:.6f}.",
                tolerance=float(f"{0.005 * plateau:.2g}"),
                tolerance_reason="scatter of load histories",
                gate=True,
            ),
        ]
        yield recipe(name, content, references, Remarks(OWN, summary, ("walls",)))
