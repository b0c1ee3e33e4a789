"""Certificates of brackets that are won by cases of contacts prove what they say, and nothing that is false."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.bounds import small_wall
from methods.la.certify.window_certificate import certificate_of, certifier_of, equations_of
from methods.la.core.problem import make_problem
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.proof.same_wall import require_same_wall
from methods.proof.search.rate_bounds import RateProgramme
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.subproblem import AtContact, AtNormalForce, Subproblem
from methods.proof.search.window_search import Bracket, WindowSearch
from methods.proof.verify.cases import STEPS, states_of
from methods.proof.verify.checker import verify
from methods.proof.verify.document import digest
from methods.proof.verify.exact_wall import CertificateError, ExactWall
from methods.proof.verify.windows import WindowLimits
from tests.bound.by_cases import ShortFirst, certificate_of_cases
from tests.bound.digits import one_digit_changed, refused_or_true
from tests.bound.test_bracket import IRREGULAR
from tests.la.bodies import running_bond

LEAST = Fraction(13, 20)
"""Least multiplier of 2 courses of 2 bricks .4 x .2 on friction 13/20: the top course slides."""


@cache
def of_bond() -> dict[str, Any]:
    return certificate_of_cases(running_bond(2, 2, 0.2, 0.65))


@cache
def of_irregular_wall() -> dict[str, Any]:
    return certificate_of_cases(small_wall(10), ShortFirst)


def nodes(node: dict[str, Any]) -> Iterator[dict[str, Any]]:
    yield node
    for part in node.get("parts", ()):
        yield from nodes(part)


def test_cases_prove_a_bonded_wall_to_a_millionth() -> None:
    require_same_wall(of_bond(), running_bond(2, 2, 0.2, 0.65))
    lower, upper = verify(of_bond())
    assert upper == LEAST
    assert 0 < upper - lower <= Fraction(1, 10**6) * upper
    without = {key: value for key, value in of_bond().items() if key != "cases"}
    with pytest.raises(CertificateError, match="windows prove"):
        verify(without | {"digest": digest(without)})


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_one_digit_changed_anywhere_is_refused(data: st.DataObject) -> None:
    with pytest.raises(CertificateError):
        verify(one_digit_changed(data, of_bond()))


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.data())
def test_one_digit_changed_proves_nothing_false_even_with_the_digest_made_anew(data: st.DataObject) -> None:
    part = {key: of_bond()[key] for key in ("cases", "bound", "multiplier")}
    refused_or_true(LEAST, of_bond() | one_digit_changed(data, part))


def test_a_half_that_is_left_out_or_in_the_place_of_the_other_is_refused() -> None:
    halves = of_bond()["cases"]["parts"]
    for parts in ([halves[0]], [halves[1], halves[0]], [halves[0], halves[0]], [halves[1], halves[1]]):
        document = copy.deepcopy(of_bond())
        document["cases"]["parts"] = parts
        assert refused_or_true(LEAST, document)


HIGHER = Fraction(7, 11)
"""Least multiplier of 3 courses of 2 bricks."""


@cache
def of_two_normal_forces() -> dict[str, Any]:
    """A bond whose states are divided at half of the widest normal force of one window."""
    wall = running_bond(3, 2, 0.2, 0.65)
    problem, known = make_problem(wall), LimitAnalysis().solve(wall, SearchSettings())
    equations, certifier, upper = equations_of(problem), certifier_of(problem), float(HIGHER) / problem.unit_multiplier
    search = WindowSearch(equations, SlackProgramme(equations), Bracket(0.0, upper), 0.0, certifier)
    while search.found.lower == 0.0:
        search.window()  # to its first check
    assert not search.found.closed
    search.until = np.inf
    bounds = SlackProgramme(equations).bounds(search.found.lower, upper)
    assert bounds is not None
    widest = int((bounds.normal_greatest - bounds.normal_least).argmax())
    at = AtNormalForce(widest, 0.5 * float(bounds.normal_greatest[widest]))
    for part in search.parts(at, RateProgramme(equations)):
        while part.window() and not part.found.closed:
            pass
        assert part.found.closed
    assert known.multiplier is not None
    assert known.mechanism is not None
    document = certificate_of(problem, known.multiplier, known.mechanism, certifier)
    assert document is not None
    return document


@pytest.mark.slow
def test_states_divided_at_a_normal_force_are_proved_on_both_sides_of_it() -> None:
    document = of_two_normal_forces()
    node = document["cases"]
    assert {"interface", "normal"} <= node.keys()
    lower, upper = verify(document)
    assert upper == HIGHER
    assert lower >= HIGHER * (1 - Fraction(2, 10**6))
    few, many = node["parts"]
    for parts in ([many, few], [few, few], [many, many], [few]):
        assert refused_or_true(HIGHER, document | {"cases": node | {"parts": parts}})


def test_every_part_is_needed_to_its_end() -> None:
    """A part without its last step no longer reaches the bound."""
    parts = [node for node in nodes(of_bond()["cases"]) if "parts" not in node]
    assert len(parts) >= 2
    for k in range(len(parts)):
        document = copy.deepcopy(of_bond())
        [node for node in nodes(document["cases"]) if "parts" not in node][k]["steps"].pop()
        assert refused_or_true(LEAST, document)


@pytest.mark.parametrize(
    "shown",
    [
        pytest.param(name, marks=[pytest.mark.slow] * (name == "loaded"))
        for name in sorted(STEPS.keys() - {"no mechanism", "slow"})
    ],
)
def test_steps_are_refused_with_opposite_proofs(shown: str) -> None:
    document = copy.deepcopy(of_irregular_wall())
    steps = [step for node in nodes(document["cases"]) for step in node["steps"] if step["shows"] == shown]
    assert steps
    for step in steps:
        if shown == "window":
            step["multiplier"]["columns"][-2][-3] += 2 ** step["multiplier"]["exponent"]
        for key in {"velocities", "strains"} & step.keys():
            step[key] = [-value for value in step[key]]
    with pytest.raises(CertificateError):
        verify(document | {"digest": digest(document)})


def test_forces_show_how_little_a_contact_moves_and_opposite_ones_do_not() -> None:
    # The proof of this wall has such steps with the arithmetic of any processor.
    document, found = certificate_of_cases(small_wall(18), ShortFirst), 0
    window = document["windows"][-1]
    limits = WindowLimits(ExactWall(document), window)
    greatest = limits.greatest_size(window["size"])
    left = [(states_of(limits, greatest, limits.bound(window["multiplier"], greatest)), document["cases"])]
    while left:
        states, node = left.pop()
        for step in node["steps"]:
            if step["shows"] == "slow":
                opposite = step | {"strains": [-value for value in step["strains"]]}
                for each, moves in ((step, False), (opposite, True)):
                    assert (states.after(each).known.slow[step["contact"]] > Fraction(1, 10**6)) is moves
                found += 1
            states = states.after(step)
        if "parts" in node:
            left += zip(states.halves(node), node["parts"], strict=True)
    assert found > 0


def test_a_step_about_an_interface_beyond_the_last_is_refused() -> None:
    document = of_bond()
    limits = WindowLimits(ExactWall(document), document["windows"][-1])
    states = states_of(limits, Fraction(1), limits.forces.low)
    still = [0] * (3 * running_bond(2, 2, 0.2, 0.65).n_free)
    count = running_bond(2, 2, 0.2, 0.65).n_interfaces
    step = {"shows": "loaded", "least": "0", "velocities": still}
    assert states.after(step | {"interface": count - 1}).known.least[count - 1] == 0  # no force is below zero
    for beyond in (count, count + 1, -1):
        with pytest.raises(CertificateError):
            states.after(step | {"interface": beyond})


def test_a_case_in_which_nothing_moves_is_empty() -> None:
    """No mechanism has live work where all contacts but one are still; where more may move, forces do not show so."""
    problem = make_problem(running_bond(2, 2, 0.2, 0.65))
    equations, certifier = equations_of(problem), certifier_of(problem)
    upper = float(LEAST) / problem.unit_multiplier
    search = WindowSearch(equations, SlackProgramme(equations), Bracket(0.0, upper), np.inf, certifier)
    search.window()
    part = certifier.part(AtContact(1), False)
    assert part is not None
    held = frozenset(range(1, 4 * problem.n_interfaces))
    for contact in sorted(held):
        part = part.part(AtContact(contact), False)
    bounds = SlackProgramme(equations).bounds(search.found.lower, upper)
    assert bounds is not None
    decided, proofs = RateProgramme(equations).decided(upper, bounds, Subproblem(still=held))
    assert (decided, [proof.shows for proof in proofs]) == (None, ["no mechanism"])
    other = certifier.part(AtContact(0), False)
    assert other is not None
    assert other.rates(proofs) < upper
    assert part.rates(proofs) == pytest.approx(upper, rel=1e-8)


def test_cases_prove_an_irregular_wall() -> None:
    lower, upper = verify(of_irregular_wall())
    assert float(upper) == pytest.approx(IRREGULAR, rel=1e-9)
    assert 0 < upper - lower <= Fraction(2, 10**6) * upper
