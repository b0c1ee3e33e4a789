"""Cases of joints with dilatancy, cohesion, tensile and compressive strength: statics, and programmes of other code."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import cases.recipe as r
from cases.recipe import BOND_21, STATICS, Recipe, Remarks, exact, push, recipe, wall
from harness.model.case import Reference
from harness.model.wall import Wall

_BONDED = (
    "A. Orduna, P. B. Lourenco, Cap model for limit analysis and strengthening of masonry structures, Journal of "
    "Structural Engineering 129 (2003) 1367-1375"
)
_DRUCKER = (
    "D. C. Drucker, Coulomb friction, plasticity, and limit loads, Journal of Applied Mechanics 21 (1954) 71-74: the "
    "limit of associated flow is unique"
)


@dataclass(frozen=True)
class BondedBlock:
    """A block on one joint with cohesion and tensile strength, pushed by its weight; in m and kPa."""

    does: str
    width: float
    height: float
    friction: float
    cohesion: float
    tension: float

    @property
    def peak(self) -> float:
        """The multiplier at which it slides or topples, by statics."""
        weight = UNIT_WEIGHT * self.width * self.height
        slides = self.friction + self.cohesion * self.width / weight
        topples = self.width / self.height * (1.0 + self.tension * self.width / weight)
        return min(slides, topples)

    @property
    def formula(self) -> str:
        """Of that multiplier."""
        return "mu + c A / W" if self.does == "slides" else "(b / h)(1 + T / W)"

    def wall(self, joint: str, **more: Any) -> Wall:
        """The wall; what its joint is stands in the title."""
        return wall(
            f"A block {self.width} x {self.height} m on a {joint}",
            unit_weight=UNIT_WEIGHT,
            friction=self.friction,
            cohesion=self.cohesion,
            **({"tensile_strength": self.tension} if self.tension else {}),
            pattern={"type": "stack", "width": self.width, "height": self.height, "count": 1},
            loads=push(),
            **more,
        )


UNIT_WEIGHT = 20.0
BLOCKS = (BondedBlock("slides", 1.0, 0.2, 0.5, 1.0, 0.0), BondedBlock("topples", 0.4, 2.0, 1.0, 8.0, 4.0))


def _bonded_blocks() -> Iterator[Recipe]:
    """One block with cohesion slides at mu + c A / W, one with tensile strength topples at (b / h)(1 + T / W)."""
    for block in BLOCKS:
        value, does, formula = round(block.peak, 14), block.does, block.formula
        strength = f"cohesion {block.cohesion:g} and tensile strength {block.tension:g} kPa"
        source = f"{STATICS}: lambda = {formula}, A = b t, T = f_t A, t = 1 m"
        references = exact(value, source, f"The block {does} at {formula} = {value:g}.")
        summary = f"Pushed by a multiple of its weight, it {does} at {formula}; without strength it would at less."
        remarks = Remarks(_BONDED, summary, ("strength",))
        yield recipe(f"bonded-block-{does}", block.wall(f"joint with {strength}"), references, remarks)


def _bonded_wall() -> Iterator[Recipe]:
    """The 21-brick wall with a cohesion of a twentieth of unit weight times brick length in all joints."""
    content = wall(
        "The 21-brick wall with a little cohesion in all joints",
        unit_weight=20.0,
        friction=0.65,
        cohesion=0.4,
        pattern=BOND_21,
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
            0.6000332,
            ["la"],
            "Drystone, central paths with other block weights: exact collapse state, accepted by the judge",
            "LA finds a collapse state at least as low as 0.6000332.",
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
    remarks = Remarks(_BONDED, summary, ("strength",))
    yield recipe("bonded-wall-21", content, references, remarks)


def _couplet() -> Iterator[Recipe]:
    """Two units on a joint under a confining stress, sheared along it: tau = c + mu sigma, in N and mm."""
    length, thickness, height, sigma, cohesion, friction = 100.0, 140.0, 50.0, 0.0536, 0.27, 0.94
    area = length * thickness
    shear = cohesion + friction * sigma
    content = wall(
        f"A couplet of {length:g} x {thickness:g} mm under {sigma} MPa, sheared along its joint",
        units={"length": "mm", "force": "N"},
        thickness=thickness,
        friction=friction,
        cohesion=cohesion,
        blocks=[
            {"id": "lower", "polygon": [(0, -height), (length, -height), (length, 0), (0, 0)], "fixed": True},
            {"id": "upper", "polygon": [(0, 0), (length, 0), (length, height), (0, height)], "weight": 0.0},
        ],
        loads={
            "dead": {"pressures": [{"from": (0, height), "to": (length, height), "uniform": sigma}]},
            "live": {"points": [{"block": "upper", "at": (length / 2.0, 0.0), "force": (area, 0.0)}]},
        },
    )
    source = f"{STATICS}: tau = c + mu sigma; the live load is 1 MPa on the joint"
    references = exact(round(shear, 14), source, f"The joint shears at {shear:.6g} MPa.")
    summary = "The multiplier is the shear strength in MPa; the force lies in the joint and turns nothing."
    yield recipe("couplet-shears", content, references, Remarks(_BONDED, summary, ("strength",)))


def _dilatant_wall() -> Iterator[Recipe]:
    """The 21-brick wall whose slips lift by the friction: associated flow, so that all methods have one multiplier."""
    exact = ("la", "la-associated", "fe")
    value, shown = 0.5844609341, "a linear programme of other code: max lambda under equilibrium and yield"
    sentence = "With the dilatancy of the friction every method finds the associated maximum 0.5844609."
    content = wall(
        "The 21-brick wall whose joints lift by their friction as they slip",
        unit_weight=20.0,
        friction={"default": 0.65, "dilatancy": 0.65},
        pattern=BOND_21,
        loads=push(),
    )
    references = [
        r.reference(
            "associated",
            "exact",
            value,
            exact,
            shown,
            sentence,
            tolerance=1e-9,
            tolerance_reason="ten digits recorded",
            gate=True,
        ),
        r.of_de("associated-de", value, shown, sentence),
    ]
    summary = (
        "With the dilatancy of the friction the flow is associated and the limit unique (Drucker 1954), whatever the "
        "self-stress and the stiffness of joints; dry stone lifts by less and collapses at 0.5579978 (least known)."
    )
    yield recipe(
        "dilatant-wall-21", content, references, Remarks(_DRUCKER, summary, ("strength",), methods=(*exact, "de"))
    )


def _crushing_piers() -> Iterator[Recipe]:
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
        source, sentence = f"{STATICS}: {formula}, t = 1 m", f"The pier overturns at {value:.7g}."
        references = _of_one_limit(round(value, 14), source, sentence, r.ROUND_OFF)
        summary = (
            "It turns about the inner edge of the strip that is crushed, not about its corner: less than b / h by "
            "gamma b / f_c."
        )
        yield recipe(name, content, references, Remarks(_BONDED, summary, ("strength",), methods=_CRUSHING))


def _crushing_walls() -> Iterator[Recipe]:
    """The 21-brick wall and a semicircular arch whose joints crush: second-order cone programmes of other code.

    The arch does not slide, so that it has one limit. The weaker of the two walls presses more than half of a joint,
    where methods without dilatancy find no state.
    """
    ring = {"type": "ring", "inner_radius": 0.9, "outer_radius": 1.1, "count": 20}
    bricks, arch = "The 21-brick wall", "A semicircular arch of 20 voussoirs"
    for name, title, friction, pattern, length, ratio, value, digits in (
        ("crushing-wall-21", bricks, 0.65, BOND_21, 0.4, 20.0, 0.51801, 5e-6),
        ("crushing-wall-21-strong", bricks, 0.65, BOND_21, 0.4, 100.0, 0.571732, 5e-7),
        ("crushing-arch-20", arch, 1000.0, ring, 1.0, 20.0, 0.2530433, 5e-8),
    ):
        content = wall(
            f"{title} whose joints crush",
            unit_weight=20.0,
            friction=friction,
            compressive_strength=20.0 * length * ratio,
            pattern=pattern,
            loads=push(),
        )
        source = f"a second-order cone programme of other code, f_c = {ratio:g} unit weight times {length:g} m"
        sentence = f"The associated maximum is {value:g}."
        summary = "Crushing at the hinges of the mechanism lowers the associated maximum."
        methods = _ASSOCIATED if ratio < 100.0 and pattern is BOND_21 else _CRUSHING
        if pattern is ring:
            references = _of_one_limit(value, source, sentence, digits)
        else:
            references = [_of_crushing("associated", value, _ASSOCIATED, source, sentence, digits)]
        if name == "crushing-wall-21-strong":
            references += _without_dilatancy()
            summary += " Without dilatancy it slides and crushes at 0.5515217 (least known), dry at 0.5579978."
        yield recipe(name, content, references, Remarks(_BONDED, summary, ("strength",), methods=methods))


_ASSOCIATED = ("la-associated", "la-associated-cvxpy")
_EXACT = ("la", *_ASSOCIATED, "fe")
_CRUSHING = (*_EXACT, "de")
"""Methods that take joints which crush."""


def _of_one_limit(value: float, source: str, requirement: str, tolerance: float) -> list[Reference]:
    """An exact value for all methods that take joints which crush, of a wall in which nothing slides."""
    of_de = r.of_de("limit-de", value, source, requirement)
    return [_of_crushing("limit", value, _EXACT, source, requirement, tolerance), of_de]


def _of_crushing(
    name: str, value: float, methods: tuple[str, ...], source: str, requirement: str, tolerance: float
) -> Reference:
    """An exact value of methods that take joints which crush."""
    reason = r.ROUND_OFF_REASON if tolerance == r.ROUND_OFF else "half a unit of the last digit recorded"
    return r.reference(
        name, "exact", value, methods, source, requirement, tolerance=tolerance, tolerance_reason=reason, gate=True
    )


def _without_dilatancy() -> list[Reference]:
    """The states of the stronger of the two 21-brick walls without dilatancy: least known, plateau of FE, in DE."""
    said = (
        ("la", "at_most", "LA finds a collapse state at least as low as 0.5515217."),
        ("fe", "equal", "The plateau of FE is 0.5515217."),
        ("de", "contains", "The bracket of DE holds 0.5515217."),
    )
    return [
        r.reference(
            f"{method}-known",
            "regression",
            0.5515217391,
            [method],
            "Drystone, first release with crushing in these methods: a state accepted by the judge",
            sentence,
            relation=relation,
            tolerance=1e-9,
            tolerance_reason="ten digits recorded",
            gate=True,
        )
        for method, relation, sentence in said
    ]


def recipes() -> Iterator[Recipe]:
    """Every case of joints with strength."""
    for family in (_bonded_blocks, _couplet, _bonded_wall, _dilatant_wall, _crushing_piers, _crushing_walls):
        yield from family()
