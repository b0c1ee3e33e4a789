"""What is proved of a collapse state, in words: the minimum, the minimum to rounding, or the least that is known.

This is the one place that decides it. Report, appendix, CSV, JSON, terminal and library print what it says.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_FLOOR, Context
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from harness.model.comparison import refusal
from harness.model.details import AnswerDetails
from harness.model.method import Status

if TYPE_CHECKING:
    from harness.model.comparison import CaseResults
    from harness.model.result import Result


from fractions import Fraction

_CERTIFIED = 3e-6
"""Relative height above a certified bound up to which a state is called the minimum: certificates leave 2e-6, and the
rest is for rounding of the state."""
_EQUAL = 1e-9
"""Relative difference of multipliers of one state that two methods found."""


class Standing(StrEnum):
    """How the multiplier of a collapse state stands to the minimum over all collapse states."""

    MINIMUM = "minimum"
    TO_ROUNDING = "minimum_to_rounding"
    KNOWN = "least_known"
    NONE = "none"


LABELS = {
    Standing.MINIMUM: "minimum, proved",
    Standing.TO_ROUNDING: "least, to rounding",
    Standing.KNOWN: "least known",
    Standing.NONE: "",
}


@dataclass(frozen=True)
class Proof:
    """What is proved of one result.

    Attributes:
        standing: of its multiplier.
        bound: no collapse state lies from zero to below it, proved in fractions; None where no certificate is known.
        lower_bound: the same in floating point, from a search; None where it is zero or not above `bound`.
        by: the method that says so in floating point, of `lower_bound` and of a minimum to rounding.
        refused: what is said of the certificate that the method handed on, where it is refused.
    """

    standing: Standing = Standing.NONE
    bound: float | None = None
    lower_bound: float | None = None
    by: str = ""
    refused: str = ""

    @property
    def label(self) -> str:
        """What the multiplier is called, in a few words; empty for what is no least collapse state."""
        return LABELS[self.standing]

    @property
    def clause(self) -> str:
        """What is known of lower collapse states; empty for what is no least collapse state."""
        if self.standing is Standing.NONE:
            return ""
        if self.standing is Standing.MINIMUM and self.bound is not None:
            return f"an exact certificate proves that no collapse state lies {_excluded(self.bound)}"
        if self.standing is Standing.TO_ROUNDING:
            return f"{self.by} finds in floating point that no collapse state lies below it"
        known = [] if self.bound is None else [f"none lies {_excluded(self.bound)}, by an exact certificate"]
        if self.lower_bound is not None:
            known.append(f"{self.by} finds none below {_rounded_down(self.lower_bound)}, to rounding")
        return "; ".join(["a lower collapse state is not excluded", *known])

    @property
    def sentence(self) -> str:
        """The same as a sentence, and a second one where a certificate is refused."""
        known = "" if not self.clause else f"{self.label[0].upper()}{self.label[1:]}: {self.clause}."
        return f"{known} {self.refused}".strip()

    def as_json(self) -> dict[str, Any]:
        """As JSON values."""
        values = {"standing": str(self.standing), "bound": self.bound, "lower_bound": self.lower_bound}
        return values | {"sentence": self.sentence}


def _excluded(bound: float) -> str:
    """The multipliers that a certificate of this bound excludes, in words."""
    return f"from zero to below {_rounded_down(bound)}"


def _rounded_down(bound: float) -> str:
    """A lower bound to seven digits, rounded downwards so that the printed number is a bound too."""
    return f"{Context(prec=7, rounding=ROUND_FLOOR).create_decimal(bound).normalize():f}"


def is_collapse_state(result: Result) -> bool:
    """Whether a result is a collapse state without dilatancy that the judge accepts and holds closely.

    A method may ask the judge for a tolerance of a hundredth of the loads. A state that is known no better than that
    is no least one beside states to rounding, and takes no proof from them.
    """
    worst = result.judge.worst
    return (
        result.status is Status.OK
        and result.finding.has_multiplier
        and result.judge.accepted is True
        and result.flow == "non-associated"
        and result.multiplier is not None
        and (worst is None or worst[1] <= _CERTIFIED)
    )


def least_known(item: CaseResults) -> Result | None:
    """The least accepted collapse state without dilatancy, whichever method found it.

    Of several that are equal to rounding it is one that is proved, then one of a method that seeks the least.
    """
    states = [result for result in item.results if is_collapse_state(result)]
    best = min((result.multiplier or 0.0 for result in states), default=0.0)
    near = [r for r in states if (r.multiplier or 0.0) <= best + _EQUAL * max(abs(best), 1e-300)]

    def rank(result: Result) -> tuple[bool, bool, str]:
        return not AnswerDetails(result.details).proved_least, not result.traits.seeks_least, result.method

    return min(near, key=rank, default=None)


def proof_of(item: CaseResults, result: Result) -> Proof:
    """What is proved of a result, by a certificate that was checked here and by what the methods found to rounding.

    A bound that a method says it has certified counts only through its certificate: see `drystone.certificates`. What
    a method says in floating point is said in its name. Neither counts where a state is known that it excludes.

    Args:
        item: all results of the wall; result: one of them.
    """
    refused = refusal(result.method, item.refused[result.method]) if result.method in item.refused else ""
    if not is_collapse_state(result):
        return Proof(refused=refused)
    value = result.multiplier or 0.0
    least = min(each.multiplier or 0.0 for each in [*item.results, result] if is_collapse_state(each))
    bound = _certified_bound(item, value, least)
    sound = [each for each in item.results if each.status is Status.OK and each.judge.accepted is not False]
    floating = [(_said(each), each.method) for each in sound if _said(each) <= min(value, least)]
    lower, by = max(floating, key=lambda pair: pair[0], default=(0.0, ""))
    if bound is not None and value - bound <= _CERTIFIED * abs(value):
        return Proof(Standing.MINIMUM, bound, refused=refused)
    if AnswerDetails(result.details).proved_least and value <= least + _EQUAL * abs(least):
        return Proof(Standing.TO_ROUNDING, bound, by=result.method, refused=refused)
    if result is not least_known(item):
        return Proof(refused=refused)
    above = lower > max(0.0, bound or 0.0)
    return Proof(Standing.KNOWN, bound, lower if above else None, by if above else "", refused)


def _certified_bound(item: CaseResults, value: float, least: float) -> float | None:
    """What a certificate proves below a state of this value; None where it says nothing of it or is contradicted."""
    known = item.certified
    if known is None or known.bound > value or value <= 0.0:
        return None
    return None if known.bound - least > _CERTIFIED * abs(known.bound) else known.bound


def _said(result: Result) -> float:
    """The lower bound that a method says it found in floating point; zero where it says none, or no number."""
    return AnswerDetails(result.details).lower_bound or 0.0


SHORT, SHOWN = 9, 40
"""Characters of a fraction up to which a sentence shows it alone, and beside its value."""


def in_words(value: Fraction) -> str:
    """A multiplier as a fraction where that is short, else as a decimal: all of it, or cut off after twelve decimals.

    A bound has twelve, so that the state above it is not shown below it.

    >>> in_words(Fraction(7, 11)), in_words(Fraction(499999, 1250000)), in_words(Fraction(-499999, 1250000))
    ('7/11', '0.3999992', '-0.3999992')
    >>> in_words(Fraction(1567589759, 2809311829))
    '0.557997778252 (1567589759/2809311829)'
    """
    if len(str(value)) <= SHORT:
        return str(value)
    below = value.numerator * 10**12 // value.denominator
    whole, part = divmod(abs(below), 10**12)
    decimal = f"{'-' if below < 0 else ''}{whole}.{part:012d}".rstrip("0").rstrip(".")
    return f"{decimal} ({value})" if 10**12 % value.denominator and len(str(value)) <= SHOWN else decimal
