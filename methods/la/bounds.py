"""A lower bound for the answer of a search: by the tree where that ended, else by windows, with its certificate."""

from __future__ import annotations

import json
import time
from dataclasses import replace
from fractions import Fraction
from typing import Any

from harness.model.answer_check import DEEPEST
from harness.model.assembly import Assembly
from harness.model.json_text import nested_deeper
from harness.model.method import Answer, Finding, Status
from harness.model.proof import in_words
from methods.la.certify.window_certificate import certified_bracket
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.family import LimitAnalysisFamily
from methods.la.find_certificate import account, beyond, certificate
from methods.la.least import SAME_MULTIPLIER, least_known
from methods.la.methods import LA_BOUND
from methods.la.settings import BoundSettings
from methods.proof.search.options import PROVED
from methods.proof.search.window_search import Bracket
from methods.proof.verify.checker import verify
from methods.springs.warm_up import load_kernels


def with_bound(assembly: Assembly, problem: Problem, known: Answer, settings: BoundSettings) -> Answer:
    """The answer of a search with what is proved below its state, within the seconds of the settings.

    The tree gives the certificate where it ended and its leaves exist in fractions, else windows do.

    Args:
        assembly: a wall of one component; problem: the same, scaled.
        known: the answer of the whole search.
        settings: time and size of the bound.
    """
    multiplier = known.multiplier
    if known.status is not Status.OK or known.finding is not Finding.COLLAPSES or multiplier is None:
        return known
    if known.details.get("stopped_by_limit"):
        return known
    if assembly.dilates or assembly.strong:
        own, why = (
            known.sentence.rstrip("."),
            "some joints have dilatancy" if assembly.dilates else "joints have strength",
        )
        if assembly.is_bar.any():
            why = "the wall has ties or props"
        return replace(known, sentence=f"{own}. No bound below it is sought: {why}.")
    began = time.process_time()
    document = None
    if known.details["proved_least"]:
        document = certificate(assembly, seconds=settings.bound_seconds, mechanism=known.mechanism)
    if document is not None or multiplier <= 0.0:
        return _kept(certified(known, document), settings)
    too_large = beyond(problem, settings.most_interfaces)
    if too_large:
        return replace(known, sentence=f"{known.sentence} {too_large}")
    assert known.mechanism is not None
    left = settings.bound_seconds - (time.process_time() - began)
    found, document = certified_bracket(problem, multiplier, known.mechanism, left)
    said = account(problem, multiplier, found, document, time.process_time() - began)
    if said and known.details["proved_least"]:
        return known
    answer = certified(bounded(problem, known, found), document)
    return _kept(replace(answer, sentence=f"{answer.sentence} {said}".rstrip()), settings)


def _kept(answer: Answer, settings: BoundSettings) -> Answer:
    """The answer, without its certificate where that is too long, or nested too deeply, for an answer to hold it."""
    document = answer.details.get("certificate")
    if document is None:
        return answer
    if len(json.dumps(document)) <= settings.largest_certificate and not nested_deeper(document, DEEPEST - 1):
        return answer
    return replace(answer, details={k: v for k, v in answer.details.items() if k != "certificate"})


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
    lower, shown = verify(document)
    upper = Fraction(known.multiplier) if shown is None else shown
    if lower < upper * (1 - Fraction(PROVED)):
        return replace(
            known,
            sentence=f"The least collapse multiplier known is {known.multiplier:.7g}; there is none from zero to below "
            f"{float(lower):.7g}, proved in fractions.",
            details=known.details | {"certificate": document, "certified_bound": float(lower)},
        )
    if abs(float(upper) - known.multiplier) > SAME_MULTIPLIER * max(abs(known.multiplier), SAME_MULTIPLIER):
        return known
    state = "" if "state" in document else " (its forces to rounding)"
    sentence = (
        f"The minimum collapse multiplier is {in_words(upper)} to two millionths, proved in fractions: "
        f"there is a collapse state there{state}, and none below {float(lower):.9g}."
    )
    details = known.details | {"certificate": document, "certified_bound": float(lower)}
    return replace(known, sentence=sentence, details=details)


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
        sentence = f"{least}; no lower bound above zero was found."
    return replace(known, sentence=sentence, details=details)


load_kernels()


class BoundedLimitAnalysis(LimitAnalysisFamily):
    """The state of `la`, and a multiplier below which there is no collapse state (`la-bound`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The search of `la`, then windows on the multiplier below its state."""
        known = least_known(problem, newton, settings.search(), LA_BOUND.tolerance)
        return with_bound(assembly, problem, known, settings)
