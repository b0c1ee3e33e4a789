"""The report: one self-contained HTML file that works offline, with a folder of data beside it."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

from markupsafe import Markup

from harness.model.columns import COMPARED, LISTED, REPEATED, ResultColumn
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.envelope import by_wall, envelopes
from harness.model.result_texts import answer_text, settings_text
from harness.model.writing import write_whole
from reports import agreement, numbers, paper, shapes, tables, words
from reports.curves import curves
from reports.drawing import case_data, fields_drawn, force_unit, result_data, wall_svg
from reports.environment import environment
from reports.export import export
from reports.limits import known_limits
from reports.once import each_once
from reports.opening import opening, run_in_order
from reports.sections import CaseSection, case_section
from reports.studies import studies

DRAWING_BUDGET = 1_700_000
"""Bytes the fields of mechanisms and forces may take in the page, so that it stays below 5 MB: at 65 cases of 60 blocks
and 8 methods all else takes 3 MB."""
STILL_BUDGET, STILL_BYTES = 400_000, 140
"""Bytes that still drawings of forces, for pages without scripts, may take, and about what one joint takes of them."""


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
    scripts = [_static(name) for name in ("table.js", "draw.js")]
    fields = fields_drawn(run, DRAWING_BUDGET)
    template = environment().get_template("report.html.j2")
    return template.render(
        run=run,
        created=_date(run.created),
        digest=_digest(rows),
        versions=run.provenance.get("versions", {}),
        opening=opening(run),
        findings=tables.findings(run),
        columns=tables.columns(run),
        shown=shown,
        listed=listed,
        repeated=REPEATED,
        matrix=_matrix(rows, shown),
        rows=[row for case_rows in rows for row in case_rows],
        failures=tables.failures(row for case_rows in rows for row in case_rows),
        failed_runs=sum(row.failed or row.judged == "rejected" for case_rows in rows for row in case_rows),
        references=tables.reference_rows(run),
        compared=COMPARED,
        purposes=words.PURPOSE,
        load_cases=by_wall(envelopes(run.cases)),
        answer_text=answer_text,
        gates=[(number, item.case.id, gate) for number, item in enumerate(run.cases) for gate in item.gates],
        paper=paper.paper_comparison(run),
        errata=[(number, item.case) for number, item in enumerate(run.cases) if item.case.file.errata],
        sections=_sections(run, rows, fields),
        studies=studies(run),
        limits=known_limits(run),
        provenance=_provenance(run),
        origins=_origins(rows),
        data_folder=data_folder,
        data=Markup(script_json(_data(run, fields))),
        style=Markup(_static("report.css")),
        scripts=[Markup(script) for script in scripts],
        script_hashes=Markup(" ".join(script_hash(script) for script in scripts)),
        numbers=numbers,
    )


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


def _sections(run: ComparisonRun, rows: list[list[tables.RunRow]], fields: list[str]) -> list[CaseSection]:
    sections, left = [], STILL_BUDGET
    for number, item in enumerate(run.cases):
        if shapes.problem(item.case):
            sections.append(case_section(number, item, rows[number], [], [], Markup("")))
            continue
        pairs = agreement.agreements(item)
        joints = item.case.assembly.n_interfaces * sum(result.forces is not None for result in item.results)
        still = STILL_BYTES * joints <= left
        left -= STILL_BYTES * joints if still else 0
        wall = wall_svg(item.case)
        sections.append(
            case_section(number, item, rows[number], pairs, curves(item), wall, fields[number], still_forces=still)
        )
    return sections


def _data(run: ComparisonRun, fields: list[str]) -> list[dict[str, Any]]:
    """What the page draws from: per case its geometry and the fields of its results, within the budget."""
    return [_case_data(item, level) for item, level in zip(run.cases, fields, strict=True)]


def _case_data(item: CaseResults, fields: str) -> dict[str, Any]:
    if fields == "none" or shapes.problem(item.case):
        return {"results": []}
    unit = force_unit(item.results)
    return case_data(item.case) | {
        "unit": unit,
        "results": [
            {"method": result.method} | result_data(item.case, result, unit, fields=fields) for result in item.results
        ],
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
