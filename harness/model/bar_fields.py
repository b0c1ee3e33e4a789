"""Fields of ties and props in `wall/1`: bars between points of two blocks."""

from __future__ import annotations

from pydantic import Field, model_validator

from harness.model.fields import Name, NonNegative, Point, Positive, Strict


class BarEnd(Strict):
    """Where a bar is fixed: a point that moves with a block. One of the ground belongs to a fixed block."""

    block: Name
    at: Point = Field(description="(x, y) [length], within the outline of the block or without")


class _Bar(Strict):
    """A bar with a hinge at each end, which bears one sign of force up to its yield force."""

    id: Name | None = Field(None, description='for messages and tables; "tie 1" and so on if absent')
    start: BarEnd = Field(alias="from")
    end: BarEnd = Field(alias="to")
    yield_force: Positive = Field(description="greatest force [force]; at it the bar gives without end")
    prestress: NonNegative = Field(
        0.0, description="force [force] it has from the start, which acts as dead load: from 0 to below the yield force"
    )
    stiffness: Positive | None = Field(
        None,
        description="force for a unit of elongation [force/length], where joints are springs; as a joint's if absent",
    )

    @model_validator(mode="after")
    def _has_two_ends_and_a_range(self) -> _Bar:
        if self.start.block == self.end.block:
            raise ValueError(f'both ends are on the block "{self.start.block}": a bar joins two blocks')
        if self.start.at == self.end.at:
            raise ValueError("its ends are at one point, so it has no direction: give two points")
        if self.prestress >= self.yield_force:
            raise ValueError(
                f"the prestress {self.prestress:g} is not below the yield force {self.yield_force:g}: give less, or "
                "two forces among the points of the dead load for a bar that has yielded"
            )
        return self


class Tie(_Bar):
    """A tie: tension from its prestress to its yield force."""


class Prop(_Bar):
    """A prop: compression from its prestress to its yield force, that of buckling where that is less."""
