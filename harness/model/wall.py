"""The wall description, format `wall/1`: what a user writes and `drystone expand` prints.

A wall is blocks (or a pattern that makes them), friction, interfaces (found from the geometry unless given) and
loads, dead and live apart. `harness.model.reading` reads it, `harness.model.build` makes its `Assembly`.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Discriminator, Field, StrictBool, Tag, model_validator

from harness.model.bar_fields import Prop, Tie
from harness.model.fields import (
    MANY,
    OBJECT,
    ONE,
    OTHER,
    Angle,
    Blocks,
    Coefficient,
    Name,
    NonNegative,
    Number,
    Point,
    Positive,
    Strict,
)
from harness.model.friction_fields import (
    After,
    Cohesion,
    CompressiveStrength,
    Dilatancy,
    Friction,
    JointStrength,
    TensileStrength,
    check_dilatancy,
    check_strength,
    coefficient_of,
)
from harness.model.load_fields import DEAD, Combination, Loads, Travelling
from harness.model.pattern_fields import Pattern
from harness.model.units import DIMENSIONLESS, KILONEWTONS, METRES, ForceUnit, LengthUnit, unit_weight_in_kn_m3

_MOST_VERTICES = 5_000
"""Of one outline: joints of two faces are found in time that grows with the square of their vertices."""
MOST_LOAD_CASES = 500
"""Each is built, and answered, as a wall of its own."""
_LOAD_CASE_NAME = r"[a-z0-9][a-z0-9-]{0,59}"
"""A load case is part of the id of a case, which users type."""


def _one_or_many(value: Any) -> str:
    return MANY if isinstance(value, list) else ONE


def _object_or_other(value: Any) -> str:
    return OBJECT if isinstance(value, dict | BaseModel) else OTHER


class Units(Strict):
    """Units of the file, "1" for none. The multiplier is dimensionless unless the live load is a force."""

    length: LengthUnit = "m"
    force: ForceUnit = "kN"
    unit_weight: str | None = Field(None, description='as "kN/m3" or "kg/m3"; else force/length^3 of the file')

    @model_validator(mode="after")
    def _known_unit_weight(self) -> Units:
        if self.unit_weight is not None:
            unit_weight_in_kn_m3(self.unit_weight)
            if self.dimensionless:
                raise ValueError("a unit weight has no unit where length and force have none")
        return self

    @property
    def dimensionless(self) -> bool:
        """Whether lengths or forces have no unit."""
        return DIMENSIONLESS in (self.length, self.force)

    @property
    def metre(self) -> float:
        """One metre in the unit of length of the file; 1 where it has none."""
        return 1.0 if self.length in ("m", DIMENSIONLESS) else 1.0 / METRES[self.length]

    @property
    def unit_weight_factor(self) -> float:
        """What a unit weight of the file is multiplied with to be one in force/length^3 of the file."""
        if self.unit_weight is None:
            return 1.0
        return unit_weight_in_kn_m3(self.unit_weight) / (KILONEWTONS[self.force] / METRES[self.length] ** 3)

    @property
    def unit_weight_name(self) -> str:
        """The unit that unit weights of the file are in."""
        return self.unit_weight or f"{self.force}/{self.length}3"


class Block(Strict):
    """A rigid block, with holes or without. Its weight is given, or unit_weight x area x thickness."""

    id: Name
    polygon: Annotated[
        list[Point],
        Field(min_length=3, max_length=_MOST_VERTICES, description="vertices in order round the block, either way"),
    ]
    holes: list[Annotated[list[Point], Field(min_length=3, max_length=_MOST_VERTICES)]] = Field(
        default_factory=list, description="polygons within it that are not stone, as of a frame"
    )
    weight: NonNegative | None = Field(None, description="weight [force]; else unit_weight x area x thickness")
    unit_weight: NonNegative | None = Field(None, description="[force/length^3]; else the wall's")
    thickness: Positive | None = Field(None, description="out of plane [length]; else the wall's")
    material: str = "stone"
    fixed: StrictBool = Field(False, description="a support")
    groups: list[Name] = Field(default_factory=list, description="groups a load may name")

    @model_validator(mode="after")
    def _holes_that_can_be_cut(self) -> Block:
        """Cuts from outline to holes are sought among all pairs of their vertices, once for every hole."""
        inside = sum(map(len, self.holes))
        if len(self.holes) * inside * (len(self.polygon) + inside) > 500_000:
            raise ValueError(f"its {len(self.holes)} holes have {inside} vertices, too many to be cut: simplify them")
        return self


class Inset(Strict):
    """Contact points set in from both ends of an interface, by a length or by a fraction of the interface."""

    length: NonNegative | None = None
    fraction: Annotated[float, Field(ge=0.0, lt=0.5)] | None = None

    @model_validator(mode="after")
    def _one_measure(self) -> Inset:
        if (self.length is None) == (self.fraction is None):
            raise ValueError("an inset gives either length or fraction")
        return self


class Interface(Strict):
    """A contact between two blocks along a segment."""

    between: tuple[str, str] = Field(description="ids of the two blocks")
    start: Point = Field(alias="from")
    end: Point = Field(alias="to")
    friction: Coefficient | None = None
    friction_angle: Angle | None = Field(None, description="phi [degrees], instead of `friction`")
    dilatancy: Dilatancy = None
    cohesion: Cohesion = None
    tensile_strength: TensileStrength = None
    compressive_strength: CompressiveStrength = None
    after: After = None
    joint: str | None = Field(None, description='a name for friction rules; "bed" or "head" by inclination if absent')
    inset: Inset | None = None

    @model_validator(mode="after")
    def _one_friction(self) -> Interface:
        if self.friction is not None and self.friction_angle is not None:
            raise ValueError("an interface gives either friction or friction_angle")
        if self.friction is not None or self.friction_angle is not None:
            friction = coefficient_of(self.friction, self.friction_angle)
            check_dilatancy(self.dilatancy, friction)
            check_strength(self, friction)
        elif self.dilatancy is not None:
            raise ValueError("an interface gives dilatancy beside a friction of its own")
        elif _gives_strength(self):
            raise ValueError(
                "an interface gives cohesion, tensile and compressive strength beside a friction of its own"
            )
        return self


class Detection(Strict):
    """How interfaces are found: faces that face each other, with the interface in the middle between them."""

    tolerance: Positive | None = Field(
        None, description="greatest gap and overlap at once [length]; default 1e-6 of the typical block size"
    )
    greatest_gap: Positive | None = Field(None, description="between the two faces of a joint [length]; or tolerance")
    greatest_overlap: Positive | None = Field(None, description="of the two faces of a joint [length]; or tolerance")
    greatest_angle: Annotated[float, Field(gt=0.0, lt=90.0, strict=True)] = Field(
        20.0, description="between the two faces of a joint [degrees]: mortar may be a wedge"
    )
    least_contact: Positive | None = Field(
        None,
        description="faces beside each other along no more than this touch at a corner [length]; default the "
        "greatest gap, at most a hundredth of the typical block size",
    )
    sight: Positive | None = Field(
        None,
        description="opposite faces up to this distance without a joint cause a warning [length]; "
        "default ten times the greatest gap, at least a fiftieth of the typical block size",
    )
    given: list[Interface] = Field(
        default_factory=list, description="these, in place of those found between their blocks"
    )
    removed: list[tuple[Name, Name]] = Field(default_factory=list, description="pairs of blocks without a joint")


class Settlement(Strict):
    """A prescribed motion of fixed blocks, by which the reaction along it is asked for."""

    blocks: Blocks | None = Field(None, description="ids of fixed blocks")
    group: Name | None = Field(None, description="a group of fixed blocks")
    translation: Point = Field((0.0, 0.0), description="(x, y), a direction of any length: the reaction is a force")
    rotation: Number = Field(0.0, description="counter-clockwise [radian]; of rotations alone it is a moment")
    about: Point | None = Field(None, description="centre of the rotation [length]; else the centroid of each block")

    @model_validator(mode="after")
    def _moves_something(self) -> Settlement:
        if (self.blocks is None) == (self.group is None):
            raise ValueError("a settlement names either blocks or a group")
        if self.translation == (0.0, 0.0) and self.rotation == 0.0:
            raise ValueError("a settlement that moves nothing: give a translation or a rotation")
        return self


Patterns = Annotated[Annotated[Pattern, Tag(ONE)] | Annotated[list[Pattern], Tag(MANY)], Discriminator(_one_or_many)]
FrictionOfWall = Annotated[
    Annotated[Coefficient, Tag(OTHER)] | Annotated[Friction, Tag(OBJECT)], Discriminator(_object_or_other)
]
Interfaces = Annotated[
    Annotated[list[Interface], Tag(OTHER)] | Annotated[Detection, Tag(OBJECT)], Discriminator(_object_or_other)
]


class Wall(Strict):
    """A wall, format `wall/1`. Its own cohesion, tensile and compressive strength are of all joints."""

    format: Literal["wall/1"]
    title: str = ""
    units: Units = Field(default_factory=Units)
    metadata: dict[str, Any] = Field(default_factory=dict, description="free: source, author, remarks")
    schema_address: str = Field("", alias="$schema", description="for editors that check and complete a file")
    comment: str | list[str] = Field("", description="free: remarks of the author")
    doubts: list[str] = Field(
        default_factory=list,
        description="what was ignored or assumed when the drawing was imported; a warning with every answer",
    )
    unit_weight: NonNegative | None = Field(None, description="[force/length^3] for blocks that give no weight")
    thickness: Positive | None = Field(None, description="out of plane [length]; one metre if absent")
    friction: FrictionOfWall | None = Field(None, description="coefficient of friction, tan(phi), or rules")
    friction_angle: Angle | None = Field(None, description="phi [degrees], instead of `friction`")
    cohesion: Cohesion = None
    tensile_strength: TensileStrength = None
    compressive_strength: CompressiveStrength = None
    after: After = None
    pattern: Patterns | None = None
    blocks: list[Block] = Field(default_factory=list)
    interfaces: Interfaces = Field(default_factory=Detection)
    contact_inset: Inset | None = None
    loads: Loads = Field(default_factory=Loads)
    load_cases: dict[str, Loads] = Field(
        default_factory=dict,
        max_length=MOST_LOAD_CASES,
        description="by name, each on top of the gravity and the dead load of `loads`",
    )
    travelling: dict[str, Travelling] = Field(
        default_factory=dict,
        max_length=MOST_LOAD_CASES,
        description="by name, each a load case for every place of the force: NAME-1, NAME-2, ...",
    )
    combinations: dict[str, Combination] = Field(
        default_factory=dict,
        max_length=MOST_LOAD_CASES,
        description="by name, each a load case that adds others with factors",
    )
    settlements: list[Settlement] = Field(
        default_factory=list, description="supports that move; asked about by `drystone reaction` alone"
    )
    ties: list[Tie] = Field(default_factory=list, description="bars that bear tension alone")
    props: list[Prop] = Field(default_factory=list, description="bars that bear compression alone")

    @model_validator(mode="after")
    def _one_friction(self) -> Wall:
        if self.friction is None and self.friction_angle is None:
            raise ValueError('it gives no friction: "friction" is tan(phi), "friction_angle" is phi in degrees')
        if self.friction is not None and self.friction_angle is not None:
            raise ValueError("a wall gives either friction or friction_angle")
        if isinstance(self.friction, Friction):
            if _gives_strength(self):
                raise ValueError(
                    "friction by rules holds the cohesion, tensile and compressive strength too: give them beside "
                    '"default" or in a rule'
                )
        else:
            check_strength(self, coefficient_of(self.friction, self.friction_angle))
        return self

    @model_validator(mode="after")
    def _load_cases_named(self) -> Wall:
        named = [*self.load_cases, *self.travelling, *self.combinations]
        if named and self.loads.live is not None:
            raise ValueError(
                "loads.live beside load_cases: a load case has a live load of its own, so name this one there too"
            )
        twice = next((name for name, count in Counter(named).items() if count > 1), None)
        if twice is not None:
            raise ValueError(f'"{twice}" names two of load_cases, travelling and combinations: give each its own name')
        if self.combinations and DEAD in named:
            raise ValueError(f'"{DEAD}" is gravity and the dead load in combinations: give the load case another name')
        for name in named:
            if re.fullmatch(_LOAD_CASE_NAME, name) is None:
                raise ValueError(
                    f'"{name}" is no name of a load case: give small letters, digits and hyphens, as "snow-left"'
                )
        return self

    @property
    def load_case_fields(self) -> list[str]:
        """Names of what makes load cases: those written out, loads that travel, combinations; empty without any."""
        return [*self.load_cases, *self.travelling, *self.combinations]

    @property
    def load_cases_place(self) -> str:
        """The fields of the file that give load cases, for errors; `load_cases` where none does."""
        fields = ("load_cases", "travelling", "combinations")
        return ", ".join(name for name in fields if getattr(self, name)) or fields[0]

    @property
    def units_declared(self) -> bool:
        """Whether the file says its units; otherwise metres and kilonewtons are taken."""
        return "units" in self.model_fields_set

    @property
    def units_sentence(self) -> str:
        """The units in words, for the head of whatever shows the wall."""
        units = self.units
        length, force = ("none" if unit == DIMENSIONLESS else unit for unit in (units.length, units.force))
        stated = f"length {length}, force {force}" + (f", unit weight {units.unit_weight}" if units.unit_weight else "")
        return stated if self.units_declared else f"{stated} (assumed: the file declares none)"

    def document(self) -> dict[str, Any]:
        """The wall as JSON values of format wall/1: fields at their defaults left out, but units that are declared."""
        data = self.model_dump(mode="json", by_alias=True, exclude_defaults=True)
        if self.units_declared and "units" not in data:
            data["units"] = self.units.model_dump(mode="json", exclude_none=True)
        return {"format": "wall/1"} | data


def _gives_strength(given: JointStrength) -> bool:
    """Whether any strength is given."""
    strengths = given.cohesion, given.tensile_strength, given.compressive_strength, given.after
    return any(value is not None for value in strengths)
