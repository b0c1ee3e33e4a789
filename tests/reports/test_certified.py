"""The certificate beside a case makes its least state the minimum, in the report too; a broken one is told."""

from __future__ import annotations

import gzip
import json
import shutil
import sqlite3
from pathlib import Path

import pytest

import drystone
from harness.certificates import with_certificates
from harness.engine.compare import recall
from harness.engine.regression import violations
from harness.engine.store import open_store
from harness.model.case import read_case, shipped_cases
from harness.model.comparison import ComparisonRun
from reports.opening import wall_findings, which_number
from reports.tables import run_row

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
    assert "proved in fractions" in which_number(item)
    rows = {result.method: run_row(0, number, item) for number, result in enumerate(item.results)}
    assert rows["la"].proved
    assert not rows["fe"].proved
    (gate,) = [gate for gate in item.gates if gate.name == "certificate"]
    assert gate.passed
    assert compared.violations == []


def test_a_broken_certificate_is_a_violation_and_proves_nothing(tmp_path: Path):
    shutil.copytree(shipped_cases() / "wall-21", tmp_path / "wall-21")
    file = tmp_path / "wall-21" / "certificate.json.gz"
    document = json.loads(gzip.decompress(file.read_bytes()))
    document["bound"] = "56/100"
    file.write_bytes(gzip.compress(json.dumps(document).encode()))
    compared = compared_on(tmp_path / "wall-21")
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
    assert any("no collapse state lies below the bound" in sentence for sentence in violations(again))


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
