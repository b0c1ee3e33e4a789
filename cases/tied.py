"""Cases with ties and props: one block by statics, and an arch on rollers by its least thrust."""

from __future__ import annotations

import math
from collections.abc import Iterator

import cases.recipe as r
from cases.recipe import STATICS, Recipe, Remarks, push, recipe, wall

EXACT = ("la", "la-associated", "fe")
METHODS = (*EXACT, "de")
SUITES = ("ties",)
THRUST = (
    "J. Heyman, The stone skeleton, International Journal of Solids and Structures 2 (1966) 249-279: an arch spreads "
    "at its least thrust"
)


def _held_blocks() -> Iterator[Recipe]:
    """A slender block that is pushed topples at b / h + 2 T_y z / (W h), held by a tie or by a prop at the height z."""
    width, height, weight, strength, level, gap = 0.4, 2.0, 16.0, 2.0, 1.8, 0.6
    value = round(width / height + 2.0 * strength * level / (weight * height), 14)
    for kind, side, at in (("tie", -gap, 0.0), ("prop", width + gap, width)):
        left, right = sorted([side, side + math.copysign(width, side)])
        bar = {
            "from": {"block": "wall", "at": (side, level)},
            "to": {"block": "block", "at": (at, level)},
            "yield_force": strength,
        }
        content = wall(
            f"A block {width} x {height} m held near its top by a {kind}",
            friction=0.7,
            blocks=[
                r.box("ground", 0.0, -0.4, width, 0.0, fixed=True),
                r.box("block", 0.0, 0.0, width, height, weight=weight),
                r.box("wall", left, 0.0, right, height, fixed=True),
            ],
            loads=push(),
            **{f"{kind}s": [bar]},
        )
        formula = "b / h + 2 T_y z / (W h)"
        shown = f"{STATICS}: moments about the edge, lambda = {formula}"
        sentence = f"The block topples at {formula} = {value:g}, and the {kind} yields."
        references = [
            r.closed_form(value, shown, sentence, EXACT),
            r.of_de("closed-form-de", value, shown, sentence),
        ]
        summary = f"Pushed by a multiple of its weight, it topples at {formula}; alone it would at b / h = 0.2."
        yield recipe(f"{kind}-block", content, references, Remarks(STATICS, summary, SUITES, methods=METHODS))


def _tied_arches() -> Iterator[Recipe]:
    """A semicircle of 20 voussoirs on rollers stands if and only if its tie bears the least thrust."""
    count, thickness, thrust, unit = 20, 0.15, 0.1756349, 20.0
    inner, outer = 1.0 - thickness / 2, 1.0 + thickness / 2
    weight = unit * count * (outer**2 - inner**2) / 2 * math.sin(math.pi / count)
    angles = [math.pi * (1.0 - k / count) for k in range(count + 1)]

    def point(radius: float, k: int) -> tuple[float, float]:
        return (radius * math.cos(angles[k]), radius * math.sin(angles[k]) if 0 < k < count else 0.0)

    voussoirs = [
        {"id": f"v{k + 1}", "polygon": [point(inner, k), point(outer, k), point(outer, k + 1), point(inner, k + 1)]}
        for k in range(count)
    ]
    rollers = [{"between": pair, "value": 0.0} for pair in (("v1", "left"), (f"v{count}", "right"))]
    for factor, word in ((1.001, "stands"), (0.999, "falls")):
        strength = round(factor * thrust * weight, 9)
        content = wall(
            f"A semicircle of {count} voussoirs, t/R {thickness}, on rollers, tied at its springings: {word}",
            unit_weight=unit,
            friction={"default": 1.5, "rules": rollers},
            blocks=[
                *voussoirs,
                r.box("left", -outer, -0.2, -inner, 0.0, fixed=True),
                r.box("right", inner, -0.2, outer, 0.0, fixed=True),
            ],
            ties=[
                {
                    "from": {"block": "v1", "at": (-1.0, 0.0)},
                    "to": {"block": f"v{count}", "at": (1.0, 0.0)},
                    "yield_force": strength,
                }
            ],
        )
        source = f"a linear programme of other code: least thrust H = {thrust} W of this arch where nothing slides"
        sentence = f"With a tie of {factor} of the least thrust the arch {word}."
        references = [r.reference(word, "exact", word, METHODS, source, sentence, quantity="finding", gate=True)]
        summary = (
            f"Its yield force is {factor} of the least thrust {thrust} W; without friction only the tie bears any."
        )
        remarks = Remarks(THRUST, summary, (*SUITES, "stability"), kind="stability", methods=METHODS)
        yield recipe(f"tied-arch-{word}", content, references, remarks)


def recipes() -> Iterator[Recipe]:
    """Every case with ties or props."""
    yield from _held_blocks()
    yield from _tied_arches()
