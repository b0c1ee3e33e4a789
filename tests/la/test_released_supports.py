"""Reactions without dilatancy: a guided support is the same wall, and collapse states lie between the extremes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.reactions import Reaction, least_known_reactions, reactions
from drystone.released_supports import released
from harness.engine.judge import answered, judge
from harness.engine.residuals import block_sums
from harness.model.bars import bar_tensions
from harness.model.errors import InputError
from harness.model.method import Finding
from harness.model.method_registry import load_method
from methods.la.core.reaction import ExtremeReaction, extreme_reaction
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, data
from tests.tied_walls import arch, bar, block

EXACT = 1e-9
"""Relative accuracy that the methods declare."""
BOND = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 6, "bricks": 3, "base": False}
AROUND = {"blocks": ["right"], "rotation": -1.0, "about": [0.3, 0.0]}


def bricks(friction: float) -> drystone.Wall:
    """The 21-brick wall of unit weight one, whose support beyond x = 1.5 goes down by one."""

    def support(name: str, left: float, right: float) -> dict[str, Any]:
        return {"id": name, "polygon": [[left, -0.5], [right, -0.5], [right, 0], [left, 0]], "fixed": True}

    supports = [support("left", 0.0, 1.5), support("right", 1.5, 3.0)]
    settlements = [{"blocks": ["right"], "translation": [0, -1]}]
    content = {"format": "wall/1", "unit_weight": 1.0, "friction": friction, "pattern": BOND}
    return drystone.build_wall(content | {"blocks": supports, "settlements": settlements})


def both(found: tuple[Reaction, Reaction] | str) -> tuple[Reaction, Reaction]:
    assert not isinstance(found, str), found
    assert all(each.judgement.accepted for each in found), [each.judgement.sentence for each in found]
    return found


@pytest.mark.parametrize("friction", [0.4, 0.65, 1.0])
@pytest.mark.parametrize("greatest", [False, True])
def test_guided_support_has_the_extreme_reaction_of_the_programme_over_forces(friction: float, greatest: bool):
    """By associated flow the multiplier of the guided support leads to the extreme that the other programme finds."""
    wall = bricks(friction).assembly
    extreme = extreme_reaction(wall, greatest)
    assert isinstance(extreme, ExtremeReaction)
    begins, sense = 4.5, 1.0 if greatest else -1.0
    guided = released(wall, begins, greatest)
    result, judgement = answered(load_method("la-associated"), guided.assembly)
    assert judgement.accepted
    assert result.multiplier is not None
    assert begins + sense * result.multiplier == pytest.approx(extreme.reaction, rel=EXACT)
    tensions = bar_tensions(guided.assembly, result)
    assert tensions is not None
    assert guided.holds(tensions)


def test_block_on_a_base_that_settles():
    """It tilts about the edge of what rests, and does not slide: 2/7 of its weight 4, and all of it."""
    found = both(least_known_reactions(drystone.build_wall(data(DOWN))))
    assert [each.value for each in found] == pytest.approx([2.0 / 7.0 * 4.0, 4.0], rel=EXACT)
    assert all(each.moving == ("block",) for each in found)


def test_judge_calls_the_reaction_what_it_is():
    """What the search finds is a change of the reaction: the judge is told so, and speaks of no multiplier."""
    for each in both(least_known_reactions(drystone.build_wall(data(DOWN)))):
        assert (
            "By virtual work the change of the reaction of this mechanism is known to within" in each.judgement.sentence
        )
        assert "multiplier" not in each.judgement.sentence


def test_judge_names_the_quantity_in_whatever_it_finds_wrong():
    guided = released(drystone.build_wall(data(DOWN)).assembly, 2.0, True)
    result, right = answered(load_method("la"), guided.assembly)
    assert right.accepted
    assert result.multiplier is not None
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"multiplier": -1.0}, "Its thrust or the lower end of its bracket lies below zero"),
        ({"bracket": (10.0, 11.0)}, "Its thrust 2 lies outside its bracket [10, 11]"),
        ({"multiplier": 1e200}, "Its thrust: not finite"),
        ({"finding": Finding.STANDS}, "It gives a thrust or a bracket beside"),
        ({"mechanism": None}, "The contact forces at thrust 2 were"),
        ({"flow": "approximate", "mechanism": None, "bracket": (2.0, 2.1)}, "contact forces at thrust 2 were"),
    ]
    for change, words in wrong:
        said = judge(guided.assembly, result.model_copy(update=change), 1e-9, "thrust").sentence
        assert words in said
        assert "multiplier" not in said


@pytest.mark.parametrize("settlement", [DOWN, AROUND])
def test_mechanism_moves_the_support_as_prescribed_and_forces_do_the_work(settlement: dict[str, Any]):
    wall = drystone.build_wall(data(settlement))
    for each, sense in zip(both(least_known_reactions(wall)), (1.0, -1.0), strict=True):
        fixed = wall.assembly.fixed
        np.testing.assert_allclose(each.mechanism[fixed], sense * wall.assembly.support_motion[fixed], atol=1e-12)
        work = float((block_sums(wall.assembly, each.forces) * wall.assembly.support_motion).sum())
        assert work == pytest.approx(each.value, rel=EXACT)


def test_rotation_of_the_support_about_its_edge():
    """Moments about x = .3 of what the right part bears: 4 (.5 - .3) with the rest at x = .3, 2 (1 - .3) at x = 0."""
    found = both(reactions(drystone.build_wall(data(AROUND))))
    known = both(least_known_reactions(drystone.build_wall(data(AROUND))))
    assert [each.value for each in found] == pytest.approx([0.8, 1.4], rel=EXACT)
    assert [each.value for each in known] == pytest.approx([0.8, 1.4], rel=EXACT)


@pytest.mark.parametrize("friction", [0.4, 0.65])
def test_bricks_collapse_before_the_extremes_of_associated_flow(friction: float):
    """Where a brick slides without dilatancy the wall collapses earlier, at a state that the judge accepts."""
    wall = bricks(friction)
    low, high = (each.value for each in both(reactions(wall)))
    gives, pushes = (each.value for each in both(least_known_reactions(wall)))
    assert low < gives < pushes < high


def test_thrusts_of_an_arch_do_not_depend_on_the_flow():
    """Nothing slides, so that all mechanisms are hinges: .1542448 and .2553107 of the weight of a semicircle, t/R .2.

    These are by another programme, exact to the 1e-7 that its solver is; ours is judged to 1e-9 by virtual work.
    """
    drawn = arch(0.2, 1.0)
    blocks = [
        {"id": name, "polygon": polygon.tolist(), "fixed": bool(fixed)}
        for name, polygon, fixed in zip(drawn.block_ids, drawn.polygons, drawn.fixed, strict=True)
    ]
    spread = [{"blocks": ["right"], "translation": [1, 0]}]
    content = {"format": "wall/1", "unit_weight": 1.0, "friction": 50.0, "blocks": blocks, "settlements": spread}
    weight = float(drawn.weight[drawn.free].sum())
    found = both(least_known_reactions(drystone.build_wall(content)))
    assert [each.value / weight for each in found] == pytest.approx([0.1542448, 0.2553107], abs=2e-7)


def test_tie_on_the_moving_support():
    """As of associated flow, for nothing slides: from 2.5 - 16/9, where the block topples, to the tie's yield force."""
    ties = [bar(("left", [-0.6, 1.8]), ("block", [0.0, 1.8]), 2.0, prestress=0.2)]
    push = {"dead": {"points": [{"block": "block", "at": [0.0, 1.8], "force": [2.5, 0.0]}]}}
    wall = block(ties=ties) | {"loads": push, "settlements": [{"blocks": ["left"], "translation": [1, 0]}]}
    found = both(least_known_reactions(drystone.build_wall(wall)))
    assert [each.value for each in found] == pytest.approx([2.5 - 16.0 / 9.0, 2.0], rel=EXACT)
    assert [each.tensions[0] for each in found] == pytest.approx([2.5 - 16.0 / 9.0, 2.0], rel=EXACT)


def test_several_supports_move_as_one_body_or_are_refused():
    together = [{"group": "ground", "translation": [0, -1]}]
    said = least_known_reactions(drystone.build_wall(data(*together)))
    assert said == "Equilibrium leaves one reaction alone, 4: it does not depend on the flow."
    apart = [DOWN, {"blocks": ["left"], "translation": [0, -0.5]}]
    with pytest.raises(InputError, match="left and right do not move as one rigid body"):
        least_known_reactions(drystone.build_wall(data(*apart)))


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path, "--without-dilatancy")
    assert done.returncode == 0, done.stderr
    assert "greatest known reaction of a support that gives way, without dilatancy, is 1.142857 kN" in done.stdout
    assert "By virtual work the change of the reaction of this mechanism is known" in done.stdout
    assert "multiplier" not in done.stdout
    listed = json.loads(command("reaction", path, "--without-dilatancy", "--json").stdout)
    assert listed["pushing"]["value"] == pytest.approx(4.0, rel=EXACT)
    assert listed["giving_way"]["judge"]["accepted"] is True
