"""The least state known and a lower bound on every other, as the harness knows it."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status
from methods.bound.exact_wall import CertificateError
from methods.bound.same_wall import require_same_wall
from methods.bound.tuning import PRECISION, WINDOWS
from methods.bound.verify import verify
from methods.bound.window_search import Bracket
from methods.la.certify.tree_certificate import certificate
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.search_settings import SearchSettings
from methods.la.declared_la import DeclaredBound
from methods.la.family import LimitAnalysisFamily
from methods.la.least import SAME_MULTIPLIER, least_known
from methods.numerics.statics import analysed
from methods.springs.warm_up import load_kernels

load_kernels()


class BoundedLimitAnalysis(LimitAnalysisFamily, DeclaredBound):
    """The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """The answer of the component that fails first, with the least of the bounds of all components."""
        parts: list[Answer] = []

        def solve_part(part: Assembly) -> Answer:
            parts.append(self._of_component(part, settings))
            return parts[-1]

        answer = _of_this_wall(analysed(assembly, solve_part), assembly)
        if len(parts) == 1 or answer.finding is not Finding.COLLAPSES or answer.multiplier is None:
            return answer
        bounds = [part.details.get("lower_bound", 0.0) for part in parts if part.finding is not Finding.STANDS]
        lower = min(bounds)
        proved = all(part.details.get("proved_least", False) for part in parts if part.finding is not Finding.STANDS)
        return replace(answer, details=answer.details | {"lower_bound": lower, "proved_least": proved})

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The search of `la`, then windows on the multiplier below its state."""
        known = least_known(problem, newton, settings.search(), self.tolerance)
        multiplier = known.multiplier
        if known.status is not Status.OK or known.finding is not Finding.COLLAPSES or multiplier is None:
            return known
        if known.details.get("stopped_by_limit"):
            return known
        if known.details["proved_least"]:
            return certified(known, certificate(assembly, seconds=settings.seconds))
        if multiplier <= 0.0 or problem.n_interfaces > settings.most_interfaces:
            return known
        assert known.mechanism is not None
        found, document = certified_bracket(problem, multiplier, known.mechanism, settings.seconds)
        answer = certified(bounded(problem, known, found), document)
        if document is not None and len(json.dumps(document)) > settings.largest_certificate:
            return replace(answer, details={k: v for k, v in answer.details.items() if k != "certificate"})
        return answer


def certified(known: Answer, document: dict[str, Any] | None) -> Answer:
    """The answer of `la` with a certificate that its state is the least; unchanged where there is none for it.

    Args:
        known: a collapse.
        document: the certificate, or None.

    Raises:
        CertificateError: it proves nothing.
    """
    if document is None or known.multiplier is None:
        return known
    lower, upper = verify(document)
    if lower < upper * (1 - Fraction(WINDOWS.proved)):
        return replace(
            known,
            sentence=f"The least collapse multiplier known is {known.multiplier:.7g}; there is none from zero to below "
            f"{float(lower):.7g}, proved in fractions.",
            details=known.details | {"certificate": document, "certified_bound": float(lower)},
        )
    if abs(float(upper) - known.multiplier) > SAME_MULTIPLIER * max(abs(known.multiplier), SAME_MULTIPLIER):
        return known
    exact = str(upper) if len(str(upper)) <= PRECISION.shown else f"{float(upper):.9g}"
    state = "" if "state" in document else " (its forces to rounding)"
    sentence = (
        f"The minimum collapse multiplier is {exact} to two millionths, proved in fractions: "
        f"there is a collapse state there{state}, and none below {float(lower):.9g}."
    )
    details = known.details | {"certificate": document, "certified_bound": float(lower)}
    return replace(known, sentence=sentence, details=details)


def find_certificate(
    assembly: Assembly, nodes: int, seconds: float, search: SearchSettings | None = None
) -> dict[str, Any] | None:
    """The certificate of the tree where that ends, else of windows; None where neither proves anything.

    Args:
        assembly: a wall of one component, which stands under its dead load.
        nodes: of the tree at most.
        seconds: of CPU time for the windows.
        search: of the state below which the windows lie.
    """
    document = certificate(assembly, nodes)
    if document is not None or not assembly.has_live_load:
        return document
    problem = make_problem(assembly)
    known = least_known(problem, NewtonMatrix(problem), search or SearchSettings(), BoundedLimitAnalysis.tolerance)
    if known.finding is not Finding.COLLAPSES or known.mechanism is None or not (known.multiplier or 0.0) > 0.0:
        return None
    assert known.multiplier is not None
    return certified_bracket(problem, known.multiplier, known.mechanism, seconds)[1]


def _of_this_wall(answer: Answer, assembly: Assembly) -> Answer:
    """The answer without a certificate that is of one component of the wall only."""
    document = answer.details.get("certificate")
    if document is None:
        return answer
    try:
        require_same_wall(document, assembly)
    except CertificateError:
        details = {k: v for k, v in answer.details.items() if k not in ("certificate", "certified_bound")}
        sentence = f"The least collapse multiplier is {answer.multiplier:.7g}, by branch and bound."
        return replace(answer, sentence=sentence, details=details)
    return answer


def bounded(problem: Problem, known: Answer, found: Bracket) -> Answer:
    """The answer of `la` with the bracket, which holds to rounding and is therefore not called a proof."""
    lower = max(found.lower * problem.unit_multiplier, float(known.details["lower_bound"]))
    details = known.details | {
        "lower_bound": lower,
        "bound_windows": [value * problem.unit_multiplier for value in found.windows],
        "bound_iterations": found.iterations,
        "bound_closed": found.closed,
    }
    least = f"The least collapse multiplier known is {known.multiplier:.7g}"
    if found.closed:
        sentence = f"{least}; a relaxation solved in floating point leaves none below {lower:.7g}."
    elif lower > 0.0:
        sentence = f"{least}; the least is at least {lower:.7g}, by a relaxation solved in floating point."
    else:
        sentence = f"{least}; in this time no lower bound above zero was found."
    return replace(known, sentence=sentence, details=details)
