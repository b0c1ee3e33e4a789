"""Cohesion and tensile strength in a wall file: where they may stand, what they become, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from harness.model.build import build
from harness.model.content import content_of
from harness.model.errors import InputError
from harness.model.reading import parse_wall
from harness.model.wall import Wall
from tests.walls import running_bond, stack, wall_data

BOND = running_bond(2, 2, length=0.5, height=0.25)


def constants(data: dict[str, Any]) -> np.ndarray:
    return build(Wall.model_validate(data)).assembly.constant


def test_strength_of_a_joint_is_its_stress_times_length_and_thickness():
    """T/2 at both ends and c A both ways, T = f_t A and A = L t, of the whole length of the joint."""
    data = wall_data(stack(1, 0.4, 2.0), 0.5, thickness=0.3, cohesion=8.0, tensile_strength=4.0)
    area = 0.4 * 0.3
    np.testing.assert_allclose(constants(data), [[2.0 * area, 2.0 * area, 8.0 * area, 8.0 * area]], rtol=1e-15)
    inset = data | {"contact_inset": {"fraction": 0.1}}
    np.testing.assert_allclose(constants(inset), constants(data), rtol=1e-15)


def test_the_thinner_block_bounds_a_joint_and_a_support_that_gives_no_thickness_does_not():
    def block(name: str, at: float, **more: Any) -> dict[str, Any]:
        return {"id": name, "polygon": [[0, at], [1, at], [1, at + 1], [0, at + 1]]} | more

    blocks = [block("ground", -1, fixed=True), block("thick", 0, thickness=3.0), block("thin", 1, thickness=0.5)]
    data = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "cohesion": 1.0, "blocks": blocks}
    assert constants(data)[:, 2].tolist() == [3.0, 0.5]
    blocks[0]["thickness"] = 0.1
    assert constants(data)[:, 2].tolist() == [0.1, 0.5]


@pytest.mark.parametrize(
    ("where", "bed", "head"),
    [
        ({"friction": 0.5, "cohesion": 2.0, "tensile_strength": 1.0}, (2.0, 1.0), (2.0, 1.0)),
        ({"friction": {"default": 0.5, "cohesion": 2.0}}, (2.0, 0.0), (2.0, 0.0)),
        (
            {"friction": {"default": 0.5, "cohesion": 2.0, "rules": [{"joint": "head", "value": 0.4}]}},
            (2.0, 0.0),
            (0.0, 0.0),
        ),
        (
            {"friction": {"friction_angle": 30.0, "rules": [{"joint": "bed", "value": 0.4, "cohesion": 3.0}]}},
            (3.0, 0.0),
            (0.0, 0.0),
        ),
        (
            {"friction": {"default": 0.5, "rules": [{"materials": ["stone", "stone"], "value": 0.4, "cohesion": 3.0}]}},
            (3.0, 0.0),
            (3.0, 0.0),
        ),
    ],
)
def test_strength_stands_wherever_friction_may(
    where: dict[str, Any], bed: tuple[float, float], head: tuple[float, float]
):
    """The most particular rule holds for the strength too; one that gives none leaves the joint dry."""
    built = build(Wall.model_validate(wall_data(BOND) | where))
    wall = built.assembly
    beds = np.array(wall.joint) == "bed"
    stress = wall.constant[:, [2, 0]] * [1.0, 2.0] / wall.length[:, None]
    np.testing.assert_allclose(stress[beds], np.tile(bed, (beds.sum(), 1)), rtol=1e-14)
    np.testing.assert_allclose(stress[~beds], np.tile(head, ((~beds).sum(), 1)), rtol=1e-14)


def test_an_interface_and_a_pair_have_strength_of_their_own():
    data = wall_data(stack(2, 1.0, 0.5), {"default": 0.5, "rules": []})
    names = build(Wall.model_validate(data)).assembly.block_ids
    data["friction"]["rules"] = [{"between": [names[1], names[2]], "value": 0.6, "cohesion": 2.0}]
    assert constants(data)[:, 2].tolist() == [0.0, 2.0]
    given = {"between": [names[0], names[1]], "from": [0, 0], "to": [1, 0], "friction": 0.7, "cohesion": 5.0}
    assert sorted(constants(data | {"interfaces": {"given": [given]}})[:, 2].tolist()) == [2.0, 5.0]


def test_explicit_form_keeps_the_strength():
    data = wall_data(BOND, 0.5, thickness=0.3, cohesion=2.0, tensile_strength=1.0)
    data["blocks"] = [
        {"id": "cap", "polygon": [[0, 0.5], [1, 0.5], [1, 0.7], [0, 0.7]], "thickness": 0.2, "unit_weight": 20}
    ]
    built = build(Wall.model_validate(data))
    again = build(Wall.model_validate(built.wall.document())).assembly
    np.testing.assert_array_equal(again.constant, built.assembly.constant)
    np.testing.assert_array_equal(again.weight, built.assembly.weight)


def test_walls_that_differ_in_strength_have_keys_of_their_own():
    keys = {
        content_of(build(Wall.model_validate(wall_data(BOND, 0.5) | more)).assembly)
        for more in ({}, {"cohesion": 2.0}, {"cohesion": 2.1}, {"cohesion": 2.0, "tensile_strength": 1.0})
    }
    assert len(keys) == 4


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"cohesion": -1.0}, "cohesion: .*greater than or equal to 0"),
        ({"cohesion": float("nan")}, "cohesion: "),
        ({"cohesion": float("inf")}, "cohesion: "),
        ({"cohesion": 1e16}, "cohesion: "),
        ({"cohesion": "2"}, "cohesion: "),
        ({"tensile_strength": -1.0}, "tensile_strength: .*greater than or equal to 0"),
        ({"tensile_strength": 1.0}, r"tensile strength 1 is above cohesion / friction = 0"),
        ({"cohesion": 1.0, "tensile_strength": 2.1}, r"tensile strength 2.1 is above cohesion / friction = 2\b"),
        (
            {"friction": {"default": 0.5, "cohesion": 1.0, "tensile_strength": 3.0}},
            r"friction: .*tensile strength 3 is above cohesion / friction = 2\b",
        ),
        (
            {"friction": {"default": 0.5, "rules": [{"joint": "bed", "value": 0.25, "tensile_strength": 1.0}]}},
            r"rules\[0\].*tensile strength 1 is above",
        ),
        ({"friction": {"default": 0.5}, "cohesion": 1.0}, 'give them beside "default" or in a rule'),
        (
            {"interfaces": [{"between": ["1", "2"], "from": [0, 0], "to": [1, 0], "cohesion": 1.0}]},
            "cohesion, tensile and compressive strength beside a friction of its own",
        ),
    ],
)
def test_strength_that_no_joint_can_have_is_refused(more: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        parse_wall(wall_data(stack(1, 1.0, 0.2), 0.5) | more, "wall.json")


def test_strength_immense_beside_the_load_is_refused():
    with pytest.raises(InputError, match=r"interface between .*: its strength is more than a thousand million times"):
        constants(wall_data(stack(1, 1.0, 0.2), 0.5, cohesion=1e14))


def test_tensile_strength_of_a_smooth_joint_has_no_limit():
    """Without friction compression adds nothing to the cohesion, and tension takes nothing from it."""
    data = wall_data(stack(1, 1.0, 0.2), 0.0, tensile_strength=3.0)
    assert constants(data).tolist() == [[1.5, 1.5, 0.0, 0.0]]


def test_tensile_strength_may_be_cohesion_over_friction_to_rounding():
    assert constants(wall_data(stack(1, 1.0, 0.2), 0.65, cohesion=0.25, tensile_strength=0.38461538461538))[0, 0] > 0.0


def test_dry_walls_are_written_as_before():
    built = build(Wall.model_validate(wall_data(BOND, 0.5)))
    assert not {"cohesion", "tensile_strength"} & set(str(built.wall.document()).split("'"))
    assert not built.assembly.constant.any()


def brittle(data: dict[str, Any]) -> list[bool]:
    return build(Wall.model_validate(data)).assembly.brittle.tolist()


@pytest.mark.parametrize(
    ("where", "bed", "head"),
    [
        ({"friction": 0.5, "cohesion": 2.0}, False, False),
        ({"friction": 0.5, "cohesion": 2.0, "after": "plastic"}, False, False),
        ({"friction": 0.5, "cohesion": 2.0, "after": "residual"}, True, True),
        (
            {
                "friction": {
                    "default": 0.5,
                    "cohesion": 2.0,
                    "after": "residual",
                    "rules": [{"joint": "bed", "value": 1}],
                }
            },
            False,
            True,
        ),
        (
            {"friction": {"default": 0.5, "rules": [{"joint": "bed", "value": 1, "cohesion": 1, "after": "residual"}]}},
            True,
            False,
        ),
    ],
)
def test_brittle_joints_are_named_where_strength_is(where: dict[str, Any], bed: bool, head: bool):
    built = build(Wall.model_validate(wall_data(BOND) | where))
    wall = built.assembly
    beds = np.array(wall.joint) == "bed"
    assert wall.brittle.tolist() == np.where(beds, bed, head).tolist()
    assert brittle(built.wall.document()) == wall.brittle.tolist()
    assert wall.breaks is (bed or head)
    assert (wall.residual.constant[wall.brittle] == 0.0).all()
    if wall.breaks:
        np.testing.assert_array_equal(wall.residual.constant[~wall.brittle], wall.constant[~wall.brittle])
    else:
        assert not wall.residual.strong


def test_an_interface_is_brittle_by_its_own_field():
    data = wall_data(stack(2, 1.0, 0.5), 0.5)
    names = build(Wall.model_validate(data)).assembly.block_ids
    given = {"between": [names[0], names[1]], "from": [0, 0], "to": [1, 0], "friction": 0.7, "cohesion": 5.0}
    assert sum(brittle(data | {"interfaces": {"given": [given | {"after": "residual"}]}})) == 1
    assert sum(brittle(data | {"interfaces": {"given": [given]}})) == 0


def test_a_brittle_wall_has_a_key_of_its_own():
    strong = wall_data(BOND, 0.5, cohesion=2.0)
    keys = {
        content_of(build(Wall.model_validate(strong | more)).assembly)
        for more in ({}, {"after": "plastic"}, {"after": "residual"})
    }
    assert len(keys) == 2


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"after": "brittle", "cohesion": 1.0}, 'after: .*"plastic" or "residual"'),
        ({"after": "residual"}, "neither cohesion nor tensile strength"),
        ({"after": "residual", "cohesion": 0.0}, "neither cohesion nor tensile strength"),
        ({"after": "residual", "friction": {"default": 0.5}}, "friction by rules holds"),
    ],
)
def test_a_word_about_no_strength_is_refused(more: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        parse_wall(wall_data(BOND, 0.5) | more, "")
