"""What a wall file says of blocks that are in a pattern; `harness.model.pattern` makes the blocks."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool, model_validator

from harness.model.fields import MOST_BLOCKS, Count, Name, NonNegative, Number, Point, Positive, Strict


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
    base: StrictBool = Field(True, description="add a fixed block under the whole width, one block high")

    @model_validator(mode="after")
    def _courses_or_count(self) -> RunningBond:
        if (self.courses is None) == (self.count is None or self.bricks is None):
            raise ValueError("a running bond gives either courses, or count and bricks")
        if self.courses is not None and not self.courses:
            raise ValueError("it has no course")
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
