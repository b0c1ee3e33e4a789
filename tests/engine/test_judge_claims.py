"""Answers that are wrong, each one of a kind, and answers that prove nothing: none of them is accepted."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drystone.cli.terminal import print_judgement, print_result
from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.foreign.result_document import answer_from_file
from harness.model.json_text import read_json
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.proof import Proof
from harness.model.reading import read_wall
from harness.model.result import Result, result_of
from harness.model.wall import Wall
from methods.numerics.statics import admissible_forces
from reports.labels import numbers
from tests.walls import PUSH, assembly, case, running_bond, stack

OVERTURNED: dict[str, Any] = {"dead": {"body": [{"per_weight": [2.0, 0.0]}]}}
DATA = Path(__file__).parent.parent / "data" / "judge"


def said(wall: Assembly, answer: Answer, tolerance: float = 1e-9):
    return judge(wall, as_result(wall, answer), tolerance)


def as_result(wall: Assembly, answer: Answer) -> Result:
    return result_of(answer, wall, case="x", method="hand", family="hand")


def state_of(wall: Assembly, method: str = "la") -> Answer:
    chosen = load_method(method)
    return chosen.solve(wall, chosen.Settings())


@pytest.fixture(scope="module")
def bonded() -> tuple[Assembly, Answer]:
    wall = assembly(running_bond(2, 2), 0.6)
    return wall, state_of(wall)


@pytest.mark.parametrize(
    ("name", "outcome"),
    [
        ("bystander-1e+10-0.9", "rejected"),
        ("falls-closing-slide-2-dead", "rejected"),
        ("falls-though-stands", "rejected"),
        ("forces-multiplier", "rejected"),
        ("ground-moves", "rejected"),
        ("heavy-1e+10-0.505", "rejected"),
        ("selfstress-bracket-1e+12", "rejected"),
        ("selfstress-stands-1e+12", "rejected"),
        ("two-fixed-far-flies", "rejected"),
        ("two-tiny-mechanism", "rejected"),
        ("unbounded", "rejected"),  # it gives a multiplier besides
        ("wedge-up-1e+11", "rejected"),
    ],
)
def test_wrong_answer_is_not_accepted(name: str, outcome: str):
    wall = read_wall(DATA / f"{name}.wall.json").assembly
    answer = answer_from_file(read_json(DATA / f"{name}.result.json"), wall, name)
    assert said(wall, answer).outcome == outcome


def test_text_is_no_number():
    wall = read_wall(DATA / "nan-mech.wall.json").assembly
    with pytest.raises(InputError, match="mechanism"):
        answer_from_file(read_json(DATA / "nan-mech.result.json"), wall, "nan-mech")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_rejected(bonded: tuple[Assembly, Answer], bad: float):
    wall, answer = bonded
    assert answer.forces is not None
    forces = answer.forces.copy()
    forces[0, 0] = bad
    assert said(wall, replace(answer, forces=forces)).outcome == "rejected"


def test_standing_shows_no_multiplier(bonded: tuple[Assembly, Answer]):
    wall, _ = bonded
    unloaded = replace(wall, live=np.zeros_like(wall.live))
    answer = state_of(unloaded)
    assert answer.finding is Finding.STANDS
    assert said(unloaded, answer).outcome == "accepted"
    assert said(wall, answer).outcome == "not_judged"


def test_growth_without_limit_is_shown_by_forces_that_balance_the_live_load_alone():
    wall = assembly(stack(1), 0.5)
    pressed = replace(wall, live=wall.dead.copy())
    half = float(np.linalg.norm(wall.dead[1, :2])) / 2.0
    forces = np.array([[half, half, 0.0]])
    answer = Answer(Status.OK, Finding.UNBOUNDED, "", forces=forces, forces_multiplier=0.0)
    assert said(pressed, answer).outcome == "not_judged"
    assert said(pressed, replace(answer, details={"live_forces": forces.tolist()})).outcome == "accepted"
    assert said(wall, replace(answer, details={"live_forces": forces.tolist()})).outcome == "rejected"


def test_measured_fall_is_not_judged():
    wall = assembly(stack(2) | {"offsets": [0.0, 0.2]}, 0.5)
    proof = state_of(wall, "fe")
    assert said(wall, proof, 1e-8).outcome == "accepted"
    assert said(wall, replace(proof, details={}), 1e-8).outcome == "not_judged"
    assert said(wall, replace(proof, details={"dilatant_mechanism": [[0, 0, 0]]}), 1e-8).outcome == "rejected"


def test_lower_end_of_a_bracket_is_what_forces_show(bonded: tuple[Assembly, Answer]):
    wall, answer = bonded
    assert answer.multiplier is not None
    measured = replace(answer, flow="approximate", mechanism=None)
    low, high = answer.multiplier - 0.01, answer.multiplier + 0.01
    assert said(wall, replace(measured, bracket=(low, high))).outcome == "accepted"
    assert said(wall, replace(measured, bracket=(high, high + 0.1))).outcome == "rejected"
    assert said(wall, replace(measured, forces=None, bracket=(low, high))).outcome == "not_judged"


@pytest.mark.parametrize(
    ("bracket", "outcome"),
    [
        ((0.0, 1e-3), "not_judged"),  # it stands under its dead load, which is no multiplier
        ((0.0, 1e50), "not_judged"),
        ((0.2, 1e50), "not_judged"),
        ((0.2, 3.0), "accepted"),  # wide, and its lower end is a proof of a good part of it
        ((0.0, np.inf), "rejected"),
    ],
)
def test_a_bracket_whose_lower_end_is_zero_beside_its_upper_end_states_nothing(
    bonded: tuple[Assembly, Answer], bracket: tuple[float, float], outcome: str
):
    """The forces bear the lower end, on the way from the dead load to the collapse state: yield is convex."""
    wall, state = bonded
    assert state.multiplier is not None
    dead = admissible_forces(wall, wall.dead)
    assert dead is not None
    share = bracket[0] / state.multiplier
    assert share < 1.0
    measured = Answer(
        Status.OK,
        Finding.COLLAPSES,
        "",
        bracket[0],
        bracket,
        forces=(1.0 - share) * dead + share * np.asarray(state.forces),
        flow="approximate",
    )
    assert said(wall, measured).outcome == outcome


def two_blocks(weight: float, friction: float = 0.5) -> Assembly:
    """Two blocks 2 wide and 1 high that do not touch, on one ground; the second of another weight, the first of 20."""

    def box(name: str, x: float, y: float, width: float, **more: Any) -> dict[str, Any]:
        polygon = [[x, y], [x + width, y], [x + width, y + 1.0], [x, y + 1.0]]
        return {"id": name, "polygon": polygon} | more

    blocks = [
        box("ground", 0.0, -1.0, 10.0, fixed=True),
        box("a", 1.0, 0.0, 2.0, unit_weight=10.0),
        box("b", 6.0, 0.0, 2.0, unit_weight=weight / 2.0),
    ]
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": PUSH}
    return build(Wall.model_validate(wall)).assembly


def sliding_state(wall: Assembly, multiplier: float, speed_beside: float = 0.0) -> Answer:
    """Block a slides at `multiplier`; block b bears the same, or slides along at its own speed."""
    forces = np.zeros((2, 3))
    for k in range(2):
        block = wall.block_b[k] if wall.fixed[wall.block_a[k]] else wall.block_a[k]
        weight = -wall.dead[block, 1]
        lever = multiplier * weight * 0.5 / 2.0
        right = wall.end1[k, 0] > wall.end2[k, 0]
        first, second = (weight / 2.0 + lever, weight / 2.0 - lever)
        onto_b = 1.0 if wall.block_b[k] == block else -1.0
        shear = -multiplier * weight * wall.tangent[k, 0] * onto_b
        forces[k] = [first, second, shear] if right else [second, first, shear]
    mechanism = np.zeros((3, 3))
    mechanism[1, 0], mechanism[2, 0] = 1.0, speed_beside
    return Answer(Status.OK, Finding.COLLAPSES, "", multiplier, forces=forces, mechanism=mechanism)


@pytest.mark.parametrize("weight", [1e-9, 1e-3, 20.0, 1e9])
@pytest.mark.parametrize("speed", [0.0, 1e-6, 1e6])
def test_an_independent_block_changes_no_residual(weight: float, speed: float):
    wall = two_blocks(weight)
    right, wrong = said(wall, sliding_state(wall, 0.5, speed)), said(wall, sliding_state(wall, 0.4999, speed))
    assert right.outcome == "accepted", right
    assert wrong.outcome == "rejected", wrong
    alone = said(two_blocks(20.0), sliding_state(two_blocks(20.0), 0.4999))
    for name in ("equilibrium", "interpenetration", "dilatancy", "virtual_work"):
        assert wrong.residuals[name] == pytest.approx(alone.residuals[name], rel=1e-9, abs=1e-15), name


def test_block_that_flies_hides_no_penetration_of_its_neighbours():
    """A slides into B, which stands in its way and gets no force, while C on top weighs nothing and flies."""
    panel = {"type": "panel", "cell_length": 0.5, "cell_height": 0.2, "layout": ["CC", "AB", "__"], "fixed": "_"}
    wall = assembly(panel, 0.5)
    wall = replace(wall, dead=wall.dead.copy(), live=wall.live.copy())
    base, a, b, c = range(4)
    wall.dead[c] = wall.live[c] = wall.live[b] = 0.0
    pairs = list(zip(wall.block_a.tolist(), wall.block_b.tolist(), strict=True))
    forces = np.zeros((5, 3))
    forces[pairs.index((base, a))] = [1.2, 0.8, 1.0]
    forces[pairs.index((base, b))] = [1.0, 1.0, 0.0]
    mechanism = np.zeros((4, 3))
    mechanism[a, 0] = 1e-10
    answer = Answer(Status.OK, Finding.COLLAPSES, "", 0.5, forces=forces, mechanism=mechanism)
    assert said(wall, answer).residuals["interpenetration"] == pytest.approx(1.0)
    mechanism[c, 1] = 1.0
    judgement = said(wall, replace(answer, mechanism=mechanism))
    assert judgement.outcome == "rejected"
    assert [name for name, value in judgement.residuals.items() if value > 1e-9] == ["interpenetration", "live_work"]
    assert (state_of(wall).multiplier or 0.0) == pytest.approx(1.0)


METHODS = ["la", "la-associated", "la-paper", "la-tresca", "fe", "fe-newton", "fe-qp", "de", "de-soft"]


@pytest.mark.parametrize("name", METHODS)
def test_methods_show_that_no_multiplier_is_too_high_and_that_a_wall_falls(name: str):
    method = load_method(name)
    pressed = assembly(running_bond(2, 2), 0.5, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    leaning = assembly(stack(3) | {"offsets": [0.0, 0.2, 0.3]}, 0.5)
    for wall, finding in ((pressed, Finding.UNBOUNDED), (leaning, Finding.FALLS)):
        answer = state_of(wall, name)
        assert answer.finding is finding
        assert said(wall, answer, method.tolerance).accepted, (finding, said(wall, answer, method.tolerance).sentence)


@pytest.mark.parametrize("loads", [{"live": {"body": [{"per_weight": [0, -1]}]}}, PUSH])
def test_answer_of_a_run_is_judged_from_its_file_as_in_the_run(loads: dict[str, Any]):
    """`drystone run --json --fields` writes what proves a claim among the details."""
    offsets = {"offsets": [0.0, 0.2, 0.3]} if loads is PUSH else {}
    wall = assembly(stack(3) | offsets, 0.5, loads=loads)
    result = as_result(wall, state_of(wall, "fe"))
    again = answer_from_file(result.model_dump(mode="json"), wall, "a file")
    assert result.finding in (Finding.FALLS, Finding.UNBOUNDED)
    assert said(wall, again, 1e-8).outcome == "accepted"


@pytest.mark.parametrize(
    "further", [{}, {"cohesion": 2.0, "tensile_strength": 1.0}, {"compressive_strength": 200.0}], ids=str
)
def test_measured_answer_of_a_run_is_judged_from_its_file_as_in_the_run(further: dict[str, Any]):
    """Its bracket, the forces measured with its motion, and the answer without strength are those of the run."""
    wall = assembly(stack(2, 0.4, 1.0), 0.6, **further)
    written = as_result(wall, state_of(wall, "de")).model_dump(mode="json")
    assert said(wall, answer_from_file(written, wall, "a file"), 1e-6).outcome == "accepted"
    lower, upper = written["bracket"]
    above = written | {"bracket": [lower + 0.01, upper + 0.02]}
    assert said(wall, answer_from_file(above, wall, "a file"), 1e-6).outcome == "rejected"
    stopped = answer_from_file(written | {"status": "timeout"}, wall, "a file")
    assert said(wall, stopped, 1e-6).outcome == "not_judged"


@pytest.mark.parametrize("document", [{}, {"format": "result/1"}], ids=["a run", "result/1"])
@pytest.mark.parametrize(
    "wrong", [{"without_strength": 5}, {"displaced_state": {"places": [[1, 2]]}}, {"broken": "x"}], ids=str
)
def test_details_that_the_judge_cannot_read_are_named(document: dict[str, Any], wrong: dict[str, Any]):
    wall = assembly(stack(2), 0.5)
    data = document | {"multiplier": 0.5, "flow": "approximate", "details": wrong}
    with pytest.raises(InputError, match=f"a file.*details.*{next(iter(wrong))}"):
        answer_from_file(data, wall, "a file")


def test_multiplier_is_printed_with_the_digits_that_its_error_allows(capsys: pytest.CaptureFixture[str]):
    wall = two_blocks(1.0)
    answer = sliding_state(wall, 0.5)
    judgement = said(wall, answer)
    assert judgement.multiplier_error is not None
    assert judgement.multiplier_error < 1e-12
    rough = as_result(wall, replace(answer, multiplier=0.5 + 3e-5, forces_multiplier=0.5))
    rough = rough.model_copy(update={"judge": judge(wall, rough, 1e-3)})
    assert rough.judge.accepted
    assert rough.judge.multiplier_error == pytest.approx(3e-5, rel=0.1)
    assert rough.judge.decimals == 4
    assert numbers.multiplier(rough.multiplier, rough.judge.decimals) == "0.5000"
    print_result(rough, case(stack(1), 0.5), Proof())
    assert re.search(r"finding +0\.5000 *\n", capsys.readouterr().out)


def test_work_among_the_residuals_says_that_it_is_none(bonded, capsys: pytest.CaptureFixture[str]):
    wall, answer = bonded
    judgement = said(wall, answer)
    assert judgement.worst is not None
    assert judgement.worst[0] != "live_work"
    for shown in (print_judgement, lambda judgement: print("\n".join(map(" ".join, judgement.listed())))):
        shown(judgement)
        lines = [line for line in capsys.readouterr().out.splitlines() if "no residual" in line]
        assert len(lines) == 1
        assert "live_work" in lines[0]
        assert "work of the live load, must be positive" in lines[0]
    stands = load_method("fe").solve(falling := assembly(stack(2), 0.3, loads=OVERTURNED), load_method("fe").Settings())
    falls = dict(said(falling, stands).listed())
    assert stands.finding is Finding.FALLS
    assert "must exceed closing_work" in falls["dead_work"]
    assert "must be below dead_work" in falls["closing_work"]
