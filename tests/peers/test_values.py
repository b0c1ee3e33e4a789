"""Values of peers on walls whose least multiplier is known, and that what they claim is never called proved.

They need the extras `scip`, `discopt` and `pounce`, which the development environment leaves out: `docs/peers.md`.
"""

from __future__ import annotations

import importlib.util
from dataclasses import replace

import numpy as np
import pytest

import drystone
from benchmarks.peers import claim_of
from drystone.bench import Speed, rows_of, wall_set
from harness.model.assembly import Assembly
from harness.model.comparison import Certified
from harness.model.method import Answer, Status
from harness.model.method_registry import load_method
from harness.model.proof import Standing
from tests.enumeration import least_by_enumeration
from tests.la.bodies import column
from tests.reports import samples
from tests.walls import case, stack


def needing(name: str, package: str) -> object:
    missing = importlib.util.find_spec(package) is None
    return pytest.param(name, marks=pytest.mark.skipif(missing, reason=f"the extra {name} is missing"))


SCIP, DISCOPT, POUNCE = needing("scip", "pyscipopt"), needing("discopt", "discopt"), needing("pounce", "pounce")
GLOBAL = [SCIP, DISCOPT]


def solved(name: str, wall: Assembly, **settings: float) -> Answer:
    method = load_method(name)
    return method.solve(wall, method.Settings(**settings))


@pytest.mark.parametrize("name", [*GLOBAL, POUNCE])
@pytest.mark.parametrize(("wall", "least"), [("single-block", 0.4), ("two-frictions", 0.2), ("topple", 0.4)])
def test_closed_forms(name: str, wall: str, least: float):
    result = drystone.analyse(drystone.library_wall(wall), name)
    assert result.judge.accepted is True
    assert result.multiplier == pytest.approx(least, rel=1e-9)


@pytest.mark.parametrize("name", GLOBAL)
@pytest.mark.parametrize("friction", [0.3, 0.9])
def test_two_blocks_against_all_states(name: str, friction: float):
    wall = column([0.5, 0.4], [0.3, 0.5], friction)
    answer = solved(name, wall)
    least = least_by_enumeration(wall)
    assert answer.multiplier == pytest.approx(least, rel=1e-7)
    assert answer.details["claimed_optimal"] is True
    assert answer.details["claimed_bound"] == pytest.approx(least, rel=1e-5)


@pytest.mark.parametrize("name", GLOBAL)
@pytest.mark.parametrize("friction", [(0.2, 0.9), (0.9, 0.2)])
def test_a_block_on_halves_against_all_states(name: str, friction: tuple[float, float]):
    """Self-stress between the halves leaves a range of collapse states, of which the least is asked for."""
    wall = replace(column([1.0], [0.4], 0.5, halves=2), friction=np.array(friction))
    assert solved(name, wall).multiplier == pytest.approx(least_by_enumeration(wall), rel=1e-7)


@pytest.mark.parametrize("name", [SCIP])
def test_the_bound_reaches_the_state_of_a_wall_by_the_row_of_virtual_work(name: str):
    answer = solved(name, drystone.library_wall("running-bond-overturns").assembly)
    assert answer.details["claimed_bound"] == pytest.approx(0.2, rel=1e-6)


@pytest.mark.parametrize("name", [POUNCE])
def test_the_relaxed_programme_in_all_unknowns_reproduces_that_in_reduced_ones(name: str):
    result = drystone.analyse(drystone.library_wall("wall-21"), name)
    assert result.judge.accepted is True
    assert result.multiplier == pytest.approx(0.557997778, rel=1e-8)


@pytest.mark.parametrize("name", [SCIP])
def test_what_is_found_by_the_end_of_its_time_is_the_answer(name: str):
    answer = solved(name, drystone.library_wall("wall-21").assembly, seconds=1.0)
    assert answer.details["claimed_optimal"] is False
    assert answer.details["claimed_bound"] <= 0.557997778 * (1.0 + 1e-6)
    assert answer.status in (Status.OK, Status.NOT_CONVERGED)


@pytest.mark.parametrize("name", GLOBAL)
def test_a_claimed_bound_is_never_called_proved(name: str):
    wall = drystone.new_wall("stack", count=3, width=0.37, friction=0.4)
    compared = drystone.compare(wall, [name], isolated=False)
    (result,) = compared.results
    assert result.details["claimed_bound"] == pytest.approx(result.multiplier, rel=1e-5)
    assert result.proof.standing is Standing.KNOWN
    assert (result.proof.bound, result.proof.lower_bound) == (None, None)
    assert "lower_bound" not in result.details
    assert not rows_of(wall_set("core"), compared, Speed(1.0, 0.0))["proved"].any()


@pytest.mark.parametrize(
    ("bound", "optimal", "value", "words"),
    [
        (0.41, True, 0.41, "wrong: a state is known at 0.4"),
        (0.4, True, 0.4, "agrees with the certificate"),
        (0.35, True, 0.35, "the certificate excludes it"),
        (0.35, False, None, "holds, not tight"),
        (0.0, False, None, "says nothing"),
    ],
)
def test_a_claim_is_held_against_the_certificate_and_the_known_states(
    bound: float, optimal: bool, value: float | None, words: str
):
    result = samples.solved(case(stack(1)), "la", 0.4)
    result.details.update(claimed_bound=bound, claimed_optimal=optimal, programme_value=value)
    claim = claim_of(result, 0.4, Certified(0.3999999, "", ""))
    assert claim is not None
    assert words in claim.verdict
    del result.details["claimed_bound"]
    assert claim_of(result, 0.4, None) is None
