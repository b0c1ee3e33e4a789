"""Cases with a closed form: elementary statics of blocks, stacks, columns and arches, with the formula in the case.

Each function returns recipes; `cases.generate` writes them. Values follow from the formula printed in `source`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import cases.recipe as r
from cases.recipe import BOND_21, STATICS, Recipe, Remarks, exact, push, recipe, wall

_MILANKOVITCH = (
    "M. Milankovitch, Theorie der Druckkurven, Zeitschrift fur Mathematik und Physik 55 (1907) 1-27; "
    "J. Heyman, The safety of masonry arches, International Journal of Mechanical Sciences 11 (1969) 363-385"
)
SUITES = ("closed-form",)


def _blocks() -> Iterator[Recipe]:
    """One block and stacks of them on level ground: min(friction, width / height)."""
    for name, width, height, count, friction in (
        ("slide", 0.4, 0.2, 1, 0.3),
        ("topple", 0.2, 0.5, 1, 0.7),
        ("stack-2", 0.3, 0.2, 2, 0.8),
        ("stack-10", 0.5, 0.2, 10, 0.7),
    ):
        slides = friction < width / (count * height)
        value = friction if slides else width / (count * height)
        formula = "lambda = friction" if slides else "lambda = width / height of the whole"
        many = "A block" if count == 1 else f"A stack of {count} blocks"
        title = f"{many} {width} x {height} m, friction {friction}: {'slides' if slides else 'overturns'}"
        content = wall(
            title,
            unit_weight=20.0,
            friction=friction,
            pattern={"type": "stack", "width": width, "height": height, "count": count},
            loads=push(),
        )
        source = f"{STATICS}: min(friction, b / h), so {formula}"
        does = "slides at its friction" if slides else "overturns at b / h"
        summary = f"{many} pushed by a multiple of its weight: lambda = min(friction, b / h), width b, height h."
        if count == 10:
            summary += " Distinct-element engines at their defaults miss it by more than half."
        suites = (*SUITES, "small")
        yield recipe(
            name, content, exact(value, source, f"{many} {does}: {value:g}."), Remarks(STATICS, summary, suites)
        )


def _inclines() -> Iterator[Recipe]:
    """A block on an incline pushed horizontally down or up it: tan(phi -+ alpha)."""
    friction, slope, length, height = 0.5, 10.0, 1.0, 0.2
    cosine, sine = math.cos(math.radians(slope)), math.sin(math.radians(slope))

    def turned(x: float, y: float) -> tuple[float, float]:
        return (round(x * cosine - y * sine, 12), round(x * sine + y * cosine, 12))

    ground = [turned(-0.5, -0.3), turned(length + 0.5, -0.3), turned(length + 0.5, 0.0), turned(-0.5, 0.0)]
    body = [turned(0.0, 0.0), turned(length, 0.0), turned(length, height), turned(0.0, height)]
    for name, sense, word in (("incline-down", -1.0, "down"), ("incline-up", 1.0, "up")):
        value = math.tan(math.atan(friction) + sense * math.radians(slope))
        sign = "+" if sense > 0.0 else "-"
        content = wall(
            f"A block on an incline of {slope:g} degrees pushed {word} it, friction {friction}",
            unit_weight=20.0,
            friction=friction,
            blocks=[{"id": "ground", "polygon": ground, "fixed": True}, {"id": "block", "polygon": body}],
            loads=push(sense),
        )
        source = f"{STATICS}: lambda = tan(phi {sign} alpha)"
        references = exact(
            value, source, f"The block slides {word} the incline at tan(phi {sign} alpha) = {value:.6f}."
        )
        summary = "A flat block on an incline under its weight and a horizontal multiple of it."
        yield recipe(name, content, references, Remarks(STATICS, summary, (*SUITES, "small")))


def _two_frictions() -> Iterator[Recipe]:
    """The paper's block with other numbers: a range of collapse states and the one gap springs choose."""
    rough, smooth, height = 0.8, 0.2, 0.4
    least = smooth
    greatest = rough / (1.0 + (rough - smooth) * height)
    springs = 0.5 * (rough + smooth) / (1.0 + 0.5 * (rough - smooth) * height)
    content = wall(
        f"Block 1 x {height} m on two supports of friction {rough} and {smooth}",
        units={"force": "1"},
        unit_weight=1.0,
        friction={
            "default": rough,
            "rules": [
                {"value": rough, "between": ("left", "block")},
                {"value": smooth, "between": ("right", "block")},
            ],
        },
        blocks=[
            {"id": "left", "polygon": [(0, -0.2), (0.5, -0.2), (0.5, 0), (0, 0)], "fixed": True},
            {"id": "right", "polygon": [(0.5, -0.2), (1, -0.2), (1, 0), (0.5, 0)], "fixed": True},
            {"id": "block", "polygon": [(0, 0), (1, 0), (1, height), (0, height)]},
        ],
        loads=push(),
    )
    same = {"tolerance": r.ROUND_OFF, "tolerance_reason": r.ROUND_OFF_REASON, "gate": True}
    references = [
        r.reference(
            "la-least",
            "exact",
            least,
            ["la"],
            f"{STATICS}: the whole weight on the smooth half, lambda = mu2",
            f"The least collapse state has the whole weight on the smooth half: {least}.",
            **same,
        ),
        r.reference(
            "la-greatest",
            "exact",
            round(greatest, 14),
            ["la-associated"],
            f"{STATICS}: lambda = mu1 / (1 + (mu1 - mu2) h), base length 1",
            f"The greatest multiplier is mu1 / (1 + (mu1 - mu2) h) = {greatest:.6f}.",
            **same,
        ),
        r.reference(
            "fe",
            "exact",
            round(springs, 14),
            ["fe"],
            f"{STATICS} of four equal springs: lambda = (mu1 + mu2)/2 / (1 + (mu1 - mu2) h / 2)",
            f"Four equal gap points give {springs:.6f} whatever their stiffness.",
            **same,
        ),
        r.reference(
            "de-range",
            "bound",
            (least, round(greatest, 14)),
            ["de"],
            "the range of the collapse states of limit analysis",
            "The bracket of DE lies between the least and the greatest multiplier of limit analysis.",
            relation="inside",
            tolerance=1e-3,
            tolerance_reason="width at which the bisection stops, and the slop of the contact solver",
            gate=True,
        ),
    ]
    summary = "The paper's single block with a wider gap between the two frictions: the three methods differ more."
    yield recipe("two-frictions", content, references, Remarks(STATICS, summary, (*SUITES, "small")))


def _overhangs() -> Iterator[Recipe]:
    """Harmonic stacks of eight blocks just inside and just outside the limit of overhang."""
    count = 8
    limit = 0.5 * sum(1.0 / k for k in range(1, count + 1))
    for factor, word in ((0.999, "stands"), (1.001, "falls")):
        # The k-th block from the top reaches 1 / (2 k) beyond the one below, the lowest beyond the table's edge at 0.
        shifts = [0.5 * factor / k for k in range(count, 0, -1)]
        offsets = [round(sum(shifts[: number + 1]) - 1.0, 12) for number in range(count)]
        content = wall(
            f"Overhang of {count} blocks at {factor} of the harmonic limit: {word}",
            unit_weight=20.0,
            friction=0.5,
            pattern={
                "type": "stack",
                "width": 1.0,
                "height": 0.2,
                "count": count,
                "offsets": offsets,
                "base": (-1.0, 0.0),
            },
        )
        source = f"harmonic stack (textbook): limit (1/2) sum 1/k = {limit:.6f} block lengths"
        sentence = f"{count} blocks at {factor} of the harmonic overhang: the stack {word}."
        summary = "The greatest overhang of one block a course; one thousandth decides."
        remarks = Remarks("textbook", summary, (*SUITES, "stability"), kind="stability")
        yield recipe(f"overhang-{count}-{word}", content, r.finding(word, source, sentence), remarks)


def _columns() -> Iterator[Recipe]:
    """A column of four blocks: under an eccentric dead force on top, and pushed by a force at a height."""
    width, height, count, unit = 0.4, 0.25, 4, 20.0
    block = unit * width * height
    total, tall = count * block, count * height
    pattern = {"type": "stack", "width": width, "height": height, "count": count}

    force, eccentricity, friction = 10.0, 0.05, 0.7
    value = (force * (width / 2 - eccentricity) + total * width / 2) / (total * tall / 2)
    content = wall(
        f"Column of {count} blocks under a force of {force:g} kN, {eccentricity:g} m off its axis, on a tilting table",
        unit_weight=unit,
        friction=friction,
        pattern=pattern,
        loads={
            "dead": {
                "points": [{"block": str(count), "at": (width / 2 + eccentricity, tall), "force": (0.0, -force)}],
            },
            "live": {"body": [{"per_weight": (1.0, 0.0)}]},
        },
    )
    source = f"{STATICS}: moments about the toe, lambda = (P (b/2 - e) + W b/2) / (W h/2)"
    summary = "The force on top is dead and does not push, so it holds the column back."
    yield recipe(
        "column-point-load",
        content,
        exact(value, source, f"The column rocks on its toe at {value:g}.", relative_de=0.005),
        Remarks(STATICS, summary, (*SUITES, "small")),
    )

    friction, at = 1.2, 0.9
    beds = [(total - number * block, number * height) for number in range(count)]
    value = min(min(friction * above, above * width / 2 / (at - low)) for above, low in beds)
    content = wall(
        f"Column of {count} blocks pushed by a force at {at:g} m",
        unit_weight=unit,
        friction=friction,
        pattern=pattern,
        loads={"live": {"points": [{"block": str(count), "at": (0.0, at), "force": (1.0, 0.0)}]}},
    )
    source = f"{STATICS}: the least over the beds of mu W and W b/2 / (a - y), W the weight above the bed at height y"
    summary = "The live load is a unit force, so the multiplier is in kN. The lowest bed decides here."
    yield recipe(
        "column-point-push",
        content,
        exact(value, source, f"The column rocks on its toe at {value:.6g} kN.", relative_de=0.005),
        Remarks(STATICS, summary, (*SUITES, "small")),
    )


def minimum_thickness(count: int) -> float:
    """Least thickness over mean radius at which a semicircle of `count` voussoirs stands without sliding.

    The thrust line passes the extrados at crown and springings and touches the intrados at the joint that decides.
    Chord voussoirs of equal angle, `count` even. Tends to 0.107478, which Milankovitch
    prints as 0.1075, as the voussoirs grow in number (0.107426 with the weight on the centre line).

    Source: Milankovitch 1907; Heyman 1969, with hinges at joints only.
    """
    if count < 2 or count % 2:
        raise ValueError("an even number of voussoirs has a joint at the crown")
    low, high = 0.01, 0.5
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _semicircle_slack(count, middle) >= 0.0 else (middle, high)
    return 0.5 * (low + high)


def _semicircle_slack(count: int, thickness: float) -> float:
    """Least slack of the thrust over the intrados of half a semicircle of mean radius 1; negative: it falls."""
    inner, outer = 1.0 - thickness / 2, 1.0 + thickness / 2
    step = math.pi / count
    # Centroid of a voussoir with straight edges: between two similar triangles with their apex at the centre.
    reach = math.cos(step / 2) * (2.0 / 3.0) * (outer**3 - inner**3) / (outer**2 - inner**2)
    half = count // 2
    places = [reach * math.sin((number + 0.5) * step) for number in range(half)]  # from the crown's axis, weight 1
    thrust = sum(outer - place for place in places) / outer  # crown's extrados, moments about the springing's extrados
    slack, above = math.inf, 0.0
    for joint in range(1, half):
        x, y = inner * math.sin(joint * step), inner * math.cos(joint * step)
        above += places[joint - 1]
        slack = min(slack, thrust * (outer - y) - (joint * x - above))
    return slack


def _thin_arches() -> Iterator[Recipe]:
    """Semicircles of 10, 20 and 40 voussoirs half a per cent thinner and thicker than the least thickness."""
    for count in (10, 20, 40):
        least = minimum_thickness(count)
        for factor, word in ((1.005, "stands"), (0.995, "falls")):
            thickness = round(factor * least, 8)
            content = wall(
                f"Semicircular arch of {count} voussoirs, t/R {thickness:.6f}: {word}",
                unit_weight=20.0,
                friction=0.7,
                pattern={
                    "type": "ring",
                    "inner_radius": round(1.0 - thickness / 2, 9),
                    "outer_radius": round(1.0 + thickness / 2, 9),
                    "count": count,
                },
            )
            source = (
                f"Milankovitch 1907, Heyman 1969 with hinges at joints only: least t/R {least:.6f} for {count} "
                "voussoirs; 0.1075 (Milankovitch) for the continuous arch"
            )
            sentence = f"The arch of {count} voussoirs at {factor} of its least thickness {word}."
            summary = (
                "The thrust line runs through the extrados at crown and springings and just touches the intrados at "
                f"the haunch: thrust H = sum w (Ro - x) / Ro, least thickness {least:.6f} of the mean radius."
            )
            remarks = Remarks(_MILANKOVITCH, summary, (*SUITES, "stability"), kind="stability")
            yield recipe(f"heyman-arch-{count}-{word}", content, r.finding(word, source, sentence), remarks)


def _running_bonds() -> Iterator[Recipe]:
    """The 21-brick wall where it slides on the ground as one, and a slender wall that overturns as one."""
    friction = 0.2
    content = wall(
        f"The 21-brick wall with friction {friction}: slides as a whole",
        unit_weight=20.0,
        friction=friction,
        pattern=BOND_21,
        loads=push(),
    )
    source = f"{STATICS}: lambda = friction, the whole wall slides on the ground or any course on the one below"
    summary = "With little friction every course slides before anything can rock: lambda = friction."
    yield recipe(
        "running-bond-slides",
        content,
        exact(friction, source, f"The wall slides at its friction, {friction}.", relative_de=r.DE_TOLERANCE),
        Remarks(STATICS, summary, (*SUITES, "friction-family")),
    )

    length, height, count = 0.4, 0.2, 10
    value = length / (count * height)
    content = wall(
        f"A slender wall of {count} courses, one brick and two halves by turns: overturns as a whole",
        unit_weight=20.0,
        friction=0.75,
        pattern={
            "type": "running_bond",
            "block_length": length,
            "block_height": height,
            "count": count,
            "bricks": 1,
            "start": "full",
        },
        loads=push(),
    )
    source = f"{STATICS}: lambda = B / H, the whole wall turns about its toe"
    summary = "The whole bricks bind the halves, so that the wall turns about its toe as one: lambda = B / H."
    yield recipe(
        "running-bond-overturns",
        content,
        exact(value, source, f"The wall overturns at B / H = {value:g}.", relative_de=r.DE_TOLERANCE),
        Remarks(STATICS, summary, SUITES),
    )


def recipes() -> Iterator[Recipe]:
    """Every closed form."""
    for family in (_blocks, _inclines, _two_frictions, _overhangs, _columns, _thin_arches, _running_bonds):
        yield from family()
