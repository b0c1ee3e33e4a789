"""Walls that just stand or just fall: every method finds the same, and what a closed form or a programme says."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.knife_edge import KINDS, edges, verdict
from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method, prepared
from harness.model.reading import read_wall

INPUTS = Path(__file__).parents[1] / "data" / "knife-edge"
METHODS = ("la", "la-associated", "la-tresca", "fe", "fe-newton", "de")
SLOW = pytest.mark.slow
MEASURED = 5e-3
"""Relative accuracy that `de` states of a multiplier between its two loads."""


def wall(name: str) -> Assembly:
    return read_wall(INPUTS / f"{name}.json").assembly


@pytest.mark.parametrize("method", [*METHODS, "fe-qp", "de-soft", "la-paper", "la-from-fe", "la-bound"])
@pytest.mark.parametrize("name", ["pz4-opt-mu0", "edge-2e-09", "harm4-10"])
def test_a_wall_at_its_limit_is_so_for_every_method(name, method):
    result, judged = answered(prepared(load_method(method)), wall(name))
    assert (result.status, result.finding, result.multiplier) == (Status.OK, Finding.AT_LIMIT, 0.0)
    assert judged.accepted, judged.sentence
    assert "at its limit" in result.sentence


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("name", "multiplier"), [("pz4-in-mu0", 0.02723503), ("pz4-in-mu5", 0.04121737), ("sb-stable", 0.00174533)]
)
def test_a_multiplier_near_the_limit_is_found_by_every_method(name, multiplier, method):
    result, judged = answered(prepared(load_method(method)), wall(name))
    assert (result.status, result.finding) == (Status.OK, Finding.COLLAPSES)
    assert judged.accepted, judged.sentence
    measured = result.bracket is not None and result.flow == "approximate"
    # The expected values have seven digits.
    assert result.multiplier == pytest.approx(multiplier, rel=MEASURED if measured else 3e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["pz4-out-mu0", "sb-slide", "sb-topple", "sb-both"])
def test_a_wall_beyond_its_limit_falls_for_every_method(name, method):
    result, judged = answered(prepared(load_method(method)), wall(name))
    assert (result.finding, result.multiplier) == (Finding.FALLS, None)
    assert judged.accepted, judged.sentence


@pytest.mark.parametrize(
    "method", ["la", "la-associated", *(pytest.param(name, marks=SLOW) for name in ("fe", "fe-newton", "de"))]
)
@pytest.mark.parametrize("name", [pytest.param("par6-mu0", marks=SLOW), "par6-in-mu0"])
def test_a_frictionless_stack_is_at_its_limit(name, method):
    result, judged = answered(prepared(load_method(method)), wall(name))
    assert (result.finding, result.multiplier) == (Finding.AT_LIMIT, 0.0)
    assert judged.accepted, judged.sentence


@pytest.mark.parametrize("method", ["la-associated", "fe"])
def test_a_stack_with_friction_bears_at_most_what_statics_allows(method):
    result, judged = answered(prepared(load_method(method)), wall("par6-in-mu5"))
    assert judged.accepted, judged.sentence
    assert 0.0 <= result.multiplier <= 3.0 + 1e-9


@pytest.mark.parametrize("method", ["la", "la-associated", "fe", "fe-newton", "fe-qp", "de", "de-soft"])
def test_a_block_in_a_notch_bears_any_load(method):
    result, judged = answered(prepared(load_method(method)), wall("fe-lost-cra-type-b"))
    assert result.finding is Finding.UNBOUNDED
    assert judged.accepted, judged.sentence


@pytest.mark.parametrize("method", ["la", "la-associated", "fe"])
def test_the_least_thrust_keeps_its_value(method):
    result, _ = answered(prepared(load_method(method)), wall("thrust-min"))
    assert result.multiplier == pytest.approx(0.3680362, abs=5e-8)


@pytest.mark.parametrize("name", ["gb16-7855-l", "gb16-8500-l"])
def test_a_state_of_self_stress_at_zero_says_what_statics_bears(name):
    slope = wall(name)
    greatest, _ = answered(load_method("la-associated"), slope)
    least, judged = answered(prepared(load_method("la")), slope)
    assert (least.finding, least.multiplier) == (Finding.COLLAPSES, 0.0)
    assert judged.accepted, judged.sentence
    assert f"Statics alone would bear up to {greatest.multiplier:.7g}" in least.sentence


def test_springs_that_fall_where_statics_stands_say_so():
    result, judged = answered(prepared(load_method("fe")), wall("gb16-7855-l"))
    assert (result.finding, judged.accepted) == (Finding.FALLS, None)
    assert result.sentence.startswith("Not proved: the wall falls")
    assert "Statics alone would bear up to 0.09676127, so the wall may also stand" in result.sentence


@pytest.mark.parametrize("powers", [(4, 9), pytest.param((2, 12), marks=SLOW)])
@pytest.mark.parametrize("method", ["la", "la-associated", "fe", "fe-newton", "de"])
@pytest.mark.parametrize(
    "kind",
    [
        pytest.param(kind, marks=[SLOW] * (kind.endswith("degrees") and "40" not in kind))
        for kind in KINDS
        if "12" not in kind
    ],
)
def test_walls_off_their_limit_agree_with_closed_forms(kind, method, powers):
    found, (resolved, unresolved) = prepared(load_method(method)), powers
    walls = edges(kind, resolved=(resolved,), unresolved=(unresolved,))
    told = {edge.name: verdict(edge, *answered(found, edge.wall)) for edge in walls}
    assert len(told) == 5
    assert set(told.values()) == {"right"}, told
