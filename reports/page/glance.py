"""The first screen: the comparison of the paper in pictures, or what governs a wall of the user's own."""

from __future__ import annotations

import itertools
import shlex
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.library import library
from harness.model.live_load import is_horizontal
from harness.model.load_cases import title_of_wall
from harness.model.method import Status
from harness.model.proof import least_known, proof_of
from harness.model.ranges import range_of
from harness.model.result import Result
from reports.charts.dots import Dot, DotPlot, DotRow, html, legend, plain_scale
from reports.charts.families import friction_of
from reports.charts.overview import dot, plotted, wall_plot
from reports.charts.styles import Mark, mark_of
from reports.drawing.mechanism_drawing import loaded_mechanism, moved_wall
from reports.drawing.svg import inline
from reports.findings.agreement import agreement, mains
from reports.findings.joints import joints_in_words, motion
from reports.findings.reasons import mechanism_in_words
from reports.geometry import shapes
from reports.labels import labels, numbers
from reports.labels.wall_summary import value_in_words
from reports.page import paper
from reports.page.governing import Governing, governing

_PRINTED = Mark("#4a5763", "o", "solid")
"""The mark of what the paper prints."""


@dataclass(frozen=True)
class _Picture:
    """The mechanism of one family.

    Attributes:
        title, method, value: family, method, and its multiplier in words.
        proved: what is proved of it, in a few words.
        drawing: all pictures of a wall at one scale.
        words: what its joints do.
    """

    title: str
    method: str
    value: str
    proved: str
    drawing: Markup
    words: str


@dataclass(frozen=True)
class _GlancePart:
    """A plot with its heading and the sentence that says what it shows."""

    title: str
    plot: Markup
    sentence: str


@dataclass(frozen=True)
class _Glance:
    """The first screen.

    Attributes:
        headline: what was compared.
        number, case: of the wall that is drawn; None where none has a mechanism.
        pictures: its families side by side.
        sentence: how far their mechanisms agree.
        parts: plots beside them.
        governs: for a comparison of one wall that is not the paper's: what governs it.
        drawing, words: its mechanism.
        further: questions that a command answers.
    """

    headline: str
    number: int | None = None
    case: str = ""
    pictures: list[_Picture] = field(default_factory=list)
    sentence: str = ""
    parts: list[_GlancePart] = field(default_factory=list)
    governs: Governing | None = None
    drawing: Markup = field(default_factory=Markup)
    words: str = ""
    further: list[tuple[str, str]] = field(default_factory=list)


def glance(run: ComparisonRun) -> _Glance:
    """What a reader sees first: the paper's walls where they were run, otherwise the first wall with a mechanism."""
    built = [(number, item) for number, item in enumerate(run.cases) if not shapes.problem(item.case)]
    said = paper.printed()
    focus = next((pair for pair in built if pair[1].case.id == said.wall.case), None) or next(
        (pair for pair in built if any(r.mechanism is not None for r in mains(pair[1]))), None
    )
    block = next((item for _, item in built if item.case.id == said.block.case), None)
    own = _own(run, [item for _, item in built])
    if focus is None:
        return _Glance(headline(run), governs=own)
    number, item = focus if own is None else next(pair for pair in built if pair[1] is own.item)
    parts = [] if block is None else [_block(block)]
    if item.case.id == said.wall.case:
        parts.extend(filter(None, [_cost(run, item)]))
    elif item is not block:
        plot = wall_plot(item)
        parts.append(
            _GlancePart("Multiplier by method", html(plot), "Filled: proved minimum. A bar is a measured bracket.")
        )
    drawing, words = _governing_mechanism(own)
    return _Glance(
        headline(run),
        number,
        item.case.id,
        pictures(item),
        mechanisms_compared(item),
        parts,
        own,
        drawing,
        words,
        [] if own is None else _further(run, own),
    )


def _governing_mechanism(own: Governing | None) -> tuple[Markup, str]:
    """The mechanism of the state that governs an only wall, and what it is in words."""
    least = None if own is None else least_known(own.item)
    drawn = least if own is None or (least is not None and least.mechanism is not None) else own.shown
    if own is None or drawn is None:
        return Markup(""), ""
    case = own.item.case
    words = mechanism_in_words(case.assembly, np.asarray(drawn.mechanism, dtype=float), case.wall.units.length)
    at = f"{words[0].upper()}{words[1:]}, at {numbers.multiplier(drawn.multiplier)} ({drawn.method})."
    return inline(loaded_mechanism(case, drawn)), at


def _further(run: ComparisonRun, own: Governing) -> list[tuple[str, str]]:
    """Commands that say what would change the number most: the opposite load, friction, the joint tolerance."""
    case = own.item.case
    found = []
    if len(own.ways) == 1 and not case.load_case and is_horizontal(case):
        found.append(("The opposite live load", f"{run.command} --both-signs"))
    if not case.argument:
        return found
    friction, name = friction_of(case.assembly), shlex.quote(case.argument)
    if friction is not None:
        ends = f"{numbers.given(0.8 * friction, 3)}:{numbers.given(1.2 * friction, 3)}:9"
        found.append(("Friction 20 % lower to 20 % higher", f"drystone sweep {name} --vary friction={ends}"))
    if Path(case.argument).suffix:  # a wall of the library is named by its id, and is valid
        found.append(("Whether it depends on the joint tolerance", f"drystone validate {name}"))
    return found


def headline(run: ComparisonRun) -> str:
    """What was compared, e.g. "Finite elements and limit analysis on 21 walls"; the title of an only wall."""
    found = {r.family: labels.order(r) for item in run.cases for r in item.results}
    known = library().families
    names = sorted(found, key=lambda name: found[name])
    families = [known[name][0].lower() + known[name][1:] if name in known else name for name in names]
    walls = {item.case.wall_id or item.case.id for item in run.cases}
    if len(walls) == 1:
        first = run.cases[0].case
        return first.file.title if len(run.cases) == 1 else title_of_wall(first)
    who = labels.and_(families) if families else "no method"
    return f"{who[0].upper()}{who[1:]} on {numbers.count(len(walls), 'wall')}"


def _own(run: ComparisonRun, items: list[CaseResults]) -> Governing | None:
    """What governs the only wall of a comparison; None of several walls, and of the paper's."""
    walls = {item.case.wall_id or item.case.id for item in run.cases}
    if len(walls) != 1 or walls & set(paper.printed().cases) or not items:
        return None
    return governing(items)


def pictures(item: CaseResults) -> list[_Picture]:
    """The mechanisms of the families at one scale: that of the one which allows the least."""
    assembly = item.case.assembly
    drawn = [r for r in mains(item) if r.mechanism is not None and len(r.mechanism) == assembly.n_blocks]
    fields = [np.asarray(result.mechanism, dtype=float) for result in drawn]
    scale = min((shapes.amplitude(assembly, each) for each in fields), default=0.0)
    return [
        _Picture(
            title=library().family_title(result.family, result.method),
            method=result.method,
            value=value_in_words(result),
            proved=proof_of(item, result).label,
            drawing=inline(moved_wall(assembly, result, scale)),
            words=_joints(item, result),
        )
        for result in drawn
    ]


def _joints(item: CaseResults, result: Result) -> str:
    found = motion(item.case.assembly, result)
    if found is None:
        return "Measured velocity field"
    return joints_in_words(found) or "No joint moves"


def mechanisms_compared(item: CaseResults) -> str:
    """Which families have the same mechanism or the most alike ones, and how the least state stands to the others."""
    drawn = [r for r in mains(item) if r.mechanism is not None and r.multiplier is not None]
    found = [agreement(item.case.assembly, first, second) for first, second in itertools.combinations(drawn, 2)]
    pairs = {frozenset([pair.first, pair.second]): pair for pair in found if pair.cosine is not None}
    if not pairs:
        return ""
    names, best = max(pairs.items(), key=lambda each: (each[1].same_mechanism, each[1].cosine))
    alike = frozenset().union(names, *(two for two, pair in pairs.items() if pair.same_mechanism and two & names))
    who = labels.all_of(r.method for r in drawn if r.method in alike)
    if best.same_mechanism and len(alike) == len(drawn):
        return f"{who} find the same mechanism. {_paper_found(item)}".strip()
    what = "the same mechanism" if best.same_mechanism else "the most similar mechanisms"
    cosine = min(pair.cosine or 0.0 for two, pair in pairs.items() if two <= alike)
    sentences = [f"{who} find {what} (cosine {numbers.cosine(cosine)})."]
    for other in (r for r in drawn if r.method not in alike):
        near = max((pair for two, pair in pairs.items() if other.method in two), key=lambda pair: pair.cosine or 0.0)
        joints = numbers.count(near.other_joints or 0, "joint")
        sentences.append(
            f"{other.method.upper()} finds another mechanism (cosine {numbers.cosine(near.cosine)}, "
            f"other motion at {joints}){_below(item, other, drawn)}."
        )
    return " ".join(filter(None, [*sentences, _paper_found(item)]))


def _below(item: CaseResults, least: Result, others: list[Result]) -> str:
    """How far the least state known lies below the lowest of the other families."""
    if least is not least_known(item):
        return ""
    ends = [ends[0] for r in others if r is not least and (ends := range_of(r)) is not None]
    gap = min(ends, default=0.0) - (least.multiplier or 0.0)
    if gap <= 0.0:
        return ""
    return f", {numbers.plain(gap, 2)} lower ({proof_of(item, least).label})"


def _paper_found(item: CaseResults) -> str:
    said = paper.printed().wall
    return f"In the paper {said.mechanisms}." if item.case.id == said.case else ""


def _block(item: CaseResults) -> _GlancePart:
    """The paper's block: what it prints, and ours, on one axis."""
    results = {result.method: result for result in plotted(item) if result.multiplier is not None}
    printed = [row for row in paper.printed().block.rows if row.exact is not None and row.method in results]
    names = {method: dot(item, result, 0.0).name for method, result in results.items()}
    theirs = [
        Dot(names[r.method], r.exact or 0.0, mark_of(results[r.method]), f"{r.method} {r.printed}") for r in printed
    ]
    rows = [
        DotRow("Paper", theirs, _labels_of(theirs)),
        DotRow("Drystone", [dot(item, result, 0.0) for result in results.values()], ""),
    ]
    ends = [end for result in results.values() for end in range_of(result) or ()]
    values = [*ends, *(mark.value for mark in theirs)]
    plot = DotPlot("Multipliers of the single block, the paper's and ours", plain_scale(values), rows)
    return _GlancePart("Single block", html(plot) + legend(plot), _block_in_words(item, list(results.values())))


def _labels_of(dots: list[Dot]) -> str:
    """The values of marks in rising order."""
    return ", ".join(numbers.given(dot.value, 3) for dot in sorted(dots, key=lambda dot: dot.value))


def _block_in_words(item: CaseResults, results: list[Result]) -> str:
    """The range that limit analysis leaves, and where the others stand in it."""
    least, greatest = least_known(item), item.associated
    if least is None or greatest is None:
        return ""
    low, high = least.multiplier or 0.0, greatest.multiplier or 0.0
    others = [f"{r.method.upper()} {value_in_words(r)}" for r in results if r.is_main and r is not least]
    if high <= low:
        return f"All collapse states lie at {numbers.multiplier(low)}."
    said = f"Limit analysis leaves {numbers.multiplier(low)} to {numbers.multiplier(high)}"
    return f"{said}{'; ' + ', '.join(others) if others else ''}: equilibrium does not determine the contact forces."


def _cost(run: ComparisonRun, item: CaseResults) -> _GlancePart | None:
    """CPU time as ratios beside the paper's, and the largest walls."""
    found = paper.paper_comparison(run)
    if found is None or not found.ratio_ours:
        return None
    rows, base = [], float(paper.printed().wall.rows[0].minutes)
    first = next(row.cpu.sort for row in found.cost if row.cpu.sort)
    for printed, ours in zip(paper.printed().wall.rows, found.cost, strict=True):
        result = item.of(ours.method)
        if result is None or ours.cpu.sort is None:
            return None
        value = base * ours.cpu.sort / first
        early = None if ours.until_value is None else base * ours.until_value / first
        text = f"{ours.method} {ours.ratio} here" + (
            "" if early is None else f", {numbers.plain(early, 2)} until its value"
        )
        ends = (early, value) if early is not None and early < value else None
        marks = [
            Dot("paper", printed.minutes, _PRINTED, f"{ours.method} {ours.paper_ratio} in the paper"),
            Dot("Drystone", value, Mark(_PRINTED.colour, "s", "solid"), text, ends, filled=True),
        ]
        rows.append(
            DotRow(ours.method.upper(), marks, f"{numbers.given(printed.minutes, 3)} → {numbers.plain(value, 2)}")
        )
    values = [end for row in rows for mark in row.dots for end in (mark.value, *(mark.ends or ()))]
    plot = DotPlot("CPU time as ratios, the paper's and ours", plain_scale(values, log=True), rows)
    until = f" ({found.ratio_to_value} until a search first reached its value)" if found.ratio_to_value else ""
    sentence = (
        f"{found.names} is {found.ratio_paper} in the paper and {found.ratio_ours} here{until}. {largest_walls(run)}"
    )
    return _GlancePart("CPU time, ratio", html(plot) + legend(plot), sentence)


def largest_walls(run: ComparisonRun) -> str:
    """Blocks of the largest wall that each of the paper's methods was run on, in the paper and here."""
    said = paper.printed().wall.rows
    ours = []
    for row in said:
        runs = [result for item in run.cases for result in item.results if result.method == row.method]
        blocks = max((r.blocks for r in runs if r.status is Status.OK and r.judge.accepted is not False), default=0)
        ours.append(str(blocks))
    theirs = ", ".join(f"{row.largest} ({row.method.upper()})" for row in said)
    here = f"{ours[0]} (all)" if len(set(ours)) == 1 else ", ".join(ours)
    return f"Largest walls, in blocks: {theirs} in the paper, {here} in this comparison."
