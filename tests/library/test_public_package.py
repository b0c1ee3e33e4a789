"""`import drystone`: what a notebook or a script does with it, and what it says when files lie in the way."""

from __future__ import annotations

import doctest
import importlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import drystone

ROOT = Path(drystone.__file__).resolve().parent.parent
WALL = drystone.new_wall("stack", count=3, width=0.3, height=0.2, friction=0.8)
MULTIPLIER = 0.5
"""Width over height of the whole stack, 0.3 / 0.6: it topples about its lower corner."""


MODULES = [
    "drystone",
    *(f"drystone.{name}" for name in ("walls", "analysis", "comparing", "safety", "studies", "checking")),
]


@pytest.mark.parametrize("module", MODULES)
def test_examples_in_docstrings_say_what_comes_out(module: str):
    assert doctest.testmod(importlib.import_module(module)).failed == 0


def test_every_public_name_is_there_and_documented():
    for name in drystone.__all__:
        assert name.startswith("__") or getattr(drystone, name).__doc__


def test_an_analysis_is_judged_and_gives_tables_with_units():
    result = drystone.analyse(WALL, "la-associated")
    assert result.multiplier == pytest.approx(MULTIPLIER, abs=1e-8)
    assert result.judge.accepted
    assert drystone.judge(WALL, result).accepted
    table = result.to_pandas()
    assert table["multiplier"][0] == result.multiplier
    assert table.attrs["units"]["cpu_seconds"] == "s"
    forces = result.forces_to_pandas()
    assert forces.attrs["units"]["n1"] == WALL.units["force"]
    # the lowest joint bears the weight of all three stones
    weight = WALL.assembly.weight[~WALL.assembly.fixed].sum()
    assert (forces["n1"] + forces["n2"]).max() == pytest.approx(weight)
    assert len(result.mechanism_to_pandas()) == WALL.assembly.n_blocks


def test_a_comparison_has_a_process_a_run_and_costs_a_row_where_one_dies(tmp_path: Path):
    compared = drystone.compare(WALL, ["la-associated", "dummy"])
    assert [item.method for item in compared.results] == ["la-associated", "dummy"]
    assert compared.multipliers()["la-associated"].iloc[0] == pytest.approx(MULTIPLIER, abs=1e-8)
    assert compared.report(tmp_path / "report.html").exists()
    here = drystone.compare([WALL], ["la-associated"], isolated=False)
    assert here.results[0].multiplier == pytest.approx(compared.results[0].multiplier)
    assert 'alt="Mechanism of ' in here.results[0]._repr_html_()
    assert 'alt="The wall ' in WALL._repr_html_()
    assert "la-associated" in compared._repr_html_()
    assert compared.plot().axes


def test_wrong_input_is_told_as_by_the_command(tmp_path: Path):
    with pytest.raises(drystone.InputError, match=r"no method is called"):
        drystone.analyse(WALL, "al")
    with pytest.raises(drystone.InputError, match=r"settings"):
        drystone.analyse(WALL, "la-associated", no_such_setting=1)
    with pytest.raises(drystone.InputError, match=r"two walls are called"):
        drystone.compare([WALL, WALL], ["la-associated"])
    with pytest.raises(drystone.InputError, match=r"no kind of wall"):
        drystone.new_wall("stak")
    path = tmp_path / "wall.json"
    WALL.save(path)
    assert drystone.read_wall(path).document() == WALL.document()
    path.write_text(json.dumps(WALL.document() | {"frction": 1}), encoding="utf-8")
    with pytest.raises(drystone.InputError, match=r"frction"):
        drystone.read_wall(path)


@pytest.mark.parametrize("name", ["harness.py", "methods.py", "cases/__init__.py", "reports.py"])
def test_a_file_of_one_of_our_names_is_told_in_one_sentence(tmp_path: Path, name: str):
    obstacle = tmp_path / name
    obstacle.parent.mkdir(exist_ok=True)
    obstacle.write_text("", encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    ran = subprocess.run(
        [sys.executable, "-m", "drystone", "list", "methods"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert ran.returncode == 2
    assert ran.stdout == ""
    lines = ran.stderr.splitlines()
    assert len(lines) == 1
    assert str(tmp_path / name.split("/")[0]) in lines[0]
    assert "rename" in lines[0]


def test_a_script_without_a_main_guard_may_compare(tmp_path: Path):
    script = tmp_path / "script.py"
    script.write_text(
        "import drystone\n"
        "wall = drystone.new_wall('stack', count=1)\n"
        "print(len(drystone.compare(wall, ['la-associated', 'dummy']).results))\n",
        encoding="utf-8",
    )
    ran = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False, timeout=120)
    assert (ran.stdout, ran.returncode) == ("2\n", 0), ran.stderr


def test_a_sweep_gives_rows_in_order_tables_and_a_page_and_finds_runs_again(tmp_path: Path):
    store, told = tmp_path / "runs.sqlite", list[bool]()
    vary = {"friction": [0.3, 0.4, 0.8]}
    done = drystone.sweep(WALL, vary, ["la-associated"], store=store, jobs=2, progress=told.append)
    table = done.to_pandas()
    # friction below 0.5 lets the lowest joint slide; above, the stack topples
    assert list(table["friction"]) == vary["friction"]
    assert table["multiplier"].tolist() == pytest.approx([0.3, 0.4, MULTIPLIER], abs=1e-8)
    assert (told, done.rejected) == ([False] * 3, 0)
    assert "quantiles" in done.tables
    assert {path.name for path in done.save(tmp_path / "out")} >= {"runs.csv", "quantiles.csv"}
    assert "friction" in done.report(tmp_path / "out.html").read_text(encoding="utf-8")
    assert "<table" in done._repr_html_()
    again = drystone.sweep(WALL, vary, ["la-associated"], store=store, progress=told.append)
    assert told[3:] == [True] * 3
    assert again.to_pandas()["multiplier"].tolist() == table["multiplier"].tolist()


def test_a_sweep_takes_a_shipped_study_with_changes_and_refuses_what_varies_nothing():
    done = drystone.sweep("friction", methods=["la-associated"])
    assert set(done.to_pandas()["method"]) == {"la-associated"}
    with pytest.raises(drystone.InputError, match=r"nothing of"):
        drystone.sweep(WALL)
    with pytest.raises(drystone.InputError, match='no study is called "frictoin"'):
        drystone.sweep("frictoin")
    with pytest.raises(drystone.InputError, match=r"defines what varies"):
        drystone.sweep("friction", {"friction": [0.5]})


def test_a_check_holds_methods_to_gated_references():
    checked = drystone.check([drystone.library_wall("slide"), drystone.library_wall("topple")])
    assert checked.passed
    table = checked.to_pandas()
    assert set(table["case"]) == {"slide", "topple"}
    assert set(table["verdict"]) == {"agrees"}
    assert "references are met" in checked._repr_html_()


@pytest.mark.parametrize(
    "ask",
    [
        drystone.analyse,
        drystone.compare,
        lambda path: drystone.compare([path]),
        drystone.check,
        drystone.factor,
        drystone.domain,
        drystone.capacity,
        lambda path: drystone.shake(path, "0.1:0.1"),
        lambda path: drystone.least_shaking(path, "0.1:0.1"),
        lambda path: drystone.judge(path, drystone.analyse(drystone.new_wall("stack"), "la-associated")),
    ],
)
def test_a_path_in_place_of_a_wall_is_told_how_it_becomes_one(ask: Callable[[str], object]):
    """It ended in an AttributeError of a str, deep inside."""
    with pytest.raises(
        drystone.InputError, match=r"'garden.json' is no wall. Give drystone.read_wall\('garden.json'\)"
    ):
        ask("garden.json")


def test_a_path_in_place_of_data_and_an_unknown_number_of_a_kind_are_told():
    with pytest.raises(
        drystone.InputError, match=r"'garden.json' is no wall. Give the data of a wall; drystone.read_wall reads"
    ):
        drystone.build_wall("garden.json")
    with pytest.raises(drystone.InputError, match=r'arch: it has no number "fricton". Did you mean "friction"'):
        drystone.new_wall("arch", fricton=0.6)
