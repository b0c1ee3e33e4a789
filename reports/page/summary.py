"""What the page says of its walls: findings in sentences, the number to use, and all that went wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.errors import first_few
from harness.model.live_load import direction_in_words
from harness.model.method import Status
from harness.model.proof import least_known, proof_of
from harness.model.ranges import percent_text
from harness.model.result import Result, Verdict, bears_less_with_strength, plastic_and_residual_of
from reports.charts.overview import AGREE
from reports.drawing.display_list import DisplayList
from reports.drawing.mechanism_drawing import mechanism_drawing, overlay_drawing
from reports.findings.agreement import agreement, mains, spread
from reports.findings.joints import joints_in_words, motion
from reports.findings.reasons import mechanism_in_words
from reports.findings.strength import least_safe
from reports.geometry import shapes
from reports.labels import labels, numbers
from reports.labels.wall_summary import friction_text, value_in_words
from reports.memo import memo
from reports.page import paper
from reports.page.tables import anchor_of

_JOINTS_OF_ONE = "Joints that slide (red) or open (violet) in one of them only are marked, those of the second dashed."


@dataclass(frozen=True)
class _RedRow:
    """A run, or a statement of theory, that a reader has to know of.

    Attributes:
        anchor: where it stands in the page.
        name: case and method.
        what: what is wrong with it.
    """

    anchor: str
    name: str
    what: str


@dataclass(frozen=True)
class _Summary:
    """The sentences of the first screen.

    Attributes:
        findings: sentences.
        advice: which number to use; empty where there is more than one wall.
        red: every run and statement that went wrong, by name.
    """

    findings: list[str]
    advice: str
    red: list[_RedRow]


def summary(run: ComparisonRun, governs: CaseResults | None = None, unanswered: Sequence[str] = ()) -> _Summary:
    """The sentences of a comparison: of one wall, or of a suite.

    Args:
        run: the comparison.
        governs: the load case that governs its only wall; None of several walls.
        unanswered: names of load cases of that wall without an accepted answer.
    """
    items = [item for item in run.cases if not shapes.problem(item.case)]
    found, missed = _broken_theory(run)
    governing = governs or (items[0] if len(run.cases) == len(items) == 1 else None)
    advice = "" if governing is None else which_number(governing, unanswered)
    if governing is None:
        found.extend(_suite(items))
    elif least_known(governing) is None:
        found.append(wall_findings(governing))
    return _Summary([*found, *missed], advice, _red_rows(run))


@memo
def run_in_order(run: ComparisonRun) -> ComparisonRun:
    """The comparison with its cases in the order of the page."""
    return replace(run, cases=in_order(run.cases))


def in_order(items: list[CaseResults]) -> list[CaseResults]:
    """Cases as a reader wants them: their own, the paper's, those on which methods differ or fail, the rest."""
    return sorted(items, key=_rank)


def is_calm(item: CaseResults) -> bool:
    """Whether a case is one of the rest: known from a source, with methods that agree and nothing that went wrong."""
    return _rank(item) == 3


def _rank(item: CaseResults) -> int:
    if shapes.problem(item.case) or not item.case.file.references:
        return 0  # nothing is known of it beforehand: a wall of the user's own
    if item.case.id in paper.printed().cases:
        return 1
    wrong = any(gate.passed is False for gate in item.gates) or any(_wrong(result) for result in item.results)
    return 2 if wrong or _apart(item) > AGREE else 3


def _red_rows(run: ComparisonRun) -> list[_RedRow]:
    """Failed and rejected runs, values that miss a reference, statements of theory that do not hold."""
    rows: list[_RedRow] = []
    for number, item in enumerate(run.cases):
        rows.extend(
            _RedRow(
                f"case-{number}",
                f"{item.case.id}, {'search' if gate.of_search else 'theory'}",
                f"{gate.statement}: not met ({gate.sentence})",
            )
            for gate in item.gates
            if gate.passed is False
        )
        for index, result in enumerate(item.results):
            what = _wrong(result)
            if what:
                rows.append(_RedRow(anchor_of(number, index), f"{item.case.id}, {result.method}", what))
    return rows


def _wrong(result: Result) -> str:
    if result.status is not Status.OK:
        return f"{labels.STATUS[result.status][1]}: {result.sentence}"
    if result.judge.accepted is False:
        return f"rejected by the judge: {result.judge.sentence}"
    missed = [c for c in result.comparisons if c.verdict in (Verdict.OUTSIDE_TOLERANCE, Verdict.VIOLATES_BOUND)]
    return "; ".join(f"{labels.VERDICT[c.verdict][1]} ({c.reference}): {c.sentence}" for c in missed)


def _broken_theory(run: ComparisonRun) -> tuple[list[str], list[str]]:
    """A sentence of walls on which a method is wrong, and one of those on which a search missed a state, if any."""
    failed = [(item.case.id, gate) for item in run.cases for gate in item.gates if gate.passed is False]
    wrong = ", ".join(dict.fromkeys(name for name, gate in failed if not gate.of_search))
    missed = "; ".join(f"{name} ({gate.sentence})" for name, gate in failed if gate.of_search)
    return (
        [f"Theory is violated on {wrong}: at least one method is wrong there."] if wrong else [],
        [f"The search for the least state missed one that another method reached: {missed}."] if missed else [],
    )


def wall_findings(item: CaseResults) -> str:
    """What was found of one wall, in a few sentences."""
    least, assembly = least_known(item), item.case.assembly
    answered = mains(item)
    others = ", ".join(f"{r.method.upper()} {value_in_words(r)}" for r in answered if r is not least)
    if least is None:
        answers = others or "no method gave an answer"
        return f"{item.case.id}: no collapse state without dilatancy was accepted ({answers})."
    called = f"{least.method.upper()}, {proof_of(item, least).label}"
    way = direction_in_words(item.case)
    under = f" under the live load {way}" if way in ("to the left", "to the right") else ""
    said = f"{item.case.id} collapses at {numbers.multiplier(least.multiplier)}{under}{_counting(item)} ({called})"
    sentences = [f"{said}{'; ' + others if others else ''}.", _agreement(item)]
    if least.mechanism is not None:
        mechanism = np.asarray(least.mechanism, dtype=float)
        joints = motion(assembly, least)
        how = mechanism_in_words(assembly, mechanism, item.case.wall.units.length)
        more = f"; {joints_in_words(joints)}" if joints is not None and joints_in_words(joints) else ""
        sentences.append(f"{how[0].upper()}{how[1:]}{more}.")
    associated = item.associated
    if associated is not None and _above(associated, least):
        sentences.append(f"Do not rely on the associated maximum {_height(associated, least)}.")
    return " ".join(filter(None, sentences))


def _counting(item: CaseResults) -> str:
    """What a multiplier counts of the strength of joints, after it; empty of dry joints."""
    if not item.case.assembly.strong:
        return ""
    return " as its joints break" if item.case.assembly.breaks else " with the strength of its joints"


def _above(second: Result, first: Result) -> bool:
    return (second.multiplier or 0.0) > (first.multiplier or 0.0) * (1.0 + 1e-6)


def _apart(item: CaseResults) -> float:
    """How far the families lie from each other at least."""
    return (spread(item) or (0.0, 0.0))[0]


def _agreement(item: CaseResults) -> str:
    """Whether the families agree on a wall; where they differ, whether the mechanism does."""
    apart = spread(item)
    if apart is None:
        return ""
    least, most = apart
    if most <= 1e-4:
        return "The methods agree."
    if most <= AGREE:
        return f"They lie within {100.0 * most:.2f} % of each other."
    if least <= AGREE:
        return f"A measured bracket does not decide whether they agree: they differ by {percent_text(least, most)}."
    why = _mechanisms(item)
    return f"They differ by {percent_text(least, most)}{': ' + why if why else ''}."


def _mechanisms(item: CaseResults) -> str:
    """Whether the least state and the highest of the other families' have one mechanism, joint by joint."""
    least = least_known(item)
    others = [
        r
        for r in mains(item)
        if r is not least and r.mechanism is not None and r.flow == "non-associated" and r.multiplier is not None
    ]
    if least is None or not others:
        return ""
    highest = max(others, key=lambda r: r.multiplier or 0.0)
    pair = agreement(item.case.assembly, least, highest)
    if pair.cosine is None or not _above(highest, least):
        return ""
    names = f"{least.method.upper()} and {highest.method.upper()}"
    if pair.same_mechanism:
        return f"the mechanism of {names} is the same, but equilibrium does not determine the forces"
    return f"the mechanisms of {names} differ"


def which_number(item: CaseResults, unanswered: Sequence[str] = ()) -> str:
    """Which multiplier to use for what, with the case's own numbers; none while a load case may govern unknown."""
    least, associated = least_known(item), item.associated
    lead, doubt = "For safety use", ""
    if unanswered and item.case.load_case:
        lead = "The least of the others is"
        doubt = (
            f"Which load case governs is not known: there is no accepted answer to {first_few(list(unanswered), 6)}."
        )
    if least is None:
        return doubt
    value = numbers.multiplier(least.multiplier)
    proof = proof_of(item, least)
    under = f" in load case {item.case.load_in_words}" if item.case.load_case else ""
    brittle = _without_strength(item, lead, under)
    known = f"{value} ({least.method}){'' if brittle else under}, {proof.label}: {proof.clause}."
    given = "As its joints break" if item.case.assembly.breaks else "With its strength"
    sentences = [doubt] * bool(doubt)
    sentences.append(f"{brittle} {given}: {known}" if brittle else f"{lead} {known}")
    springs = [r for r in mains(item) if r.traits.elastic and r is not least and r.multiplier is not None]
    if springs and springs[0].finding.has_multiplier:
        sentences.append(
            f"Elastic joints without self-stress would give {_or_the_same(springs[0], least)} ({springs[0].method})."
        )
    if associated is not None and _above(associated, least):
        sentences.append(
            f"Do not rely on {_height(associated, least)} ({associated.method}): its joints open as they slide."
        )
    return " ".join(sentences)


def _without_strength(item: CaseResults, lead: str, under: str) -> str:
    """The number to use for joints with cohesion or tensile strength, which are brittle in mortar; empty for others."""
    found = least_safe(item)
    if found is None or not math.isfinite(found[0]):
        return ""
    pair = plastic_and_residual_of(found[1])
    if pair is not None and bears_less_with_strength(*pair):
        return (
            f"{lead} {numbers.multiplier(found[0])} ({found[1].method}){under}, below the residual multiplier: "
            "without dilatancy a wall may collapse at less with cohesion and tensile strength than without."
        )
    return (
        f"{lead} {numbers.multiplier(found[0])} ({found[1].method}){under}, the residual multiplier: mortar is "
        "brittle, and this is the wall without its cohesion and tensile strength."
    )


def _height(associated: Result, least: Result) -> str:
    """The associated maximum, and how far it lies above the least multiplier."""
    value = numbers.multiplier(associated.multiplier)
    if not least.multiplier:
        return f"{value}, which is above the least multiplier"
    over = (associated.multiplier or 0.0) / least.multiplier - 1.0
    return f"{value}, which is {numbers.plain(100.0 * over, 2)} % above the least multiplier"


def _or_the_same(result: Result, least: Result) -> str:
    value = numbers.multiplier(result.multiplier)
    return "the same" if value == numbers.multiplier(least.multiplier) else value


def _suite(items: list[CaseResults]) -> list[str]:
    """On how many walls the families agree, differ, are not separated by a bracket, or find different things."""
    spreads = [(by, item.case.id) for item in items if (by := spread(item)) is not None]
    found = []
    if spreads:
        apart = sorted((entry for entry in spreads if entry[0][0] > AGREE), reverse=True)
        open_ = [name for (least, most), name in spreads if least <= AGREE < most]
        sentence = (
            f"At least two families give a collapse multiplier of {numbers.count(len(spreads), 'wall')}; on "
            f"{len(spreads) - len(apart) - len(open_)} of them all lie within 1 % of each other"
        )
        if open_:
            sentence += f"; on {len(open_)} a measured bracket does not decide ({first_few(open_, 6)})"
        if apart:
            sentence += f"; they differ on {first_few([f'{name} ({percent_text(*by)})' for by, name in apart], 6)}"
        found.append(f"{sentence}.")
    split = [item.case.id for item in items if len({r.finding for r in mains(item)}) > 1]
    if split:
        found.append(
            f"The families find different things on {numbers.count(len(split), 'wall')}: {first_few(split, 6)}."
        )
    return found


@memo
def figure_of(item: CaseResults) -> tuple[DisplayList | None, str]:
    """The mechanism of the least state, that of another family dashed over it, and its caption; None without one."""
    least = least_known(item)
    if least is None or least.mechanism is None:
        return None, ""
    apart = [
        r
        for r in mains(item)
        if r is not least and r.mechanism is not None and r.finding.has_multiplier and r.flow == "non-associated"
    ]
    other = apart[0] if apart else None
    friction = f"tan φ {friction_text(item.case.assembly)}"
    caption = f"Mechanism of {item.case.id}, {friction}, by {least.method} at {numbers.multiplier(least.multiplier)}"
    if other is None:
        drawn = mechanism_drawing(item.case, least)
        return drawn, f"{caption}. Velocities drawn as displacements."
    caption += f"; dashed, by {other.method} at {value_in_words(other)}, where its blocks stand elsewhere"
    drawn = overlay_drawing(item.case, least, other)
    return drawn, f"{caption}. Velocities drawn as displacements. {_JOINTS_OF_ONE}"
