"""Fields of loads in `wall/1`: gravity, dead and live load, loads that travel, and combinations."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, StrictBool, Tag, model_validator

from harness.model.fields import MANY, NO_TEXT, OTHER, Blocks, Name, Number, Point, Strict
from harness.model.pressure_fields import Fill, Pressure


class BodyForce(Strict):
    """A force on blocks as a multiple of their weight, at their centroids."""

    per_weight: Point = Field(description="(x, y) multiple of the weight; gravity is [0, -1]")
    blocks: Blocks | None = Field(None, description="ids; all free blocks if neither blocks nor group is given")
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
    pressures: list[Pressure] = Field(default_factory=list)
    fills: list[Fill] = Field(default_factory=list)


def _vector_or_switch(value: Any) -> str:
    return MANY if isinstance(value, list | tuple) else OTHER


def _is_no_size(value: Any) -> Any:
    """A vector or a switch.

    Raises:
        ValueError: it is a number or a word, as for an acceleration or a direction.
    """
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        raise ValueError("gravity is [x, y], a multiple of the weight of every block, as [0, -1], or true or false")
    return value


Gravity = Annotated[
    Annotated[Point, Tag(MANY)] | Annotated[StrictBool, Tag(OTHER)],
    Discriminator(_vector_or_switch),
    BeforeValidator(_is_no_size),
]


class Loads(Strict):
    """Gravity, dead load (both present at every multiplier) and live load (multiplied)."""

    gravity: Gravity | None = Field(
        None, description="on every block; absent or true: [0, -1] times its weight; false: none; [x, y]: so much of it"
    )
    dead: Load = Field(default_factory=Load, description="on top of gravity")
    live: Load | None = Field(None, description="absent: only whether the wall stands is decided")

    @model_validator(mode="after")
    def _resistance_is_no_live_load(self) -> Loads:
        if self.live is not None and any(fill.passive is not None for fill in self.live.fills):
            raise ValueError("passive fill in a live load: what resists is not multiplied, so give it in the dead load")
        return self

    @property
    def gravity_per_weight(self) -> Point:
        """Gravity as a multiple (x, y) of the weight of every block."""
        if isinstance(self.gravity, tuple):
            return self.gravity
        return (0.0, 0.0) if self.gravity is False else (0.0, -1.0)


DEAD = "dead"
"""The name under which a combination gives a factor to gravity and to the dead load of `loads`."""


class Travelling(Strict):
    """A force that travels over the wall: one load case for each face that it acts on, from left to right."""

    force: Point = Field(description="(x, y) [force]; its multiplier is that of the load case")
    along: Literal["top", "extrados"] = Field(
        "top",
        description="top: faces that look up and have no block above; extrados: all faces that look up without a joint",
    )
    blocks: Blocks | None = Field(None, description="on these alone; on all free blocks if absent")
    group: Name | None = Field(None, description="on the blocks of this group alone")
    per_face: Annotated[int, Field(ge=1, le=100), NO_TEXT] = Field(
        1, description="places on each face, in the middle of equal parts"
    )

    @model_validator(mode="after")
    def _says_where_and_how_much(self) -> Travelling:
        if self.blocks is not None and self.group is not None:
            raise ValueError("a travelling load names either blocks or group, not both")
        if self.force == (0.0, 0.0):
            raise ValueError("a travelling load of no force: give (x, y), as [0, -1] for a unit downwards")
        return self


Combination = Annotated[
    dict[str, Number],
    Field(min_length=1, description='factors by load case; of "dead" for gravity and the dead load of `loads`'),
]
