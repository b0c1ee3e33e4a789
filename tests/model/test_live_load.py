"""Which way a live load acts, and the same wall under the opposite one."""

from __future__ import annotations

from typing import Any

import pytest

import drystone
from harness.model.errors import InputError
from harness.model.fields import LARGEST
from harness.model.live_load import both_signs, direction_in_words, is_horizontal, reversed_live, with_live_load

STONES = [
    {"id": "g", "fixed": True, "polygon": [[0, -0.1], [0.4, -0.1], [0.4, 0], [0, 0]]},
    {"id": "a", "polygon": [[0, 0], [0.4, 0], [0.4, 0.2], [0, 0.2]]},
]


def loaded(live: dict[str, Any] | None, **loads: Any) -> drystone.Wall:
    given = loads if live is None else loads | {"live": live}
    return drystone.build_wall(
        {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": STONES, "loads": given}
    )


def body(x: float, y: float) -> dict[str, Any]:
    return {"body": [{"per_weight": [x, y]}]}


@pytest.mark.parametrize(
    ("live", "said", "horizontal"),
    [
        (body(1, 0), "to the right", True),
        (body(-0.3, 0), "to the left", True),
        (body(0, -1), "downwards", False),
        (body(0, 2), "upwards", False),
        (body(1, 1), "at 45° from the right, counter-clockwise", False),
        ({"points": [{"block": "a", "at": [0.1, 0.2], "force": [1, 0]}]}, "to the right", True),
        (body(1, 0) | {"points": [{"block": "a", "at": [0.1, 0.2], "force": [0, -1]}]}, "at", False),
        (None, "", False),
    ],
)
def test_direction_of_a_live_load(live: dict[str, Any] | None, said: str, horizontal: bool):
    case = loaded(live).case
    assert direction_in_words(case).startswith(said)
    assert bool(direction_in_words(case)) is bool(said)
    assert is_horizontal(case) is horizontal


def test_loads_of_unlike_blocks_one_way_have_one_direction():
    """The greater block carries the greater load."""
    tall = {"id": "b", "polygon": [[0, 0.2], [0.4, 0.2], [0.4, 0.9], [0, 0.9]]}
    data = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [*STONES, tall]}
    one_way = {"body": [{"per_weight": [1, 0.5]}]}
    two_ways = {"body": [{"per_weight": [1, 0], "blocks": ["a"]}, {"per_weight": [-1, 0], "blocks": ["b"]}]}
    said = [
        direction_in_words(drystone.build_wall(data | {"loads": {"live": live}}).case) for live in (one_way, two_ways)
    ]
    assert said == ["at 26.57° from the right, counter-clockwise", "in several directions"]


def test_right_and_horizontal_are_those_of_gravity():
    case = loaded(body(0, 1), gravity=[1, 0]).case  # the sheet is turned: down is to the right of it
    assert is_horizontal(case)
    assert direction_in_words(case) == "to the right"


def test_the_reversed_wall_has_the_opposite_load_and_no_reference():
    case = drystone.library_wall("single-block").case
    assert case.file.references
    turned = reversed_live(case)
    assert turned.assembly.live.tolist() == (-case.assembly.live).tolist()
    assert turned.assembly.dead.tolist() == case.assembly.dead.tolist()
    assert turned.file.references == []
    assert {direction_in_words(each) for each in (case, turned)} == {"to the right", "to the left"}


def test_another_live_load_takes_the_place_of_that_of_the_file_and_what_is_known_of_it():
    case = drystone.library_wall("single-block").case
    loaded_anew = with_live_load(case, 0.5, -2.0)
    free = case.assembly.free
    expected = case.assembly.weight[free, None] * [0.5, -2.0]
    assert loaded_anew.assembly.live[free, :2].tolist() == expected.tolist()
    assert loaded_anew.assembly.dead.tolist() == case.assembly.dead.tolist()
    assert loaded_anew.file.references == []
    assert "live load (0.5, -2) times the weight replaces that of the file" in loaded_anew.warnings[0]
    with pytest.raises(InputError, match="the live load 0,0 is none"):
        with_live_load(case, 0.0, 0.0)
    for x, y in ((LARGEST, 0.0), (0.0, -LARGEST)):
        assert with_live_load(case, x, y).wall.loads.live is not None
        with pytest.raises(InputError, match="is no pair of numbers up to 1e\\+15"):
            with_live_load(case, 2.0 * x, 2.0 * y)


def test_both_signs_are_two_load_cases_of_one_wall():
    case = drystone.library_wall("single-block").case
    there, back = both_signs(case)
    assert (there.id, back.id) == ("single-block", "single-block-reversed")
    assert (there.load_case, back.load_case) == ("to the right", "to the left")
    assert there.wall_id == back.wall_id == "single-block"
    assert there.file.references == case.file.references
    assert back.assembly.live.tolist() == (-case.assembly.live).tolist()


def test_both_signs_of_loads_several_ways_have_a_name_each():
    """The upper block is pushed to the left, the lower to the right: reversed, both loads act in several directions."""
    upper = {"id": "b", "polygon": [[0, 0.2], [0.4, 0.2], [0.4, 0.4], [0, 0.4]]}
    data = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [*STONES, upper]}
    live = {"body": [{"per_weight": [1, 0], "blocks": ["a"]}, {"per_weight": [-0.3, 0], "blocks": ["b"]}]}
    cases = both_signs(drystone.build_wall(data | {"loads": {"live": live}}).case)
    assert [case.load_case for case in cases] == ["as given", "reversed"]
    assert cases[1].assembly.live.tolist() == (-cases[0].assembly.live).tolist()


@pytest.mark.parametrize("live", [body(0, -1), None, {"pressures": [{"from": [0, 0], "to": [0, 0.2], "uniform": 1.0}]}])
def test_both_signs_of_what_is_no_earthquake_are_refused(live: dict[str, Any] | None):
    with pytest.raises(InputError, match="its live load is not horizontal, or a pressure"):
        both_signs(loaded(live).case)
