"""Values of `opensees`, `rbe`, `cra` and `lmgc90` on walls with closed forms, that the judge accepts; what they refuse.

They need the extras `opensees`, `cra` and `lmgc90`, which the development environment leaves out: `docs/peers.md`.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec

import pytest

import drystone
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from tests.walls import assembly, stack

needs_opensees = pytest.mark.skipif(find_spec("openseespy") is None, reason="the extra opensees is missing")
needs_cra = pytest.mark.skipif(find_spec("compas_cra") is None, reason="the extra cra is missing")
needs_lmgc90 = pytest.mark.skipif(find_spec("compas_lmgc90") is None, reason="the extra lmgc90 is missing")


@needs_opensees
@pytest.mark.parametrize(
    ("wall", "exact"), [("single-block", 10 / 21), ("topple", 0.4), ("slide", 0.3), ("stack-10", 0.25)]
)
def test_opensees_stops_at_the_closed_form_with_a_state_that_the_judge_accepts(wall: str, exact: float):
    result = drystone.analyse(drystone.library_wall(wall), "opensees")
    assert result.multiplier == pytest.approx(exact, rel=1e-5)
    assert result.judge.accepted is True
    assert "not a proof of collapse" in result.sentence


@needs_opensees
def test_opensees_keeps_an_arch_whose_points_open_under_the_dead_load():
    result = drystone.analyse(drystone.library_wall("borri-arch-13"), "opensees")
    assert result.multiplier == pytest.approx(0.13355, rel=1e-3)
    assert result.judge.accepted is True


@needs_opensees
@pytest.mark.parametrize(("steps", "finding"), [({}, Finding.STANDS), ({"load_cap": 0.01}, Finding.NONE)])
def test_opensees_says_no_collapse_where_none_was_seen(steps: dict[str, float], finding: Finding):
    loads = {} if steps else {"loads": {"live": None}}
    method = load_method("opensees")
    answer = method.solve(assembly(stack(2), 0.5, **loads), method.Settings(**steps))
    assert (answer.finding, answer.multiplier) == (finding, None)


@needs_cra
@pytest.mark.parametrize(("wall", "exact"), [("topple", 0.4), ("slide", 0.3), ("stack-10", 0.25)])
def test_rbe_brackets_the_associated_maximum_and_is_not_judged_without_a_mechanism(wall: str, exact: float):
    result = drystone.analyse(drystone.library_wall(wall), "rbe")
    low, high = result.bracket
    assert low - 1e-6 <= exact <= high
    assert high - low <= 5e-4 * high
    assert result.judge.accepted is None


@needs_cra
def test_cra_brackets_the_multiplier_of_a_block_that_slides():
    low, high = drystone.analyse(drystone.library_wall("slide"), "cra", accuracy=0.01).bracket
    assert low - 1e-4 <= 0.3 <= high


@needs_cra
@pytest.mark.parametrize("name", ["rbe", "cra"])
def test_compas_cra_refuses_two_frictions(name: str):
    result = drystone.analyse(drystone.library_wall("single-block"), name)
    assert result.status is Status.REFUSED
    assert "one friction coefficient" in result.sentence


@needs_lmgc90
@pytest.mark.parametrize(("wall", "exact"), [("topple", 0.4), ("slide", 0.3), ("stack-2", 0.75)])
def test_lmgc90_brackets_the_closed_form_with_forces_and_a_motion_that_the_judge_accepts(wall: str, exact: float):
    result = drystone.analyse(drystone.library_wall(wall), "lmgc90")
    low, high = result.bracket
    assert low * (1.0 - 1e-3) <= exact <= high * (1.0 + 1e-3)
    assert high - low <= 2e-3 * high
    assert result.judge.accepted is True
    assert (result.flow, len(result.mechanism)) == ("approximate", 1 + result.blocks)


@needs_lmgc90
def test_lmgc90_answers_in_the_units_of_the_wall():
    """Forces, moments and motions come back in the units of the wall."""
    wall = drystone.new_wall("stack", count=2, width=300.0, height=200.0, friction=0.8)
    result = drystone.analyse(wall, "lmgc90")
    assert result.multiplier == pytest.approx(0.75, rel=2e-3)
    assert result.judge.accepted is True


@needs_lmgc90
def test_lmgc90_refuses_two_frictions_and_blocks_that_are_not_convex():
    assert "one friction coefficient" in drystone.analyse(drystone.library_wall("single-block"), "lmgc90").sentence
    notched = [[0, 0], [1, 0], [1, 1], [0.5, 0.5], [0, 1]]
    base = {"id": "base", "polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]], "fixed": True}
    data = {
        "format": "wall/1", "unit_weight": 20.0, "friction": 0.5,
        "blocks": [base, {"id": "notched", "polygon": notched}],
        "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
    }  # fmt: skip
    result = drystone.analyse(drystone.build_wall(data), "lmgc90")
    assert result.status is Status.REFUSED
    assert "takes convex blocks; notched is none" in result.sentence


@pytest.mark.parametrize(
    ("name", "module", "extra"),
    [
        ("lmgc90", "compas_lmgc90.solver", "lmgc90"),
        ("opensees", "openseespy.opensees", "opensees"),
        ("cra", "compas_cra.equilibrium", "cra"),
    ],
)
def test_missing_package_is_named_with_the_way_to_install_it(
    name: str, module: str, extra: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setitem(sys.modules, module, None)
    method = load_method(name)
    with pytest.raises(InputError, match=rf"drystone\[{extra}\]"):
        method.solve(assembly(stack(1), 0.5), method.Settings())
