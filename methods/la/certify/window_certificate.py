"""A bracket of the least multiplier whose lower end a certificate proves window by window."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.la.core.state import moving_contacts
from methods.proof.search.bracket import bracket
from methods.proof.search.certifier import Certifier
from methods.proof.search.equations import Equations
from methods.proof.search.options import ProofOptions
from methods.proof.search.window_document import Scales
from methods.proof.search.window_search import Bracket
from methods.proof.tree.certificate import wall_document, with_state
from methods.proof.verify.document import digest


def equations_of(problem: Problem, jobs: int = 1) -> Equations:
    """The equations of a problem as the bound takes them, for so many processes."""
    return Equations(problem.kinematic, problem.dead, problem.live, problem.friction, ProofOptions(jobs=jobs))


def certified_bracket(
    problem: Problem, multiplier: float, mechanism: FloatArray, seconds: float, jobs: int = 1
) -> tuple[Bracket, dict[str, Any] | None]:
    """The scaled bracket below a collapse state, and its certificate; None where nothing is proved.

    The certificate holds the state where that exists in fractions.

    Args:
        problem: a wall of one component, which stands under its dead load.
        multiplier: of the state, above zero.
        mechanism: (n_blocks, 3) velocities of the state.
        seconds: of CPU time; of elapsed time with several processes.
        jobs: processes that work on the parts of divided states.
    """
    certifier = certifier_of(problem)
    upper = multiplier / problem.unit_multiplier
    found = bracket(equations_of(problem, jobs), upper, seconds, certify=certifier)
    found.refused = certifier.refused
    return found, certificate_of(problem, multiplier, mechanism, certifier)


def certifier_of(problem: Problem) -> Certifier:
    """What keeps the certificate of a search for the bracket of a problem."""
    return Certifier(wall_document(problem.assembly, problem.unit_force), _scales_of(problem), equations_of(problem))


def certificate_of(
    problem: Problem, multiplier: float, mechanism: FloatArray, certifier: Certifier
) -> dict[str, Any] | None:
    """The certificate of what a search has proved, None if that is nothing, with the state if it exists in fractions.

    Args:
        problem: of the search; multiplier, mechanism: of the state; certifier: of the search.
    """
    if not certifier.documents:
        return None
    document = wall_document(problem.assembly, problem.unit_force)
    rates = problem.rates_of_velocities(problem.from_mechanism(mechanism), False)
    exact, state = with_state(document, multiplier, moving_contacts(rates))
    bound = min(certifier.bound, exact)
    document |= state | {"bound": _short(bound, exact), "windows": certifier.documents}
    if certifier.cases is not None:
        document["cases"] = certifier.cases.document()
    document["digest"] = digest(document)
    return document


def _scales_of(problem: Problem) -> Scales:
    """From the scaled wall to that of a certificate."""
    assembly = problem.assembly
    length = np.linalg.norm(assembly.end2 - assembly.end1, axis=1)
    velocity = np.tile([1.0, 1.0, 1.0 / problem.unit_length], assembly.n_free)
    return Scales(length, velocity, problem.unit_multiplier, problem.live_work)


def _short(bound: Fraction, state: Fraction) -> str:
    """A decimal fraction that is not above the bound."""
    places = 10**12
    return str(Fraction(bound.numerator * places // bound.denominator, places)) if bound != state else str(bound)
