"""The reaction of supports carried step by step, by distinct elements: closed forms and the path of fe."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.support_paths import reaction_paths
from harness.engine.reaction_judge import judge_plateau
from harness.model.errors import InputError
from harness.model.followed import SupportPath
from methods.de.engines.soft_wall import SoftWall
from methods.de.settings import SoftSettings
from methods.de.support_path import NO_REST, support_path
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, PARTS, WEIGHT, data, extremes
from tests.moving_supports import BRICKS, both, bricks, keystone, path_of, semicircle, thrusts, tilted, values, weight

MOVED = 2e-4
"""Share of the weight by which displacements and rounded corners change a reaction: the arches have 5e-5."""
HISTORY = 4e-3
"""Share of a reaction by which the speed of the supports changes it where bricks slide: they have up to 2e-3."""


@pytest.mark.parametrize("part", PARTS)
def test_block_on_a_base_that_settles(part: float):
    """Portioli and Cascini (2016)."""
    found = both(reaction_paths(drystone.build_wall(data(DOWN, part=part)), "de-soft"))
    assert values(found) == pytest.approx(extremes(part), abs=MOVED * WEIGHT)
    assert found[0].reaction[0] == found[1].reaction[0]


@pytest.mark.parametrize(
    ("thickness", "thrusts"),
    [(0.12, (0.1912256, 0.2079935)), (0.2, (0.1542448, 0.2553107))],
)
def test_thrusts_of_an_arch_that_does_not_slide(thickness: float, thrusts: tuple[float, float]):
    wall = semicircle(thickness, 20, 50.0)
    found = both(reaction_paths(wall, "de-soft"))
    assert [value / weight(wall) for value in values(found)] == pytest.approx(thrusts, abs=MOVED)


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "greatest"), [(0.5, 0.25), (0.7, 0.2545831)])
def test_thrusts_of_a_long_chain(friction: float, greatest: float):
    """Where the wall slides at its springings the greatest is half the friction; the least is .1540326."""
    wall = semicircle(0.2, 100, friction)
    found = both(reaction_paths(wall, "de-soft"))
    assert [value / weight(wall) for value in values(found)] == pytest.approx([0.1540326, greatest], abs=MOVED)


@pytest.mark.parametrize("friction", BRICKS)
def test_bricks_end_where_springs_do(friction: float):
    """Bricks that slide without dilatancy end inside the extremes, as on the path of `fe`."""
    wall = bricks(friction)
    springs = both(reaction_paths(wall))
    found = both(reaction_paths(wall, "de-soft"))
    assert values(found) == pytest.approx(values(springs), rel=HISTORY)
    for each, other in zip(found, springs, strict=True):
        assert each.reaction[0] == pytest.approx(other.reaction[0], rel=MOVED)
        assert each.opened[-1] > each.opened[0]
        assert each.slipping[-1] > 0


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_a_wedge_that_slides_both_ways(friction: float):
    wall = keystone(friction)
    found = both(reaction_paths(wall, "de-soft"))
    assert values(found) == pytest.approx(thrusts(friction), abs=5e-3 * weight(wall))


def test_support_that_turns():
    """A base that turns under a block pushes it over or lets it stand: the reaction is the moment of its weight."""
    wall = tilted(1.0, 2.0, 0.9)
    springs = both(reaction_paths(wall))
    assert values(both(reaction_paths(wall, "de-soft"))) == pytest.approx(values(springs), rel=MOVED)


def test_judge_rejects_what_is_no_plateau():
    wall = semicircle(0.2, 20, 50.0)
    gives, pushes = both(reaction_paths(wall, "de-soft"))
    assert gives.judgement is not None
    assert gives.mechanism is not None
    how: dict[str, Any] = {
        "gives_way": True,
        "tolerance": gives.judgement.tolerance,
        "extremes": gives.extremes,
    }
    right = path_of(gives)
    assert judge_plateau(wall.assembly, right, **how).accepted
    for other in ({"forces": pushes.forces}, {"mechanism": pushes.mechanism}, {"mechanism": 2.0 * gives.mechanism}):
        assert not judge_plateau(wall.assembly, replace(right, **other), **how).accepted


def test_path_that_ends_before_the_reaction_is_constant():
    found = support_path(bricks(0.65).assembly, True, SoftSettings(), most=3)
    assert isinstance(found, SupportPath)
    assert (found.mechanism, found.constant_from) == (None, None)
    assert found.reason == "The reaction still changes after 3 steps."
    assert len(found.displacement) == 4


def test_wall_that_falls_has_no_path():
    assembly = semicircle(0.05, 20, 50.0).assembly
    assert support_path(assembly, True, SoftSettings(hold_steps=1000, relaxations=2)) == NO_REST
    said = reaction_paths(semicircle(0.05, 20, 50.0), "de-soft")
    assert isinstance(said, str)


def test_supports_are_carried_and_stop():
    assembly = drystone.build_wall(data(DOWN)).assembly
    wall = SoftWall(assembly, 1e8, 1.0, 1e-5)
    motion = 1e-6 * assembly.support_motion
    wall.carry(motion, 400)
    np.testing.assert_allclose(wall.places[assembly.fixed], motion[assembly.fixed], rtol=1e-12)
    wall.advance(400)
    np.testing.assert_allclose(wall.places[assembly.fixed], motion[assembly.fixed], rtol=1e-12)
    assert wall.places[~assembly.fixed].any()


def test_joints_that_it_does_not_take():
    with pytest.raises(InputError, match="cohesion"):
        reaction_paths(drystone.build_wall(data(DOWN, cohesion=1.0)), "de-soft")


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path, "--path", "--by", "de-soft", "--json")
    assert done.returncode == 0, done.stderr
    listed = json.loads(done.stdout)
    assert listed["giving_way"]["value"] == pytest.approx(2.0 / 7.0 * WEIGHT, abs=MOVED * WEIGHT)
    assert listed["pushing"]["value"] == pytest.approx(WEIGHT, abs=MOVED * WEIGHT)
    done = command("reaction", path, "--by", "de-soft")
    assert (done.returncode, done.stdout) == (2, "")
    assert "Give --path with it" in done.stderr
