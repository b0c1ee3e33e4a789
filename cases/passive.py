"""Cases in passive fill: one block by statics, and an arch by a linear programme written apart."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import cases.recipe as r
from cases.recipe import STATICS, Recipe, Remarks, push, recipe, wall

EXACT = ("la", "la-associated", "fe")
METHODS = (*EXACT, "de")
RING = (
    "M. Gilbert, Limit analysis applied to masonry arch bridges: state-of-the-art and recent developments, 5th "
    "International Conference on Arch Bridges (2007) 13-28: passive pressure on the extrados"
)


def _pushed_block() -> Recipe:
    """A block that slides into fill beside it bears friction and the passive force."""
    width, height, weight, gamma, level, share, phi, friction = 1.0, 0.8, 16.0, 18.0, 0.6, 0.5, 30.0, 0.2
    sine = math.sin(math.radians(phi))
    value = round(friction + share * (1.0 + sine) / (1.0 - sine) * gamma * level**2 / 2.0 / weight, 14)
    passive = {"mobilised": share, "friction_angle": phi}
    fill = {"level": level, "unit_weight": gamma, "between": (width, 3.0), "passive": passive}
    content = wall(
        f"A block {width:g} x {height:g} m pushed into passive fill {level:g} m high",
        friction=friction,
        blocks=[
            {"id": "ground", "polygon": [(-1.0, -1.0), (3.0, -1.0), (3.0, 0.0), (-1.0, 0.0)], "fixed": True},
            {"id": "block", "polygon": [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], "weight": weight},
        ],
        loads={**push(), "dead": {"fills": [fill]}},
    )
    formula = "mu + m K_p gamma h^2 / (2 W)"
    shown = f"{STATICS}: lambda = {formula}"
    sentence = f"The block slides at {formula} = {value:g}, and the whole face bears the passive pressure."
    references = [r.closed_form(value, shown, sentence, EXACT), r.of_de("closed-form-de", value, shown, sentence)]
    summary = f"Pushed by a multiple of its weight, it slides at {formula}; without the fill it would at mu."
    return recipe("passive-block", content, references, Remarks(STATICS, summary, ("ties",), methods=METHODS))


def _filled_arch(*, passive: bool) -> Recipe:
    """An arch whose voussoirs do not slide, under fill with a growing load on its left haunch."""
    count, inner, outer, haunch, value = 16, 0.9, 1.1, 120.0, 51.793549 if passive else 16.800887
    fill: dict[str, Any] = {"level": 1.3, "unit_weight": 16.0}
    if passive:
        fill["passive"] = {"mobilised": 0.5, "friction_angle": 30.0}
    angle = math.radians(haunch)
    loaded = f"v{count - round(haunch / 180.0 * count) + 1}"
    load = {"block": loaded, "at": (outer * math.cos(angle), outer * math.sin(angle)), "force": (0.0, -1.0)}
    word = "passive fill" if passive else "fill that does not resist"
    content = wall(
        f"A semicircle of {count} voussoirs under {word}, loaded on its haunch",
        unit_weight=22.0,
        friction=100.0,
        pattern={"type": "ring", "inner_radius": inner, "outer_radius": outer, "count": count},
        loads={"dead": {"fills": [fill]}, "live": {"points": [load]}},
    )
    shown = "a linear programme of other code (tests/la/test_passive_fill.py)"
    sentence = f"The arch bears {value:g} on its haunch where nothing slides."
    programme = r.reference(
        "programme",
        "exact",
        value,
        EXACT,
        shown,
        sentence,
        tolerance=5e-7,
        tolerance_reason="half of the last digit that is given",
        gate=True,
    )
    summary = (
        "The voussoirs of the other haunch move into the fill: with its passive pressure the arch bears three times."
    )
    name = "filled-arch-passive" if passive else "filled-arch"
    return recipe(
        name,
        content,
        [programme, r.of_de("programme-de", value, shown, sentence)],
        Remarks(RING, summary, ("ties",), methods=METHODS),
    )


def recipes() -> Iterator[Recipe]:
    """Every case in passive fill, and the arch without it."""
    yield _pushed_block()
    yield _filled_arch(passive=True)
    yield _filled_arch(passive=False)
