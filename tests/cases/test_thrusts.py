"""The thrusts of a semicircular arch by code of its own: a linear programme for the force at one springing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import linprog

from harness.model.case import read_case, shipped_cases


def extreme_thrusts(count: int, thickness: float) -> tuple[float, float]:
    """Least and greatest H / W of a semicircle of radius one whose voussoirs do not slide.

    Unknown are the thrust, the vertical force and the moment at the right springing. At every joint the resultant of
    what lies beyond it passes between intrados and extrados: |M| <= N t / 2 (Heyman 1966).
    """
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    angles = math.pi * np.arange(count + 1) / count
    half = math.pi / count / 2.0
    weight = 0.5 * (outer**2 - inner**2) * math.sin(2.0 * half)
    # The centroid of a quadrilateral between two circles, from the triangles of both radii: distance from the centre.
    reach = 2.0 / 3.0 * math.cos(half) * (outer**3 - inner**3) / (outer**2 - inner**2)
    places = reach * np.cos(angles[:-1] + half)
    rows, limits = [], []
    for k, angle in enumerate(angles):
        above, moment = weight * k, weight * places[:k].sum()
        for radius, sense in ((inner, -1.0), (outer, 1.0)):
            x, y = radius * math.cos(angle), radius * math.sin(angle)
            rows.append([-sense * y, -sense * x, sense])
            limits.append(sense * (moment - x * above))
    ends = [linprog([sign, 0, 0], rows, limits, bounds=[(None, None)] * 3, method="highs").x[0] for sign in (1, -1)]
    return ends[0] / (count * weight), ends[1] / (count * weight)


@pytest.mark.parametrize(
    ("thickness", "least", "greatest"),
    [(0.12, 0.1912256, 0.2079935), (0.15, 0.1756349, 0.2277179), (0.2, 0.1542448, 0.2553107)],
)
def test_thrusts_are_those_of_yet_another_code(thickness: float, least: float, greatest: float):
    assert extreme_thrusts(20, thickness) == pytest.approx((least, greatest), abs=2e-7), "printed to seven digits"


def test_the_cases_have_these_thrusts():
    thrusts = dict(zip(("least", "greatest"), extreme_thrusts(20, 0.2), strict=True))
    for name, thrust in thrusts.items():
        case = read_case(shipped_cases() / f"arch-thrust-{name}")
        (reference,) = [item for item in case.file.references if item.id == "thrust"]
        assert reference.value == pytest.approx(abs(0.2 - thrust), abs=1e-10)
