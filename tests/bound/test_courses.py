"""The slip of joints that may be unloaded is bounded where they slide together and cannot all be unloaded."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from benchmarks.walls import courses_of_stones
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.reading import parse_wall
from harness.model.wall import Wall
from methods.proof.verify.checker import digest, verify
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from methods.proof.verify.force_limits import KnownLimits
from methods.proof.verify.window_limits import Columns, Course, Motions
from methods.proof.verify.windows import WindowLimits
from tests.bound.test_window_certificate import certificate_of

DATA = Path(__file__).parents[1] / "data" / "walls"


def slab_on_two_supports(friction: Any = 0.3) -> Assembly:
    """A slab 3 long and 2 high, whose weight acts over its right support and is pushed over its left one, 1.4 long."""
    blocks: list[dict[str, Any]] = [
        {"id": "left", "polygon": [[-1, -1], [1.4, -1], [1.4, 0], [-1, 0]], "fixed": True},
        {"id": "right", "polygon": [[1.4, -1], [4, -1], [4, 0], [1.4, 0]], "fixed": True},
        {"id": "slab", "polygon": [[0, 0], [3, 0], [3, 2], [0, 2]]},
    ]
    loads = {"live": {"body": [{"per_weight": [-1, 0]}]}}
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": loads}
    return build(Wall.model_validate(data)).assembly


@cache
def of_slab() -> dict[str, Any]:
    return certificate_of(slab_on_two_supports())


def courses_of(document: Any) -> list[dict[str, Any]]:
    return [course for window in document["windows"] for course in window["motions"]["courses"]]


def test_a_slab_that_slides_on_unequal_joints_is_proved() -> None:
    """It slides at the friction, .3, long before it turns over, at 1.5; either joint alone may carry nothing."""
    lower, upper = verify(of_slab())
    assert upper == Fraction(3, 10)
    assert 0 < upper - lower <= Fraction(1, 10**6) * upper
    assert {tuple(sorted(course["joints"])) for course in courses_of(of_slab())} == {(0, 1)}


def test_the_joints_of_a_course_bear_the_weight_above_whatever_their_lengths() -> None:
    """Forces are per length, slips times length: the least friction is the weight over the length of the first joint.

    A course that weighed its joints alike would have less, since the longer joint could bear all.
    """
    document = of_slab()
    wall, window = ExactWall(document), document["windows"][0]
    limits, inverse = WindowLimits(wall, window), Fraction(1, 2 ** window["motions"]["exponent"])
    assert isinstance(limits.motions, Motions)
    strains = window["motions"]["strains"]
    rows = [dict(zip(strains, (inverse * v for v in row), strict=True)) for row in window["motions"]["inverse"]]
    course = Course(limits.columns, window["motions"]["courses"][0], rows)
    x1, _, x2, _ = (Fraction(x) for x in document["interfaces"][course.joints[0]]["ends"])
    weight = -Fraction(document["blocks"][0]["dead"][1])
    assert float(course.least) == pytest.approx(float(weight / abs(x2 - x1)), rel=1e-6)  # velocities have 40 places


def test_a_slip_of_a_course_is_the_lift_over_the_least_friction_and_what_is_left_over_by_rounding():
    """Friction on a slip s of the first joint takes mu N s, no more than the lift, which is 1 / weight in size one."""
    document = of_slab()
    wall, window = ExactWall(document), document["windows"][0]
    columns, unit = WindowLimits(wall, window).columns, Fraction(1, 2 ** window["motions"]["exponent"])
    strains = window["motions"]["strains"]
    rows = [{k: unit * v for k, v in zip(strains, row, strict=True) if v} for row in window["motions"]["inverse"]]
    course = Course(columns, window["motions"]["courses"][0], rows)
    first, still = course.joints[0], dict.fromkeys(columns.strain_limits(), Fraction(0))
    exact = [Fraction(0)] * columns.n
    slip, part = course.slip(still, exact, {first: course})
    assert slip == 1 / (wall.friction[first] * columns.lift_weight * course.least)
    assert part == 0
    left_over = [Fraction(1, 7), Fraction(1, 3), Fraction(1, 5)]
    _, part = course.slip(still, left_over, {first: course})
    lost = [
        wall.friction[p] * columns.forces.normal[p] * sum(abs(v) * left_over[d] for d, v in wall.sparse[3 * p + 2])
        for p in course.joints
    ]
    assert part == sum(lost) / (wall.friction[first] * course.least)


CHANGES: dict[str, Callable[[dict[str, Any]], Any]] = {
    "a joint that may be unloaded alone": lambda course: course["joints"].pop(),
    "a joint counted twice": lambda course: course["joints"].append(course["joints"][0]),
    "a joint that is not there": lambda course: course["joints"].append(2),
    "no velocities": lambda course: course.update(velocities=[0] * len(course["velocities"])),
    "velocities downwards": lambda course: course.update(velocities=[-v for v in course["velocities"]]),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_course_whose_friction_may_be_zero_is_refused(name: str) -> None:
    document = copy.deepcopy(of_slab())
    for course in courses_of(document):
        CHANGES[name](course)
    with pytest.raises(CertificateError):
        verify(document | {"digest": digest(document)})


def test_a_joint_without_friction_does_not_bound_the_slip_of_a_course() -> None:
    """The same certificate, of a wall whose left joint is smooth: all the weight may lie there."""
    document = copy.deepcopy(of_slab())
    document["interfaces"][0]["friction"] = "0"
    document.pop("state")
    with pytest.raises(CertificateError):
        verify(document | {"digest": digest(document)})


@pytest.mark.parametrize("seed", [0, 17, 22])
def test_courses_of_stones_are_proved(seed: int) -> None:
    lower, upper = verify(certificate_of(courses_of_stones(seed)))
    assert 0 < upper - lower <= Fraction(1, 10**6) * upper


def test_a_wall_of_courses_with_unequal_joints_is_proved() -> None:
    wall = parse_wall(json.loads((DATA / "courses-unequal-joints.json").read_text()), "courses")
    lower, upper = verify(certificate_of(build(wall).assembly))
    assert upper == Fraction(10, 21)  # the block of least height over width turns over
    assert 0 < upper - lower <= Fraction(1, 10**6) * upper


def columns_of(still: set[int], least: dict[int, Fraction], slow: dict[int, Fraction]) -> Columns:
    """Of the slab, with what is known of its contacts; a rate of the left joint weighs 2, of the right one 4."""
    wall, window = ExactWall(of_slab()), of_slab()["windows"][0]
    said = {"weight_exponent": 1, "weights": [4, 8], "lift_weight": 2}
    return Columns(WindowLimits(wall, window).forces, KnownLimits(frozenset(still), least, slow), said)


def test_rates_of_a_loaded_joint_are_weighed_and_lose_friction_by_hand() -> None:
    """Contacts 4 p + k: an opening at each end, and the slip each way, which a signed joint has as one number."""
    half, eighth = Fraction(1, 2), Fraction(1, 8)
    columns = columns_of({4}, {1: half}, {0: eighth})
    wall, n = columns.wall, columns.n
    opening = [dict(wall.sparse[k]) for k in (0, 1, 3, 4)]
    slip = dict(wall.sparse[5])
    assert (columns.signed, columns.backward, columns.width) == ([0], {1: n}, n + 1)
    assert columns.rates == {1: opening[1], 5: opening[3], 6: slip | {n: 1}, 7: {n: 1}}
    assert columns.still == [(opening[0], eighth), (opening[2], 0)]
    assert (columns.weights, columns.lift_weight) == ({1: 2, 5: 4, 6: 4, 7: 4}, 1)
    assert columns.strain_limits() == {0: 0, 1: half, 3: 0, 4: half / 2, 5: half / 2}
    lost = {d: -wall.friction[1] * half * v for d, v in slip.items()} | {n: -2 * wall.friction[1] * half}
    high = columns.forces.high
    lift = {d: high * f + g for d, (f, g) in enumerate(zip(wall.live, wall.dead, strict=True))}
    assert columns.lift == {d: lift.get(d, 0) + lost.get(d, 0) for d in range(n + 1)}
    assert columns.work == {d: f for d, f in enumerate(wall.live) if f}


@pytest.mark.parametrize("p", [0, 1])
def test_slips_that_are_held_one_way_or_both_by_hand(p: int) -> None:
    slip = dict(ExactWall(of_slab()).sparse[3 * p + 2])
    backwards = {d: -v for d, v in slip.items()}
    forward, backward = 4 * p + 2, 4 * p + 3
    weight, other = (2, 4)[p], 1 - p
    for held, rates, limit in (
        ({forward}, {backward: backwards}, Fraction(1, weight)),
        ({backward}, {forward: slip}, Fraction(1, weight)),
        ({forward, backward}, {}, 0),
    ):
        columns = columns_of(held, {}, {})
        assert columns.signed == [other]
        assert {k: form for k, form in columns.rates.items() if k in (forward, backward)} == rates
        assert columns.strain_limits()[3 * p + 2] == limit
        assert columns.still == ([(slip, 0)] if held == {forward, backward} else [])
        assert columns.backward == {}
    slow = columns_of(set(), {}, {forward: Fraction(1, 3)})
    assert slow.signed == [other]
    assert (slip | {slow.n: 1}, Fraction(1, 3)) in slow.still
    assert columns_of(set(), {}, {}).signed == [0, 1]
