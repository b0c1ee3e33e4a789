"""A drawing mended: nothing moves further than allowed, and the joints of the exact wall are found again."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from drystone.cli.main import main
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method_registry import load_method
from harness.model.repair import repair
from harness.model.wall import Detection, Wall
from tests.walls import running_bond, wall_data

SNAP = 0.008


def multiplier(wall: Wall) -> float | None:
    method = load_method("la-associated")
    return method.solve(build(wall).assembly, method.Settings()).multiplier


def surveyed(seed: int) -> tuple[Wall, Wall]:
    """Running bond, exact, and with every vertex up to 2 mm off, which no tolerance of the exact one holds together."""
    rng = np.random.default_rng(seed)
    exact = build(Wall.model_validate(wall_data(running_bond(3, 4), 0.65))).wall
    data = exact.model_dump(by_alias=True, mode="json") | {"pattern": None, "interfaces": {}}
    for block in data["blocks"]:
        block["polygon"] = (np.array(block["polygon"]) + rng.uniform(-0.002, 0.002, (4, 2))).tolist()
    return exact, Wall.model_validate(data)


@pytest.mark.parametrize("seed", range(12))
def test_surveyed_wall_gets_the_joints_of_the_exact_one_and_nothing_moves_too_far(seed: int):
    exact, drawn = surveyed(seed)
    mended = repair(drawn, SNAP)
    assert mended.moves
    assert max(move.distance for move in mended.moves) <= SNAP
    built = build(mended.wall)
    assert built.warnings == ()
    assert built.assembly.n_interfaces == build(exact).assembly.n_interfaces
    assert multiplier(mended.wall) == pytest.approx(multiplier(exact), rel=0.03)


def test_sound_wall_does_not_move():
    exact, _ = surveyed(0)
    mended = repair(exact.model_copy(update={"interfaces": Detection()}), SNAP)
    assert mended.moves == ()
    assert mended.doubles == ()


def test_outline_drawn_twice_is_taken_once():
    _, drawn = surveyed(1)
    twice = drawn.blocks[5].model_copy(update={"id": "again"})
    mended = repair(drawn.model_copy(update={"blocks": [*drawn.blocks, twice]}), SNAP)
    assert mended.doubles == (("again", drawn.blocks[5].id),)
    assert len(mended.wall.blocks) == len(drawn.blocks)


def drawn(*outlines: list[list[float]]) -> Wall:
    blocks = [{"id": name, "polygon": outline} for name, outline in zip("abcd", outlines, strict=False)]
    blocks[0]["fixed"] = True
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "blocks": blocks}
    return Wall.model_validate(data)


def box(left: float, low: float, right: float, high: float) -> list[list[float]]:
    return [[left, low], [right, low], [right, high], [left, high]]


def test_corners_that_nearly_meet_meet_in_their_middle():
    mended = repair(drawn(box(0, 0, 1, 1), box(1.25, 0, 2, 1)), 0.25)
    assert [block.polygon for block in mended.wall.blocks] == [
        [(0.0, 0.0), (1.125, 0.0), (1.125, 1.0), (0.0, 1.0)],
        [(1.125, 0.0), (2.0, 0.0), (2.0, 1.0), (1.125, 1.0)],
    ]
    assert [(move.block, move.vertex, move.start, move.end) for move in mended.moves] == [
        ("a", 1, (1.0, 0.0), (1.125, 0.0)),
        ("a", 2, (1.0, 1.0), (1.125, 1.0)),
        ("b", 0, (1.25, 0.0), (1.125, 0.0)),
        ("b", 3, (1.25, 1.0), (1.125, 1.0)),
    ]
    assert {move.distance for move in mended.moves} == {0.125}
    assert (mended.doubles, mended.splits) == ((), ())


def test_a_corner_that_nearly_meets_a_face_comes_to_lie_on_it_and_the_face_gets_a_vertex():
    mended = repair(drawn(box(0, 0, 4, 1), box(1, 1.125, 2, 2)), 0.25)
    ground, block = (each.polygon for each in mended.wall.blocks)
    assert block == [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]
    assert ground == [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0)]
    assert mended.splits == (("a", 2),)
    assert [(move.block, move.vertex) for move in mended.moves] == [("b", 0), ("b", 1)]


@pytest.mark.parametrize(("gap", "moved"), [(0.25, True), (0.2501, False)])
def test_gaps_up_to_the_distance_are_closed(gap: float, moved: bool):
    for block in (box(1, 1 + gap, 2, 3), box(0, 1 + gap, 4, 3)):
        assert bool(repair(drawn(box(0, 0, 4, 1), block), 0.25).moves) is moved


def test_snapping_further_than_an_edge_is_long_is_refused():
    _, drawn = surveyed(2)
    with pytest.raises(InputError, match=r"would vanish. Snap over less than"):
        repair(drawn, 0.5)


def test_command_writes_the_wall_and_tells_what_moved(tmp_path: Path):
    _, drawn = surveyed(3)
    source, target = tmp_path / "drawn.json", tmp_path / "mended.json"
    source.write_text(json.dumps(drawn.document()))
    run = CliRunner().invoke(main, ["repair", str(source), "-o", str(target), "--snap", str(SNAP)])
    assert run.exit_code == 0
    assert "vertices moved" in run.stdout
    assert build(Wall.model_validate(json.loads(target.read_text()))).warnings == ()
    run = CliRunner().invoke(main, ["repair", str(source), "-o", str(tmp_path / "none.json"), "--snap", "0.5"])
    assert run.exit_code == 2
    assert not (tmp_path / "none.json").exists()
