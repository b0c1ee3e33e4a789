"""The wall description, format `wall/1`: what a user writes and `drystone expand` prints.

A wall is blocks (or a pattern that makes them), friction, interfaces (found from the geometry unless given) and
loads, dead and live apart. `harness.model.reading` reads it, `harness.model.build` makes its `Assembly`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

LARGEST = 1e15
"""Greatest size of any number of the format, whatever its unit, so that no product of a few of them overflows."""
MOST_BLOCKS = 100_000
"""Blocks that a pattern makes at most."""
Number = Annotated[float, Field(ge=-LARGEST, le=LARGEST, strict=True)]
Point = tuple[Number, Number]
Positive = Annotated[float, Field(gt=0.0, le=LARGEST, strict=True)]
NonNegative = Annotated[float, Field(ge=0.0, le=LARGEST, strict=True)]
Coefficient = Annotated[float, Field(ge=0.0, le=1e4, strict=True)]
Count = Annotated[int, Field(ge=1, le=MOST_BLOCKS)]
Name = Annotated[str, Field(min_length=1, max_length=200)]


class Strict(BaseModel):
    """Base of the format: unknown fields, NaN and infinities are refused."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, frozen=True, populate_by_name=True)


TAGS = ONE, MANY, OBJECT, OTHER = "(one)", "(many)", "(object)", "(other)"
"""Alternatives of a field, told apart by what is given, so that only the faults of the one meant are found.

Parentheses keep them apart from names of fields.
"""


def _one_or_many(value: Any) -> str:
    return MANY if isinstance(value, list) else ONE


def _object_or_other(value: Any) -> str:
    return OBJECT if isinstance(value, dict | BaseModel) else OTHER


class Units(Strict):
    """Units of the file. The multiplier is dimensionless unless the live load is a given force."""

    length: str = "m"
    force: str = "kN"


class Block(Strict):
    """A rigid block. Its weight is given, or unit_weight x area x thickness."""

    id: Name
    polygon: Annotated[list[Point], Field(min_length=3, description="vertices in order round the block, either way")]
    weight: NonNegative | None = Field(None, description="weight [force]; else unit_weight x area x thickness")
    unit_weight: NonNegative | None = Field(None, description="[force/length^3]; else the wall's")
    thickness: Positive | None = Field(None, description="out of plane [length]; else the wall's")
    material: str = "stone"
    fixed: bool = Field(False, description="cannot move: a support")
    groups: list[Name] = Field(default_factory=list, description="groups a load may name")


class FrictionRule(Strict):
    """Friction of some interfaces: those between two materials, of a named joint, or between two blocks."""

    value: Coefficient = Field(description="coefficient of friction, tan(phi)")
    materials: tuple[str, str] | None = None
    joint: str | None = Field(None, description='"bed", "head", or a name given in `interfaces`')
    between: tuple[str, str] | None = Field(None, description="ids of the two blocks")

    @model_validator(mode="after")
    def _one_selector(self) -> FrictionRule:
        if sum(item is not None for item in (self.materials, self.joint, self.between)) != 1:
            raise ValueError("a friction rule names exactly one of materials, joint, between")
        return self


class Friction(Strict):
    """Friction by rules. The most particular rule holds: interface, then between, then joint, then materials."""

    default: Coefficient
    rules: list[FrictionRule] = Field(default_factory=list)


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
    joint: str | None = Field(None, description='a name for friction rules; "bed" or "head" by inclination if absent')
    inset: Inset | None = None


class Detection(Strict):
    """How interfaces are found: edges that lie along each other within `tolerance`."""

    tolerance: Positive | None = Field(None, description="[length]; default 1e-6 of the typical block size")


class BodyForce(Strict):
    """A force on blocks as a multiple of their weight, at their centroids."""

    per_weight: Point = Field(description="(x, y) multiple of the weight; gravity is [0, -1]")
    blocks: list[Name] | None = Field(None, description="ids; all free blocks if neither blocks nor group is given")
    group: Name | None = None

    @model_validator(mode="after")
    def _one_choice(self) -> BodyForce:
        if self.blocks is not None and self.group is not None:
            raise ValueError("a body force names either blocks or group, not both")
        return self


class PointForce(Strict):
    """A force at a point of a block."""

    block: Name
    at: Point
    force: Point = Field(description="(x, y) [force]")


class Load(Strict):
    """A set of forces that act together."""

    body: list[BodyForce] = Field(default_factory=list)
    points: list[PointForce] = Field(default_factory=list)


def _gravity() -> Load:
    return Load(body=[BodyForce(per_weight=(0.0, -1.0))])


class Loads(Strict):
    """Dead load (present at every multiplier; gravity if absent) and live load (multiplied)."""

    dead: Load = Field(default_factory=_gravity)
    live: Load | None = Field(None, description="absent: the wall is asked only whether it stands")


class PatternBase(Strict):
    """What every pattern shares."""

    prefix: str = Field("", description="put before the ids of the blocks it makes")
    origin: Point = (0.0, 0.0)
    material: str = "stone"
    groups: list[Name] = Field(default_factory=list)
    unit_weight: NonNegative | None = None
    thickness: Positive | None = None


class RunningBond(PatternBase):
    """Courses of blocks from the bottom up; `courses` lists relative block lengths, negative for a gap."""

    type: Literal["running_bond"]
    block_length: Positive
    block_height: Positive
    courses: list[list[Number]] | None = Field(
        None, description="bottom to top; 1 = one block length, -1 = a gap of one"
    )
    count: Count | None = Field(None, description="number of courses, instead of `courses`")
    bricks: Count | None = Field(None, description="whole bricks in a full course, with `count`")
    start: Literal["half", "full"] = Field("half", description="bottom course begins with half a brick, or a whole one")
    base: bool = Field(True, description="add a fixed block under the whole width, one block high")

    @model_validator(mode="after")
    def _courses_or_count(self) -> RunningBond:
        if (self.courses is None) == (self.count is None or self.bricks is None):
            raise ValueError("a running bond gives either courses, or count and bricks")
        if self.count is not None and self.bricks is not None and self.count * self.bricks > MOST_BLOCKS:
            raise ValueError(f"{self.count} courses of {self.bricks} bricks are more than {MOST_BLOCKS} blocks")
        for number, course in enumerate(self.courses or [], start=1):
            if not any(width > 0.0 for width in course) or any(width == 0.0 for width in course):
                raise ValueError(f"course {number} has a width of zero or no block")
        return self


class Ring(PatternBase):
    """Voussoirs between two concentric arcs, with straight (chord) edges; `origin` is the centre."""

    type: Literal["ring"]
    inner_radius: Positive
    outer_radius: Positive
    count: Count
    angles: tuple[Number, Number] = Field((180.0, 0.0), description="[degrees] from the x axis, first to last joint")
    supports: Literal["abutments", "end_voussoirs", "none"] = Field(
        "abutments", description="fixed blocks added beyond both ends, or the end voussoirs fixed, or neither"
    )

    @model_validator(mode="after")
    def _radii_and_angles(self) -> Ring:
        if self.outer_radius <= self.inner_radius:
            raise ValueError("outer_radius must be greater than inner_radius")
        if not 0.0 < abs(self.angles[1] - self.angles[0]) < 360.0:
            raise ValueError("angles must differ by more than 0 and less than 360 degrees")
        return self


class Stack(PatternBase):
    """Equal blocks one upon the other; `offsets` shifts each sideways from the origin."""

    type: Literal["stack"]
    width: Positive
    height: Positive
    count: Count
    offsets: list[Number] | None = Field(None, description="[length] of each block's left edge from the origin")
    base: tuple[Number, Number] | None = Field(
        None, description="left and right edge of the fixed block; as wide as a block"
    )

    @model_validator(mode="after")
    def _one_offset_each(self) -> Stack:
        if self.offsets is not None and len(self.offsets) != self.count:
            raise ValueError(f"offsets must have {self.count} entries, one a block")
        return self


class Panel(PatternBase):
    """A drawing in letters: cells with the same letter are one block. Rows are listed from the top."""

    type: Literal["panel"]
    cell_length: Positive
    cell_height: Positive
    layout: Annotated[list[str], Field(min_length=1)] = Field(description='rows; "." or a blank is empty')
    fixed: str = Field("", description="letters of the blocks that are fixed")

    @model_validator(mode="after")
    def _equal_rows(self) -> Panel:
        if len({len(row) for row in self.layout}) != 1:
            raise ValueError("the rows of layout must have equal length")
        return self


Pattern = Annotated[RunningBond | Ring | Stack | Panel, Field(discriminator="type")]
Patterns = Annotated[Annotated[Pattern, Tag(ONE)] | Annotated[list[Pattern], Tag(MANY)], Discriminator(_one_or_many)]
FrictionOfWall = Annotated[
    Annotated[Coefficient, Tag(OTHER)] | Annotated[Friction, Tag(OBJECT)], Discriminator(_object_or_other)
]
Interfaces = Annotated[
    Annotated[list[Interface], Tag(OTHER)] | Annotated[Detection, Tag(OBJECT)], Discriminator(_object_or_other)
]


class Wall(Strict):
    """A wall, format `wall/1`."""

    format: Literal["wall/1"]
    title: str = ""
    units: Units = Field(default_factory=Units)
    metadata: dict[str, Any] = Field(default_factory=dict, description="free: source, author, remarks")
    unit_weight: NonNegative | None = Field(None, description="[force/length^3] for blocks that give no weight")
    thickness: Positive = Field(1.0, description="out of plane [length]")
    friction: FrictionOfWall
    pattern: Patterns | None = None
    blocks: list[Block] = Field(default_factory=list)
    interfaces: Interfaces = Field(default_factory=Detection)
    contact_inset: Inset | None = None
    loads: Loads = Field(default_factory=Loads)
