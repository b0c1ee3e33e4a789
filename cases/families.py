"""The paper's 21-brick wall as a family: its proportions, friction and bottom course are lost with the figures.

`wall_21` gives any member, `family` all of a grid, `recipes` the few that have a folder of their own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import cases.recipe as r
from cases.recipe import Recipe, Remarks, push, recipe, wall
from harness.model.case import Reference
from harness.model.wall import Wall

PROPORTIONS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0)
"""Length over height of a brick."""

_FRICTIONS = tuple(round(0.1 * tenths, 1) for tenths in range(2, 13))

Start = Literal["half", "full"]
STARTS: tuple[Start, ...] = ("half", "full")
"""How the bottom course begins: half-full-full-half, or three whole bricks. Both have 21 bricks in six courses."""

PAPER = "C. Baggio, P. Trovalusci, Computer Methods in Structural Masonry 3, 1995, pp. 184-194"
_PROTOTYPES = "Drystone, prototypes before release 0.1"
_CODES = "two public gap-spring codes, both 0.56522 at friction 0.65 and 0.75; 13/23 is the vertex they round to"


def wall_21(proportion: float = 2.0, friction: float = 0.65, start: Start = "half") -> Wall:
    """The wall of six courses and 21 bricks on a tilting table.

    Args:
        proportion: length over height of a brick; the height is 0.2 m.
        friction: of every joint.
        start: how the bottom course begins.

    Raises:
        ValueError: a proportion or friction that is not positive.
    """
    if proportion <= 0.0 or friction <= 0.0:
        raise ValueError("proportion and friction are greater than zero")
    return wall(
        f"21 bricks {proportion:g}:1, friction {friction:g}, bottom course begins {start}",
        metadata={"source": PAPER, "proportion": proportion, "start": start},
        unit_weight=20.0,
        friction=friction,
        pattern={
            "type": "running_bond",
            "block_length": round(0.2 * proportion, 12),
            "block_height": 0.2,
            "count": 6,
            "bricks": 3,
            "start": start,
        },
        loads=push(),
    )


@dataclass(frozen=True)
class Member:
    """One wall of the family with its parameters."""

    proportion: float
    friction: float
    start: Start
    wall: Wall


def family(
    proportions: tuple[float, ...] = PROPORTIONS,
    frictions: tuple[float, ...] = _FRICTIONS,
    starts: tuple[Start, ...] = STARTS,
) -> Iterator[Member]:
    """Every wall of a grid, friction running fastest."""
    for start in starts:
        for proportion in proportions:
            for friction in frictions:
                yield Member(proportion, friction, start, wall_21(proportion, friction, start))


@dataclass(frozen=True)
class Known:
    """What is known of the wall with bricks 2:1 at one friction. `fraction` is the exact least collapse state known."""

    associated: float
    least: float
    fraction: str
    plateau: float | None


KNOWN = {
    0.3: Known(0.3, 0.3, "", 0.3),
    0.4: Known(0.4, 0.4, "", 0.4),
    0.5: Known(0.5, 0.5, "", 0.5),
    0.75: Known(0.622318, 0.5519524, "84797/153631", 13 / 23),
    0.85: Known(0.690766, 0.5375880, "3165869/5889025", None),
    1.0: Known(0.979073, 0.5339130, "307/575", None),
}
"""Bricks 2:1, bottom course half-full-full-half. Where fraction is empty every method gives the friction itself."""


def recipes() -> Iterator[Recipe]:
    """A folder for each friction of `KNOWN`; friction 0.65 is the case wall-21, 0.2 running-bond-slides."""
    for friction, known in KNOWN.items():
        content = wall_21(friction=friction)
        errata = [
            "The proportions of the brick and the friction stand only in figures of the paper that are not "
            "available; this is one member of the family that stands for them."
        ]
        if known.fraction:
            summary = (
                "Above a friction of about 0.57 the methods differ: gap springs and distinct elements leave the head "
                "joints unloaded, the associated maximum rests on self-stress through them, and the least collapse "
                "state known falls as friction grows."
            )
            references = _parted(friction, known)
        else:
            summary = "With this little friction the wall slides on its lowest bed and every method gives the friction."
            references = _together(friction)
        remarks = Remarks(PAPER, summary, ("friction-family",), errata)
        yield recipe(f"wall-21-friction-{round(100 * friction):03d}", content, references, remarks)


def _together(friction: float) -> list[Reference]:
    source = "elementary statics: the whole wall slides on the ground, lambda = friction"
    return r.exact(friction, source, f"The wall slides at its friction, {friction:g}.", relative_de=r.DE_TOLERANCE)


def _parted(friction: float, known: Known) -> list[Reference]:
    references = [
        r.reference(
            "la-associated",
            "regression",
            known.associated,
            ["la-associated"],
            f"{_PROTOTYPES}: two independent linear programmes",
            f"The associated maximum is {known.associated}.",
            tolerance=1e-6,
            tolerance_reason="six digits recorded",
            gate=True,
        ),
        r.reference(
            "la-least-known",
            "regression",
            known.least,
            ["la"],
            f"{_PROTOTYPES}: exact collapse state {known.fraction}, checked in rational arithmetic",
            f"LA finds a collapse state at least as low as {known.fraction}.",
            relation="at_most",
            tolerance=1e-6,
            tolerance_reason="seven digits recorded",
            gate=True,
        ),
        r.reference(
            "tresca",
            "regression",
            13 / 23,
            ["la-tresca"],
            f"{_PROTOTYPES}: fixed point of a sequence of programmes with frozen friction bounds, 0.565217",
            "The Tresca sequence stops at 13/23, above the least collapse state known.",
            tolerance=1e-5,
            tolerance_reason="six digits recorded",
        ),
        r.reference(
            "de",
            "regression",
            13 / 23,
            ["de"],
            f"{_PROTOTYPES}: pymunk within 0.4 % of the state with unloaded head joints",
            "DE lies within 0.5 % of 13/23, the state with unloaded head joints.",
            tolerance=0.005 * 13 / 23,
            tolerance_reason=r.DE_REASON,
        ),
    ]
    if known.plateau is not None:
        references.append(
            r.reference(
                "fe-plateau",
                "published",
                known.plateau,
                ["fe"],
                _CODES,
                "FE gives 13/23, as the two codes.",
                tolerance=1e-8,
                tolerance_reason="exact continuation ends on a vertex; the codes print five digits",
                gate=True,
            )
        )
    return references
