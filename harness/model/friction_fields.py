"""Fields of friction and strength of joints in `wall/1`: of all joints, and by rules of some."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Protocol

from pydantic import Field, model_validator

from harness.model.fields import Angle, Coefficient, NonNegative, Positive, Strict


def coefficient_of(value: float | None, angle: float | None) -> float:
    """A coefficient of friction from whichever is given, itself or the angle phi [degrees]."""
    return value if value is not None else math.tan(math.radians(angle or 0.0))


Dilatancy = Annotated[
    Coefficient | None, Field(description="by which a slip lifts, from 0 (absent) to the friction: associated flow")
]


Cohesion = Annotated[
    NonNegative | None, Field(description="shear strength without compression [force/length^2 of the file]; else none")
]


TensileStrength = Annotated[
    NonNegative | None, Field(description="[force/length^2 of the file], from 0 (absent) to cohesion / friction")
]


CompressiveStrength = Annotated[
    Positive | None,
    Field(description="stress at which a joint crushes [force/length^2 of the file]; else it never does"),
]


After = Annotated[
    Literal["plastic", "residual"] | None,
    Field(
        description='of cohesion and tensile strength once a joint has opened or slipped: "plastic" (absent): it keeps '
        'them; "residual": it is brittle and loses both'
    ),
]


class JointStrength(Protocol):
    """Whatever gives the strength of joints beside their friction: a wall, friction, a rule, an interface."""

    @property
    def cohesion(self) -> float | None:
        """Shear strength without compression [force/length^2]."""

    @property
    def tensile_strength(self) -> float | None:
        """Tensile strength [force/length^2]."""

    @property
    def compressive_strength(self) -> float | None:
        """Compressive strength [force/length^2]."""

    @property
    def after(self) -> Literal["plastic", "residual"] | None:
        """What is left of cohesion and tensile strength in a joint that has opened or slipped."""


def stresses_of(given: JointStrength) -> tuple[float, float, float]:
    """Cohesion, tensile, compressive strength [force/length^2]: zero, and the last infinite, where none is given."""
    crushing = given.compressive_strength
    return given.cohesion or 0.0, given.tensile_strength or 0.0, math.inf if crushing is None else crushing


def is_brittle(given: JointStrength) -> bool:
    """Whether joints lose their cohesion and tensile strength once they have opened or slipped."""
    return given.after == "residual"


def check_strength(given: JointStrength, friction: float) -> None:
    """A joint bears no tension at which its shear strength would be used up already, but for rounding."""
    cohesion, tension, _ = stresses_of(given)
    if is_brittle(given) and cohesion == tension == 0.0:
        raise ValueError(
            'after "residual" beside neither cohesion nor tensile strength: there is nothing that a joint could lose'
        )
    if friction * tension > cohesion * (1.0 + 1e-9):
        raise ValueError(
            f"the tensile strength {tension:g} is above cohesion / friction = {cohesion / friction:.6g}, where no "
            "shear strength is left: give one from 0 to that, or more cohesion"
        )


def check_dilatancy(dilatancy: float | None, friction: float) -> None:
    """No slip lifts by more than the friction."""
    if dilatancy is not None and dilatancy > friction:
        raise ValueError(f"the dilatancy {dilatancy:g} is above the friction {friction:g}: give one from 0 to that")


class FrictionRule(Strict):
    """Friction of some interfaces: those between two materials, of a named joint, or between two blocks."""

    value: Coefficient | None = Field(None, description="coefficient of friction, tan(phi)")
    friction_angle: Angle | None = Field(None, description="phi [degrees], instead of `value`")
    dilatancy: Dilatancy = None
    cohesion: Cohesion = None
    tensile_strength: TensileStrength = None
    compressive_strength: CompressiveStrength = None
    after: After = None
    materials: tuple[str, str] | None = None
    joint: str | None = Field(None, description='"bed", "head", or a name given in `interfaces`')
    between: tuple[str, str] | None = Field(None, description="ids of the two blocks")

    @model_validator(mode="after")
    def _one_selector(self) -> FrictionRule:
        if sum(item is not None for item in (self.materials, self.joint, self.between)) != 1:
            raise ValueError("a friction rule names exactly one of materials, joint, between")
        if (self.value is None) == (self.friction_angle is None):
            raise ValueError("a friction rule gives either value or friction_angle")
        check_dilatancy(self.dilatancy, self.coefficient)
        check_strength(self, self.coefficient)
        return self

    @property
    def coefficient(self) -> float:
        """Coefficient of friction, tan(phi)."""
        return coefficient_of(self.value, self.friction_angle)


class Friction(Strict):
    """Friction by rules, with what joints have beside it where none holds.

    The most particular rule holds: interface, then between, then joint, then materials.
    """

    default: Coefficient | None = Field(None, description="coefficient of friction, tan(phi)")
    friction_angle: Angle | None = Field(None, description="phi [degrees], instead of `default`")
    dilatancy: Dilatancy = None
    cohesion: Cohesion = None
    tensile_strength: TensileStrength = None
    compressive_strength: CompressiveStrength = None
    after: After = None
    rules: list[FrictionRule] = Field(default_factory=list)

    @model_validator(mode="after")
    def _one_default(self) -> Friction:
        if (self.default is None) == (self.friction_angle is None):
            raise ValueError("friction by rules gives either default or friction_angle")
        check_dilatancy(self.dilatancy, self.coefficient)
        check_strength(self, self.coefficient)
        return self

    @property
    def coefficient(self) -> float:
        """Coefficient of friction where no rule holds."""
        return coefficient_of(self.default, self.friction_angle)
