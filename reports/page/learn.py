"""A page for teaching: the block of the paper with sliders, by closed forms, and its wall over friction, from runs."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.writing import write_whole
from reports.charts import charts
from reports.charts.styles import mark_of
from reports.drawing.looks import HATCH
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.svg import inline
from reports.environment import environment
from reports.findings.joints import joints_in_words, motion
from reports.labels import labels, numbers
from reports.labels.wall_summary import friction_text, value_in_words
from reports.page.build import page_style, script_hash, script_json
from reports.page.paper import printed


@dataclass(frozen=True)
class BlockAnswers:
    """What the methods answer on the paper's block, by hand.

    Attributes:
        least, greatest: ends of the range of collapse states, which is what limit analysis and distinct elements span.
        springs: what four equal gap points choose.
        shares: (rear, rear, front, front) compressions of those four over the weight, at `springs`.
    """

    least: float
    greatest: float
    springs: float
    shares: tuple[float, float, float, float]


def block_answers(rear: float, front: float) -> BlockAnswers:
    """Collapse multipliers of the block L x L/2 on two supports, pushed at its centroid.

    With the share a of the weight on the rear half the block slides at front + (rear - front) a. Statics allows
    0 <= a <= 1 - lambda / 2; four equal springs give a = 1/2 - lambda / 4 (Baggio and Trovalusci 1995, section 3).

    Args:
        rear, front: coefficients of friction of the two halves, below 2, at which the block would overturn.
    """
    ends = (front, rear / (1.0 + 0.5 * (rear - front)))
    springs = 0.5 * (rear + front) / (1.0 + 0.25 * (rear - front))
    outer = 0.25 * springs
    return BlockAnswers(min(ends), max(ends), springs, (0.25 - outer, 0.25, 0.25, 0.25 + outer))


@dataclass(frozen=True)
class _LessonPanel:
    """One method's answer on one wall, for the page."""

    method: str
    value: str
    drawing: Markup
    words: str


@dataclass(frozen=True)
class _Step:
    """One friction of the wall."""

    friction: str
    panels: list[_LessonPanel]


@dataclass(frozen=True)
class _Demonstration:
    """Where the sliders stand when the page opens: the paper's block.

    Attributes:
        rear, front: coefficients of friction.
        stiffness: of a spring, in weights of the block over its length.
    """

    rear: float = 0.6
    front: float = 0.4
    stiffness: float = 10.0


def write_learn(run: ComparisonRun, path: Path) -> None:
    """Write the page as one HTML file that works offline.

    Args:
        run: the paper's block and walls that differ in friction alone, with fe, la, la-associated and de.
        path: the file.
    """
    write_whole(path, render(run))


def render(run: ComparisonRun, start: _Demonstration = _Demonstration()) -> str:
    """The page as text, with its sliders at the start."""
    name = printed().block.case
    block = next(item for item in run.cases if item.case.id == name)
    walls = sorted(
        (item for item in run.cases if item.case.id != name), key=lambda item: float(item.case.assembly.friction[0])
    )
    script = files("reports").joinpath("static/learn.js").read_text(encoding="utf-8")
    return (
        environment()
        .get_template("learn.html.j2")
        .render(
            run=run,
            start=start,
            answers=block_answers(start.rear, start.front),
            measured=[
                (r.method, r.traits.caption, value_in_words(r)) for r in labels.in_order(block) if r.status is Status.OK
            ],
            steps=[_Step(friction_text(item.case.assembly), _panels(item)) for item in walls],
            chart=Markup(charts.svg(_chart(walls))),
            style=page_style(),
            hatch=Markup(HATCH),
            extra=Markup(files("reports").joinpath("static/learn.css").read_text(encoding="utf-8")),
            script=Markup(script),
            script_hash=Markup(script_hash(script)),
            data=Markup(script_json({"frictions": [friction_text(item.case.assembly) for item in walls]})),
            numbers=numbers,
        )
    )


def _panels(item: CaseResults) -> list[_LessonPanel]:
    panels = []
    for result in labels.in_order(item):
        if result.status is not Status.OK or result.mechanism is None:
            continue
        found = motion(item.case.assembly, result)
        panels.append(
            _LessonPanel(
                result.method,
                value_in_words(result),
                inline(mechanism_drawing(item.case, result)),
                joints_in_words(found) if found is not None else "a measured field of velocities",
            )
        )
    return panels


def _chart(walls: list[CaseResults]) -> charts.Chart:
    """Multipliers over friction; what is measured is drawn with its bracket."""
    series = []
    for name in dict.fromkeys(result.method for item in walls for result in labels.in_order(item)):
        points = [
            (float(item.case.assembly.friction[0]), result)
            for item in walls
            if (result := item.of(name)) is not None and result.multiplier is not None and result.finding.has_multiplier
        ]
        if not points:
            continue
        low, high = (
            [float((r.bracket or (r.multiplier, r.multiplier))[end] or 0.0) for _, r in points] for end in (0, 1)
        )
        series.append(
            charts.Series(
                name,
                [x for x, _ in points],
                [float(r.multiplier or 0.0) for _, r in points],
                low=low if points[0][1].traits.brackets else [],
                high=high if points[0][1].traits.brackets else [],
                mark=mark_of(points[0][1]),
            )
        )
    return charts.Chart("Multiplier over friction", "friction tan φ", "collapse multiplier", series, zero_y=True)
