"""Leaves and windows at the ends of what they may say: one of both loads alone, a normal force of zero."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from methods.proof.verify.checker import _Leaf
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from methods.proof.verify.force_limits import known_of
from methods.proof.verify.windows import WindowLimits
from tests.bound.test_attacks import tree, windows

ROOT = list(range(8))
PRESSING = [0, 1, 4, 5]
"""Contacts of the normal forces of both joints."""


def checked(leaf: dict[str, Any], bound: Fraction) -> str:
    """Why a leaf is refused; empty if it is not."""
    wall = ExactWall(tree())
    try:
        _Leaf(wall, {"tight": [], "still": []} | leaf).check(wall, bound)
    except CertificateError as error:
        return str(error)
    return ""


def balancing() -> list[Fraction]:
    """Forces that balance the live load alone: the difference of those of two multipliers, by that of these."""
    document = tree()
    step = Fraction(document["multiplier"]) - Fraction(document["bound"])
    leaf = next(leaf for leaf in document["leaves"] if leaf.get("parts") == ["1", "0"])
    pairs = zip(document["state"]["forces"], leaf["forces"], strict=True)
    return [(Fraction(above) - Fraction(below)) / step for above, below in pairs]


@pytest.mark.parametrize(
    ("parts", "times", "reason"),
    [
        ((0, 1), 1, ""),
        ((0, 3), 3, ""),
        ((0, 1), 2, "equilibrium"),
        ((1, 1), 1, "equilibrium"),
        ((0, 0), 0, "exclude nothing"),
        ((0, -1), -1, "exclude nothing"),
        ((-1, 2), 1, "exclude nothing"),
    ],
)
def test_forces_may_balance_the_live_load_alone(parts: tuple[int, int], times: int, reason: str):
    """In a leaf without rates all forces lose nothing; on no mechanism has the live load work then."""
    forces = [str(times * force) for force in balancing()]
    leaf = {"still": ROOT, "forces": forces, "parts": [str(part) for part in parts]}
    found = checked(leaf, Fraction(1, 7))
    assert found == "" if not reason else reason in found


def test_forces_against_a_rate_need_it_to_be_zero():
    forces = balancing()
    signed = [value for p in range(2) for value in (*forces[3 * p : 3 * p + 3], -forces[3 * p + 2])]
    lost = [k for k, value in enumerate(signed) if value < 0]
    assert lost
    leaf = {"forces": [str(force) for force in forces], "parts": ["0", "1"]}
    assert checked(leaf | {"still": lost}, Fraction(0)) == ""
    for k in lost:
        assert "lose work" in checked(leaf | {"still": [j for j in lost if j != k]}, Fraction(0))


@pytest.mark.parametrize(
    ("velocities", "bound", "tight", "reason"),
    [
        ((0, 1, 0), 5, PRESSING, ""),  # nothing presses, and the weight is borne by nothing
        ((0, 1, 0), 5, PRESSING[1:], "gain work"),
        ((0, -1, 0), 5, PRESSING, "exclude nothing"),
        ((1, 0, 0), 0, ROOT, ""),  # without forces no multiplier is below zero
        ((1, 0, 0), Fraction(1, 10), ROOT, "exclude nothing"),
        ((-1, 0, 0), 0, ROOT, "exclude nothing"),
    ],
)
def test_velocities_may_do_work_on_one_load_alone(velocities: Any, bound: Any, tight: list[int], reason: str):
    leaf = {"tight": tight, "velocities": [str(value) for value in velocities]}
    found = checked(leaf, Fraction(bound))
    assert found == "" if not reason else reason in found


@pytest.mark.parametrize(("least", "holds"), [("0", True), ("-1/1000000", False), ("1/1000000", False)])
def test_without_velocities_a_normal_force_is_at_least_zero_and_no_more(least: str, holds: bool):
    document = windows()
    window = document["windows"][0]
    forces = WindowLimits(ExactWall(document), window).forces
    said = window | {"loaded": [0], "least": [least], "least_velocities": [[0, 0, 0]]}
    if holds:
        assert known_of(forces, said).least == {0: 0}
        return
    with pytest.raises(CertificateError, match="less than is said"):
        known_of(forces, said)
