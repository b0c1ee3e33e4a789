"""Cases with brittle joints: blocks by statics, two joints that share a load by stiffness, and the 21-brick wall."""

from __future__ import annotations

from collections.abc import Iterator

import cases.recipe as r
from cases.joint_strength import BLOCKS
from cases.recipe import BOND_21, STATICS, Recipe, Remarks, push, recipe, wall
from harness.model.case import Reference

SUITES = ("strength",)
METHODS = ("la", "la-associated", "fe")
_LAWS = "elementary statics of joints that lose their strength at once when they open or slip"


def _values(found: dict[str, float], source: str, requirement: dict[str, str]) -> list[Reference]:
    """A gated closed form for each method, which takes the joints broken, whole, or as they break."""
    return [
        r.reference(
            method,
            "exact",
            round(value, 14),
            [method],
            f"{STATICS}: {source}",
            requirement[method],
            tolerance=r.ROUND_OFF,
            tolerance_reason=r.ROUND_OFF_REASON,
            gate=True,
        )
        for method, value in found.items()
    ]


def _blocks() -> Iterator[Recipe]:
    """One block: it bears its plastic multiplier, breaks there, and is left with the residual one."""
    for block in BLOCKS:
        peak, formula = block.peak, block.formula
        dry = "mu" if block.does == "slides" else "b / h"
        residual = min(block.friction, block.width / block.height)
        strength = f"cohesion {block.cohesion:g}, tensile strength {block.tension:g} kPa"
        requirement = {
            "la": f"With the joint broken it moves at {dry} = {residual:g}.",
            "la-associated": f"With the joint whole it bears {formula} = {peak:g}.",
            "fe": f"The joint breaks at {formula} = {peak:g}, and nothing bears that without it.",
        }
        found = {"la": residual, "la-associated": peak, "fe": peak}
        summary = f"The joint bears {formula}, then breaks and leaves {dry}."
        references = _values(found, f"{formula} whole, {dry} broken", requirement)
        content = block.wall(f"brittle joint, {strength}", after="residual")
        yield recipe(
            f"brittle-block-{block.does}", content, references, Remarks(_LAWS, summary, SUITES, methods=METHODS)
        )


def _side_by_side() -> Iterator[Recipe]:
    """A block on two joints of one length, a smooth brittle one and a rough plain one, pushed along both."""
    force, at, bond, tension = 10.0, 0.9, 7.0, 5.0
    content = wall(
        "A block on a brittle and a plain joint side by side",
        friction={
            "default": 1.0,
            "rules": [
                {
                    "between": ("left", "block"),
                    "value": 0.0,
                    "cohesion": bond / 0.5,
                    "tensile_strength": tension / 0.5,
                    "after": "residual",
                }
            ],
        },
        blocks=[
            r.box("left", -0.5, -1.0, 0.5, 0.0, fixed=True),
            r.box("right", 0.5, -1.0, 1.5, 0.0, fixed=True),
            r.box("block", 0.0, 0.0, 1.0, 0.5, weight=2.0),
        ],
        loads={
            "dead": {"points": [{"block": "block", "at": (1.0, 0.5), "force": (0.0, -8.0)}]},
            "live": {"points": [{"block": "block", "at": (0.0, 0.0), "force": (force, 0.0)}]},
        },
    )
    # four equal springs at 0, .5 | .5, 1: n = W (a + b x), the sum and the moment give a = -.15, b = .8
    ends = [force * (-0.15 + 0.8 * x) for x in (0.5, 1.0)]
    shared = sum(min(0.5 * bond, end) for end in ends)
    # the least on the right joint broken: the rest rests at x = .5; the greatest whole: all tension pulls on the left
    least, greatest = force * (at - 0.5) / 0.5, bond + force + tension
    requirement = {
        "la": "Broken, the joints share the weight so that the right one slides at .8.",
        "la-associated": "Whole, the left joint bears 7 and draws on the right one with its tension of 5: 2.2.",
        "fe": "The left joint breaks at 7, when the right one bears 2.5 by friction and 3.5 by stiffness: 1.3.",
    }
    found = {"la": least / force, "la-associated": greatest / force, "fe": (bond + shared) / force}
    source = "equilibrium of four contact points; springs of equal stiffness, of which one slides at mu n"
    summary = "The brittle joint breaks before the plain one bears all it could, between the safe and upper estimates."
    yield recipe(
        "brittle-beside-plain",
        content,
        _values(found, source, requirement),
        Remarks(_LAWS, summary, SUITES, methods=METHODS),
    )


def _bonded_wall() -> Iterator[Recipe]:
    """The 21-brick wall with strong brittle joints."""
    content = wall(
        "The 21-brick wall with strong brittle joints",
        unit_weight=20.0,
        friction=0.65,
        cohesion=8.0,
        tensile_strength=4.0,
        after="residual",
        pattern=BOND_21,
        loads=push(),
    )
    references = [
        r.reference(
            "la-associated",
            "exact",
            0.9833333,
            ["la-associated"],
            "a linear programme of other code: max lambda under equilibrium and yield with c = gamma L, f_t = c / 2",
            "The associated maximum of whole joints is 0.9833333.",
            tolerance=5e-8,
            tolerance_reason="half a unit of the last digit recorded",
            gate=True,
        ),
        r.reference(
            "fe-peak",
            "regression",
            0.6938758,
            ["fe"],
            "Drystone, first release with brittle joints: forces and break accepted by the judge",
            "Joints break from .18 on, and the wall with them at 0.6938758.",
            tolerance=1e-6,
            tolerance_reason="seven digits recorded",
            gate=True,
        ),
    ]
    summary = (
        "Whole, its joints would bear 0.9833; dry, it collapses at 0.5580 (least known). Joints break one after the "
        "other from .18 on, and those at the base let the wall go at 0.6939."
    )
    yield recipe("brittle-wall-21", content, references, Remarks(_LAWS, summary, SUITES, methods=METHODS))


def recipes() -> Iterator[Recipe]:
    """Every case with brittle joints."""
    for family in (_blocks, _side_by_side, _bonded_wall):
        yield from family()
