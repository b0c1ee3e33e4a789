"""What a person hears of a wall stands in the JSON document too, and a question of the dead load alone says so."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.commands import drystone as command

PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}
DOWN = [{"blocks": ["ground"], "translation": [0, -1]}]


def wall(tmp_path: Path, **more: Any) -> Path:
    """A block on the ground whose unit weight is a density."""
    blocks = [
        {"id": "ground", "polygon": [[-1, -0.2], [2, -0.2], [2, 0], [-1, 0]], "fixed": True},
        {"id": "block", "polygon": [[0, 0], [0.4, 0], [0.4, 2], [0, 2]]},
    ]
    path = tmp_path / "wall.json"
    content = {"format": "wall/1", "unit_weight": 2000, "friction": 0.7, "blocks": blocks}
    path.write_text(json.dumps(content | more), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("arguments", "more"),
    [
        (["factor"], {"loads": PUSH}),
        (["domain"], {}),
        (["capacity"], {"loads": PUSH}),
        (["shake", "--pulse", "0.1:0.1"], {}),
        (["shake", "--pulse", "1:0.1", "--least"], {}),
        (["reaction"], {"settlements": DOWN}),
        (["reaction", "--held"], {"settlements": DOWN}),
        (["reaction", "--path"], {"settlements": DOWN}),
        (["reaction", "--without-dilatancy"], {"settlements": DOWN}),
        (["reaction", "--until-collapse"], {"settlements": DOWN}),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_warnings_stand_in_every_json_document(arguments: list[str], more: dict[str, Any], tmp_path: Path):
    done = command(arguments[0], wall(tmp_path, **more), *arguments[1:], "--json")
    told = json.loads(done.stdout)["warnings"]
    assert 'the unit weight of block "block" is 2000 kN/m3' in told[0]
    assert told[0] in done.stderr


@pytest.mark.parametrize(("word", "more"), [("domain", {}), ("factor", {}), ("reaction", {"settlements": DOWN})])
def test_a_question_that_counts_strength_as_plastic_says_so(word: str, more: dict[str, Any], tmp_path: Path):
    mortar = {"unit_weight": 20, "cohesion": 50, "tensile_strength": 20}
    done = command(word, wall(tmp_path, **mortar, **more), "--json")
    told = json.loads(done.stdout)["warnings"]
    assert [sentence for sentence in told if "of 1 of 1 joints counts as plastic" in sentence] == told
    assert len(told) == 1
    assert told[0] in done.stderr


def test_domain_warns_of_both_load_cases(tmp_path: Path):
    def water(unit_weight: float) -> dict[str, Any]:
        level = {"level": 2, "unit_weight": unit_weight}
        return {"live": {"pressures": [{"from": [0, 0], "to": [0, 2], "water": level}]}}

    path = wall(tmp_path, unit_weight=20, load_cases={"water": water(9.81), "flood": water(1000)})
    told = json.loads(command("domain", path, "--json").stdout)["warnings"]
    assert len(told) == 1
    assert "unit weight of 1000 kN/m3" in told[0]


def test_sweep_tells_the_warnings_of_the_described_wall_once(tmp_path: Path):
    """They were told nowhere: neither on the terminal nor in the document nor on the page."""
    asked = ["sweep", wall(tmp_path, loads=PUSH), "--vary", "friction=0.3,0.5", "--methods", "la-associated", "--json"]
    done = command(*asked, cwd=tmp_path)
    (told,) = json.loads(done.stdout)["warnings"]
    assert 'the unit weight of block "block" is 2000 kN/m3' in told
    assert done.stderr.count(told) == 1
    assert "the unit weight of block" in Path(tmp_path / json.loads(done.stdout)["report"]).read_text(encoding="utf-8")
    planned = command(*asked, "--dry-run", cwd=tmp_path)
    assert json.loads(planned.stdout)["warnings"] == [told]


def test_sweep_tells_the_doubts_of_walls_as_they_vary_each_kind_once(tmp_path: Path):
    """A friction of 5 and a thickness of a micrometre were swept without a word; a store says it too."""
    path = wall(tmp_path, unit_weight=20, loads=PUSH)
    values = ["--vary", "friction=0.5,3,5", "--vary", "thickness=1e-6,1"]
    asked = ["sweep", path, *values, "--methods", "la-associated", "--json"]
    told = json.loads(command(*asked, cwd=tmp_path).stdout)["warnings"]
    assert len(told) == 2
    assert told[0].startswith('block "block": the thickness is 1e-06 m: the unit of length?')
    assert told[0].endswith("(and 2 more walls)")
    assert told[1].startswith("friction is 3 in 1 of 1 interfaces: an angle?")
    assert told[1].endswith("(and 3 more walls)")
    again = command(*asked, cwd=tmp_path)
    assert json.loads(again.stdout)["warnings"] == told
    assert "block with friction = 0.5, thickness = 1e-06: " not in again.stdout
    assert f"with friction = 0.5, thickness = 1e-06: {told[0]}" in again.stderr
    assert "the thickness is 1e-06 m" in (tmp_path / json.loads(again.stdout)["report"]).read_text(encoding="utf-8")
    assert json.loads(command(*asked, "--dry-run", cwd=tmp_path).stdout)["warnings"] == told


def test_sweep_says_of_a_quantity_that_nothing_depends_on_that_it_varies_in_vain(tmp_path: Path):
    """The same multiplier was listed at every friction of a wall whose joints have their own, without a word."""
    path = wall(tmp_path, unit_weight=20, loads=PUSH)
    asked = ["sweep", "--vary", "friction=0.3,0.5", "--vary", "unit_weight=18,20", "--dry-run", "--json"]
    assert json.loads(command(*asked, path, cwd=tmp_path).stdout)["warnings"] == []
    described = json.loads(command("expand", path).stdout)
    path.write_text(json.dumps(described), encoding="utf-8")
    told = json.loads(command(*asked, path, cwd=tmp_path).stdout)["warnings"]
    vain = "varies, and no block, joint or load depends on it"  # blocks of an explicit wall have their own weight, too
    assert [sentence[: sentence.index(vain) - 1] for sentence in told] == ["friction", "unit_weight"]


def test_sweep_says_why_no_run_has_an_answer(tmp_path: Path):
    """Of a wall without a support nine runs were refused, and the exit code was that of an answer."""
    path = wall(tmp_path, unit_weight=20, loads=PUSH)
    described = json.loads(path.read_text(encoding="utf-8"))
    described["blocks"][0]["fixed"] = False
    path.write_text(json.dumps(described), encoding="utf-8")
    done = command("sweep", path, "--vary", "friction=0.5,3", "--methods", "la-associated", cwd=tmp_path)
    assert done.returncode == 1
    assert "2 of 2 runs refused: blocks: no block is fixed" in done.stdout


def test_a_wall_that_is_mended_by_what_varies_is_swept(tmp_path: Path):
    path = wall(tmp_path, unit_weight=20, loads=PUSH)
    described = json.loads(path.read_text(encoding="utf-8"))
    described["blocks"][1]["polygon"][0] = [0, -0.1]  # within the ground
    path.write_text(json.dumps(described), encoding="utf-8")
    varied = "blocks[1].polygon[0]=[0,0],[0.01,0]"
    done = command("sweep", path, "--vary", varied, "--methods", "la-associated", "--json", cwd=tmp_path)
    assert json.loads(done.stdout)["statuses"] == {"ok": 2}, done.stderr


@pytest.mark.parametrize(
    ("arguments", "more"),
    [(["factor"], {}), (["shake", "--pulse", "0.1:0.1"], {}), (["reaction"], {"settlements": DOWN})],
)
def test_a_question_of_the_dead_load_says_that_the_live_load_rests(
    arguments: list[str], more: dict[str, Any], tmp_path: Path
):
    loaded = command(arguments[0], wall(tmp_path, loads=PUSH, **more), *arguments[1:])
    assert "the live load of the wall does not act" in loaded.stderr
    without = command(arguments[0], wall(tmp_path, **more), *arguments[1:])
    assert "does not act" not in without.stderr


def test_a_share_of_the_live_load_acts(tmp_path: Path):
    assert "does not act" not in command("factor", wall(tmp_path, loads=PUSH), "--share", "0.1").stderr


def test_check_says_that_references_are_not_checked(tmp_path: Path):
    """A published value without a gate read "0 of 0 checked references are met", as if it had been held against it."""
    folder = tmp_path / "cases" / "mine"
    folder.mkdir(parents=True)
    wall(folder, unit_weight=20, loads=PUSH)
    about = 'source = "a paper"\nsummary = "A block."\ntitle = "A block"\n'
    value = 'value = 0.2\ntolerance = 0.01\napplies_to = ["la-associated"]\nrequirement = "It topples."\n'
    case = f'id = "mine"\nkind = "multiplier"\nwall = "wall.json"\n{about}'
    reference = f'[[references]]\nid = "paper"\ntype = "published"\nsource = "a paper"\n{value}'
    (folder / "case.toml").write_text(f'{case}{reference}tolerance_reason = "two digits"\n', encoding="utf-8")
    done = command("check", "mine", "--cases", tmp_path / "cases", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (
        "References without gate = true, which are not checked: 1. `drystone compare` compares with them" in done.stdout
    )
