"""Where the gap points of an interface lie: rules on [0, 1] that contain both ends.

With both ends among the points the admissible (N, T, M) of an interface are exactly |T| <= mu N and |M| <= l N for
any number of points. A rule without the ends (Gauss) moves the hinge inside the joint and gives too small a multiplier;
it is refused.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre
from pydantic import Field, field_validator

from harness.model.assembly import FloatArray
from harness.model.method import Settings

_GAUSS_REFUSAL = (
    "Gauss points are refused: none of them lies at an end of the interface, so the hinge would form inside the joint "
    "and the multiplier would be too small (0.468 in place of 0.565 on the 21-brick wall); use 'uniform' or 'lobatto'"
)


def gap_points(rule: str, count: int) -> tuple[FloatArray, FloatArray]:
    """Positions and weights of the gap points of one interface.

    Args:
        rule: "uniform" (equal distances, trapezoidal weights scaled so that two points weigh one half each) or
            "lobatto" (Gauss-Lobatto).
        count: number of points, two or more.

    Returns:
        (count,) positions in [0, 1] measured from end 1, ascending, and (count,) weights that add up to one.

    Raises:
        ValueError: the rule is unknown or leaves the ends out, or fewer than two points are asked for.
    """
    if rule == "gauss":
        raise ValueError(_GAUSS_REFUSAL)
    if count < 2:
        raise ValueError(f"an interface needs a gap point at each of its two ends; {count} given")
    if rule == "uniform":
        weights = np.ones(count)
        weights[[0, -1]] = 0.5
        return np.linspace(0.0, 1.0, count), weights / weights.sum()
    if rule == "lobatto":
        basis = np.zeros(count)
        basis[-1] = 1.0
        inner = np.sort(legendre.legroots(legendre.legder(basis)))
        nodes = np.concatenate([[-1.0], inner, [1.0]])
        weights = 2.0 / (count * (count - 1) * legendre.legval(nodes, basis) ** 2)
        return (nodes + 1.0) / 2.0, weights / 2.0
    raise ValueError(f"the rule of the gap points is {rule!r}; there are 'uniform' and 'lobatto'")


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
