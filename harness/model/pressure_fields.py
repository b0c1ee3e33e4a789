"""Pressure on faces of blocks as a wall file gives it: uniform, linear, of water or of earth; line loads; fill."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from harness.model.fields import Angle, Blocks, Name, NonNegative, Number, Point, Positive, Strict


class Water(Strict):
    """Water up to a level: unit_weight times the depth below it, square to the face."""

    level: Number = Field(description="height y of the surface [length]")
    unit_weight: NonNegative = Field(description="of water [force/length^3], or in the unit of unit weights")


class Earth(Strict):
    """Earth up to a level: vertical stress surcharge + unit_weight times depth, horizontal stress K times that."""

    level: Number = Field(description="height y of the surface [length]")
    unit_weight: NonNegative = Field(description="of the earth [force/length^3], or in the unit of unit weights")
    friction_angle: Angle | None = Field(None, description="phi of the earth [degrees], with `state`")
    state: Literal["active", "at_rest"] | None = Field(
        None, description="active: K = (1 - sin phi)/(1 + sin phi); at_rest: K = 1 - sin phi"
    )
    coefficient: NonNegative | None = Field(None, description="K itself, instead of `friction_angle` and `state`")
    surcharge: NonNegative = Field(0.0, description="load on the surface of the earth [force/length^2]")

    @model_validator(mode="after")
    def _one_coefficient(self) -> Earth:
        by_angle = (self.friction_angle is not None, self.state is not None)
        if self.coefficient is not None and any(by_angle):
            raise ValueError("earth gives either coefficient, or friction_angle and state")
        if self.coefficient is None and not all(by_angle):
            raise ValueError('earth gives friction_angle and state ("active" or "at_rest"), or coefficient')
        return self


class Passive(Strict):
    """How fill resists faces that move into it: by up to mobilised x K_p x unit_weight x depth, horizontally."""

    mobilised: Annotated[float, Field(gt=0.0, le=1.0, strict=True)] = Field(
        description="share m of the passive pressure that small motions bring about"
    )
    friction_angle: Angle | None = Field(
        None, description="phi of the fill [degrees]: K_p = (1 + sin phi)/(1 - sin phi)"
    )
    coefficient: Positive | None = Field(None, description="K_p itself, instead of `friction_angle`")

    @model_validator(mode="after")
    def _one_coefficient(self) -> Passive:
        if (self.coefficient is None) == (self.friction_angle is None):
            raise ValueError("passive fill gives either friction_angle or coefficient")
        if self.friction_angle is not None and math.sin(math.radians(self.friction_angle)) == 1.0:
            raise ValueError("a friction_angle that rounds to 90 degrees gives passive fill no finite K_p")
        return self


class Fill(Strict):
    """Fill up to a level: its weight on the faces that look up below it and have no block above them."""

    level: Number = Field(description="height y of its horizontal surface [length]")
    unit_weight: NonNegative = Field(description="of the fill [force/length^3], or in the unit of unit weights")
    between: tuple[Number, Number] | None = Field(
        None, description="x of its left and right end [length]; the whole wall if absent"
    )
    blocks: Blocks | None = Field(None, description="ids; all free blocks if neither blocks nor group is given")
    group: Name | None = None
    factor: Number = Field(1.0, description="multiple of its weight that acts; its resistance is not multiplied")
    passive: Passive | None = Field(None, description="of a dead fill: it resists faces that move into it")

    @model_validator(mode="after")
    def _one_place(self) -> Fill:
        if self.blocks is not None and self.group is not None:
            raise ValueError("a fill names either blocks or group, not both")
        if self.passive is not None and self.unit_weight == 0.0:
            raise ValueError("passive fill without weight resists nothing: give a unit weight, or leave passive out")
        if self.between is not None and not self.between[0] < self.between[1]:
            raise ValueError("a fill lies between two x, of which the first is the smaller")
        return self


class Pressure(Strict):
    """Pressure on the faces of blocks along a segment, pushing into the blocks; or a line load on them."""

    start: Point = Field(alias="from", description="one end of the loaded segment, on a face")
    end: Point = Field(alias="to", description="its other end")
    blocks: Blocks | None = Field(None, description="ids; all free blocks if neither blocks nor group is given")
    group: Name | None = None
    uniform: Number | None = Field(None, description="pressure [force/length^2]; negative: suction")
    linear: Annotated[tuple[Number, Number] | None, Field(description="pressure at `from` and `to`")] = None
    water: Water | None = None
    earth: Earth | None = None
    line_load: Point | None = Field(
        None, description="(x, y) [force/length], in this direction whatever the face and the thickness"
    )
    factor: Number = Field(1.0, description="multiple of it that acts; negative: the other way")

    @model_validator(mode="after")
    def _one_kind(self) -> Pressure:
        kinds = (self.uniform, self.linear, self.water, self.earth, self.line_load)
        if sum(kind is not None for kind in kinds) != 1:
            raise ValueError("a pressure gives exactly one of uniform, linear, water, earth, line_load")
        if self.blocks is not None and self.group is not None:
            raise ValueError("a pressure names either blocks or group, not both")
        if self.start == self.end:
            raise ValueError("a pressure acts along a segment: give different from and to")
        return self
