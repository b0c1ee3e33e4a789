"""A wall of the Sassi di Matera and the vault it carries: the paper's application as a parametric family.

The section of a wall of small blocks in two faces with a cavity between them, tied by a few bonding stones, and a
segmental vault of 6 m span and 0.25 m thickness that springs from it. The wall and a tenth of the vault are dead load,
the vault's weight is live, so that the multiplier counts vault weights and no voussoir slips at zero load.

Source: C. Baggio, P. Trovalusci, Computer Methods in Structural Masonry 3, 1995, pp. 184-194, application. The paper
gives the geometry in figures only: the geometry here is ours, calibrated to its text.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import cases.recipe as r
from cases.recipe import Recipe, Remarks, recipe, wall
from harness.model.case import Reference
from harness.model.wall import Wall

SPAN = 6.0
VAULT_THICKNESS = 0.25
PAPER = "C. Baggio, P. Trovalusci, Computer Methods in Structural Masonry 3, 1995, pp. 184-194, application"
OWN = "Drystone 0.1, this geometry"
_GEOMETRY = (
    "The paper gives the geometry of wall and vault in figures that are not available. Number and size of stones, "
    "cavity, rise of the vault, friction 0.6 and the added weight are ours, chosen so that the multipliers lie near "
    "those of the text: 0.30, 0.90 and 1.35 vault weights."
)
DEAD_PART = 0.1
"""Part of the vault's weight that is dead load; the whole weight of the vault is live load on top of it."""

UNIT_WEIGHT = 17.0
"""Weight of the calcarenite of Matera [kN/m3], a round value."""


@dataclass(frozen=True)
class Masonry:
    """How a wall is laid. Lengths in m.

    Attributes:
        courses: number of courses of small blocks below the springer.
        course_height: height of a course.
        face: thickness of each face.
        cavity: width between the faces.
        stones: how a face is laid in courses without a bonding stone, from outside to inside, as parts of the face;
            courses take them by turns. (1.0,) is one stone, (0.5, 0.5) two short ones.
        bonds: courses (from 1, bottom up) that bonding stones lie in.
        bond_length: length of a bonding stone, the whole thickness if None; shorter than that, it reaches in from the
            outer and from the inner face by turns and a stone of the other face fills the rest.
        extra_weight: dead force on the springer above the wall's middle [kN/m].
        friction: of every joint.
    """

    courses: int = 10
    course_height: float = 0.25
    face: float = 0.41
    cavity: float = 0.3
    stones: Sequence[Sequence[float]] = ((0.5, 0.5),)
    bonds: tuple[int, ...] = ()
    bond_length: float | None = None
    extra_weight: float = 0.0
    friction: float = 0.6
    voussoirs: int = 12
    half_angle: float = 60.0

    @property
    def thickness(self) -> float:
        """Of the wall, from face to face."""
        return 2.0 * self.face + self.cavity

    @property
    def height(self) -> float:
        """Of the courses below the springer."""
        return self.courses * self.course_height


def course_widths(masonry: Masonry, number: int) -> list[float]:
    """The stones of a course from outside to inside [m], a negative width for the cavity; courses count from 1."""
    pattern = masonry.stones[(number - 1) % len(masonry.stones)]
    face = [part * masonry.face for part in pattern]
    if number not in masonry.bonds:
        return [*face, -masonry.cavity, *reversed(face)]
    length = masonry.thickness if masonry.bond_length is None else masonry.bond_length
    rest = masonry.thickness - length
    if rest < 1e-9:
        return [masonry.thickness]
    # What the bonding stone leaves free is cavity first, then stones of the other face.
    gap = max(0.0, masonry.face + masonry.cavity - length)
    course = [length, *([-gap] if gap > 1e-9 else []), rest - gap]
    return course if masonry.bonds.index(number) % 2 == 0 else course[::-1]


def matera_wall(masonry: Masonry, title: str, *, full: bool = False) -> Wall:
    """The wall with half the vault on a frictionless plane at its crown, or both walls with the full vault.

    Args:
        masonry: how the wall is laid.
        title: of the wall.
        full: two mirrored walls and the full vault; else one wall, half the vault and a support at the crown that
            passes thrust and no shear, which is right for mechanisms that are symmetric.
    """
    top = masonry.height
    inner = round(0.5 * SPAN / math.sin(math.radians(masonry.half_angle)), 12)
    outer = inner + VAULT_THICKNESS
    middle = round(masonry.thickness + 0.5 * SPAN, 12)
    springing = top + masonry.course_height - VAULT_THICKNESS * math.cos(math.radians(masonry.half_angle))
    centre = (middle, round(springing - inner * math.cos(math.radians(masonry.half_angle)), 12))
    back = (
        masonry.thickness - VAULT_THICKNESS * math.sin(math.radians(masonry.half_angle)),
        top + masonry.course_height,
    )
    springer = [(0.0, top), (masonry.thickness, top), (masonry.thickness, springing), back, (0.0, back[1])]
    patterns: list[dict[str, Any]] = [_courses(masonry, "w", mirrored=False)]
    blocks: list[dict[str, Any]] = [{"id": "springer", "polygon": _round(springer), "groups": ["wall"]}]
    count, last = (masonry.voussoirs, 90.0)
    if full:
        patterns.append(_courses(masonry, "e", mirrored=True))
        mirror = [(2 * middle - x, y) for x, y in springer]
        blocks.append({"id": "springer-e", "polygon": _round(mirror), "groups": ["wall"]})
        count, last = 2 * masonry.voussoirs, 90.0 - masonry.half_angle
    else:
        crown = [(middle, centre[1] + inner), (middle, centre[1] + outer)]
        support = [*crown, (middle + 0.25, crown[1][1]), (middle + 0.25, crown[0][1])]
        blocks.append({"id": "crown", "polygon": _round(support), "material": "symmetry", "fixed": True})
    patterns.append(
        {
            "type": "ring",
            "prefix": "vault-",
            "origin": centre,
            "inner_radius": inner,
            "outer_radius": round(outer, 12),
            "count": count,
            "angles": (90.0 + masonry.half_angle, last),
            "supports": "none",
            "groups": ["vault"],
        }
    )
    # What is dead of the vault is less than its weight, so gravity is written out in parts.
    dead: dict[str, Any] = {
        "body": [
            {"per_weight": (0.0, -1.0), "group": "wall"},
            {"per_weight": (0.0, -DEAD_PART), "group": "vault"},
        ]
    }
    if masonry.extra_weight:
        names = ("springer", "springer-e") if full else ("springer",)
        places = (0.5 * masonry.thickness, 2 * middle - 0.5 * masonry.thickness)
        dead["points"] = [
            {"block": name, "at": (round(x, 9), back[1]), "force": (0.0, -masonry.extra_weight)}
            for name, x in zip(names, places, strict=False)
        ]
    rules = [{"value": 0.0, "materials": ("stone", "symmetry")}]
    return wall(
        title,
        metadata={"source": "geometry ours, calibrated to the text of Baggio & Trovalusci 1995"},
        unit_weight=UNIT_WEIGHT,
        friction=masonry.friction if full else {"default": masonry.friction, "rules": rules},
        pattern=patterns,
        blocks=blocks,
        loads={"gravity": False, "dead": dead, "live": {"body": [{"per_weight": (0.0, -1.0), "group": "vault"}]}},
    )


def _courses(masonry: Masonry, prefix: str, *, mirrored: bool) -> dict[str, Any]:
    courses = [course_widths(masonry, number) for number in range(1, masonry.courses + 1)]
    return {
        "type": "running_bond",
        "prefix": prefix,
        "origin": (round(masonry.thickness + SPAN, 12) if mirrored else 0.0, 0.0),
        "block_length": 1.0,
        "block_height": masonry.course_height,
        "courses": [[round(width, 9) for width in (course[::-1] if mirrored else course)] for course in courses],
        "groups": ["wall"],
    }


def _round(polygon: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(round(x, 9), round(y, 9)) for x, y in polygon]


POOR = Masonry(bonds=(1, 2, 10))
"""Three bonding stones that leave stacks of seven short stones between them."""
LOADED = replace(POOR, extra_weight=45.0)
"""The same wall with more weight on it."""
GOOD = Masonry(bonds=(4, 7, 10))
"""Three bonding stones of the same length, spread so that no stack of short stones is higher than three courses."""


@dataclass(frozen=True)
class Found:
    """Our own multipliers of one wall: associated maximum, least collapse state known, FE plateau."""

    associated: float
    least: float
    plateau: float


@dataclass(frozen=True)
class Variant:
    """A folder of the family: what the paper says of such a wall, and what we find."""

    name: str
    title: str
    masonry: Masonry
    full: bool
    paper: float
    summary: str
    found: Found


_VARIANTS = (
    Variant(
        "matera-poor",
        "Sassi di Matera: three bonding stones badly placed",
        POOR,
        False,
        0.30,
        "Stacks of seven short stones between the bonding stones: the faces part and the wall fails early.",
        Found(0.2915994424, 0.1066988067, 0.1887741591),
    ),
    Variant(
        "matera-loaded",
        "Sassi di Matera: the badly bonded wall with more weight on it",
        LOADED,
        False,
        0.90,
        "A force on the springer presses the short stones together: the same wall carries three times as much.",
        Found(1.1826974952, 0.7111318675, 0.7951014478),
    ),
    Variant(
        "matera-good",
        "Sassi di Matera: three bonding stones well placed",
        GOOD,
        False,
        1.35,
        "As many bonding stones as in matera-poor, spread over the height: the wall carries the whole vault and more.",
        Found(1.6512818301, 1.0170803672, 1.2148642066),
    ),
    Variant(
        "matera-good-full",
        "Sassi di Matera: both walls and the full vault, bonding stones well placed",
        GOOD,
        True,
        1.35,
        "matera-good without the support at the crown: the half was right, FE and the associated maximum are the same.",
        Found(1.6512818301, 1.0170803672, 1.2148642066),
    ),
)


def recipes() -> Iterator[Recipe]:
    """A poor wall, the same with more weight on it, and a good one; the last also in full."""
    for variant in _VARIANTS:
        content = matera_wall(variant.masonry, variant.title, full=variant.full)
        remarks = Remarks(
            PAPER,
            f"{variant.summary} Vault weights carried are {DEAD_PART:g} (dead) + lambda; the paper reports "
            f"{variant.paper:.2f} for such a wall.",
            ("matera",),
            errata=(_GEOMETRY,),
        )
        yield recipe(variant.name, content, _references(variant), remarks)


def _references(variant: Variant) -> list[Reference]:
    carried = DEAD_PART + variant.found.plateau
    return [
        r.reference(
            "paper",
            "published",
            round(variant.paper - DEAD_PART, 4),
            ["fe"],
            f"Baggio & Trovalusci 1995, application: {100 * variant.paper:.0f} % of the vault's weight",
            f"FE finds that the wall fails near {variant.paper:.2f} vault weights, as the paper's text.",
            tolerance=0.06,
            tolerance_reason="the geometry is ours: the message is the ratio between the walls, not the digits",
        ),
        r.reference(
            "la-associated",
            "regression",
            variant.found.associated,
            ["la-associated"],
            OWN,
            f"The associated maximum is {variant.found.associated:.6f}.",
            tolerance=1e-6,
            tolerance_reason="accuracy of the linear programme",
            gate=True,
        ),
        r.reference(
            "fe-plateau",
            "regression",
            variant.found.plateau,
            ["fe"],
            OWN,
            f"FE finds that the wall carries {carried:.3f} vault weights.",
            tolerance=0.005,
            tolerance_reason="scatter of load histories",
            gate=True,
        ),
        r.reference(
            "la-least-known",
            "regression",
            variant.found.least,
            ["la"],
            OWN,
            f"LA finds a collapse state at least as low as {variant.found.least:.6f}.",
            relation="at_most",
            tolerance=1e-6,
            tolerance_reason="accuracy of an exact collapse state",
        ),
    ]
