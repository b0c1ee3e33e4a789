"""A part of a face bears once: supports that overlap, and interfaces listed twice, would double its strength."""

from __future__ import annotations

from typing import Any

import pytest

from harness.model.build import build
from harness.model.errors import InputError
from harness.model.wall import Wall


def support(name: str, left: float, right: float, top: float = 0.0) -> dict[str, Any]:
    return {"id": name, "polygon": [[left, -1], [right, -1], [right, top], [left, top]], "fixed": True}


def built(supports: list[dict[str, Any]], **changes: Any) -> int:
    """Joints of a glued block of 1 x 1 on supports."""
    block = {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]}
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.6, "cohesion": 3, "blocks": [*supports, block]}
    return build(Wall.model_validate(wall | changes)).assembly.n_interfaces


@pytest.mark.parametrize(("left", "length"), [(0.2, r"0\.6"), (-1.0, r"0\.8")])
def test_a_block_on_two_supports_that_overlap_is_refused(left: float, length: str):
    with pytest.raises(InputError, match=rf"joints of g/a and of h/a.* for a length of {length} and would bear twice"):
        built([support("g", -1, 0.8), support("h", left, 2)])


def test_supports_that_meet_below_a_block_bear_it():
    assert built([support("g", -1, 0.5), support("h", 0.5, 2)]) == 2


def test_supports_may_overlap_where_no_block_rests_on_both():
    assert built([support("g", -1, 0.5), support("h", 0.5, 2), support("i", 1, 3)]) == 2


def test_supports_meet_within_the_tolerance_of_a_drawing():
    """They overlap by half a millimetre, which the file says may be."""
    assert built([support("g", -1, 0.5005), support("h", 0.5, 2)], interfaces={"tolerance": 0.001}) == 2


def test_joints_round_a_notch_are_two():
    """Both lie within the tolerance of its edge, and on faces that are not in one line."""
    notch = {"id": "g", "polygon": [[-1, -1], [2, -1], [2, 0], [0, 0], [0, 2], [-1, 2]], "fixed": True}
    assert built([notch]) == 2


@pytest.mark.parametrize("turned", [False, True])
def test_an_interface_listed_twice_is_refused(turned: bool):
    first = {"between": ["g", "a"], "from": [0, 0], "to": [0.6, 0]}
    second = {"between": ["a", "g"], "from": [1, 0], "to": [0.5, 0]} if turned else first | {"from": [0.5, 0]}
    with pytest.raises(InputError, match=r"for a length of 0\.1 and would bear twice"):
        built([support("g", -1, 2)], interfaces=[first, second])
    assert built([support("g", -1, 2)], interfaces=[first, second | {"from": [0.6, 0], "to": [1, 0]}]) == 2
