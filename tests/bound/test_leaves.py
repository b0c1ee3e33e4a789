"""Leaves and windows at the ends of what they may say: one of both loads alone, a normal force of zero."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from methods.proof.verify.cases import States, states_of
from methods.proof.verify.checker import Leaf
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from methods.proof.verify.force_limits import known_of
from methods.proof.verify.windows import WindowLimits
from tests.bound.shown import tree, windows

ROOT = list(range(8))
PRESSING = [0, 1, 4, 5]
"""Contacts of the normal forces of both joints."""


def checked(leaf: dict[str, Any], bound: Fraction) -> str:
    """Why a leaf is refused; empty if it is not."""
    wall = ExactWall(tree())
    try:
        Leaf(wall, {"tight": [], "still": []} | leaf).check(wall, bound)
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
        ((-1, 1, 0), 5, PRESSING, ""),  # the live load may lose work: nothing is said of multipliers below zero
        ((1, 1, 0), 5, PRESSING, "exclude nothing"),
        ((1, 0, 0), 0, ROOT, "exclude nothing"),
        ((1, 0, 0), Fraction(1, 10), ROOT, "exclude nothing"),
        ((-1, 0, 0), 0, ROOT, "exclude nothing"),
    ],
)
def test_velocities_exclude_multipliers_from_zero_to_the_bound(
    velocities: Any, bound: Any, tight: list[int], reason: str
):
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
    with pytest.raises(CertificateError, match="less than stated"):
        known_of(forces, said)


def limits_of(window: dict[str, Any]) -> list[Any]:
    """All that a window of the incline says, in numbers."""
    limits = WindowLimits(ExactWall(windows()), window)
    size = limits.greatest_size(window["size"])
    bound = limits.bound(window["multiplier"], size)
    columns = limits.columns
    return [limits.forces.total, limits.forces.normal, columns.weights, columns.lift_weight, limits.motions.limits,
            size, bound]  # fmt: skip


def times(value: Any, factor: int) -> Any:
    return [times(v, factor) for v in value] if isinstance(value, list) else factor * value


EXPONENTS: dict[str, tuple[Callable[[Any], Any], str, tuple[str, ...], int]] = {
    "weights": (lambda w: w, "weight_exponent", ("weights", "lift_weight"), 200),
    "forces": (lambda w: w["forces"], "exponent", ("total", "greatest"), 200),
    "motions": (lambda w: w["motions"], "exponent", ("inverse",), 200),
    "size": (lambda w: w["size"], "exponent", ("columns", "signed", "still", "balance"), 400),
    "multiplier": (lambda w: w["multiplier"], "exponent", ("columns", "signed", "still", "balance"), 400),
}
"""(place, name of the exponent, numbers that are times a power of two, greatest exponent)."""


@pytest.mark.parametrize("name", EXPONENTS)
def test_numbers_may_be_given_in_smaller_parts_down_to_a_least_one(name: str):
    """The same numbers in parts of another size say the same; parts below the least are refused."""
    place, key, names, most = EXPONENTS[name]
    window = windows()["windows"][0]
    assert not window["motions"]["courses"]
    said = limits_of(window)
    for exponent in (most, most + 1):
        finer = copy.deepcopy(window)
        part = place(finer)
        factor = 2 ** (exponent - part[key])
        part.update({key: exponent} | {each: times(part[each], factor) for each in names})
        if name == "forces":  # velocities of contacts have its parts too
            finer |= {each: times(finer[each], factor) for each in ("still_velocities", "least_velocities")}
        if exponent == most:
            assert limits_of(finer) == said
            continue
        with pytest.raises(CertificateError, match="may stand here"):
            limits_of(finer)


def zeros(value: Any) -> Any:
    return times(value, 0)


FALSE_WINDOWS: dict[str, tuple[Callable[[Any], Any], str]] = {
    "no bound of all forces": (lambda w: w["forces"].update(total=zeros(w["forces"]["total"])), "are not bounded"),
    "a weight of nothing": (lambda w: w["weights"].__setitem__(0, 0), "a weight is above zero"),
    "no weight of the lift": (lambda w: w.update(lift_weight=0), "may stand here"),
    "a width of nothing": (lambda w: w.update(high=w["low"]), "no width"),
    "no bound of a mechanism": (lambda w: w["size"].update(columns=zeros(w["size"]["columns"])), ""),
    "an interface that is not there": (
        lambda w: w.update(loaded=[len(w["weights"])], least=["0"], least_velocities=[[0] * 3]),
        "may stand here",
    ),
    "a strain that is not there": (
        lambda w: w["motions"]["strains"].__setitem__(0, 3 * len(w["weights"])),
        "may stand here",
    ),
    "velocities of one block more": (lambda w: w["motions"]["inverse"].append([0] * 3), "are missing"),
}


@pytest.mark.parametrize("name", FALSE_WINDOWS)
def test_why_a_window_is_refused_is_said(name: str):
    change, reason = FALSE_WINDOWS[name]
    window = windows()["windows"][0]
    change(window)
    with pytest.raises(CertificateError) as raised:
        limits_of(window)
    assert reason in str(raised.value)


def all_states() -> States:
    """Of the window of the incline."""
    window = windows()["windows"][0]
    limits = WindowLimits(ExactWall(windows()), window)
    size = limits.greatest_size(window["size"])
    return states_of(limits, size, limits.bound(window["multiplier"], size))


def test_states_may_be_divided_at_a_normal_force_of_zero_and_none_below():
    states = all_states()
    few, many = states.halves({"interface": 0, "normal": "0"})
    assert (few.forces.sides[0], many.forces.sides[0]) == ((0, 0), (0, None))
    with pytest.raises(CertificateError, match="not below zero"):
        states.halves({"interface": 0, "normal": "-1/1000000"})


def test_forces_that_are_zero_exclude_no_mechanism():
    states = all_states()
    step = {"shows": "no mechanism", "exponent": 0, "strains": [0] * 3 * states.wall.n_interfaces}
    with pytest.raises(CertificateError, match="do not exclude"):
        states.after(step | {"lift": 0, "work": 0})


@pytest.mark.parametrize(("beyond", "speed", "holds"), [(-1, 1, True), (1, 1, False), (1, 2, False)])
def test_a_normal_force_is_at_least_what_bears_the_weight_with_all_friction(beyond: int, speed: int, holds: bool):
    """A block of weight one bears on an incline: N (x + mu y) >= 1, where x and y are the sides of its joint."""
    document = windows()
    window, (joint,) = document["windows"][0], document["interfaces"]
    x1, y1, x2, y2 = map(Fraction, joint["ends"])
    least = 1 / (abs(x2 - x1) + Fraction(joint["friction"]) * abs(y2 - y1))
    forces = WindowLimits(ExactWall(document), window).forces
    claim = least + Fraction(2 * beyond, forces.unit)
    down = [0, -speed * math.floor(least * forces.unit), 0]
    said = window | {"loaded": [0], "least": [str(claim)], "least_velocities": [down]}
    if holds:
        assert known_of(forces, said).least == {0: claim}
        return
    with pytest.raises(CertificateError, match="less than stated"):
        known_of(forces, said)


def test_sums_of_velocities_by_hand_where_nothing_else_is_said():
    """Live work is one, openings are not negative, a contact that is still has no rate, and all else is within reach.

    The block is supported at its only joint, whose first three contacts are still: it may slip backwards alone.
    """
    states = all_states()
    wall, reach = states.wall, states.reach
    assert states.known.still == {0, 1, 2}
    size = [min(abs(v) for v in reach if v), max(reach)]
    assert size[0] < 1 < size[1]  # so that a product is no quotient
    nothing = {"exponent": 0, "strains": [0, 0, 0], "lift": 0, "work": 0}
    for d, most in enumerate(reach):
        assert states.greatest({d: Fraction(-2)}, nothing) == 2 * most
    live = {d: value for d, value in enumerate(wall.live) if value}
    assert states.greatest(live, nothing | {"work": 1}) == 1
    assert states.greatest({}, nothing | {"work": -1}) == -1 + sum(abs(wall.live[d]) * reach[d] for d in live)
    for k in (0, 1):
        opening = dict(wall.sparse[k])
        unit = [int(j == k) for j in range(3)]
        assert states.greatest(opening, nothing | {"strains": unit}) == 0
        assert states.greatest({d: -v for d, v in opening.items()}, nothing | {"strains": times(unit, -1)}) == 0
    slip = dict(wall.sparse[2])
    assert states.greatest(slip, nothing | {"strains": [0, 0, 1]}) == 0
    backwards = states.greatest({d: -v for d, v in slip.items()}, nothing | {"strains": [0, 0, -1]})
    assert backwards == sum(abs(v) * reach[d] for d, v in slip.items())
    with pytest.raises(CertificateError, match="lift is below zero"):
        states.greatest({}, nothing | {"lift": -1})
