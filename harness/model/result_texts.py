"""A result in a few words of plain text: its answer, its references, the residual, its settings."""

from __future__ import annotations

import json
import math
from typing import Any

from harness.model.method import Finding, Status
from harness.model.result import Result, Verdict, plastic_of, residual_of

PROVED = "∎"
"""Before the multiplier of a proved minimum."""
VERDICT_TEXTS: dict[Verdict, str] = {
    Verdict.AGREES: "✓ agrees",
    Verdict.NOT_TESTED: "· not tested",
    Verdict.OUTSIDE_TOLERANCE: "✗ outside tolerance",
    Verdict.VIOLATES_BOUND: "✗ violates bound",
    Verdict.NO_REFERENCE: "· no reference",
}


def answer_text(result: Result) -> str:
    """The multiplier, the bracket of a measured one, the finding, or how the run ended."""
    if result.status is not Status.OK:
        return str(result.status).replace("_", " ")
    if result.finding is not Finding.COLLAPSES:
        return str(result.finding)
    if result.traits.brackets and result.bracket is not None:
        return f"[{_number(result.bracket[0], 5)}, {_number(result.bracket[1], 5)}]{result.width_in_words}"
    if result.multiplier is None:
        return "-"
    return f"{_number(result.multiplier, 7, result.judge.decimals)}{bound_in_words(result)}"


def bound_in_words(result: Result) -> str:
    """That a multiplier is an upper bound of those without dilatancy, in brackets; empty where it is not.

    So is that of a method which says so, and that of any state of associated flow.
    """
    bound = result.traits.bounds_above or result.flow == "associated"
    return " (upper bound)" if bound and result.finding is Finding.COLLAPSES else ""


def strength_in_words(result: Result) -> str:
    """What is counted of the strength of joints in a result, behind a comma; empty where it has no other beside it."""
    if residual_of(result) is not None:
        return ", with the strength of the joints"
    return "" if plastic_of(result) is None else ", without the strength of brittle joints"


def _number(value: float, decimals: int, known: int | None = None) -> str:
    """A multiplier with so many decimals; by powers of ten where those would show nothing or pretend too much.

    Args:
        value: the multiplier.
        decimals: as many at most.
        known: as many are within its error; None: nothing is known of it.
    """
    usual = value == 0.0 or 1e-3 <= abs(value) < 1e6
    if known is not None:
        decimals = max(0, min(decimals, known if usual else known + math.floor(math.log10(abs(value)))))
    return f"{value:.{decimals}f}" if usual else f"{value:.{decimals}e}"


def references_text(result: Result) -> str:
    """The values of references that the multiplier or the finding is compared with."""
    shown = []
    for comparison in result.comparisons:
        if comparison.quantity not in ("multiplier", "finding"):
            continue
        expected = comparison.expected
        if isinstance(expected, list):
            text = f"[{expected[0]:.5g}, {expected[1]:.5g}]"
        else:
            text = expected if isinstance(expected, str) else f"{expected:.7g}"
        own = (result.multiplier, list(result.bracket or ()), str(result.finding))
        shown.append(text if comparison.value in own else f"{text} (other settings)")
    return ", ".join(dict.fromkeys(shown))


def settings_text(values: dict[str, Any]) -> str:
    """Names and values in one line."""
    return ", ".join(
        f"{name} = {value if isinstance(value, str) else json.dumps(value, default=str, ensure_ascii=False)}"
        for name, value in values.items()
    )
