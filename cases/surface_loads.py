"""Cases of loads on faces: water, earth, a force on an extrados; by statics and by linear programmes of other code."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import cases.recipe as r
from cases.recipe import STATICS, Recipe, Remarks, exact, recipe, reference, wall
from harness.model.case import Reference

_WATER = 9.81
_METHODS = ("la", "la-associated", "fe", "de")
_SUITES = ("surface-loads",)
_DRUCKER = "D. C. Drucker, Coulomb friction, plasticity, and limit loads, Journal of Applied Mechanics 21 (1954) 71-74"


def _upright(name: str, width: float, height: float, unit_weight: float) -> list[dict[str, Any]]:
    """A block on ground that reaches beyond it on both sides."""
    ground = [(-1.0, -1.0), (width + 1.0, -1.0), (width + 1.0, 0.0), (-1.0, 0.0)]
    box = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    return [
        {"id": "ground", "polygon": ground, "fixed": True},
        {"id": name, "polygon": box, "unit_weight": unit_weight},
    ]


def _water(height: float) -> dict[str, Any]:
    """Loads of water to the top of an upright face at x = 0."""
    face = {"from": (0.0, 0.0), "to": (0.0, height), "water": {"level": height, "unit_weight": _WATER}}
    return {"live": {"pressures": [face]}}


def _dams() -> Iterator[Recipe]:
    """A gravity dam with water to its top overturns at 3 g b^2 / (g_w h^2) or slides at 2 mu g b / (g_w h)."""
    height, friction = 3.0, 0.6
    for does, width, unit in (("overturns", 1.0, 22.0), ("slides", 2.0, 11.0)):
        overturns = 3.0 * unit * width**2 / (_WATER * height**2)
        slides = 2.0 * friction * unit * width / (_WATER * height)
        value = min(overturns, slides)
        formula = "3 g b^2 / (g_w h^2)" if value == overturns else "2 mu g b / (g_w h)"
        content = wall(
            f"A dam {width:g} x {height:g} m, water to its top: it {does}",
            friction=friction,
            blocks=_upright("dam", width, height, unit),
            loads=_water(height),
        )
        source = f"{STATICS}: lambda = {formula}, g and g_w the unit weights of dam and water"
        references = exact(value, source, f"The dam {does} at {formula} = {value:.7g}.")
        summary = f"The live load is the pressure of the water; it may be {value:.4g} times as great."
        yield recipe(f"dam-{does}", content, references, Remarks(STATICS, summary, _SUITES))


def _retaining_wall() -> Recipe:
    """Earth with a surcharge behind an upright wall: K_a (g_e h^3 / 6 + q h^2 / 2) overturns g b^2 h / 2."""
    width, height, unit, earth, surcharge, angle = 1.2, 3.0, 22.0, 18.0, 10.0, 30.0
    sine = math.sin(math.radians(angle))
    active = (1.0 - sine) / (1.0 + sine)
    value = unit * width**2 * height / 2.0 / (active * (earth * height**3 / 6.0 + surcharge * height**2 / 2.0))
    soil = {"level": height, "unit_weight": earth, "friction_angle": angle, "state": "active", "surcharge": surcharge}
    content = wall(
        f"A wall {width:g} x {height:g} m before earth with a surcharge",
        friction=0.7,
        blocks=_upright("wall", width, height, unit),
        loads={"live": {"pressures": [{"from": (0.0, 0.0), "to": (0.0, height), "earth": soil}]}},
    )
    formula = "(g b^2 h / 2) / (K_a (g_e h^3 / 6 + q h^2 / 2))"
    source = f"{STATICS}: moments about the toe, lambda = {formula}, K_a = (1 - sin phi) / (1 + sin phi)"
    references = exact(value, source, f"The wall overturns at {formula} = {value:.7g}.")
    summary = "Active pressure of earth without friction on the wall, its surcharge with the same coefficient."
    return recipe("retaining-wall", content, references, Remarks(STATICS, summary, _SUITES))


def _bonded_dam() -> Recipe:
    """Ten courses under water, which crack as they overturn; slips lift by the friction, so that there is one limit."""
    value, height = 1.06841247, 2.5
    content = wall(
        "A bonded dam of ten courses, water to its top",
        unit_weight=22.0,
        friction={"default": 0.75, "dilatancy": 0.75},
        pattern={"type": "running_bond", "block_length": 0.5, "block_height": 0.25, "count": 10, "bricks": 2},
        loads=_water(height),
    )
    source = "a linear programme of other code (tests/cases/test_bonded_dam.py)"
    sentence = f"The dam bears {value} times the water."
    summary = (
        "It cracks along its joints as it overturns: less than a block of its size bears, 3 g b^2 / (g_w h^2) = 1.0765."
    )
    remarks = Remarks(_DRUCKER, summary, _SUITES, methods=_METHODS)
    return recipe("dam-bonded", content, _of_programme(value, source, sentence, 5e-9), remarks)


def _wheels() -> Iterator[Recipe]:
    """A force down on the extrados of a semicircle, where it bears least and near its haunch; in gamma R^2."""
    count, thickness, unit = 20, 0.2, 20.0
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    for number, share, where in ((9, 0.231580, "where it bears least"), (5, 1.888767, "near its springing")):
        angle = math.pi * (1.0 - (number - 0.5) / count)
        radius = outer * math.cos(math.pi / (2.0 * count))  # in the middle of a straight face
        at = (radius * math.cos(angle), radius * math.sin(angle))
        value = round(share * unit, 5)
        content = wall(
            f"A semicircle of {count} voussoirs with a force on the extrados of voussoir {number}, {where}",
            unit_weight=unit,
            friction=100.0,
            pattern={"type": "ring", "inner_radius": inner, "outer_radius": outer, "count": count},
            loads={"live": {"points": [{"block": f"v{number}", "at": at, "force": (0.0, -1.0)}]}},
        )
        source = f"a linear programme of other code: P = {share} gamma R^2 where nothing slides"
        sentence = f"The arch bears a force of {value:g} kN {where}."
        summary = "One place of a load that travels along the extrados; `travelling` of a wall asks for all of them."
        remarks = Remarks(STATICS, summary, _SUITES, methods=_METHODS)
        references = _of_programme(value, source, sentence, 0.5e-6 * unit)
        yield recipe(f"arch-wheel-{number}", content, references, remarks)


def _of_programme(value: float, source: str, sentence: str, tolerance: float) -> list[Reference]:
    """A value by code of its own to half a unit of its last digit, for all methods, and for the bracket of DE."""
    of_all = reference(
        "programme",
        "exact",
        value,
        ("la", "la-associated", "fe"),
        source,
        sentence,
        tolerance=tolerance,
        tolerance_reason="half a unit of the last digit recorded",
        gate=True,
    )
    return [of_all, r.of_de("programme-de", value, source, sentence)]


def recipes() -> Iterator[Recipe]:
    """Every case of loads on faces."""
    yield from _dams()
    yield _retaining_wall()
    yield _bonded_dam()
    yield from _wheels()
