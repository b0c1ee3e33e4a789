"""What a user may choose about the gap-spring methods."""

from __future__ import annotations

from pydantic import Field, field_validator

from harness.model.method import Settings
from methods.fe.points import gap_points


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


class GapSpringsSettings(GapSettings):
    """Settings of `fe`, the exact continuation.

    Attributes:
        histories: how often the friction history is committed, as fractions of the multiplier reached; 0: never.
            None: none, 1 % and 0.2 % up to 1,200 blocks, none alone above.
        max_events: changes of state after which one history is given up; None: 2,000 and 5 for every gap point.
        friction_cap: friction coefficients above this are lowered to it while the path is traced; the final state is
            checked with the true ones, and traced again with them if it does not hold. Coefficients such as 1000,
            which stand for "no sliding", would otherwise make the path stiff for nothing.
    """

    histories: tuple[float, ...] | None = None
    max_events: int | None = Field(None, ge=1)
    friction_cap: float = Field(4.0, gt=0.0)


class NewtonSettings(GapSettings):
    """Settings of `fe-newton`.

    Attributes:
        first_step: first step of the multiplier; cuts: halvings after which load control stops.
        displacement_steps: steps of displacement control.
    """

    first_step: float = Field(0.02, gt=0.0)
    cuts: int = Field(8, ge=0)
    displacement_steps: int = Field(80, ge=0)


class ConvexSettings(GapSettings):
    """Settings of `fe-qp`.

    Attributes:
        first_step: first step of the multiplier; resolution: relative width of the bracket at which to stop.
        fixed_points: Tresca iterations allowed for one step; max_blocks: size above which the method refuses.
        friction_cap: friction coefficients above this are lowered to it.
    """

    first_step: float = Field(0.05, gt=0.0)
    resolution: float = Field(0.001, gt=0.0)
    fixed_points: int = Field(60, ge=1)
    max_blocks: int = Field(60, ge=1)
    friction_cap: float = Field(4.0, gt=0.0)
