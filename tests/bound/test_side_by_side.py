"""Parts of divided states worked on in processes of their own: their certificate is one, and a lost process is told."""

from __future__ import annotations

import os
import signal
from fractions import Fraction

import numpy as np
import psutil
import pytest

from benchmarks.bounds import small_wall
from methods.la.certify.window_certificate import certificate_of, certifier_of
from methods.la.core.problem import make_problem
from methods.la.find_certificate import account
from methods.proof.search.options import PROVED
from methods.proof.search.subproblem import Division
from methods.proof.search.window_search import Stop, WindowSearch
from methods.proof.verify.checker import verify
from tests.bound.by_cases import Short, certificate_of_cases, in_cases
from tests.bound.second_checker import check
from tests.bound.test_bracket import IRREGULAR
from tests.la.bodies import running_bond


def _children() -> set[int]:
    return {child.pid for child in psutil.Process().children()}


def test_what_two_processes_find_is_a_certificate_of_all_states() -> None:
    before = _children()
    document = certificate_of_cases(running_bond(2, 2, 0.2, 1.0), jobs=2)
    lower, upper = verify(document)
    assert check(document)[0] == lower
    assert upper is not None
    assert lower >= upper * (1 - Fraction(PROVED))
    assert _children() == before


class Few(Short):
    """Cases that are divided three times at most: no clock ends them."""

    def division(self) -> Division | None:
        return super().division() if len(self.case.tight | self.case.still) + len(self.case.normal) < 3 else None


def test_no_state_is_lost_between_processes() -> None:
    # From an upper end that is no state, a bound that lost the state in one of the cases would pass it.
    problem = make_problem(small_wall(10))
    least = IRREGULAR / problem.unit_multiplier
    certifier = certifier_of(problem)
    found = in_cases(problem, 1.05 * least, certify=certifier, kind=Few, jobs=2)
    assert found.branches > 1
    assert found.stopped is Stop.DECIDED
    assert found.iterations > 0
    assert found.lower <= least * (1.0 + 1e-6)
    document = certificate_of(problem, 1.05 * IRREGULAR, np.zeros((12, 3)), certifier)
    assert document is not None
    assert 0.0 < float(verify(document)[0]) <= IRREGULAR


def test_a_process_that_is_killed_costs_its_part_and_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    before = _children()
    problem, here, window = make_problem(small_wall(10)), os.getpid(), WindowSearch.window

    def killed(search: WindowSearch) -> bool:
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return window(search)

    monkeypatch.setattr(WindowSearch, "window", killed)
    found = in_cases(problem, IRREGULAR / problem.unit_multiplier, jobs=2)
    assert found.stopped is Stop.LOST
    assert 0.0 < found.lower < found.upper
    sentence = account(problem, IRREGULAR, found, None, 3.0, 2)
    assert "After 3.0 s of 2 processes" in sentence
    assert Stop.LOST in sentence
    assert _children() == before
