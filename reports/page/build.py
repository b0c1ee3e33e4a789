"""The report: one self-contained HTML file that works offline, with a folder of data beside it."""

from __future__ import annotations

import base64
import hashlib
import itertools
import json
from collections.abc import Sequence
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

from markupsafe import Markup

from harness.model.case import Case
from harness.model.columns import COMPARED, LISTED, REPEATED, ResultColumn
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.envelope import by_wall, envelopes, ranked_text
from harness.model.method import Status
from harness.model.result_texts import settings_text
from harness.model.units import DIMENSIONLESS
from harness.model.writing import write_whole
from reports.charts import dots
from reports.charts.curves import curves
from reports.charts.overview import overview_plot
from reports.charts.studies import studies
from reports.charts.styles import Mark
from reports.drawing.looks import HATCH, css
from reports.drawing.svg import inline
from reports.drawing.wall_drawing import wall_drawing
from reports.environment import environment
from reports.findings.agreement import Agreement, agreement, measure_of
from reports.findings.limits import known_limits
from reports.geometry import shapes
from reports.labels import labels, numbers
from reports.memo import each_once
from reports.page import paper, tables
from reports.page.export import export
from reports.page.glance import glance
from reports.page.page_drawings import PageDrawings, fields_drawn
from reports.page.reference_tables import reference_rows
from reports.page.sections import CaseSection, case_section
from reports.page.summary import run_in_order, summary

DRAWING_BUDGET, INLINE = 1_500_000, 300_000
"""Bytes that drawings of mechanisms and forces may take in the page, packed, and more for some that are not, so that it
stays below 5 MB: at 65 cases of 60 blocks and 8 methods all else takes 3.1 MB."""


_SIGNS = (
    ("filled: proved minimum", dots.sign(Mark("#14202b", "s", "solid"), filled=True)),
    ("reference", dots.sign(dots.REFERENCE)),
)
"""Signs of the overview beside the marks of methods."""


def write_report(run: ComparisonRun, path: Path, *, drawn: bool = False) -> None:
    """Write the report of a comparison, and `<stem>-data/` beside it. Either the whole file is there or the old one.

    Args:
        run: the comparison.
        path: the HTML file.
        drawn: whether the folder gets a figure of every case as PDF.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with each_once():
        text = render(run, data_folder=f"{path.stem}-data")
        export(run, path.with_name(f"{path.stem}-data"), drawn=drawn)
    write_whole(path, text)


def render(run: ComparisonRun, *, data_folder: str, listed: Sequence[ResultColumn] = LISTED) -> str:
    """The report as text.

    Args:
        run: the comparison.
        data_folder: name of the folder with the data, for the text.
        listed: columns of the table of every run.
    """
    run = run_in_order(run)
    rows = tables.run_rows(run)
    shown = tables.overview_columns(run)
    scripts = [_static(name) for name in ("table.js", "move.js", "steps.js")]
    fields, drawings = fields_drawn(run, DRAWING_BUDGET), PageDrawings(INLINE)
    sections = _sections(run, rows, fields, drawings)
    first, overview = glance(run), overview_plot(run)
    template = environment().get_template("report.html.j2")
    return template.render(
        run=run,
        created=_date(run.created),
        digest=_digest(rows),
        versions=run.provenance.get("versions", {}),
        glance=first,
        summary=summary(run) if first.governs is None else summary(run, first.governs.item, first.governs.unanswered),
        overview=dots.html(overview),
        overview_signs=dots.legend(overview, _SIGNS),
        findings=tables.findings(run),
        columns=tables.columns(run),
        shown=shown,
        listed=listed,
        repeated=REPEATED,
        matrix=_matrix(rows, shown),
        rows=[row for case_rows in rows for row in case_rows],
        failures=tables.failures(row for case_rows in rows for row in case_rows),
        failed_runs=sum(row.failed or row.judged == "rejected" for case_rows in rows for row in case_rows),
        references=reference_rows(run),
        compared=COMPARED,
        purposes=labels.PURPOSE,
        load_cases=by_wall(envelopes(run.cases)),
        ranked_text=ranked_text,
        gates=[(number, item.case.id, gate) for number, item in enumerate(run.cases) for gate in item.gates],
        paper=paper.paper_comparison(run),
        errata=[(number, item.case) for number, item in enumerate(run.cases) if item.case.file.errata],
        sections=sections,
        packed=Markup(drawings.packed()),
        studies=studies(run),
        limits=known_limits(run),
        provenance=_provenance(run),
        origins=_origins(rows),
        data_folder=data_folder,
        data=Markup(script_json(_data(run, fields))),
        style=page_style(),
        hatch=Markup(HATCH),
        scripts=[Markup(script) for script in scripts],
        script_hashes=Markup(" ".join(script_hash(script) for script in scripts)),
        numbers=numbers,
    )


def page_style() -> Markup:
    """The style sheet of a page, with the looks of its drawings."""
    return Markup(_static("report.css").replace("/* Drawings */", css()))


def _static(name: str) -> str:
    return files("reports").joinpath("static", name).read_text(encoding="utf-8")


def script_hash(script: str) -> str:
    """What a content security policy calls a script, so that the page runs this one and no other."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


def script_json(data: Any) -> str:
    """JSON that may stand inside a script element: nothing in it can end the element or start a comment."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    for sign, code in (
        ("<", "\\u003c"),
        (">", "\\u003e"),
        ("&", "\\u0026"),
        ("\u2028", "\\u2028"),
        ("\u2029", "\\u2029"),
    ):
        text = text.replace(sign, code)
    return text


def _matrix(
    rows: list[list[tables.RunRow]], columns: list[tables.Column]
) -> list[tuple[tables.RunRow, list[tables.RunRow | None]]]:
    """Rows of the overview: one a case, with the run of every method or None."""
    return [
        (
            case_rows[0],
            [next((row for row in case_rows if row.result.method == column.method), None) for column in columns],
        )
        for case_rows in rows
        if case_rows
    ]


def _sections(
    run: ComparisonRun, rows: list[list[tables.RunRow]], fields: list[str], drawings: PageDrawings
) -> list[CaseSection]:
    sections = []
    for number, item in enumerate(run.cases):
        if shapes.problem(item.case):
            sections.append(case_section(number, item, rows[number], [], [], Markup(""), drawings))
            continue
        pairs, wall = _agreements(item), inline(wall_drawing(item.case))
        sections.append(case_section(number, item, rows[number], pairs, curves(item), wall, drawings, fields[number]))
    return sections


def _data(run: ComparisonRun, fields: list[str]) -> list[dict[str, list[str]]]:
    """What the page says of a block, an interface and a force under the pointer, for each case with drawings.

    A line of `moves`, `joint` or `force` takes the values of the element for its braces, and is left out where one of
    them is missing.
    """
    return [
        {} if level == "none" or shapes.problem(item.case) else _sayings(item.case)
        for item, level in zip(run.cases, fields, strict=True)
    ]


def _sayings(case: Case) -> dict[str, list[str]]:
    assembly, unit = case.assembly, case.wall.units.force
    ids, force = assembly.block_ids, "" if unit == DIMENSIONLESS else f" {unit}"
    joints = zip(assembly.block_a.tolist(), assembly.block_b.tolist(), assembly.joint, assembly.friction, strict=True)
    return {
        "blocks": [f"block {name}" for name in ids],
        "joints": [f"{ids[a]} | {ids[b]}\n{kind} joint, tan φ = {numbers.given(mu, 3)}" for a, b, kind, mu in joints],
        "moves": ["u = ({}, {})", "ω = {}"],
        "joint": ["{}", "opening {}, {}; slip {}"],
        "force": [f"n₁ = {{}}, n₂ = {{}}{force}", f"s = {{}}{force}", "friction used: {} %"],
    }


def _digest(rows: list[list[tables.RunRow]]) -> str:
    """A hash over the keys of all runs, which stand for wall, method, settings, limits and code."""
    keys = sorted(row.result.key for case_rows in rows for row in case_rows)
    return hashlib.sha256("\n".join(keys).encode()).hexdigest()[:12]


def _origins(rows: list[list[tables.RunRow]]) -> list[tuple[str, str, int]]:
    """Machine and versions the runs were made with, and how many runs each; more than one where rows were reused."""
    counted: dict[tuple[str, str], int] = {}
    for row in (row for case_rows in rows for row in case_rows):
        where = tables.machine_text(row.result.machine), settings_text(row.result.versions)
        counted[where] = counted.get(where, 0) + 1
    return [(machine, versions, number) for (machine, versions), number in counted.items()]


def _date(created: str) -> str:
    """A time as people write it, or the text as it is."""
    try:
        moment = datetime.fromisoformat(created)
    except ValueError:
        return created
    zone = moment.tzname()
    return moment.strftime("%Y-%m-%d %H:%M") + (f" {zone}" if zone else "")


def _provenance(run: ComparisonRun) -> list[tuple[str, str]]:
    """Facts of the comparison as a whole, flattened to names and texts; studies are shown elsewhere.

    Machine and versions stand with the runs that were made there, once where they are the same for all.
    """
    ran = any(item.results for item in run.cases)
    flat: list[tuple[str, str]] = []
    for name, value in run.provenance.items():
        if name == "studies" or (ran and name in ("versions", "machine")):
            continue
        if isinstance(value, dict):
            flat.append((name.replace("_", " "), ", ".join(f"{key} {item}" for key, item in value.items())))
        else:
            flat.append((name.replace("_", " "), str(value)))
    return flat


def _agreements(item: CaseResults) -> list[Agreement]:
    """All pairs of the families' main methods and the associated maximum that found a collapse."""
    usable = [
        result
        for result in labels.in_order(item)
        if result.status is Status.OK
        and result.finding.has_multiplier
        and (result.is_main or result is item.associated)
    ]
    if len(usable) < 2:
        return []
    assembly = item.case.assembly
    measure = measure_of(assembly)
    return [agreement(assembly, first, second, measure) for first, second in itertools.combinations(usable, 2)]
