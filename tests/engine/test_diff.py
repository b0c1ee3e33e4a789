"""Two sets of answers side by side: what counts as worse, gone or slower, and what a server of tests is told."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

from drystone.cli.main import main
from harness.engine.baseline import Baseline, Value, write_baseline
from harness.engine.diff import Answered, Answers, difference, read_answers
from harness.engine.store import open_store
from harness.model.difference import Kind, Slower
from harness.model.errors import InputError
from harness.model.method import Status
from tests.walls import stack, wall_data

HERE, THERE = {"processor": "one"}, {"processor": "another"}


def answered(multiplier: float | None, seconds: float | None = None, *, least: bool = True, machine=HERE) -> Answered:
    status = Status.TIMEOUT if multiplier is None else Status.OK
    return Answered(Value(status=status, finding="collapses", multiplier=multiplier), least, seconds, machine)


def answers(**rows: Answered) -> Answers:
    return Answers("made up", {("wall", method): row for method, row in rows.items()})


@pytest.mark.parametrize(
    ("old", "new", "kind"),
    [
        (answered(0.5, 1.0), answered(0.49, 1.0), Kind.BETTER),
        (answered(0.5, 1.0), answered(0.51, 1.0), Kind.WORSE),
        (answered(0.5, 1.0, least=False), answered(0.49, 1.0, least=False), Kind.WORSE),
        (answered(0.5, 1.0), answered(None, 1.0), Kind.WORSE),
        (answered(None, 1.0), answered(0.5, 9.0), Kind.BETTER),
        (answered(0.5, 1.0), answered(0.5, 1.49), Kind.SAME),
        (answered(0.5, 1.0), answered(0.5, 1.51), Kind.SLOWER),
        (answered(0.5, 0.01), answered(0.5, 0.09), Kind.SAME),  # short runs consist of their start
        (answered(0.5, 1.0), answered(0.5, 9.0, machine=THERE), Kind.SAME),
        (answered(0.5, 1.0), answered(0.51, 9.0), Kind.WORSE),
    ],
)
def test_a_row_is_worse_by_its_value_and_slower_by_its_time_on_one_machine(old, new, kind):
    (row,) = difference(answers(la=old), answers(la=new), Slower(share=0.5, floor=0.1)).rows
    assert row.kind is kind


def test_what_is_not_there_any_more_is_gone_but_a_baseline_holds_more_than_one_runs():
    old, new = answers(la=answered(0.5), fe=answered(0.5)), answers(la=answered(0.5), de=answered(0.5))
    found = difference(old, new)
    assert [(row.method, row.kind) for row in found.rows] == [
        ("fe", Kind.GONE),
        ("de", Kind.NEW),
        ("la", Kind.SAME),
    ]
    assert not found.passed
    kept = Answers("a baseline", old.rows, is_baseline=True)
    against = difference(kept, new)
    assert (against.passed, against.not_run, against.counts[Kind.GONE]) == (True, 1, 0)


def test_times_of_a_method_are_told_by_the_median_over_pairs():
    old = Answers("old", {(case, "la"): answered(0.5, 1.0) for case in "abc"})
    new = Answers("new", {(case, "la"): answered(0.5, time) for case, time in zip("abc", (0.9, 1.2, 4.0), strict=True)})
    (pair,) = difference(old, new).pairs
    assert (pair.method, pair.number, pair.ratio, pair.slower) == ("la", 3, pytest.approx(1.2), 2)


def test_stores_and_baselines_are_read_and_told_in_every_form(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("wall.json").write_text(json.dumps(wall_data(stack(2), 0.65)))
    run = CliRunner().invoke
    made = run(
        main, ["compare", "wall.json", "--methods", "la,fe", "--no-report", "--jobs", "1", "--store", "a.sqlite",
               "--junit", "compare.xml"],
    )  # fmt: skip
    assert made.exit_code == 0, made.output
    tests = ElementTree.parse("compare.xml").getroot().findall(".//testcase")
    assert {"la: run", "fe: run"} <= {test.get("name") for test in tests}

    with open_store(Path("a.sqlite"), read_only=True) as store:
        kept = {row[2]: Value(status=Status.OK, finding="collapses", multiplier=row[6]) for row in store.table()}
    kept["la"].multiplier = (kept["la"].multiplier or 0.0) - 0.01  # as if a lower state had been known
    write_baseline(Path("old.json"), Baseline(values={"wall": kept}))
    done = run(main, ["diff", "old.json", "a.sqlite", "--json", "--html", "d.html", "--junit", "d.xml"])
    assert done.exit_code == 1
    document = json.loads(done.output)
    assert document["counts"] == {"worse": 1, "gone": 0, "slower": 0, "better": 0, "new": 0, "same": 1}
    assert document["rows"][0]["method"] == "la"
    suite = ElementTree.parse("d.xml").getroot()[0]
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    page = Path("d.html").read_text(encoding="utf-8")
    assert "Something is worse" in page
    assert "http" not in page.split("</style>")[1]

    same = run(main, ["diff", "a.sqlite", "a.sqlite"])
    assert same.exit_code == 0
    assert "2 same." in same.output
    assert "1.00 times as long" in same.output


def test_a_file_that_is_neither_is_refused_by_name(tmp_path: Path):
    with pytest.raises(InputError, match=r"absent\.sqlite: there is no such file"):
        read_answers(tmp_path / "absent.sqlite")
    with open_store(tmp_path / "empty.sqlite"):
        pass
    with pytest.raises(InputError, match="no comparison is in the store"):
        read_answers(tmp_path / "empty.sqlite")
