"""Where the gap points of an interface lie: rules on [0, 1] that contain both ends.

With both ends among the points the admissible (N, T, M) of an interface are exactly |T| <= mu N and |M| <= l N for
any number of points. A rule without the ends (Gauss) moves the hinge inside the joint and gives too small a multiplier;
it is refused.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from harness.model.assembly import FloatArray

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
