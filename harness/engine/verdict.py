"""Results compared with references and with statements of theory."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from harness.model.case import Reference, ReferenceType
from harness.model.comparison import CaseResults, ComparisonRun, Gate
from harness.model.details import AnswerDetails
from harness.model.displaced import DisplacedState
from harness.model.method import Finding, Status
from harness.model.proof import is_collapse_state
from harness.model.result import Comparison, Result, Verdict

_BOUND_TOLERANCE = 1e-6
"""Tolerance of bounds between methods, of the multiplier or of the unit of the load: solver accuracy, with a margin."""


def compare(reference: Reference, result: Result) -> Comparison:
    """How a result stands to one reference. Without a value that the judge accepts it does not agree."""
    value = _value(reference, result)
    verdict, sentence = _verdict(reference, result, value)
    return Comparison(
        reference=reference.id,
        quantity=reference.quantity,
        value=value,
        expected=list(reference.value) if isinstance(reference.value, tuple) else reference.value,
        tolerance=reference.tolerance,
        gate=reference.gate,
        verdict=verdict,
        sentence=sentence,
    )


def _value(reference: Reference, result: Result) -> float | list[float] | str | None:
    if reference.quantity == "multiplier":
        if reference.relation in ("inside", "contains") and result.bracket is not None:
            return list(result.bracket)
        return result.multiplier
    if reference.quantity == "finding":
        return str(result.finding)
    if reference.quantity in ("blocks", "interfaces", "unknowns"):
        count = getattr(result, reference.quantity)
        return None if count is None else float(count)
    return AnswerDetails(result.details).quantity(reference.quantity.removeprefix("details."))


def _verdict(reference: Reference, result: Result, value: float | list[float] | str | None) -> tuple[Verdict, str]:
    violated = Verdict.VIOLATES_BOUND if reference.type is ReferenceType.BOUND else Verdict.OUTSIDE_TOLERANCE
    if result.status is Status.REFUSED and AnswerDetails(result.details).missing_package:
        return Verdict.NOT_TESTED, f"not tested: {result.sentence}"
    if result.status is not Status.OK:
        return Verdict.OUTSIDE_TOLERANCE, f"no value: {result.status}. {result.sentence}"
    if value is None:
        return Verdict.OUTSIDE_TOLERANCE, f"no value: {result.finding}. {result.sentence}"
    if reference.quantity in ("multiplier", "finding") and not result.judge.accepted:
        said = "the judge rejects the answer" if result.judge.accepted is False else "the answer is not judged"
        return Verdict.OUTSIDE_TOLERANCE, f"{said}: {result.judge.sentence}"
    expected = reference.value
    if isinstance(value, str) or isinstance(expected, str):
        return (
            (Verdict.AGREES, f"{value}, as required")
            if value == expected
            else (violated, f"{value} instead of {expected}")
        )
    ends = value if isinstance(value, list) else [value, value]
    slack = reference.tolerance
    if isinstance(expected, tuple):
        holds = ends[0] >= expected[0] - slack and ends[1] <= expected[1] + slack
    elif reference.relation == "contains":
        holds = ends[0] - slack <= expected <= ends[1] + slack
    elif reference.relation == "at_most":
        holds = ends[1] <= expected + slack
    elif reference.relation == "at_least":
        holds = ends[0] >= expected - slack
    else:
        holds = abs(ends[0] - expected) <= slack
    if isinstance(expected, tuple):
        difference = f"{_text(value)} in [{expected[0]:.7g}, {expected[1]:.7g}]"
    elif isinstance(value, float | int):
        difference = f"{value:.9g} - {expected:.9g} = {value - expected:+.2g}"
    else:
        difference = f"{_text(value)} for {expected:.9g}"
    return (Verdict.AGREES if holds else violated), f"{difference}, tolerance {slack:.2g}"


def _text(value: float | list[float]) -> str:
    return f"[{value[0]:.7g}, {value[1]:.7g}]" if isinstance(value, list) else f"{value:.9g}"


def overall(comparisons: Iterable[Comparison]) -> Verdict:
    """The worst verdict of several, NO_REFERENCE if there are none."""
    order = [
        *(Verdict.NO_REFERENCE, Verdict.NOT_TESTED, Verdict.AGREES),
        *(Verdict.OUTSIDE_TOLERANCE, Verdict.VIOLATES_BOUND),
    ]
    return max((comparison.verdict for comparison in comparisons), key=order.index, default=Verdict.NO_REFERENCE)


def _is_the_least_known(result: Result) -> bool:
    """Whether a result is of a family's main method that seeks the least state, and ended its search."""
    return result.traits.seeks_least and result.is_main and not AnswerDetails(result.details).stopped_by_limit


def _bounds_above(result: Result) -> bool:
    """Whether its multiplier bounds all others: by its mechanism, not by what the method says of itself alone."""
    return result.traits.bounds_above and (result.flow == "associated" or not result.finding.has_multiplier)


def _bounds_below_states(results: CaseResults, unit: float) -> list[Gate]:
    """The gates of lower bounds that methods say they found in floating point: no collapse state lies below."""
    states = [item for item in results.results if is_collapse_state(item)]
    least = min(states, key=lambda item: item.multiplier or 0.0, default=None)
    if least is None or least.multiplier is None:
        return []
    said = [(item.method, AnswerDetails(item.details).lower_bound or 0.0) for item in results.results]
    return [
        Gate(
            name=f"{method}-bounds-below",
            statement="no collapse state lies below the lower bound that a method says it found",
            passed=bound <= least.multiplier + _BOUND_TOLERANCE * max(unit, abs(bound)),
            sentence=f"{method} bounds at {bound:.9g}, {least.method} {least.multiplier:.9g}",
        )
        for method, bound in sorted(said)
        if bound > 0.0
    ]


def theory_gates(results: CaseResults) -> list[Gate]:
    """The statements of limit analysis that tie the methods' answers on one case together.

    Sources: bounds of associated limit analysis hold for every state in equilibrium within yield (Drucker 1954;
    Livesley 1978 for masonry); a finite-element plateau is a collapse state (Baggio and Trovalusci 1995).
    """
    usable = {
        result.method: result for result in results.results if result.status is Status.OK and result.judge.accepted
    }
    gates: list[Gate] = []
    unit = _unit(results)

    def below(name: str, statement: str, lower: Result, upper: Result | None, *, of_search: bool = False) -> None:
        if upper is None:
            return
        value = lower.multiplier if lower.bracket is None else lower.bracket[0]
        limit = upper.multiplier if upper.bracket is None else upper.bracket[1]
        if value is None or limit is None:
            return
        open_left = sum(item.judge.multiplier_error or 0.0 for item in (lower, upper))
        slack = (_BOUND_TOLERANCE + lower.traits.held_accuracy) * max(unit, abs(limit)) + open_left
        gates.append(
            Gate(
                name=name,
                statement=statement,
                passed=value <= limit + slack,
                sentence=f"{lower.method} {value:.9g}, {upper.method} {limit:.9g}",
                of_search=of_search,
            )
        )

    bounding = next((usable[name] for name in sorted(usable) if _bounds_above(usable[name])), None)
    seeking = [item for item in usable.values() if _is_the_least_known(item)]
    least = seeking[0] if seeking else None
    for method in sorted(usable):
        result = usable[method]
        if _bounds_above(result) or DisplacedState.of(result.details) is not None:
            continue
        if result.traits.brackets:
            statement = "a held state is in equilibrium within yield, so it lies below the associated maximum"
            below(f"{result.family}-held-below-associated", statement, result, bounding)
        else:
            statement = "every collapse state lies below the associated maximum"
            below(f"{method}-below-associated", statement, result, bounding)
        for seeker in seeking:
            if result is not seeker and not result.traits.brackets:
                statement = "the search for the least collapse state finds none above another method's"
                below(f"{seeker.method}-below-{method}", statement, seeker, result, of_search=True)
    gates += _bounds_below_states(results, unit)
    gates += [gate for gate in (_moves_no_lower(results, usable, usable[name]) for name in sorted(usable)) if gate]
    # one that takes brittle joints as broken says nothing of the wall as it stands
    no_equilibrium = bounding or (None if least is not None and AnswerDetails(least.details).broken else least)
    if no_equilibrium is not None and no_equilibrium.finding is Finding.FALLS:
        for method, result in usable.items():
            if result.finding is Finding.FALLS:
                continue
            gates.append(
                Gate(
                    name=f"{method}-falls-without-equilibrium",
                    statement="where no equilibrium exists under dead load no method may find one",
                    passed=False,
                    sentence=f"limit analysis finds no equilibrium, {method} says {result.finding}",
                )
            )
    return gates


def _moves_no_lower(results: CaseResults, usable: dict[str, Result], moved: Result) -> Gate | None:
    """The gate of a method that measures at which load rigid blocks on even faces move, where theory knows the least.

    Every block order and history then comes to rest below it. A wall that falls under its dead load moves at zero.
    """
    if not moved.traits.moves_no_lower:
        return None
    known, why = _unique(results, usable)
    value = 0.0 if moved.finding is Finding.FALLS else AnswerDetails(moved.details).lowest_moving
    if known is None or known.multiplier is None or value is None:
        return None
    slack = moved.traits.accuracy * abs(known.multiplier) + _BOUND_TOLERANCE
    return Gate(
        name=f"{moved.method}-moves-no-lower",
        statement=f"no wall moves below the least multiplier, and {why}",
        passed=value >= known.multiplier - slack,
        sentence=f"{moved.method} moved at {value:.9g}, {known.method} {known.multiplier:.9g}",
    )


def _unique(results: CaseResults, usable: dict[str, Result]) -> tuple[Result | None, str]:
    """The state below which no wall of this case moves, and why; None where theory does not know one."""
    collapses = [result for result in usable.values() if result.finding.has_multiplier]
    proved = next((result for result in collapses if AnswerDetails(result.details).proved_least), None)
    if proved is not None:
        return proved, f"{proved.method} shows that there is none lower"
    least = next((result for result in collapses if result.traits.seeks_least and result.is_main), None)
    bounding = next((result for result in collapses if _bounds_above(result)), None)
    if least is None or bounding is None or least.multiplier is None or bounding.multiplier is None:
        return None, ""
    equal = abs(bounding.multiplier - least.multiplier) <= _BOUND_TOLERANCE * max(
        _unit(results), abs(bounding.multiplier)
    )
    if not equal or _slips(results, least) or _slips(results, bounding):
        return None, ""
    return least, "where nothing slides the associated maximum is the only one"


def _unit(results: CaseResults) -> float:
    """What is small of a multiplier of this case: see `Assembly.load_unit`; one where its wall is not known."""
    return 1.0 if results.case.assembly is None else results.case.assembly.load_unit


def _slips(results: CaseResults, result: Result) -> bool:
    """Whether a joint slides in the mechanism of a result, or it has none to show that none does."""
    if result.mechanism is None or results.case.assembly is None:
        return True
    wall, motion = results.case.assembly, np.asarray(result.mechanism, dtype=float)
    rates = (wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3)
    return bool(np.abs(rates[:, 2]).max(initial=0.0) > _BOUND_TOLERANCE * np.abs(rates).max(initial=0.0))


def violations(compared: ComparisonRun) -> list[str]:
    """Sentences about checked references and statements of theory that are not met, and about rejected answers.

    A comparison in which no run ended with an answer says so too: it shows nothing.
    """
    found = []
    if not any(result.status is Status.OK for case in compared.cases for result in case.results):
        found.append("no run ended with an answer")
    for case in compared.cases:
        for result in case.results:
            if result.judge.accepted is False:
                found.append(f"{case.case.id}, {result.method}: the judge rejects the answer: {result.judge.sentence}")
            for comparison in result.comparisons:
                if comparison.gate and comparison.verdict not in (Verdict.AGREES, Verdict.NOT_TESTED):
                    found.append(f"{case.case.id}, {result.method}: {comparison.reference}: {comparison.sentence}")
        for gate in case.gates:
            if gate.passed is False:
                found.append(f"{case.case.id}: {gate.name}: {gate.statement}, but {gate.sentence}")
    return found
