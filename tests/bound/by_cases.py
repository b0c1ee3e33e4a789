"""Brackets that are divided into cases of contacts after one window, where the product would go on with windows."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from methods.la.certify.window_certificate import certificate_of, certifier_of, equations_of
from methods.la.core.problem import Problem, make_problem
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.proof.search.bracket import branched
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.window_search import Bracket, Certify, WindowSearch


class Short(WindowSearch):
    """Windows that end once they gained something, so that cases have something left to prove.

    The product asks the clock how long they go on; here the certificate of a wall is the same on every machine.
    """

    def _gains(self, gap: float) -> bool:
        return False


class ShortFirst(Short):
    """The same for the first window alone: the others go on to their end, so that there are fewer cases."""

    def _gains(self, gap: float) -> bool:
        return self._made_by is not None


def in_cases(
    problem: Problem,
    upper: float,
    seconds: float = np.inf,
    certify: Certify | None = None,
    kind: type[Short] = Short,
    jobs: int = 1,
) -> Bracket:
    """The bracket of one window and, from there, of cases of contacts only, by so many processes."""
    equations = equations_of(problem, jobs)
    until = equations.options.clock() + seconds
    root = kind(equations, SlackProgramme(equations), Bracket(0.0, upper), until, certify)
    root.window()
    branched(root)
    return root.found


def certificate_of_cases(wall: Assembly, kind: type[Short] = Short, jobs: int = 1) -> dict[str, Any]:
    """The certificate of a bracket below the least state known."""
    problem, known = make_problem(wall), LimitAnalysis().solve(wall, SearchSettings())
    certifier, multiplier = certifier_of(problem), known.multiplier
    assert multiplier is not None
    assert known.mechanism is not None
    in_cases(problem, multiplier / problem.unit_multiplier, certify=certifier, kind=kind, jobs=jobs)
    document = certificate_of(problem, multiplier, known.mechanism, certifier)
    assert document is not None
    assert "cases" in document
    return document
