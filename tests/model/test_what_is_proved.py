"""What is proved of a collapse state: decided once, from certificates, searches and the other results of the wall."""

from __future__ import annotations

from dataclasses import replace

import pytest

from harness.model.comparison import CaseResults, Certified
from harness.model.proof import Proof, Standing, least_known, proof_of
from tests.reports import samples


def answers(**details: object) -> CaseResults:
    case = samples.bond("mine")
    la = samples.solved(case, "la", 0.5)
    la.details.update(details)
    return CaseResults(case, [samples.solved(case, "fe", 0.6), la])


def certified(item: CaseResults, bound: float) -> CaseResults:
    return replace(item, certified=Certified(bound, "", "certificate.json"))


def test_a_certificate_that_meets_the_state_makes_it_the_minimum_whoever_found_it():
    item = certified(answers(), 0.4999995)
    fe, la = item.results
    assert proof_of(item, la) == Proof(Standing.MINIMUM, 0.4999995)
    assert proof_of(item, fe).standing is Standing.NONE
    item.results[0] = fe.model_copy(update={"multiplier": 0.5})
    assert proof_of(item, item.results[0]).standing is Standing.MINIMUM


@pytest.mark.parametrize("bound", [0.49, 0.5000001, 0.51])
def test_a_certificate_that_does_not_meet_the_state_makes_it_no_minimum(bound: float):
    item = certified(answers(), bound)
    assert proof_of(item, item.results[1]).standing is Standing.KNOWN


def test_a_bound_above_the_state_is_no_bound_of_it():
    item = certified(answers(), 0.51)
    assert proof_of(item, item.results[1]).bound is None


def test_a_bound_that_a_method_says_is_certified_is_not_believed():
    item = answers(certified_bound=0.4999995)
    assert proof_of(item, item.results[1]) == Proof(Standing.KNOWN)


def test_a_bound_in_floating_point_counts_only_above_the_exact_one():
    item = certified(answers(lower_bound=0.46875), 0.4375)
    proof = proof_of(item, item.results[1])
    assert (proof.bound, proof.lower_bound) == (0.4375, 0.46875)
    assert proof.sentence == (
        "Least known: a lower collapse state is not excluded; none lies from zero to below 0.4375, "
        "by an exact certificate; la finds none below 0.46875, to rounding."
    )
    item = certified(answers(lower_bound=0.3), 0.4)
    assert proof_of(item, item.results[1]).lower_bound is None


def test_a_tree_in_floating_point_proves_to_rounding_only():
    item = answers(proved_least=True)
    proof = proof_of(item, item.results[1])
    assert proof.standing is Standing.TO_ROUNDING
    assert "in floating point" in proof.sentence


def test_what_is_no_accepted_collapse_state_without_dilatancy_proves_nothing_and_is_not_the_least():
    item = certified(answers(certified_bound=0.4999995, proved_least=True), 0.4999995)
    for change in ({"flow": "associated"}, {"judge": item.results[1].judge.model_copy(update={"accepted": False})}):
        changed = replace(item, results=[item.results[0], item.results[1].model_copy(update=change)])
        assert proof_of(changed, changed.results[1]) == Proof()
        assert least_known(changed) is changed.results[0]


def test_a_printed_bound_is_never_above_the_proved_one():
    item = certified(answers(), 0.49999999999)
    assert "below 0.4999999." in proof_of(item, item.results[1]).sentence


def test_what_a_method_says_in_floating_point_does_not_count_where_a_lower_state_is_known():
    item = answers()
    liar = item.results[1].model_copy(update={"method": "liar", "multiplier": 0.7})
    liar = liar.model_copy(update={"details": {"proved_least": True, "lower_bound": 0.6}})
    both = replace(item, results=[*item.results, liar])
    assert proof_of(both, liar) == Proof()
    assert proof_of(both, item.results[1]) == Proof(Standing.KNOWN)


def test_what_a_method_says_in_floating_point_is_said_in_its_name():
    item = answers(lower_bound=0.25)
    least = item.results[1]
    other = item.results[0].model_copy(update={"method": "other", "details": {"lower_bound": 0.375}})
    assert (
        "other finds none below 0.375, to rounding" in proof_of(replace(item, results=[other, least]), least).sentence
    )


@pytest.mark.parametrize("said", ["0.4", "x", [0.4], {"value": 0.4}, True, float("nan"), float("inf"), None])
def test_a_lower_bound_that_is_no_number_is_none(said: object):
    item = answers(lower_bound=said)
    assert proof_of(item, item.results[1]) == Proof(Standing.KNOWN)


@pytest.mark.parametrize("said", [1, "yes", [True]])
def test_only_true_says_that_a_tree_ended(said: object):
    item = answers(proved_least=said)
    assert proof_of(item, item.results[1]) == Proof(Standing.KNOWN)


def test_a_certificate_proves_nothing_of_a_state_at_zero():
    item = answers()
    at_zero = item.results[1].model_copy(update={"multiplier": 0.0})
    item = replace(item, results=[at_zero], certified=Certified(0.0, "", "certificate.json"))
    assert proof_of(item, at_zero) == Proof(Standing.KNOWN)
