"""Joints of drawings: in the middle of the gap, whatever the order; near misses told; some given, some removed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from harness.model.build import Built, build
from harness.model.contacts import JointLimits, find_contacts
from harness.model.errors import InputError
from harness.model.method import Finding
from harness.model.method_registry import load_method
from harness.model.reading import read_wall
from harness.model.wall import Wall
from tests.walls import running_bond, wall_data

DATA = Path(__file__).parent.parent / "data" / "drawings"


def rectangle(left: float, bottom: float, right: float, top: float) -> list[list[float]]:
    return [[left, bottom], [right, bottom], [right, top], [left, top]]


def least(built: Built) -> tuple[Finding, float | None]:
    method = load_method("la")
    answer = method.solve(built.assembly, method.Settings())
    return answer.finding, answer.multiplier


def bricks(**interfaces: Any) -> dict[str, Any]:
    """Running bond of 4 courses of 3 as a list of blocks."""
    wall = build(Wall.model_validate(wall_data(running_bond(3, 4), 0.65))).wall.model_dump(by_alias=True, mode="json")
    return wall | {"pattern": None, "interfaces": interfaces}


def lowered(data: dict[str, Any], number: int, by: float) -> dict[str, Any]:
    blocks = [dict(block) for block in data["blocks"]]
    blocks[number]["polygon"] = [[x, y - by] for x, y in blocks[number]["polygon"]]
    return data | {"blocks": blocks}


@pytest.mark.parametrize(
    ("names", "right"),
    [
        # Tilt about the end of the middle line: .2 wide, at the right .004 high; centroid (.099866, .501996).
        (("order-ab", "order-ba"), (0.2 - 0.0998661) / (0.501996 - 0.004)),
        (("gapstack-up", "gapstack-down"), 0.5 / 1.1),
    ],
)
def test_a_joint_lies_in_the_middle_of_its_gap_whichever_block_comes_first(names: tuple[str, str], right: float):
    values = [least(read_wall(DATA / f"{name}.json"))[1] for name in names]
    assert values == pytest.approx([right, right], rel=1e-5)


@pytest.mark.parametrize("seed", range(40))
def test_joints_are_the_same_to_the_bit_in_any_order(seed: int):
    """Bricks moved and turned a little, listed in another order, begun at another vertex: the same segments."""
    rng = np.random.default_rng(seed)
    polygons = []
    for row in range(4):
        for column in range(4):
            corner = np.array([column + 0.5 * (row % 2), 0.4 * row]) + rng.normal(scale=0.003, size=2)
            angle = rng.normal(scale=0.004)
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            polygons.append(corner + np.array(rectangle(0, 0, 0.98, 0.38)) @ turn.T)
    limits = JointLimits(0.06, 0.02, 0.3, 0.01, 0.1)
    free = np.zeros(len(polygons), dtype=bool)

    def segments(order: np.ndarray, found: Any) -> set[tuple[Any, ...]]:
        ends = zip(found.block_a, found.block_b, found.start.tolist(), found.end.tolist(), strict=True)
        return {(frozenset((order[a], order[b])), frozenset((tuple(p), tuple(q)))) for a, b, p, q in ends}

    plain = segments(np.arange(len(polygons)), find_contacts(polygons, free, limits))
    order = rng.permutation(len(polygons))
    shuffled = [np.roll(polygons[k], int(rng.integers(4)), axis=0) for k in order]
    assert len(plain) > 25
    assert segments(order, find_contacts(shuffled, free, limits)) == plain


def test_wedge_of_mortar_has_its_joint_along_the_middle():
    """Rectangular bricks of an arch: a joint of 9 mm at the intrados, 25 at the extrados."""
    left, right = rectangle(0, 0, 0.1, 0.25), [[0.109, 0], [0.2, 0], [0.2, 0.25], [0.125, 0.25]]
    limits = JointLimits(0.03, 0.001, np.radians(20.0), 0.01)
    found = find_contacts([np.array(left), np.array(right)], np.zeros(2, dtype=bool), limits)
    assert len(found.block_a) == 1
    # Half the foot of a perpendicular is .8 mm lower at 3.7 degrees than the corner it comes from.
    assert found.start[0] == pytest.approx([0.1045, 0.0], abs=1e-3)
    assert found.end[0] == pytest.approx([0.1125, 0.25], abs=1e-3)


@pytest.mark.parametrize("by", [0.001, -0.0004])
def test_brick_a_little_off_is_told_and_the_tolerance_that_is_named_mends_it(by: float):
    sound = least(build(Wall.model_validate(bricks())))[1]
    data = lowered(bricks(greatest_overlap=0.002, greatest_gap=1e-6), 7, by)
    built = build(Wall.model_validate(data))
    (warning,) = [text for text in built.warnings if "face each other" in text]
    assert f"{abs(by):.3g}" in warning
    tolerance = float(warning.rsplit('"tolerance": ', 1)[1].split("}")[0])
    mended = build(Wall.model_validate(data | {"interfaces": {"tolerance": tolerance}}))
    assert not [text for text in mended.warnings if "face each other" in text]
    assert least(mended)[1] == pytest.approx(sound, rel=0.02)


def test_block_that_lost_its_support_names_the_face_it_looks_at():
    data = wall_data(running_bond(2, 2), 0.5) | {"pattern": None}
    data["blocks"] = [
        {"id": "ground", "polygon": rectangle(0, -0.2, 1, 0), "fixed": True},
        {"id": "stone", "polygon": rectangle(0.2, 0.002, 0.8, 0.4)},
    ]
    with pytest.raises(InputError, match=r'0.002 apart, those of "ground" and "stone".*"tolerance": 0.00204'):
        build(Wall.model_validate(data))


def test_overlap_names_what_would_allow_it():
    data = wall_data(running_bond(2, 2), 0.5) | {"pattern": None}
    data["blocks"] = [
        {"id": "ground", "polygon": rectangle(0, -0.2, 1, 0), "fixed": True},
        {"id": "stone", "polygon": rectangle(0.2, -0.001, 0.8, 0.4)},
    ]
    with pytest.raises(InputError, match=r'0.001 deep.*"greatest_overlap": 0.0011'):
        build(Wall.model_validate(data))
    allowed = build(Wall.model_validate(data | {"interfaces": {"greatest_overlap": 0.0011}}))
    assert allowed.assembly.n_interfaces == 1
    assert allowed.assembly.end1[0, 1] == pytest.approx(-0.0005)


def test_gap_that_swallows_blocks_is_refused():
    with pytest.raises(InputError, match="swallows"):
        build(Wall.model_validate(bricks(greatest_gap=0.5)))


def test_wide_gap_keeps_short_contacts():
    """Stones traced with joints of 20 mm bear on each other along 12 mm too."""
    data = wall_data(running_bond(2, 2), 0.5) | {"pattern": None, "interfaces": {"greatest_gap": 0.025}}
    data["blocks"] = [
        {"id": "ground", "polygon": rectangle(0, -0.2, 1, 0), "fixed": True},
        {"id": "left", "polygon": rectangle(0.0, 0.02, 0.6, 0.4)},
        {"id": "right", "polygon": rectangle(0.588, 0.42, 1.0, 0.8)},
    ]
    assert build(Wall.model_validate(data)).assembly.n_interfaces == 2


def test_interfaces_can_be_given_or_removed_among_those_found():
    whole = build(Wall.model_validate(bricks()))
    first, second = (tuple(item.between) for item in whole.wall.interfaces[:2])  # type: ignore[union-attr]
    given = whole.wall.interfaces[0].model_dump(by_alias=True, mode="json") | {"friction": 0.1}  # type: ignore[union-attr]
    built = build(Wall.model_validate(bricks(given=[given], removed=[list(second)])))
    pairs = {
        tuple(built.assembly.block_ids[k] for k in pair): mu
        for *pair, mu in zip(built.assembly.block_a, built.assembly.block_b, built.assembly.friction, strict=True)
    }
    assert built.assembly.n_interfaces == whole.assembly.n_interfaces - 1
    assert pairs[first] == 0.1
    assert second not in pairs
    with pytest.raises(InputError, match=r"interfaces.removed\[0\].*nowhere"):
        build(Wall.model_validate(bricks(removed=[["nowhere", second[0]]])))


def test_corners_of_a_sound_bond_are_not_told():
    stack_bond = {"type": "panel", "cell_length": 0.4, "cell_height": 0.2, "layout": ["AB", "CD", "__"], "fixed": "_"}
    assert not [text for text in build(Wall.model_validate(wall_data(stack_bond, 0.6))).warnings if "corner" in text]
