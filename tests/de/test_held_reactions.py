"""Reactions of released supports by distinct elements: closed forms, thrusts of arches, and what the judge holds."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import drystone
from drystone.held_reactions import HeldReaction, held_reactions
from drystone.reactions import reactions
from harness.engine.reaction_judge import judge_held, reaction_of
from harness.engine.residuals import block_sums
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.settings import HoldSettings
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, PARTS, WEIGHT, data, extremes
from tests.la.test_released_supports import AROUND
from tests.moving_supports import BRICKS, bricks, semicircle, weight
from tests.tied_walls import bar, block

STATED = 5e-3


def both(found: tuple[HeldReaction, HeldReaction] | str) -> tuple[HeldReaction, HeldReaction]:
    """Both brackets, which the judge accepts, in the order from rest to held to moving."""
    assert not isinstance(found, str), found
    for each, sense in zip(found, (-1.0, 1.0), strict=True):
        assert each.judgement.accepted, each.sentence
        assert sense * each.rest <= sense * each.held <= sense * each.moving
        assert sense * each.held <= sense * each.value <= sense * each.moving
    return found


def values(found: tuple[HeldReaction, HeldReaction]) -> list[float]:
    return [each.value for each in found]


def test_block_on_a_base_that_settles():
    """2/7 of its weight as the base gives way, all of it as the base pushes (Portioli and Cascini 2016)."""
    wall = drystone.build_wall(data(DOWN))
    found = both(held_reactions(wall))
    assert values(found) == pytest.approx([2.0 / 7.0 * WEIGHT, WEIGHT], rel=STATED)
    assert found[0].held >= 2.0 / 7.0 * WEIGHT * (1.0 - 1e-6) >= found[0].moving
    assert found[1].held <= WEIGHT * (1.0 + 1e-6) <= found[1].moving
    assert all(each.moving_blocks == ("block",) for each in found)
    assert found[0].rest == found[1].rest
    for each, sense in zip(found, (1.0, -1.0), strict=True):
        fixed = wall.assembly.fixed
        np.testing.assert_allclose(each.mechanism[fixed], sense * wall.assembly.support_motion[fixed], atol=1e-12)
        work = float((block_sums(wall.assembly, each.forces) * wall.assembly.support_motion).sum())
        assert work == pytest.approx(each.forces_at, rel=1e-6)


def test_a_glued_block_beside_it_changes_nothing():
    """Without its glue it falls, which a measured motion does not prove: the whole wall was said not to be held."""

    def square(name: str, x: float, **more: bool) -> dict[str, object]:
        return {"id": name, "polygon": [[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]], **more}

    made = data(DOWN)
    made["blocks"] += [square("west", -4, fixed=True), square("glued", -3), square("east", -2, fixed=True)]
    made["friction"] = {"default": 0.5, "rules": [{"joint": "head", "value": 0.5, "cohesion": 15}]}
    found = both(held_reactions(drystone.build_wall(made)))
    assert values(found) == pytest.approx([2.0 / 7.0 * WEIGHT, WEIGHT], rel=STATED)


@pytest.mark.parametrize("part", PARTS)
def test_block_on_a_base_of_which_any_part_settles(part: float):
    """From half of the base on the moving part bears nothing at the least, and the wall may begin there."""
    found = both(held_reactions(drystone.build_wall(data(DOWN, part=part))))
    assert values(found) == pytest.approx(extremes(part), abs=STATED * WEIGHT)


@pytest.mark.parametrize("friction", BRICKS)
def test_bricks_that_lift_by_their_friction_end_at_the_extremes(friction: float):
    found = both(held_reactions(bricks({"default": friction, "dilatancy": friction})))
    assert values(found) == pytest.approx(BRICKS[friction], rel=STATED)


def test_a_bracket_that_is_no_answer_says_why():
    """Holds of one relaxation time leave too much undecided."""
    found = held_reactions(bricks(1.0), hold_steps=1)
    assert not isinstance(found, str)
    gives, pushes = found
    assert (gives.judgement.accepted, pushes.judgement.accepted) == (True, False)
    assert "not converged" in pushes.sentence
    assert "not converged" not in gives.sentence


def test_rotation_of_the_support_about_its_edge():
    """Moments about x = .3: 4 (.5 - .3) with the rest at x = .3, 2 (1 - .3) with it at x = 0."""
    found = both(held_reactions(drystone.build_wall(data(AROUND))))
    assert values(found) == pytest.approx([0.8, 1.4], rel=STATED)


@pytest.mark.parametrize(
    ("thickness", "thrusts"),
    [(0.12, (0.1912256, 0.2079935)), (0.15, (0.1756349, 0.2277179)), (0.2, (0.1542448, 0.2553107))],
)
def test_thrusts_of_an_arch_that_does_not_slide(thickness: float, thrusts: tuple[float, float]):
    wall = semicircle(thickness, 20, 50.0)
    found = both(held_reactions(wall))
    assert [value / weight(wall) for value in values(found)] == pytest.approx(thrusts, rel=STATED)


@pytest.mark.slow
def test_thrusts_of_an_arch_that_slides_at_its_springings():
    """The greatest is half the friction. At friction .5 and .7 a hundred voussoirs push without a settled bracket."""
    wall = semicircle(0.2, 100, 0.4)
    found = both(held_reactions(wall))
    assert [value / weight(wall) for value in values(found)] == pytest.approx([0.1540326, 0.2], rel=STATED)


@pytest.mark.parametrize("friction", [0.4, 0.65, 1.0])
def test_bricks_are_held_between_the_extremes(friction: float):
    """What holds lies within the extremes; the middle of the median order lies there to half a percent."""
    wall = bricks(friction)
    extremes = reactions(wall)
    assert not isinstance(extremes, str)
    low, high = (each.value for each in extremes)
    gives, pushes = both(held_reactions(wall))
    assert low * (1.0 - 1e-6) <= gives.held < gives.rest < pushes.held <= high * (1.0 + 1e-6)
    assert low * (1.0 - STATED) <= gives.value
    assert pushes.value <= high * (1.0 + STATED)


def driven(wall: Assembly, sense: float, order: int) -> float:
    """The reaction of a support that is moved at a given speed, ever slower, as the mean over the last time steps.

    The support is a body whose velocity is set before each step and which no impulse changes: no bracket, no guide.
    """
    moving = np.flatnonzero(np.any(wall.support_motion, axis=1))
    freed = replace(wall, fixed=np.array(wall.fixed), support_motion=np.zeros_like(wall.support_motion))
    freed.fixed[moving] = False
    course = courses(wall)
    _, blocks, joints = insertion_orders(freed, course, 3, 0)[order]
    engine = SequentialImpulses(freed, blocks, joints, HoldSettings().iterations, tunings(course, None)[0])
    bodies = np.flatnonzero(np.isin(blocks, moving))
    engine._inverse[bodies] = 0.0
    engine._rows = engine._contact_points(joints)
    engine.load(0.0)
    engine.advance(3000)
    motion = sense * wall.support_motion[blocks[bodies]] / motion_units(wall)
    measured = []
    for speed in np.repeat([0.03, 0.003, 0.0003], 6000):
        engine._velocity[bodies] = speed * motion / engine._keep
        engine.advance(1)
        measured.append(engine.save())
    engine.restore(np.mean(measured[-1000:], axis=0))
    return reaction_of(wall, engine.contact_forces(), np.zeros(0))


def test_support_that_is_driven_measures_the_reactions_of_the_block():
    wall = drystone.build_wall(data(DOWN)).assembly
    found = [driven(wall, sense, 1) / WEIGHT for sense in (1.0, -1.0)]
    assert found == pytest.approx([2.0 / 7.0, 1.0], rel=1e-5)


@pytest.mark.parametrize("order", range(3))
def test_support_that_is_driven_measures_reactions_within_the_brackets(order: int):
    """Each sweep order chooses forces of its own; all measure within the ends over all orders, to half a percent."""
    wall = bricks(0.65)
    for each, sense in zip(both(held_reactions(wall)), (1.0, -1.0), strict=True):
        low, high = sorted([each.held, each.moving])
        assert low * (1.0 - STATED) <= driven(wall.assembly, sense, order) <= high * (1.0 + STATED)


def test_tie_on_the_moving_support():
    """From 2.5 - 16/9, where the block topples, to the tie's yield force."""
    ties = [bar(("left", [-0.6, 1.8]), ("block", [0.0, 1.8]), 2.0, prestress=0.2)]
    push = {"dead": {"points": [{"block": "block", "at": [0.0, 1.8], "force": [2.5, 0.0]}]}}
    wall = block(ties=ties) | {"loads": push, "settlements": [{"blocks": ["left"], "translation": [1, 0]}]}
    found = both(held_reactions(drystone.build_wall(wall)))
    assert values(found) == pytest.approx([2.5 - 16.0 / 9.0, 2.0], rel=STATED)
    assert [each.tensions[0] for each in found] == pytest.approx([2.5 - 16.0 / 9.0, 2.0], rel=STATED)


def test_what_has_no_bracket_is_said():
    assert "the wall falls, wherever its supports go" in str(held_reactions(semicircle(0.2, 100, 0.3)))
    together = drystone.build_wall(data({"group": "ground", "translation": [0, -1]}))
    assert held_reactions(together) == "Equilibrium leaves one reaction alone, 4: it does not depend on the flow."
    apart = drystone.build_wall(data(DOWN, {"blocks": ["left"], "translation": [0, -0.5]}))
    with pytest.raises(InputError, match="do not move as one rigid body"):
        held_reactions(apart)
    crushed = drystone.build_wall(data(DOWN, compressive_strength=400))
    with pytest.raises(InputError, match="compressive strength"):
        held_reactions(crushed)


def test_judge_finds_forces_of_another_reaction_and_reactions_beyond_the_extremes():
    wall = drystone.build_wall(data(DOWN))
    gives, _ = both(held_reactions(wall))

    def said(reaction: float, forces: np.ndarray, extremes: tuple[float, float]) -> dict[str, float]:
        judged = judge_held(wall.assembly, reaction, forces, np.zeros(0), tolerance=1e-6, extremes=extremes)
        assert judged.accepted is False
        return {name: value for name, value in judged.residuals.items() if value > 1e-6}

    assert set(said(gives.forces_at + 0.1, gives.forces, gives.extremes)) == {"reaction"}
    assert "equilibrium" in said(gives.forces_at, 1.01 * gives.forces, gives.extremes)
    assert set(said(gives.forces_at, gives.forces, (gives.forces_at + 0.1, 9.0))) == {"extremes"}


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path, "--held")
    assert done.returncode == 0, done.stderr
    assert "Reactions in kN." in done.stdout
    assert "The support that gives way is held from 1.27347 to 1.14" in done.stdout
    assert "No equilibrium lies outside 1.142857 to 4." in done.stdout
    assert "multiplier" not in done.stdout
    listed = json.loads(command("reaction", path, "--held", "--json").stdout)
    assert listed["pushing"]["value"] == pytest.approx(WEIGHT, rel=STATED)
    assert listed["giving_way"]["judge"]["accepted"] is True
    both_asked = command("reaction", path, "--held", "--path")
    assert both_asked.returncode == 2
    assert "different questions" in both_asked.stderr
