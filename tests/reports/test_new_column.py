"""Requirement: a column that is declared once, with its value, appears wherever it is listed."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pandas as pd
import pytest

from drystone.cli.terminal import print_comparison
from harness.engine.plan import Limits
from harness.engine.sweep.expand import expand, sources_of
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.quick import quick_study
from harness.engine.sweep.running import STUDY, StudyColumn, refused_row, row_of
from harness.model.columns import LISTED, PRINTED, RESULTS, ResultColumn, ResultRow
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.proof import proof_of
from reports.page import build
from reports.page.export import export, result_frame
from tests.reports import samples

TWICE = ResultColumn(
    "twice",
    "Float64",
    "kN",
    "twice the multiplier",
    lambda row: None if row.result.multiplier is None else 2.0 * row.result.multiplier,
    "double",
)


@pytest.fixture(scope="module")
def run() -> ComparisonRun:
    case = samples.bond()
    results = [samples.solved(case, "la", 0.1234567), samples.failed(case, "fe", Status.TIMEOUT, "Too slow.")]
    return ComparisonRun("one", "", "", [CaseResults(case, results)])


def test_a_terminal_shows_a_new_column(run: ComparisonRun, capsys: pytest.CaptureFixture[str]):
    print_comparison(run, None, (*PRINTED, TWICE))
    lines = capsys.readouterr().out.splitlines()
    assert any("double [kN]" in line for line in lines)
    cells = {line.split("│")[2].strip(): line.split("│")[-2].strip() for line in lines if line.count("│") > 7}
    assert cells == {"la": "0.246913", "fe": "-"}


def test_the_report_shows_a_new_column(run: ComparisonRun):
    page = build.render(run, data_folder="x", listed=(*LISTED, TWICE))
    table = page[page.index('<table id="runs-table">') :]
    assert '<th scope="col" class="num" title="twice the multiplier"><button type="button">Double</button>' in table
    rows = re.findall(r"<tr id=.*?</tr>", table[: table.index("</table>")], re.DOTALL)
    last = [row.splitlines()[-2] for row in rows]
    assert '<td class="num" data-sort="0.2469134" title="0.2469134">0.24691</td>' in last
    assert '<td class="num" data-sort="">–</td>' in last


def test_files_and_frames_hold_a_new_column(run: ComparisonRun, tmp_path: Path):
    export(run, tmp_path, columns=(*RESULTS, TWICE))
    with (tmp_path / "results.csv").open(encoding="utf-8", newline="") as stream:
        assert [row["twice"] for row in csv.DictReader(stream)] == ["0.2469134", ""]
    (item,) = run.cases
    table = result_frame([ResultRow(result, proof_of(item, result)) for result in item.results], (*RESULTS, TWICE))
    assert table["twice"].dtype == "Float64"
    assert table["twice"].isna().tolist() == [False, True]
    assert table.attrs["units"]["twice"] == "kN"


def test_parquet_holds_a_new_column(run: ComparisonRun, tmp_path: Path):
    pytest.importorskip("pyarrow", reason="it is large; `.ci/extras` runs this test")
    export(run, tmp_path, columns=(*RESULTS, TWICE))
    (item,) = run.cases
    table = result_frame([ResultRow(result, proof_of(item, result)) for result in item.results], (*RESULTS, TWICE))
    assert pd.read_parquet(tmp_path / "results.parquet")["twice"].equals(table["twice"])


def test_a_study_has_a_new_column(run: ComparisonRun):
    study = quick_study("single-block", ["la"], {}, Limits(), [], vary=["friction=0.3,0.4"])
    first, second = expand(study, sources_of(study, (), None))
    joints = StudyColumn(
        "joints", "Int64", "1", "of the wall", lambda row: None if row.result is None else row.result.interfaces
    )
    columns = (*STUDY, joints)
    result = run.cases[0].results[0]
    rows = [row_of(first, result, columns), refused_row(second, "It cannot be built.", columns)]
    table = tidy(rows, ["friction"], columns)
    assert table["joints"].tolist() == [result.interfaces, pd.NA]
    assert table["status"].tolist() == ["ok", "refused"]
    assert table["sentence"].tolist()[1] == "It cannot be built."
    assert table.attrs["units"]["joints"] == "1"
