"""One section of the report for every case: the wall, its results side by side, agreement, references, errata."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from markupsafe import Markup

from harness.model.bar_forces import bar_forces_of
from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.details import AnswerDetails
from harness.model.method import Status
from harness.model.result import Result, plastic_and_residual_of
from reports.drawing.force_drawing import force_drawing
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.svg import inline
from reports.findings.agreement import Agreement
from reports.findings.joints import joints_in_words, motion, open_with_force
from reports.findings.reasons import reasons
from reports.findings.strength import strength_text
from reports.geometry import shapes, thrust_lines
from reports.labels import numbers
from reports.labels.wall_summary import value_in_words, wall_summary
from reports.page.page_drawings import PageDrawings
from reports.page.summary import figure_of, is_calm, wall_findings
from reports.page.tables import RunRow


@dataclass(frozen=True)
class _FoldedPanel:
    """One method's drawings.

    Attributes:
        row: the run.
        number: its index among the case's results.
        mechanism, forces: their drawings; empty where there is nothing to draw, or too much.
        flow: what the mechanism is, for the caption.
        states: how many interfaces move in which way, in words.
        origin: which source of a search found it, and when; or nothing.
        beside: joints drawn as open that carry force, and why; or nothing.
        forces_are: what the forces are, for the caption.
    """

    row: RunRow
    number: int
    mechanism: Markup
    forces: Markup
    flow: str
    states: str
    origin: str
    beside: str
    forces_are: str


@dataclass(frozen=True)
class CaseSection:
    """Everything the section of a case prints."""

    number: int
    case: Case
    wall: Markup
    loads_drawn: str
    through: str
    facts: list[tuple[str, str]]
    warnings: tuple[str, ...]
    rows: list[RunRow]
    panels: list[_FoldedPanel]
    without_drawing: list[RunRow]
    agreements: list[Agreement]
    curves: list[tuple[str, Markup]]
    problem: str = ""
    finding: str = ""
    cut: str = "all"
    reasons: tuple[str, ...] = ()
    calm: bool = False
    overlay: Markup = field(default_factory=Markup)
    overlay_caption: str = ""
    strength: list[_StrengthRow] = field(default_factory=list)
    bars: list[_BarRow] = field(default_factory=list)

    @property
    def families(self) -> list[_FoldedPanel]:
        """The drawings of the main method of every family."""
        return [panel for panel in self.drawn if panel.row.result.is_main]

    @property
    def checks(self) -> list[_FoldedPanel]:
        """Those of the other methods."""
        return [panel for panel in self.drawn if not panel.row.result.is_main]

    @property
    def drawn(self) -> list[_FoldedPanel]:
        """Panels with a drawing."""
        return [panel for panel in self.panels if panel.mechanism or panel.forces]

    @property
    def packed(self) -> bool:
        """Whether a reader without scripts misses a drawing."""
        return any("data-packed" in drawn for panel in self.panels for drawn in (panel.mechanism, panel.forces))


FLOW = {
    "non-associated": "mechanism without dilatancy",
    "associated": "mechanism with dilatant (associated) slip",
    "approximate": "measured velocity field",
}


def case_section(
    number: int,
    item: CaseResults,
    rows: list[RunRow],
    agreements: list[Agreement],
    curves: list[tuple[str, Markup]],
    wall: Markup,
    drawings: PageDrawings,
    fields: str = "all",
) -> CaseSection:
    """The section of one case.

    Args:
        number: of the case in the report.
        item: the case with its results.
        rows: of its results.
        agreements: of pairs of them.
        curves: captions and charts.
        wall: its drawing.
        drawings: those of the page so far.
        fields: as in `reports.page.page_drawings.fields_drawn`.
    """
    problem = shapes.problem(item.case)
    if problem:
        return CaseSection(number, item.case, wall, "", "", [], (), rows, [], rows, [], [], problem)
    calm = is_calm(item)
    overlay, caption = (None, "") if calm else figure_of(item)
    panels, without = [], []
    for row in rows:
        index = int(row.anchor.rsplit("-", 1)[1])
        result = item.results[index]
        if result.mechanism is None and result.forces is None:
            without.append(row)
            continue
        panels.append(
            _FoldedPanel(
                row=row,
                number=index,
                mechanism=Markup("")
                if result.mechanism is None or fields == "none"
                else drawings.put(mechanism_drawing(item.case, result)),
                forces=Markup("")
                if result.forces is None or fields != "all"
                else drawings.put(force_drawing(item.case, result)),
                flow=FLOW.get(result.flow, result.flow),
                states=_states(item.case, result),
                origin=origin(result),
                beside=_forces_beside(item.case, result) if fields == "all" else "",
                forces_are=_forces_are(result),
            )
        )
    return CaseSection(
        number=number,
        case=item.case,
        wall=wall,
        loads_drawn=_loads_drawn(item.case),
        through=_through(item),
        facts=_facts(item.case),
        strength=_strength_rows(item),
        bars=_bar_rows(item),
        warnings=(*item.case.warnings, *item.refusals, *filter(None, [item.split_on_dead_load])),
        rows=rows,
        panels=panels,
        without_drawing=without,
        agreements=agreements,
        curves=curves,
        finding=wall_findings(item),
        cut=fields,
        reasons=tuple(reasons(item)),
        calm=calm,
        overlay=Markup("") if overlay is None else inline(overlay),
        overlay_caption=caption,
    )


def _facts(case: Case) -> list[tuple[str, str]]:
    """The facts of a case, with the strength of its joints where they have any, and with its ties and props."""
    more = {
        "Strength of joints": strength_text(case.assembly, case.wall.units.force),
        "Ties and props": _bars_text(case),
    }
    return wall_summary(case) + [(name, text) for name, text in more.items() if text]


def _loads_drawn(case: Case) -> str:
    """The caption of a wall: what of its loads is drawn."""
    assembly = case.assembly
    bars = "; violet lines are ties, wider ones props and passive fill" if len(assembly.bars) else ""
    if not assembly.has_live_load:
        return f"The wall with its supports; dots are contact points{bars}."
    step = shapes.drawn_every(len(shapes.load_arrows(assembly, assembly.live)))
    every = f", drawn on one block in {step}" if step > 1 else ""
    return f"The wall with its loads{every}; dots are contact points{bars}."


def _through(item: CaseResults) -> str:
    """What lines through the blocks are: the line of thrust where each result has one, else how forces flow."""
    drawn = [np.asarray(result.forces, dtype=float) for result in item.results if result.forces is not None]
    assembly = item.case.assembly
    found = [shapes.thrusts(assembly, forces, thrust_lines.SMALLEST) for forces in drawn if len(forces)]
    return "line of thrust" if all(thrust_lines.has_line_of_thrust(assembly, f) for f in found) else "flow of forces"


def _states(case: Case, result: Result) -> str:
    """How the joints move, in words; nothing for a measured field, in which nothing is exactly at rest."""
    found = motion(case.assembly, result)
    return "" if found is None else joints_in_words(found)


def _forces_beside(case: Case, result: Result) -> str:
    """How the forces of the drawing below and the open joints of this one go together, where they do not."""
    number = open_with_force(case.assembly, result)
    if not number:
        return ""
    carry = f"{numbers.count(number, 'joint')} drawn as open {'carries' if number == 1 else 'carry'} force below"
    if result.flow == "approximate":
        return f"{carry}: the forces belong to the held state, the mechanism to the moving one"
    return carry


def origin(result: Result) -> str:
    """Which source of a search found the state, and when, of methods that keep their improvements.

    Nothing of a state that is lower than the last of these, as one that a proof came across.
    """
    last = AnswerDetails(result.details).last_improvement
    if last is None or last.multiplier is None or result.multiplier is None:
        return ""
    if not math.isclose(last.multiplier, result.multiplier, rel_tol=1e-7, abs_tol=1e-9):
        return ""
    after = "" if last.cpu_seconds is None else f" after {numbers.seconds(last.cpu_seconds)} of CPU time"
    return f"found from “{last.source}”{after}"


def _forces_are(result: Result) -> str:
    if result.flow == "approximate":
        moved = "; the mechanism above belongs to the moving state" if result.mechanism is not None else ""
        return f"contact forces of the last held state{moved}"
    at = numbers.multiplier(result.forces_multiplier)
    if result.forces_multiplier is not None and at != numbers.multiplier(result.multiplier):
        return f"contact forces at {at}"
    return "contact forces at collapse"


@dataclass(frozen=True)
class _BarRow:
    """The force of one bar by one method."""

    method: str
    bar: str
    joins: str
    force: str
    limits: str
    state: str


def _bar_rows(item: CaseResults) -> list[_BarRow]:
    """One row a method and bar; none where the wall has no ties and props, or no answer gives forces."""
    return [
        _BarRow(
            result.method,
            bar.bar,
            f"{bar.start} to {bar.end}",
            numbers.given(bar.tension, 4),
            f"{numbers.given(bar.least, 4)} to {numbers.given(bar.greatest, 4)}",
            bar.state,
        )
        for result in item.results
        for bar in bar_forces_of(item.case, result)
    ]


def _bars_text(case: Case) -> str:
    """How many ties, props and faces in passive fill there are, and their greatest forces; empty if there are none."""
    bars = case.assembly.bars
    said = []
    pulled, pushed = bars.prestress + bars.greatest, -(bars.prestress + bars.least)
    for kind, noun, strongest in (("tie", "tie", pulled), ("prop", "prop", pushed), ("fill", "passive face", pushed)):
        forces = [float(force) for force, own in zip(strongest, bars.kinds, strict=True) if own == kind]
        if forces:
            most = numbers.quantity(max(forces), case.wall.units.force, 4)
            limit = most if min(forces) == max(forces) else f"up to {most}"
            said.append(f"{numbers.count(len(forces), noun)}, yield force {limit}")
    return "; ".join(said)


@dataclass(frozen=True)
class _StrengthRow:
    """What one method finds for a wall with the strength of its joints, plastic, and without, the residual value."""

    method: str
    plastic: str
    residual: str


def _strength_rows(item: CaseResults) -> list[_StrengthRow]:
    """One row a method that took the strength of the joints; none where all joints are dry."""
    rows = []
    for result in item.results:
        pair = plastic_and_residual_of(result)
        if pair is None or result.status is not Status.OK:
            continue
        plastic, residual = (value_in_words(each) if each.status is Status.OK else numbers.NOTHING for each in pair)
        rows.append(_StrengthRow(result.method, plastic, residual))
    return rows
