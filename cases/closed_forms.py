"""Cases with a closed form: elementary statics of blocks, stacks, columns and arches, with the formula in the case.

Each function returns recipes; `cases.generate` writes them. Values follow from the formula printed in `source`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import cases.recipe as r
from cases.recipe import Recipe, Remarks, exact, push, recipe, wall
from harness.model.case import Reference

STATICS = "elementary statics"
MILANKOVITCH = (
    "M. Milankovitch, Theorie der Druckkurven, Zeitschrift fur Mathematik und Physik 55 (1907) 1-27; "
    "J. Heyman, The safety of masonry arches, International Journal of Mechanical Sciences 11 (1969) 363-385"
)
SUITES = ("closed-form",)


def blocks() -> Iterator[Recipe]:
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


def inclines() -> Iterator[Recipe]:
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


def two_frictions() -> Iterator[Recipe]:
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
    summary = "The paper's single block with a wider gap between the two frictions: the three methods part further."
    yield recipe("two-frictions", content, references, Remarks(STATICS, summary, (*SUITES, "small")))


def overhangs() -> Iterator[Recipe]:
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


def columns() -> Iterator[Recipe]:
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


def thin_arches() -> Iterator[Recipe]:
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
            remarks = Remarks(MILANKOVITCH, summary, (*SUITES, "stability"), kind="stability")
            yield recipe(f"heyman-arch-{count}-{word}", content, r.finding(word, source, sentence), remarks)


def running_bonds() -> Iterator[Recipe]:
    """The 21-brick wall where it slides on the ground as one, and a slender wall that overturns as one."""
    friction = 0.2
    content = wall(
        f"The 21-brick wall with friction {friction}: slides as a whole",
        unit_weight=20.0,
        friction=friction,
        pattern={"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 6, "bricks": 3},
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


BONDED = (
    "A. Orduna, P. B. Lourenco, Cap model for limit analysis and strengthening of masonry structures, Journal of "
    "Structural Engineering 129 (2003) 1367-1375"
)


def bonded_blocks() -> Iterator[Recipe]:
    """One block with cohesion slides at mu + c A / W, one with tensile strength topples at (b / h)(1 + T / W)."""
    unit = 20.0
    for name, width, height, friction, cohesion, tension, formula in (
        ("bonded-block-slides", 1.0, 0.2, 0.5, 1.0, 0.0, "mu + c A / W"),
        ("bonded-block-topples", 0.4, 2.0, 1.0, 8.0, 4.0, "(b / h)(1 + T / W)"),
    ):
        weight = unit * width * height
        slides, topples = friction + cohesion * width / weight, width / height * (1.0 + tension * width / weight)
        value = round(min(slides, topples), 14)
        does = "slides" if slides < topples else "topples"
        content = wall(
            f"A block {width} x {height} m on a joint with cohesion {cohesion:g} and tensile strength {tension:g} kPa",
            unit_weight=unit,
            friction=friction,
            cohesion=cohesion,
            **({"tensile_strength": tension} if tension else {}),
            pattern={"type": "stack", "width": width, "height": height, "count": 1},
            loads=push(),
        )
        source = f"{STATICS}: lambda = {formula}, A = b t, T = f_t A, t = 1 m"
        references = exact(value, source, f"The block {does} at {formula} = {value:g}.")
        summary = f"Pushed by a multiple of its weight, it {does} at {formula}; without strength it would at less."
        remarks = Remarks(BONDED, summary, ("strength",))
        yield recipe(name, content, references, remarks)


def bonded_wall() -> Iterator[Recipe]:
    """The 21-brick wall with a cohesion of a twentieth of unit weight times brick length in all joints."""
    content = wall(
        "The 21-brick wall with a little cohesion in all joints",
        unit_weight=20.0,
        friction=0.65,
        cohesion=0.4,
        pattern={"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 6, "bricks": 3},
        loads=push(),
    )
    references = [
        r.reference(
            "la-associated",
            "exact",
            0.6222348805,
            ["la-associated"],
            "a linear programme of other code: max lambda under equilibrium and yield with cohesion",
            "The associated maximum with c = 0.05 of unit weight times brick length is 0.6222349.",
            tolerance=1e-9,
            tolerance_reason="ten digits recorded",
            gate=True,
        ),
        r.reference(
            "la-least-known",
            "regression",
            0.6022028,
            ["la"],
            "Drystone, first release with strength of joints: exact collapse state, accepted by the judge",
            "LA finds a collapse state at least as low as 0.6022028.",
            relation="at_most",
            tolerance=1e-6,
            tolerance_reason="seven digits recorded",
            gate=True,
        ),
    ]
    summary = (
        "Dry, the wall collapses at 0.5579978 (least known) and 0.584461 (associated). Cohesion as large as the weight "
        "of a twentieth of a brick length adds 8 and 6 %; real joints are brittle, so rely on the dry values."
    )
    remarks = Remarks(BONDED, summary, ("strength",))
    yield recipe("bonded-wall-21", content, references, remarks)


def crushing_piers() -> Iterator[Recipe]:
    """Piers on a joint that crushes at its toe overturn at b / h - gamma b / f_c; one has tensile strength besides."""
    unit, width, strength = 20.0, 0.4, 200.0
    for name, height, more in (
        ("crushing-pier-2", 2.0, {}),
        ("crushing-pier-8", 8.0, {}),
        ("crushing-pier-bonded", 2.0, {"cohesion": 8.0, "tensile_strength": 4.0}),
    ):
        tension = more.get("tensile_strength", 0.0)
        weight = unit * width * height
        force = weight + tension * width
        value = (force * width - force**2 / (strength + tension)) / (weight * height)
        formula = "lambda = b / h - gamma b / f_c"
        if tension:
            formula = "lambda = (F b - F^2 / (f_c + f_t)) / (W h), F = W + f_t b"
        bonded = f", tensile strength {tension:g} kPa" if tension else ""
        content = wall(
            f"A pier {width} x {height} m whose joint crushes at {strength:g} kPa{bonded}",
            unit_weight=unit,
            friction=1.0,
            compressive_strength=strength,
            **more,
            pattern={"type": "stack", "width": width, "height": height, "count": 1},
            loads=push(),
        )
        references = _by_associated(
            round(value, 14), f"{STATICS}: {formula}, t = 1 m", f"The pier overturns at {value:.7g}.", r.ROUND_OFF
        )
        summary = (
            "It turns about the inner edge of the strip that is crushed, not about its corner: less than b / h by "
            "gamma b / f_c."
        )
        yield recipe(name, content, references, Remarks(BONDED, summary, ("strength",), methods=ASSOCIATED))


def crushing_walls() -> Iterator[Recipe]:
    """The 21-brick wall and a semicircular arch whose joints crush: second-order cone programmes of other code."""
    bond = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 6, "bricks": 3}
    ring = {"type": "ring", "inner_radius": 0.9, "outer_radius": 1.1, "count": 20}
    for name, title, friction, pattern, length, ratio, value, digits in (
        ("crushing-wall-21", "The 21-brick wall", 0.65, bond, 0.4, 20.0, 0.51801, 5e-6),
        ("crushing-arch-20", "A semicircular arch of 20 voussoirs", 1000.0, ring, 1.0, 20.0, 0.2530433, 5e-8),
    ):
        content = wall(
            f"{title} whose joints crush",
            unit_weight=20.0,
            friction=friction,
            compressive_strength=20.0 * length * ratio,
            pattern=pattern,
            loads=push(),
        )
        references = _by_associated(
            value,
            f"a second-order cone programme of other code, f_c = {ratio:g} unit weight times {length:g} m",
            f"The associated maximum is {value:g}.",
            digits,
        )
        summary = "Crushing at the hinges of the mechanism lowers the associated maximum."
        yield recipe(name, content, references, Remarks(BONDED, summary, ("strength",), methods=ASSOCIATED))


ASSOCIATED = ("la-associated", "la-associated-cvxpy")


def _by_associated(value: float, source: str, requirement: str, tolerance: float) -> list[Reference]:
    """An exact value for the methods that take joints which crush."""
    reason = r.ROUND_OFF_REASON if tolerance == r.ROUND_OFF else "half a unit of the last digit recorded"
    return [
        r.reference(
            "associated",
            "exact",
            value,
            list(ASSOCIATED),
            source,
            requirement,
            tolerance=tolerance,
            tolerance_reason=reason,
            gate=True,
        )
    ]


def recipes() -> Iterator[Recipe]:
    """Every closed form."""
    families = (blocks, inclines, two_frictions, overhangs, columns, thin_arches, running_bonds)
    for family in (*families, bonded_blocks, bonded_wall, crushing_piers, crushing_walls):
        yield from family()
