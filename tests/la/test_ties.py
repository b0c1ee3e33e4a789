"""Ties and props in limit analysis: closed forms, and a linear programme written apart."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

from harness.engine.reaction_judge import judge_reaction
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.components import components_of
from harness.model.details import BAR_FORCES
from harness.model.errors import InputError
from harness.model.method import Finding
from harness.model.method_registry import check_takes, load_method, method_names, methods_with
from harness.model.wall import Wall
from methods.la.core.problem import make_problem
from methods.la.core.reaction import ExtremeReaction, extreme_reaction
from tests.tied_walls import (
    BLOCK,
    EXACT,
    PRINTED,
    SIDE,
    TAKEN,
    arch,
    asked,
    bar,
    block,
    built,
    greatest_by_hand,
    random_wall,
    tied,
)
from tests.walls import beside


@pytest.mark.parametrize("method", TAKEN)
def test_tied_block(method: str):
    """lambda = b/h + 2 T_y z/(W h) = .2 + 2 x 2 x 1.8/(16 x 2), and the tie yields."""
    result = asked(method, tied(2.0))
    assert result.multiplier == pytest.approx(0.425, rel=EXACT)
    assert result.details[BAR_FORCES] == pytest.approx([2.0], rel=EXACT)


@pytest.mark.parametrize("method", TAKEN)
def test_propped_block(method: str):
    """A prop on the side to which the block is pushed bears as much in compression, one on the other side nothing."""
    right = bar(("right", [1.0, 1.8]), ("block", [0.4, 1.8]), 2.0)
    result = asked(method, built(block(props=[right])))
    assert result.multiplier == pytest.approx(0.425, rel=EXACT)
    assert result.details[BAR_FORCES] == pytest.approx([-2.0], rel=EXACT)
    idle = asked(method, built(block(props=[bar(("left", SIDE), ("block", BLOCK), 2.0)])))
    assert idle.multiplier == pytest.approx(0.2, rel=EXACT)
    assert idle.details[BAR_FORCES] == pytest.approx([0.0], abs=1e-12)


@pytest.mark.parametrize("method", TAKEN)
def test_tie_that_is_pushed_bears_nothing(method: str):
    slack = asked(method, built(block(ties=[bar(("right", [1.0, 1.8]), ("block", [0.4, 1.8]), 2.0)])))
    assert slack.multiplier == pytest.approx(0.2, rel=EXACT)
    assert slack.details[BAR_FORCES] == pytest.approx([0.0], abs=1e-12)


def test_prestress_presses_a_bed_that_slides():
    """A bar along the vertical keeps its length as the block slides: least with its prestress, mu (W + T0)/W.

    Associated flow lifts the block, so that the bar yields: mu (W + T_y)/W.
    """
    rod = bar(("base", [1.0, -0.5]), ("block", [1.0, 0.2]), 10.0, prestress=4.0)
    wall = built(block(0.5, 2.0, 0.2, ties=[rod]))
    assert asked("la", wall).multiplier == pytest.approx(0.5 * 20.0 / 16.0, rel=EXACT)
    assert asked("la-associated", wall).multiplier == pytest.approx(0.5 * 26.0 / 16.0, rel=EXACT)


def test_prestress_is_part_of_the_dead_load():
    """On the block it is a force of 1.5 to the left, 0.8 above the centroid; none acts on the fixed block."""
    dead = tied(2.0, prestress=1.5).dead
    assert dead[1] == pytest.approx([-1.5, -16.0, 1.5 * 0.8])
    assert not dead[2].any()


@pytest.mark.parametrize(("thickness", "thrust"), [(0.12, 0.1912256), (0.15, 0.1756349), (0.2, 0.1542448)])
@pytest.mark.parametrize("method", ["la", "la-associated"])
def test_arch_on_rollers_stands_if_its_tie_bears_the_least_thrust(thickness: float, thrust: float, method: str):
    """The least thrusts, in weights of the arch, are by another programme, to seven digits.

    At a ten thousandth less the arch falls by so little that the judge's proof still sees it beside rounding.
    """
    drawn = arch(thickness, 1.0)
    weight = float(drawn.weight[drawn.free].sum())
    for share, finding in ((1.0 + PRINTED, Finding.STANDS), (1.0 - 1e-4, Finding.FALLS)):
        assert asked(method, arch(thickness, share * thrust * weight)).finding is finding


@pytest.mark.parametrize("seed", range(8))
def test_random_ties_and_props(seed: int):
    """The associated maximum is that of a programme written apart; the least known state lies no higher."""
    wall = random_wall(seed)
    above = greatest_by_hand(wall)
    greatest = asked("la-associated", wall)
    if above < 0.0:
        assert greatest.finding is Finding.FALLS
        return
    assert greatest.multiplier == pytest.approx(above, rel=1e-7)  # of HiGHS
    least = asked("la", wall)
    assert least.multiplier is not None
    assert least.multiplier <= above * (1.0 + 1e-7)
    assert least.flow == "non-associated"


@pytest.mark.parametrize("view", VIEWS)
def test_views_of_a_tied_wall(view: str):
    wall = random_wall(1)
    assert asked("la-associated", VIEWS[view](wall)).multiplier == pytest.approx(greatest_by_hand(wall), rel=1e-7)


def test_tie_joins_two_columns_to_one_component():
    """Two columns side by side are two components, and one when tied; a further block beside them changes nothing."""
    data = block()
    data["blocks"].append({"id": "other", "polygon": [[2.4, 0.0], [2.8, 0.0], [2.8, 2.0], [2.4, 2.0]], "weight": 16.0})
    data["blocks"].append(
        {"id": "ground", "polygon": [[2.4, -0.5], [2.8, -0.5], [2.8, 0.0], [2.4, 0.0]], "fixed": True}
    )
    assert len(components_of(built(data))) == 2
    wall = built(data | {"ties": [bar(("block", [0.4, 1.8]), ("other", [2.4, 1.8]), 2.0)]})
    assert len(components_of(wall)) == 1
    for each in (wall, beside(wall, 1.0)):
        assert asked("la", each).multiplier == pytest.approx(0.2, rel=EXACT)


def test_pulled_away_from_its_neighbour_the_block_yields_the_tie():
    """Only the block on the right is pushed: both topple together at twice b/h, or it alone where the tie is weak."""
    data = block()
    data["blocks"].append({"id": "other", "polygon": [[2.4, 0.0], [2.8, 0.0], [2.8, 2.0], [2.4, 2.0]], "weight": 16.0})
    data["blocks"].append(
        {"id": "ground", "polygon": [[2.4, -0.5], [2.8, -0.5], [2.8, 0.0], [2.4, 0.0]], "fixed": True}
    )
    data["loads"] = {"live": {"body": [{"per_weight": [1, 0], "blocks": ["other"]}]}}
    for force, value in ((100.0, 0.4), (1.0, 0.2 + 2.0 * 1.8 / 32.0)):
        wall = built(data | {"ties": [bar(("block", [0.4, 1.8]), ("other", [2.4, 1.8]), force)]})
        for method in TAKEN:
            assert asked(method, wall).multiplier == pytest.approx(value, rel=EXACT)


def test_load_that_joints_bear_alone_is_borne_without_end():
    data = block(ties=[bar(("left", SIDE), ("block", BLOCK), 2.0)])
    data["loads"] = {"live": {"body": [{"per_weight": [0, -1]}]}}
    assert asked("la-associated", built(data)).finding is Finding.UNBOUNDED


def test_block_that_only_a_tie_holds_is_lifted_at_its_yield_force():
    """Pulled up by its own weight, held by a vertical tie: 1 + T_y/W."""
    rod = bar(("base", [0.2, -0.5]), ("block", [0.2, 1.0]), 8.0)
    data = block(ties=[rod]) | {"loads": {"live": {"body": [{"per_weight": [0, 1]}]}}}
    for method in TAKEN:
        assert asked(method, built(data)).multiplier == pytest.approx(1.5, rel=EXACT)


def test_joints_of_strength_and_ties_at_once():
    """Block of tensile strength: (b/h)(1 + T/W) + 2 T_y z/(W h); the residual answer keeps the tie."""
    data = block(cohesion=1000.0, tensile_strength=4.0, ties=[bar(("left", SIDE), ("block", BLOCK), 2.0)])
    result = asked("la", built(data))
    assert result.multiplier == pytest.approx(0.2 * (1.0 + 4.0 * 0.4 / 16.0) + 0.225, rel=EXACT)
    residual = result.details["without_strength"]
    assert residual["multiplier"] == pytest.approx(0.425, rel=EXACT)
    assert residual["details"][BAR_FORCES] == pytest.approx([2.0], rel=EXACT)


def test_other_methods_refuse_ties_by_name():
    taken = {*TAKEN, "fe", "fe-newton", "fe-qp", "de"}
    assert set(methods_with("any_bars")) == taken
    for name in method_names():
        if name not in taken:
            with pytest.raises(InputError, match=f"{name} takes no ties, props and passive fill; the wall has tie 1"):
                check_takes(load_method(name), tied(2.0))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"yield_force": 0.0}, "greater than 0"),
        ({"prestress": 2.0}, "prestress 2 is not below the yield force 2"),
        ({"to": {"block": "left", "at": [0, 0]}}, "both ends are on the block"),
        ({"to": {"block": "block", "at": SIDE}}, "ends are at one point"),
        ({"to": {"block": "right", "at": BLOCK}}, "both of its blocks are fixed"),
        ({"to": {"block": "blok", "at": BLOCK}}, 'no block is called "blok"'),
    ],
)
def test_faults_of_a_tie(wrong: dict[str, Any], sentence: str):
    from harness.model.reading import parse_wall

    data = block(ties=[bar(("left", SIDE), ("block", BLOCK), 2.0) | wrong])
    with pytest.raises(InputError, match=sentence):
        build(parse_wall(data, "wall.json"))


def on_moving_side(**more: Any) -> Assembly:
    """The tied block, pushed by no live load, whose fixed block on the left moves to the right by one."""
    data = block(ties=[bar(("left", SIDE), ("block", BLOCK), 2.0, **more)])
    moves = [{"blocks": ["left"], "translation": [1, 0]}]
    push = {"dead": {"points": [{"block": "block", "at": [0.0, 1.8], "force": [2.5, 0.0]}]}}
    return built(data | {"loads": push, "settlements": moves})


@pytest.mark.parametrize("prestress", [0.0, 0.8])
def test_reaction_along_a_tie(prestress: float):
    """The block topples at a push of W b/(2 z) = 16/9: pushed by 2.5 its tie bears from 2.5 - 16/9 to its yield force.

    On the fixed block the tie pulls to the right, along its motion.
    """
    wall = on_moving_side(prestress=prestress)
    least = max(2.5 - 16.0 / 9.0, prestress)
    for greatest, value in ((False, least), (True, 2.0)):
        found = extreme_reaction(wall, greatest)
        assert isinstance(found, ExtremeReaction)
        assert found.reaction == pytest.approx(value, rel=EXACT)
        assert found.tensions == pytest.approx([value], rel=EXACT)
        parts = (found.forces, found.mechanism)
        accepts = partial(judge_reaction, wall, found.reaction, *parts, greatest=greatest, tolerance=EXACT)
        assert accepts(tensions=found.tensions).accepted
        assert accepts(tensions=found.tensions + 0.1).accepted is False
        assert accepts().accepted is (value == prestress)


def test_walls_with_bars_are_never_scaled_without_them():
    with pytest.raises(ValueError, match="ties or props"):
        make_problem(tied(2.0))


@pytest.mark.parametrize("second", ["anchor", "prop 1"])
def test_two_bars_of_one_name_are_refused(second: str):
    """The path has one column a name, and tables know a bar by it; a prop without an id is called prop 1."""
    ends = {"from": {"block": "left", "at": SIDE}, "to": {"block": "block", "at": BLOCK}, "yield_force": 2}
    ties = [ends | {"id": "anchor"}, ends | {"id": second}]
    props = [] if second == "anchor" else [ends]
    where = "ties[1]" if second == "anchor" else "props[0]"
    with pytest.raises(InputError) as caught:
        build(Wall.model_validate(block(ties=ties, props=props)))
    assert str(caught.value).startswith(f'{where}: another tie or prop is called "{second}" too. Give')
