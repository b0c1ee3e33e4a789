"""The words and glyphs of the report: one place, so that tables, drawings and figures say the same thing."""

from __future__ import annotations

from collections.abc import Iterable

from harness.model.case import ReferenceType
from harness.model.comparison import CaseResults
from harness.model.library import library
from harness.model.method import Finding, Status
from harness.model.result import Result, Verdict

VERDICT: dict[Verdict, tuple[str, str]] = {
    Verdict.AGREES: ("✓", "agrees"),
    Verdict.OUTSIDE_TOLERANCE: ("≠", "outside tolerance"),
    Verdict.VIOLATES_BOUND: ("▲", "violates a bound"),
    Verdict.NO_REFERENCE: ("·", "no reference"),
    Verdict.NOT_TESTED: ("·", "not tested"),
}

STATUS: dict[Status, tuple[str, str]] = {
    Status.OK: ("", "ok"),
    Status.NOT_CONVERGED: ("~", "not converged"),
    Status.REFUSED: ("⊘", "refused"),
    Status.TIMEOUT: ("…", "timeout"),
    Status.OUT_OF_MEMORY: ("■", "out of memory"),
    Status.CRASHED: ("✗", "crashed"),
}

FINDING: dict[Finding, str] = {
    Finding.COLLAPSES: "collapses",
    Finding.STANDS: "stands",
    Finding.FALLS: "falls under its dead load",
    Finding.AT_LIMIT: "at its limit under its dead load",
    Finding.UNBOUNDED: "no collapse: unbounded",
    Finding.NONE: "nothing found",
}

STATE_LETTER: dict[str, str] = {"stick": "k", "slip": "s", "rock": "r", "open": "o"}

PURPOSE: dict[str, tuple[str, tuple[ReferenceType, ...], str]] = {
    "Verification": (
        "Verification: does each method solve its own equations?",
        (ReferenceType.EXACT, ReferenceType.BOUND),
        "Closed forms and proved bounds. A value outside its tolerance here is a fault of the programme.",
    ),
    "Benchmark": (
        "Benchmark: do others compute the same?",
        (ReferenceType.PUBLISHED,),
        "Values computed by others. A difference asks for an explanation; the fault may be on either side.",
    ),
    "Validation": (
        "Validation: does the model describe the wall?",
        (ReferenceType.MEASURED,),
        "Values found by experiments. They judge the model of rigid blocks in dry contact, not the programme.",
    ),
    "Regression": (
        "Regression: our own earlier values",
        (ReferenceType.REGRESSION,),
        "Values of an earlier release of this programme. They prove nothing; they show that something moved.",
    ),
}


def order(result: Result) -> tuple[int, bool, str]:
    """Sort key of results: families in the library's order, a family's main method first."""
    return library().order(result.method, result.family)


def in_order(item: CaseResults) -> list[Result]:
    """The results of a case in the order of `order`."""
    return sorted(item.results, key=order)


def all_of(names: Iterable[str]) -> str:
    """Names of methods in capitals, as "FE, LA and DE"."""
    return and_([name.upper() for name in names])


def and_(parts: list[str]) -> str:
    """Parts of a list in words, as "a, b and c"."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"
