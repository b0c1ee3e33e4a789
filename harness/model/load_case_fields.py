"""Fields of load cases that a file does not write out one by one: loads that travel, and combinations."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from harness.model.fields import Name, Number, Point, Strict

DEAD = "dead"
"""The name under which a combination gives a factor to gravity and to the dead load of `loads`."""


class Travelling(Strict):
    """A force that travels over the wall: one load case for each face that it acts on, from left to right."""

    force: Point = Field(description="(x, y) [force]; its multiplier is that of the load case")
    along: Literal["top", "extrados"] = Field(
        "top",
        description="top: faces that look up and have no block above; extrados: all faces that look up without a joint",
    )
    blocks: list[Name] | None = Field(None, description="on these alone; on all free blocks if absent")
    group: Name | None = Field(None, description="on the blocks of this group alone")
    per_face: Annotated[int, Field(ge=1, le=100, strict=True)] = Field(
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
