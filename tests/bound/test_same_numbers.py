"""Both checkers compute the same numbers from a certificate, not only the same verdict: limits, sizes and bounds.

The second is written from docs/theory-bound.md and shares no line with the first. They are equal to the last digit.
"""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from drystone.certificates import PACKED
from methods.proof.verify.cases import States, states_of
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from methods.proof.verify.windows import WindowLimits
from tests.bound import test_case_certificate as of_cases
from tests.bound import test_window_certificate as of_windows
from tests.bound.by_cases import certificate_of_cases
from tests.bound.second_checker import halves_of, step_of, window_of
from tests.bound.second_wall import Refused, Wall, up
from tests.bound.second_windows import Gain, Motion, Set, gain, raised, size_of
from tests.bound.test_courses import of_slab
from tests.bound.test_mutants import of_library

CERTIFICATES: dict[str, Callable[[], dict[str, Any]]] = {
    "bond": of_windows.of_bond,
    "incline up": lambda: of_library("incline-up", PACKED)[0],
    "bond in cases": of_cases.of_bond,
    "irregular wall": of_cases.of_irregular_wall,
    "two normal forces": of_cases.of_two_normal_forces,
    "two frictions in cases": lambda: certificate_of_cases(of_library("two-frictions")[1]),
}

SMALL = ("bond in cases", "two frictions in cases")
"""Certificates of which every case is gone through, of others one at each division."""
OF_STEPS = 0.1
"""Share of the steps of cases that are tried with another proof too."""


def both(first: Callable[[], Any], second: Callable[[], Any]) -> Any:
    """What both say, None where they refuse."""
    own: Any = None
    other: Any = None
    with suppress(CertificateError, ArithmeticError):
        own = first()
    with suppress(Refused, ArithmeticError):
        other = second()
    assert own == other
    return own


def shaken(products: Any, draw: random.Random, share: float = 0.05) -> Any:
    """Multipliers of products with some of them changed by up to a thousandth of one, of either sign."""
    unit = 2 ** max(products["exponent"] - 10, 0)
    changed = copy.deepcopy(products)
    for name in ("columns", "signed", "still", "balance"):
        for row in changed[name]:
            for k in range(len(row)):
                if draw.random() < share:
                    row[k] += draw.randint(-unit, unit)
    return changed


def compare(limits: WindowLimits, states: Set, window: Any, reach: Any, per_size: bool, draw: random.Random) -> None:
    """Bounds of the size and of the multiplier by the products of a window, as they are and changed."""
    motion = Motion(states, window)

    def gained(products: Any, of_size: bool) -> Gain:
        return gain(motion, products, of_size, reach, per_size)

    for share in (0.0, 0.01, 0.1):
        size = window["size"] if share == 0.0 else shaken(window["size"], draw, share)
        both(lambda size=size: limits.greatest_size(size), lambda size=size: size_of(gained(size, True)))  # type: ignore[misc]
        products = window["multiplier"] if share == 0.0 else shaken(window["multiplier"], draw, share)
        for greatest in (Fraction(0), Fraction(1), Fraction(10**6)):  # where the bound is below the upper end
            both(
                lambda p=products, g=greatest: limits.bound(p, g),  # type: ignore[misc]
                lambda p=products, g=greatest: raised(states, gained(p, False), g),  # type: ignore[misc]
            )


def known(states: States) -> Any:
    return (
        states.low,
        states.forces.tight,
        states.forces.sides,
        states.known.still,
        states.known.least,
        states.known.slow,
    )


def known_again(states: Set) -> Any:
    return states.low, states.tight, states.sides, states.still, states.loaded, states.slow


@pytest.mark.parametrize("name", CERTIFICATES)
def test_both_checkers_compute_the_same_limits_sizes_and_bounds(name: str) -> None:
    document, draw = CERTIFICATES[name](), random.Random(name)
    first, second = ExactWall(document), Wall(document)
    left: list[tuple[States, Set, Any]] = []
    for window in document["windows"]:
        limits, states = WindowLimits(first, window), window_of(second, window)
        assert (limits.forces.total, limits.forces.normal) == (states.total, list(states.normal))
        reach = Motion(states, window).per_size(window["motions"])
        assert limits.motions.limits == list(reach.values())
        compare(limits, states, window, reach, True, draw)
        size = limits.greatest_size(window["size"])
        low = limits.bound(window["multiplier"], size)
        again = replace(states, low=low, reach=tuple(up(reach[d] * size, 60) for d in range(second.n)))
        left = [(states_of(limits, size, low), again, document.get("cases"))]
    while left:
        own, other, node = left.pop()
        assert own.reach == list(other.reach)
        for step in [] if node is None else node["steps"]:
            if draw.random() < OF_STEPS:
                compare_step(own, other, step, draw)
            own, other = own.after(step), step_of(other, step)
            assert known(own) == known_again(other)
        if node is not None and "parts" in node:
            halves = list(zip(own.halves(node), halves_of(other, node), node["parts"], strict=True))
            left += halves if name in SMALL else [draw.choice(halves)]


@pytest.mark.parametrize("side", [2, 3])
def test_both_checkers_compute_the_same_bounds_where_a_joint_is_at_its_friction(side: int) -> None:
    """Shear that is known one way leaves half of the extreme forces of a joint, and so one sign of its products."""
    document, draw = of_slab(), random.Random(side)
    window = copy.deepcopy(document["windows"][0])
    for products in (window["size"], window["multiplier"]):
        products["balance"] = [[*row, 0] for row in products["balance"]]  # of the slack that is zero
    first, second = ExactWall(document), Wall(document)
    limits, states = WindowLimits(first, document["windows"][0]), window_of(second, document["windows"][0])
    assert limits.columns.signed
    unknowns = Motion(states, document["windows"][0]).unknowns
    reach = dict(zip(unknowns, limits.motions.limits, strict=True))
    again = replace(states, reach=tuple(up(reach[d], 60) for d in range(second.n)))
    own = states_of(limits, Fraction(1), states.low)
    for p in limits.columns.signed:
        half = own.half(4 * p + side, True)
        other = halves_of(again, {"contact": 4 * p + side})[0]
        case = half.window(window)
        part = replace(other, low=case.forces.low).with_forces(window["forces"])
        reach = dict(zip(Motion(part, window).unknowns, case.motions.limits, strict=True))
        compare(case, part, window, reach, False, draw)


@pytest.mark.parametrize("contacts", [(0, 1), (1, 4), (2, 7), (0, 3, 5)])
def test_both_checkers_compute_the_same_bounds_where_several_slacks_are_zero(contacts: tuple[int, ...]) -> None:
    """Each adds an equation of its own, whose multiples pay for what products leave."""
    document, draw = of_slab(), random.Random(str(contacts))
    window = copy.deepcopy(document["windows"][0])
    for products in (window["size"], window["multiplier"]):
        unit = 2 ** products["exponent"]
        products["balance"] = [[*row, *(draw.randint(-unit, unit) for _ in contacts)] for row in products["balance"]]
    first, second = ExactWall(document), Wall(document)
    limits, other = WindowLimits(first, document["windows"][0]), window_of(second, document["windows"][0])
    reach = dict(zip(Motion(other, document["windows"][0]).unknowns, limits.motions.limits, strict=True))
    own = states_of(limits, Fraction(1), other.low)
    other = replace(other, reach=tuple(up(reach[d], 60) for d in range(second.n)))
    for contact in contacts:
        own, other = own.half(contact, True), halves_of(other, {"contact": contact})[0]
    case = own.window(window)
    part = replace(other, low=case.forces.low).with_forces(window["forces"])
    assert case.forces.tight == part.tight == set(contacts)
    reach = dict(zip(Motion(part, window).unknowns, case.motions.limits, strict=True))
    compare(case, part, window, reach, False, draw)
    gained = gain(Motion(part, window), window["multiplier"], False, reach, False)
    assert case.bound(window["multiplier"], Fraction(1)) == raised(part, gained, Fraction(1))


def compare_step(own: States, other: Set, step: Any, draw: random.Random) -> None:
    """What a step shows with its proof changed, at any contact."""
    for share in (0.1, 0.5):
        changed = copy.deepcopy(step)
        for key in {"velocities", "strains"} & step.keys():
            most = max(1, *(abs(v) for v in step[key]))
            changed[key] = [v + draw.randint(-most, most) if draw.random() < share else v for v in step[key]]
        for key in {"lift", "work"} & step.keys():
            changed[key] += draw.randint(-(2 ** changed["exponent"]), 2 ** changed["exponent"])
        if "contact" in step and draw.random() < 0.5:
            changed["contact"] = draw.randrange(4 * own.wall.n_interfaces)
        both(lambda c=changed: known(own.after(c)), lambda c=changed: known_again(step_of(other, c)))  # type: ignore[misc]
    if step["shows"] == "window":
        limits = own.window(step)
        part = replace(other, low=limits.forces.low).with_forces(step["forces"])
        reach = dict(zip(Motion(part, step).unknowns, limits.motions.limits, strict=True))
        compare(limits, part, step, reach, False, draw)
