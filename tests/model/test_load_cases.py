"""Named load cases of one wall: what each consists of, and where its faults are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.errors import InputError
from harness.model.inspection import inspect
from harness.model.reading import parse_wall
from tests.walls import running_bond, stack, wall_data

CROWN = {"block": "2", "at": [0.1, 0.4], "force": [0.0, -5.0]}
SIDE = {"block": "2", "at": [0.0, 0.4], "force": [3.0, 0.0]}
PUSH = {"body": [{"per_weight": [0.1, 0]}]}


def wall(load_cases: dict[str, Any], **loads: Any) -> dict[str, Any]:
    return wall_data(stack(2), loads=loads, load_cases=load_cases)


def alone(loads: dict[str, Any]) -> drystone.Wall:
    return drystone.build_wall(wall_data(stack(2), loads=loads), "alone")


def test_a_load_case_adds_to_the_dead_load_of_all_and_has_its_own_live_load():
    data = wall(
        {"push": {"live": PUSH}, "crane": {"dead": {"points": [SIDE]}, "live": {"points": [CROWN]}}},
        dead={"points": [CROWN]},
    )
    cases = drystone.build_wall(data, "pier").load_cases
    assert list(cases) == ["push", "crane"]
    assert [each.name for each in cases.values()] == ["pier-push", "pier-crane"]
    for name, loads in (
        ("push", {"dead": {"points": [CROWN]}, "live": PUSH}),
        ("crane", {"dead": {"points": [CROWN, SIDE]}, "live": {"points": [CROWN]}}),
    ):
        np.testing.assert_array_equal(cases[name].assembly.dead, alone(loads).assembly.dead)
        np.testing.assert_array_equal(cases[name].assembly.live, alone(loads).assembly.live)
        assert cases[name].case.content == alone(loads).case.content, "the store finds the same wall"


def test_gravity_of_a_load_case_takes_the_place_of_that_of_all():
    turned = {"gravity": [0.1, -0.995]}
    cases = drystone.build_wall(wall({"level": {"gravity": True}, "slope": {}}, **turned), "pier").load_cases
    np.testing.assert_array_equal(cases["slope"].assembly.dead, alone(turned).assembly.dead)
    np.testing.assert_array_equal(cases["level"].assembly.dead, alone({}).assembly.dead)


def test_each_load_case_has_the_answer_of_the_wall_that_it_is():
    data = wall({"push": {"live": PUSH}, "side": {"live": {"points": [SIDE]}}, "none": {}})
    found = drystone.compare(drystone.build_wall(data, "pier"), ["la-associated"], isolated=False)
    assert [row.case for row in found.results] == ["pier-push", "pier-side", "pier-none"]
    for row, loads in zip(found.results, ({"live": PUSH}, {"live": {"points": [SIDE]}}, {}), strict=True):
        expected = drystone.analyse(alone(loads), "la-associated")
        assert (row.finding, row.multiplier) == (expected.finding, expected.multiplier)


def test_a_wall_of_load_cases_is_not_built_as_if_it_had_none():
    made = drystone.build_wall(wall({"push": {"live": PUSH}, "none": {}}), "pier")
    assert repr(made) == "<Wall pier: load cases push, none>"
    with pytest.raises(InputError, match=r"it has the load cases of push, none, each a wall"):
        drystone.analyse(made, "la-associated")


@pytest.mark.parametrize(
    ("load_cases", "said"),
    [
        ({"a": {"live": {"points": [CROWN | {"block": "9"}]}}}, 'load_cases.a.live.points[0]: no block is called "9"'),
        ({"a": {}, "b": {"dead": {"points": [SIDE, SIDE | {"block": "9"}]}}}, "load_cases.b.dead.points[1]: no block"),
        ({"a": {"live": {}}}, "load_cases.a.live: the live load puts no force"),
        ({"Snow left": {}}, '"Snow left" is no name of a load case'),
        ({"a": {"wind": {}}}, 'load_cases.a.wind: unknown field "wind"'),
    ],
)
def test_faults_of_a_load_case_are_told_with_their_place_in_the_file(load_cases: dict[str, Any], said: str):
    with pytest.raises(InputError) as raised:
        drystone.build_wall(wall(load_cases, dead={"points": [CROWN]}), "pier")
    assert said in str(raised.value)


def test_faults_of_what_all_load_cases_share_are_told_where_they_are():
    with pytest.raises(InputError, match=r'loads\.dead\.points\[0\]: no block is called "9"'):
        drystone.build_wall(wall({"a": {"dead": {"points": [SIDE]}}}, dead={"points": [CROWN | {"block": "9"}]}))


def test_a_live_load_beside_load_cases_is_refused():
    with pytest.raises(InputError, match=r"loads\.live beside load_cases"):
        drystone.build_wall(wall({"a": {}}, live=PUSH))


def test_validate_looks_at_every_load_case():
    good, bad = {"live": PUSH}, {"live": {"points": [SIDE | {"block": "9"}]}}
    assert inspect(parse_wall(wall({"a": good, "b": good}), "")).faults == ()
    (fault,) = inspect(parse_wall(wall({"a": good, "b": bad}), "")).faults
    assert fault.element == "load_cases.b.live.points[0]"


def test_more_load_cases_than_are_answered_are_counted():
    many = {f"c{k}": {"live": {"body": [{"per_weight": [1, 0]}]}} for k in range(501)}
    with pytest.raises(InputError, match="it has 501 entries, and may have 500 at most"):
        parse_wall({"format": "wall/1", "friction": 0.5, "load_cases": many}, "wall")


@pytest.mark.parametrize(
    ("method", "pattern", "count"), [("la-associated", running_bond(3, 4), 20), ("fe", stack(2), 3)]
)
def test_load_cases_together_have_the_bits_of_each_alone(method: str, pattern: dict[str, Any], count: int):
    """One process answers all; nothing goes from one to the next where the method takes nothing up."""
    cases = {f"c{k}": {"live": {"body": [{"per_weight": [1.0, -0.02 * k]}]}} for k in range(count)}
    made = drystone.build_wall(wall_data(pattern, loads={}, load_cases=cases), "pier")
    together = drystone.compare(made, [method]).results
    assert len({row.multiplier for row in together}) > 1
    for row, one in zip(together, made.load_cases.values(), strict=True):
        alone = drystone.analyse(one, method)
        for name in ("status", "finding", "multiplier", "forces", "mechanism"):
            assert np.array_equal(getattr(row, name), getattr(alone, name)), (row.case, name)
