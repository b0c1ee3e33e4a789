"""The certificate beside a case makes its least state the minimum, in the report too; a broken one is told."""

from __future__ import annotations

import gzip
import json
import shutil
import sqlite3
from pathlib import Path
from typing import Any

import pytest

import drystone
from drystone import certificates
from drystone.certificates import is_below, with_certificates
from drystone.cli import terminal
from harness.engine.compare import recall
from harness.engine.store import open_store
from harness.engine.verdict import violations
from harness.model.case import read_case, shipped_cases
from harness.model.comparison import Certified, ComparisonRun
from reports import appendix
from reports.page.summary import wall_findings, which_number
from reports.page.tables import run_row
from tests.commands import drystone as run_command

LEAST = 1567589759 / 2809311829
"""Minimum of the paper's wall on friction .65, proved in fractions."""


def compared_on(folder: Path) -> drystone.Comparison:
    return drystone.compare(drystone.Wall(read_case(folder)), ["la", "fe"], isolated=False)


def test_the_minimum_of_a_wall_with_a_certificate_is_called_so():
    compared = compared_on(shipped_cases() / "wall-21")
    (item,) = compared.run.cases
    assert item.certified is not None
    assert LEAST * (1 - 2e-6) <= item.certified.bound <= LEAST
    assert "(LA, minimum, proved)" in wall_findings(item)
    assert (
        "minimum, proved: an exact certificate proves that no collapse state lies from zero to below 0.557997"
        in which_number(item)
    )
    rows = {result.method: run_row(0, number, item) for number, result in enumerate(item.results)}
    assert rows["la"].proved
    assert not rows["fe"].proved
    (gate,) = [gate for gate in item.gates if gate.name == "certificate"]
    assert gate.passed
    assert compared.violations == []


def test_a_broken_certificate_is_a_violation_and_proves_nothing(tmp_path: Path):
    folder = shutil.copytree(shipped_cases() / "running-bond-overturns", tmp_path / "running-bond-overturns")
    file = folder / "certificate.json.gz"
    document = json.loads(gzip.decompress(file.read_bytes()))
    document["bound"] = "56/100"
    file.write_bytes(gzip.compress(json.dumps(document).encode()))
    compared = compared_on(folder)
    (item,) = compared.run.cases
    assert item.certified is None
    assert "minimum" not in wall_findings(item)
    assert any("certificate.json.gz is refused" in sentence for sentence in violations(compared.run))


def test_a_state_below_the_bound_is_a_violation():
    compared = compared_on(shipped_cases() / "slide")
    (item,) = compared.run.cases
    low = [r.model_copy(update={"multiplier": 0.5 * r.multiplier}) for r in item.results if r.multiplier is not None]
    item.results[:] = low
    item.gates[:] = []
    again = with_certificates(compared.run)
    assert any("no collapse state lies from zero to below the bound" in sentence for sentence in violations(again))


def test_a_wall_without_a_certificate_has_no_gate_of_it():
    wall = drystone.new_wall("stack", count=2, width=0.3, height=0.2, friction=0.5)
    compared = drystone.compare(wall, ["la"], isolated=False)
    assert all(gate.name != "certificate" for gate in compared.run.cases[0].gates)
    assert compared.run.cases[0].certified is None


def recalled(store: Path) -> ComparisonRun:
    with open_store(store, read_only=True) as opened:
        found = recall(opened)
    assert found is not None
    return with_certificates(found)


def test_a_store_proves_nothing_its_certificates_are_checked_again(tmp_path: Path):
    folder, store = tmp_path / "slide", tmp_path / "runs.sqlite"
    shutil.copytree(shipped_cases() / "slide", folder)
    drystone.compare(drystone.Wall(read_case(folder)), ["la"], store=store)
    (item,) = recalled(store).cases
    assert item.certified is not None
    assert item.certified.bound == pytest.approx(0.3, abs=1e-6)

    with sqlite3.connect(store) as database:
        ((text,),) = database.execute("SELECT content FROM comparison").fetchall()
        kept = json.loads(text) | {"verified": {"0": {"bound": 1000.0, "sentence": "", "source": ""}}}
        database.execute("UPDATE comparison SET content = ?", (json.dumps(kept),))
    (item,) = recalled(store).cases
    assert item.certified is not None
    assert item.certified.bound < 0.3

    file = folder / "certificate.json"
    file.write_text(file.read_text().replace('"1499997/5000000"', '"1499998/5000000"', 1))
    (item,) = recalled(store).cases
    assert item.certified is None
    assert any("certificate.json is refused" in sentence for sentence in violations(recalled(store)))


GARDEN = {
    "format": "wall/1",
    "unit_weight": 20,
    "friction": 0.75,
    "pattern": {
        "type": "running_bond",
        "block_length": 0.4,
        "block_height": 0.2,
        "count": 10,
        "bricks": 1,
        "start": "full",
    },
    "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
}
"""The wall of the library that overturns at .2; its windows are checked in a tenth of the time of those of wall-21."""


def garden(**changes: Any) -> drystone.Wall:
    return drystone.build_wall(GARDEN | changes)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"unit_weight": 7.3},
        {"pattern": {**GARDEN["pattern"], "prefix": "stone-"}},
    ],
)
def test_a_wall_written_elsewhere_has_the_certificate_of_the_equal_wall_of_the_library(changes: dict[str, Any]):
    wall = garden(**changes)
    found = drystone.analyse(wall, "la")
    assert found.proof.standing == "minimum"
    assert found.proof.bound == pytest.approx(0.2, rel=3e-6)


def test_another_wall_has_no_certificate_of_the_library():
    for changes in ({"friction": 0.7501}, {"pattern": {**GARDEN["pattern"], "block_length": 0.41}}):
        assert certificates.certificates_for(garden(**changes).case) == []
    nearly = garden(friction=0.75 + 1e-8)  # found by its content, and refused as it is not the same
    assert len(certificates.certificates_for(nearly.case)) == 1
    compared = drystone.compare(nearly, ["la"], isolated=False)
    assert compared.run.cases[0].certified is None
    assert compared.violations == []


def test_every_output_says_the_same_of_a_proved_minimum(tmp_path: Path):
    """Of the block on two supports, whose minimum the springs do not find."""
    file = tmp_path / "block.json"
    shutil.copy(shipped_cases() / "single-block" / "wall.json", file)
    wall = drystone.read_wall(file)
    compared = drystone.compare(wall, ["fe", "la"], isolated=False)
    item = compared.run.cases[0]
    said = "an exact certificate proves that no collapse state lies from zero to below 0.399999"
    rows = compared.to_pandas().set_index("method")
    assert said in rows.loc["la", "proof_sentence"]
    assert rows["proof"].tolist() == ["none", "minimum"]
    assert [result.proof.standing for result in compared.results] == ["none", "minimum"]
    written = terminal.comparison_json(compared.run, None)["cases"][0]["results"]
    assert [each["proof"]["standing"] for each in written] == ["none", "minimum"]
    assert said in appendix.render(compared.run)
    assert run_row(0, 1, item).proved
    assert said in which_number(item)
    assert said in " ".join(run_command("run", "la", file).stdout.split())
    alone = json.loads(run_command("run", "la", file, "--json").stdout)
    assert alone["proof"]["standing"] == "minimum"
    store = tmp_path / "runs.sqlite"
    listed = run_command("compare", file, "--methods", "la", "--no-report", "--store", store).stdout
    assert said in " ".join(listed.split())
    assert "∎ 0.4" in listed


def test_a_certificate_that_a_method_hands_on_counts_only_as_far_as_it_is_checked_here():
    wall = drystone.new_wall("stack", count=2, width=0.3, height=0.2, friction=0.5)
    compared = drystone.compare(wall, ["la"], isolated=False)
    (item,) = compared.run.cases
    other = json.loads((shipped_cases() / "slide" / "certificate.json").read_text())
    item.results[0].details.update(certificate=other, certified_bound=item.results[0].multiplier)
    (again,) = with_certificates(compared.run).cases
    assert again.certified is None


@pytest.mark.parametrize(("value", "below"), [(-0.1, False), (0.1, True)])
def test_a_certificate_excludes_no_multiplier_below_zero(value: float, below: bool):
    wall = drystone.new_wall("stack", count=2, width=0.3, height=0.2, friction=0.5)
    (item,) = drystone.compare(wall, ["la"], isolated=False).run.cases
    result = item.results[0].model_copy(update={"multiplier": value})
    assert is_below(result, Certified(0.2, "", "")) is below
