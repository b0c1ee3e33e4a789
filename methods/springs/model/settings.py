"""What a user may choose about the springs in the contacts."""

from __future__ import annotations

from pydantic import Field, field_validator

from harness.model.method import Settings
from methods.springs.model.points import gap_points


class GapSettings(Settings):
    """The gap model, common to `fe`, `fe-newton` and `fe-qp`.

    Attributes:
        rule: where the gap points lie, "uniform" or "lobatto"; both contain the ends. "gauss" is refused.
        points: gap points of an interface, two or more.
        weighting: "point": an interface carries `normal_stiffness` times the number of points, spread by the weights
            of the rule; "length": it carries `normal_stiffness` times its length over the length scale of the wall.
        normal_stiffness: kn of a gap point [force/length]; None: 1000 times the weight over the length of a block.
            The multiplier does not depend on it.
        stiffness_ratio: kt / kn.
        initial_shear: shear frozen in before the loads come, as a random fraction of what friction can hold.
        seed: of the random initial shear.
    """

    rule: str = "uniform"
    points: int = Field(2, ge=2, le=20)
    weighting: str = Field("point", pattern="^(point|length)$")
    normal_stiffness: float | None = Field(None, gt=0.0)
    stiffness_ratio: float = Field(0.5, gt=0.0)
    initial_shear: float = Field(0.0, ge=0.0, le=1.0)
    seed: int = 1995

    @field_validator("rule")
    @classmethod
    def _rule_contains_the_ends(cls, value: str) -> str:
        gap_points(value, 3)
        return value
