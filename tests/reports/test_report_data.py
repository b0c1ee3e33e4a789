"""The data folder: all digits, typed columns, nothing of an earlier report left, nothing of the user's removed."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import pytest

from harness.model import columns
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.proof import proof_of
from harness.model.table import types
from reports.page.export import export, result_frame
from tests.reports import samples


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("data") / "report-data"
    export(samples.typical(), path, drawn=True)
    return path


def test_csv_keeps_all_digits_and_failed_runs(folder: Path):
    with (folder / "results.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 12
    finite = next(row for row in rows if row["case"] == "wall-21" and row["method"] == "fe")
    assert float(finite["multiplier"]) == 0.5652173913043478
    stopped = next(row for row in rows if row["status"] == "timeout")
    assert stopped["multiplier"] == ""
    assert stopped["sentence"] == "The wall limit of 60 s was reached."


def test_joints_of_every_answer_with_forces_stand_in_one_file_the_most_critical_first(folder: Path):
    with (folder / "joints.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    answers = [(item.case, result) for item in samples.typical().cases for result in item.results if result.forces]
    assert answers
    for case, result in answers:
        mine = [row for row in rows if (row["case"], row["method"]) == (case.id, result.method)]
        assert len(mine) == case.assembly.n_interfaces
        used = [float(row["utilisation"] or 0.0) for row in mine]
        assert used == pytest.approx(sorted(used, reverse=True))
        assert {row["units"] for row in mine} == {"kN, m"}
        told = json.loads((folder / case.id / f"{result.method}.json").read_text(encoding="utf-8"))
        assert [reaction["support"] for reaction in told["reactions"]] == [
            name for name, fixed in zip(case.assembly.block_ids, case.assembly.fixed, strict=True) if fixed
        ]
    assert len(rows) == sum(case.assembly.n_interfaces for case, _ in answers)


def test_csv_quotes_texts_so_that_no_reader_makes_numbers_of_them(tmp_path: Path):
    case = samples.bond("000000")
    export(ComparisonRun("", "", "", [CaseResults(case, [samples.solved(case, "la", 0.5)])]), tmp_path)
    assert (tmp_path / "results.csv").read_text(encoding="utf-8").splitlines()[1].startswith('"000000","la"')


def test_parquet_has_typed_columns(folder: Path):
    pq = pytest.importorskip("pyarrow.parquet", reason="it is large; `.ci/extras` runs this test")
    table = pq.read_table(folder / "results.parquet")
    assert table.num_rows == 12
    assert str(table.schema.field("multiplier").type) == "double"
    assert table.column("multiplier").null_count == 2, "the failed runs have none"


def test_parquet_is_read_by_pandas_as_the_table_of_the_results(folder: Path):
    pytest.importorskip("pyarrow", reason="it is large; `.ci/extras` runs this test")
    results = [
        columns.ResultRow(result, proof_of(item, result)) for item in samples.typical().cases for result in item.results
    ]
    read = pd.read_parquet(folder / "results.parquet")
    pd.testing.assert_frame_equal(read, result_frame(results), check_column_type=False)
    assert dict(read.dtypes.astype(str)) == types(columns.RESULTS)


def test_comparisons_name_type_and_source(folder: Path):
    with (folder / "comparisons.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["type"] for row in rows} == {"exact", "bound", "published", "measured", "regression"}
    assert next(row for row in rows if row["reference"] == "closed")["source"] == "source of closed"


def test_fields_of_every_run_are_exported(folder: Path):
    data = json.loads((folder / "wall-21" / "la.json").read_text(encoding="utf-8"))
    case = samples.bond()
    assert len(data["mechanism"]) == case.assembly.n_blocks == len(data["block_ids"])
    assert data["forces"] == samples.pressing(case.assembly).tolist()
    assert data["units"] == {"length": "m", "force": "kN"}


def test_figures_are_drawn_when_asked_for_only(tmp_path: Path):
    export(samples.typical(), tmp_path)
    assert not list(tmp_path.rglob("*.pdf"))


def test_every_case_has_a_figure(folder: Path):
    assert sorted(path.name for path in (folder / "figures").iterdir()) == [
        "hostile.pdf",
        "single-block.pdf",
        "wall-21.pdf",
    ]


def test_stale_files_go_and_foreign_files_stay(tmp_path: Path):
    run = samples.typical()
    export(run, tmp_path)
    (tmp_path / "mine.txt").write_text("mine", encoding="utf-8")
    (tmp_path / "wall-21" / "notes.json").write_text("{}", encoding="utf-8")
    export(ComparisonRun("", "", "", run.cases[:1]), tmp_path)
    assert not (tmp_path / "wall-21" / "la.json").exists()
    assert (tmp_path / "wall-21" / "notes.json").exists()
    assert (tmp_path / "mine.txt").exists()
    assert (tmp_path / "single-block" / "la.json").exists()


def test_index_cannot_lead_out_of_the_folder(tmp_path: Path):
    outside = tmp_path / "precious.txt"
    outside.write_text("keep", encoding="utf-8")
    folder = tmp_path / "data"
    folder.mkdir()
    names = ["../precious.txt", str(outside), "a/../../precious.txt"]
    (folder / "index.json").write_text(json.dumps({"files": names}), encoding="utf-8")
    export(ComparisonRun("", "", "", []), folder)
    assert outside.exists()


def test_method_names_are_made_into_file_names(tmp_path: Path):
    case = samples.bond()
    export(ComparisonRun("", "", "", [CaseResults(case, [samples.solved(case, "../../evil", 0.5)])]), tmp_path / "d")
    assert [path.name for path in tmp_path.iterdir()] == ["d"]


def test_every_chart_is_a_vector_file_with_its_data_beside_it(folder: Path):
    charts = folder / "charts"
    drawn = {path.stem for path in charts.glob("*.svg")}
    assert drawn
    assert drawn == {path.stem for path in charts.glob("*.csv")}
    for name in drawn:
        root = ElementTree.parse(charts / f"{name}.svg").getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        heads, *rows = list(csv.reader((charts / f"{name}.csv").read_text(encoding="utf-8").splitlines()))
        assert heads[0] == "series"
        assert len(rows) > 0
