"""`drystone validate`: faults, doubts, and what joints and answers a drawing has over the tolerance."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from drystone.cli.main import main
from harness.engine.sensitivity import Plateau, suggested
from harness.model.build import build
from harness.model.case import shipped_cases
from harness.model.wall import Wall
from tests.walls import PUSH, running_bond, wall_data


def off(by: float, **more: Any) -> dict[str, Any]:
    """Running bond of 4 courses with one brick lower than it is meant to be."""
    wall = build(Wall.model_validate(wall_data(running_bond(3, 4), 0.65))).wall.model_dump(by_alias=True, mode="json")
    wall = wall | {"pattern": None, "interfaces": more}
    wall["blocks"][7]["polygon"] = [[x, y - by] for x, y in wall["blocks"][7]["polygon"]]
    return wall


def validated(tmp_path: Path, wall: dict[str, Any]) -> tuple[int, dict[str, Any]]:
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall))
    run = CliRunner().invoke(main, ["validate", str(path), "--json"])
    return run.exit_code, json.loads(run.stdout)


def test_brick_a_little_low_is_told_with_the_tolerance_that_finds_its_joints(tmp_path: Path):
    wall = off(0.001, greatest_overlap=0.002)
    code, told = validated(tmp_path, wall)
    assert code == 0
    assert [doubt["size"] for doubt in told["doubts"] if "face each other" in doubt["text"]] == [
        pytest.approx(0.001)
    ] * 2  # both bricks that stand on it
    most = max(told["tolerances"], key=lambda item: item["joints"] or 0)
    assert most["joints"] > told["joints"]
    assert most["low"] <= told["suggested_tolerance"] <= most["high"]
    code, mended = validated(tmp_path, off(0.001, tolerance=told["suggested_tolerance"]))
    assert (code, mended["joints"], mended["doubts"]) == (0, most["joints"], [])


def test_wall_that_cannot_be_built_is_shown_over_the_tolerance_all_the_same(tmp_path: Path):
    code, told = validated(tmp_path, off(0.001))
    assert code == 2
    assert told["joints"] is None
    assert [fault["size"] for fault in told["faults"]] == [pytest.approx(0.001)] * 2  # both that it stands in
    assert all("overlap" in fault["text"] for fault in told["faults"])
    assert told["tolerances"][-1]["joints"]


def test_a_method_that_eats_memory_costs_its_answer_alone():
    run = CliRunner().invoke(main, ["validate", "wall-21", "--method", "de", "--memory", "16", "--json"])
    assert run.exit_code == 0
    (plateau,) = json.loads(run.stdout)["tolerances"]
    assert plateau["answer"] == "out_of_memory: It was stopped at the limit of 16 MiB of memory."


def square(name: str, x: float, y: float, size: float = 1.0, **more: Any) -> dict[str, Any]:
    corners = [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]
    return {"id": name, "polygon": corners, **more}


def faulty() -> dict[str, Any]:
    """A wall with one fault of every kind, and a sound column between them."""
    return wall_data({}) | {
        "pattern": None,
        "friction": {"default": 0.6, "rules": [{"materials": ["stone", "granit"], "value": 0.3}]},
        "blocks": [
            {"id": "ground", "polygon": [[-1, -1], [20, -1], [20, 0], [-1, 0]], "fixed": True},
            square("sound", 0.0, 0.0),
            square("deep", 2.0, -0.2),
            square("deeper", 4.0, -0.3),
            square("away", 6.0, 3.0),
            square("near", 8.0, 0.01),
            {"id": "crossed", "polygon": [[10, 0], [11, 1], [11, 0], [10, 1]]},
            square("on crossed", 10.0, 1.0),
            square("twice", 12.0, 0.0),
            square("twice", 14.0, 0.0),
            square("light", 16.0, 0.0, unit_weight="much"),
        ],
        "loads": PUSH | {"dead": {"points": [{"block": "grond", "at": [0, 0], "force": [1, 0]}]}},
    }


def test_every_fault_is_listed_at_once_with_place_and_size(tmp_path: Path):
    code, told = validated(tmp_path, faulty())
    assert code == 2
    by_element = {fault["element"]: fault for fault in told["faults"]}
    assert set(by_element) == {
        'blocks "ground" and "deep"',
        'blocks "ground" and "deeper"',
        'block "away"',
        'block "near"',
        'block "crossed"',
        'blocks[9] ("twice")',
        'blocks[10].unit_weight ("light")',
        "loads.dead.points[0]",
    }
    assert by_element['blocks "ground" and "deeper"']["size"] == pytest.approx(0.3)
    assert by_element['blocks "ground" and "deeper"']["at"] == pytest.approx([4.5, -0.15])
    assert by_element['block "away"']["at"] == pytest.approx([6.5, 3.5])
    missed, unknown = told["doubts"]
    assert 'no block is of the material "granit"' in unknown["text"]
    assert missed["size"] == pytest.approx(0.01)
    assert missed["blocks"] == ["ground", "near"]
    assert missed["at"] == pytest.approx([8.5, 0.005])
    assert [row["number"] for row in told["faults"] + told["doubts"]] == list(
        range(1, 1 + len(told["faults"] + told["doubts"]))
    )


def test_a_wrong_joint_is_named_by_its_number_in_the_file(tmp_path: Path):
    """One joint is found; of those given the first is of an unknown block and the second has no length."""
    given = [
        {"between": ["none", "ground"], "from": [0, 0], "to": [1, 0]},
        {"between": ["a", "ground"], "from": [0, 0], "to": [0, 0]},
    ]
    blocks = [{"id": "ground", "polygon": [[-1, -1], [5, -1], [5, 0], [-1, 0]], "fixed": True}, square("a", 0.0, 0.0)]
    wall = wall_data({}) | {"pattern": None, "blocks": [*blocks, square("b", 3.0, 0.0)], "loads": PUSH}
    code, told = validated(tmp_path, wall | {"interfaces": {"given": given}})
    assert code == 2
    (coincide,) = [fault for fault in told["faults"] if "its two ends coincide" in fault["text"]]
    assert coincide["element"] == "interfaces[1]"


def test_material_that_no_block_is_of_is_doubted_with_the_one_that_was_meant(tmp_path: Path):
    wall = off(0.0) | {"friction": {"default": 0.6, "rules": [{"materials": ["stone", "stome"], "value": 0.3}]}}
    _, told = validated(tmp_path, wall)
    (doubt,) = told["doubts"]
    assert 'no block is of the material "stome"' in doubt["text"]
    assert 'Did you mean "stone"?' in doubt["text"]


def test_sound_wall_has_one_plateau(tmp_path: Path):
    code, told = validated(tmp_path, off(0.0))
    assert code == 0
    assert told["doubts"] == []
    assert [item["joints"] for item in told["tolerances"]] == [told["joints"]]


@pytest.mark.parametrize(
    ("ranges", "right"),
    [
        # A survey in millimetres: as drawn, the plateau of the joints, and one in which a thin stone is lost.
        ([(5e-4, 2.2, 120), (2.9, 21.8, 210), (29.1, 51.7, 230)], (2.9 * 21.8) ** 0.5),
        # Exact to all digits: one plateau, of which what is finer than a hundredth of the greatest does not count.
        ([(1e-6, 0.1, 40)], (1e-3 * 0.1) ** 0.5),
        # What cannot be built is no plateau, however wide.
        ([(1e-6, 0.01, None), (0.0133, 0.1, 12)], (0.0133 * 0.1) ** 0.5),
    ],
)
def test_tolerance_that_is_recommended_is_the_middle_of_the_widest_plateau(ranges: Any, right: float) -> None:
    advice = suggested([Plateau(low, high, joints, "") for low, high, joints in ranges])
    assert advice is not None
    assert advice[0] == pytest.approx(right)


def test_no_tolerance_is_recommended_where_none_gives_joints() -> None:
    assert suggested([]) is None
    assert suggested([Plateau(0.1, 1.0, None, "no"), Plateau(1.0, 2.0, 0, "none")]) is None


@pytest.mark.parametrize("named", ["load_cases", "travelling"])
def test_wall_with_load_cases_has_a_table_under_the_first_of_them(tmp_path: Path, named: str):
    alone = off(0.001, greatest_overlap=0.002)
    _, plain = validated(tmp_path, alone)
    given = {"push": alone["loads"]} if named == "load_cases" else {"push": {"force": [0, -1]}}
    code, told = validated(tmp_path, alone | {"loads": {}, named: given})
    assert code == 0
    assert [item["joints"] for item in told["tolerances"]] == [item["joints"] for item in plain["tolerances"]]
    assert (told["tolerances"] == plain["tolerances"]) is (named == "load_cases")
    run = CliRunner().invoke(main, ["validate", str(tmp_path / "wall.json")])
    assert f"the answers are those of the load case push{'-1' * (named == 'travelling')}\n" in run.stdout


def test_a_case_is_looked_over_as_its_wall_file_is():
    folder = shipped_cases() / "topple"
    told = [CliRunner().invoke(main, ["validate", str(word)]) for word in ("topple", folder, folder / "wall.json")]
    assert [run.exit_code for run in told] == [0, 0, 0]
    assert told[0].stdout == told[1].stdout == told[2].stdout
    unknown = CliRunner().invoke(main, ["validate", "toppel"])
    assert (unknown.exit_code, unknown.stdout) == (2, "")
    assert 'no case is called "toppel"' in unknown.stderr


def test_doubts_of_all_load_cases_are_listed_and_a_refusal_has_its_reason(tmp_path: Path):
    """Only the first load case was looked at, and a wall that every method refuses was "refused" and no more."""
    blocks = [
        {"id": "ground", "polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]], "fixed": True},
        {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
    ]

    def water(unit_weight: float) -> dict[str, Any]:
        level = {"level": 1, "unit_weight": unit_weight}
        return {"live": {"pressures": [{"from": [0, 0], "to": [0, 1], "water": level}]}}

    wall = {"format": "wall/1", "unit_weight": 2000, "friction": 0.5, "blocks": blocks}
    wall |= {"load_cases": {"river": water(9.81), "flood": water(1000)}}
    wall |= {"settlements": [{"blocks": ["ground"], "translation": [0, -1]}]}
    code, told = validated(tmp_path, wall)
    assert code == 0
    assert [doubt["number"] for doubt in told["doubts"]] == [1, 2]
    assert told["doubts"][0]["text"].startswith("the unit weight of block")
    assert "load case flood: loads.live.pressures[0] has a unit weight of 1000 kN/m3" in told["doubts"][1]["text"]
    refusal = "refused: la-associated takes supports at rest only; ground moves."
    assert told["tolerances"][0]["answer"].startswith(refusal)
