"""The reaction of supports against an imposed displacement, by gap springs: plateaus between the extremes, judged."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.reactions import reactions
from drystone.support_paths import paths_as_csv, reaction_paths
from harness.engine.reaction_judge import judge_plateau
from harness.model.errors import InputError
from harness.model.followed import SupportPath
from methods.fe.settings import GapSpringsSettings
from methods.fe.support_path import support_path
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, PARTS, WEIGHT, data, extremes
from tests.moving_supports import (
    BRICKS,
    both,
    bricks,
    keystone,
    path_of,
    segmental,
    semicircle,
    thrusts,
    values,
    weight,
)

EXACT = 1e-8
"""Relative accuracy that `fe` declares of a plateau."""
DIGITS = 2e-7
"""Of thrusts over the weight by another programme, exact to the 1e-7 that its solver is."""


SHARES = (0.0, 0.4)
"""Of the friction, by which slips lift."""


@pytest.mark.parametrize("part", PARTS)
def test_block_on_a_base_that_settles(part: float):
    """Portioli and Cascini (2016)."""
    found = both(reaction_paths(drystone.build_wall(data(DOWN, part=part))))
    assert values(found) == pytest.approx(extremes(part), abs=EXACT * WEIGHT)
    assert found[0].reaction[0] == found[1].reaction[0]


@pytest.mark.parametrize(
    ("thickness", "thrusts"),
    [(0.12, (0.1912256, 0.2079935)), (0.15, (0.1756349, 0.2277179)), (0.2, (0.1542448, 0.2553107))],
)
def test_thrusts_of_an_arch_that_does_not_slide(thickness: float, thrusts: tuple[float, float]):
    wall = semicircle(thickness, 20, 50.0)
    found = both(reaction_paths(wall))
    assert [value / weight(wall) for value in values(found)] == pytest.approx(thrusts, abs=DIGITS)


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "greatest"), [(0.4, 0.2), (0.5, 0.25), (0.7, 0.2545831)])
def test_thrusts_of_an_arch_with_friction(friction: float, greatest: float):
    """Where it slides at its springings the greatest is half the friction; the least is .1540326."""
    wall = semicircle(0.2, 100, friction)
    found = both(reaction_paths(wall))
    assert [value / weight(wall) for value in values(found)] == pytest.approx([0.1540326, greatest], abs=DIGITS)


def test_bricks_end_between_the_extremes():
    """By associated flow 1.0544815 to 7.9455185 (another programme); bricks that slide without dilatancy end inside."""
    low, high = BRICKS[0.65]
    found = both(reaction_paths(bricks(0.65)))
    assert found[0].extremes == pytest.approx((low, high), abs=1e-7)
    gives, pushes = values(found)
    assert low + 0.1 < gives < pushes < high - 0.1
    assert gives + pushes == pytest.approx(9.0, rel=EXACT)  # the wall is its own mirror image


@pytest.mark.parametrize("friction", BRICKS)
def test_bricks_that_lift_by_their_friction_end_at_the_extremes(friction: float):
    found = both(reaction_paths(bricks({"default": friction, "dilatancy": friction})))
    assert values(found) == pytest.approx(BRICKS[friction], abs=1e-7)


def test_bricks_that_lift_by_a_part_of_their_friction_end_between():
    """A lift between nothing and the friction ends between."""
    low, high = BRICKS[0.65]
    found = {
        share: values(both(reaction_paths(bricks({"default": 0.65, "dilatancy": share * 0.65})))) for share in SHARES
    }
    assert low < found[0.4][0] < found[0.0][0]
    assert found[0.0][1] < found[0.4][1] < high


def test_reaction_is_constant_from_the_displacement_given():
    for each in both(reaction_paths(bricks(0.65))):
        assert each.constant_from is not None
        beyond = each.displacement > each.constant_from * (1.0 + 1e-9)
        assert 0 < beyond.sum() < len(beyond)
        assert each.reaction[beyond] == pytest.approx(float(each.reaction[-1]), rel=EXACT)
        before = each.reaction[each.displacement < 0.5 * each.constant_from]
        assert abs(before - each.reaction[-1]).min() > 1e-3 * weight(bricks(0.65))


def test_stiffness_scales_displacements_and_no_reaction():
    wall = drystone.build_wall(data(DOWN))
    soft, stiff = (both(reaction_paths(wall, normal_stiffness=k)) for k in (1e3, 1e5))
    for one, other in zip(soft, stiff, strict=True):
        np.testing.assert_allclose(one.displacement, 100.0 * other.displacement, rtol=1e-9)
        np.testing.assert_allclose(one.reaction, other.reaction, rtol=1e-9)


@pytest.mark.parametrize(
    "settlements",
    [
        [{"blocks": ["right"], "rotation": -1.0, "about": [0.3, 0.0]}],
        [DOWN, {"blocks": ["left"], "translation": [0.5, 0]}],
        [{"group": "ground", "translation": [0, -1]}],
    ],
)
def test_any_motion_of_the_supports(settlements: list[dict[str, Any]]):
    """Rotations, and supports that are no one rigid body; all together they leave the reaction as it is."""
    wall = drystone.build_wall(data(*settlements))
    low, high = (each.value for each in reactions(wall))  # type: ignore[union-attr]
    gives, pushes = values(both(reaction_paths(wall)))
    assert low - EXACT * WEIGHT <= gives <= pushes + EXACT * WEIGHT
    assert pushes <= high + EXACT * WEIGHT


@pytest.mark.parametrize(
    "wall",
    [
        segmental(0.3, {"blocks": ["abutment-2"], "translation": [1, 0]}),
        segmental(
            0.8,
            {"blocks": ["abutment-2"], "translation": [1, 0]},
            {"blocks": ["abutment-1"], "translation": [-1, -0.5]},
        ),
    ],
    ids=["several motions without stiffness", "gaps that change states at one reaction"],
)
def test_arch_whose_mechanism_the_tangent_does_not_choose(wall: drystone.Wall):
    """It is a hinge mechanism or slides at one end, and both have the reactions of associated flow."""
    found = both(reaction_paths(wall))
    assert values(found) == pytest.approx(found[0].extremes, rel=EXACT)


def test_slip_that_goes_back_is_no_mechanism():
    """Blocks slip back for a long way at one reaction, until they stick and the wall moves on."""
    pattern = {
        "type": "running_bond",
        "block_length": 1.0,
        "block_height": 0.378,
        "count": 2,
        "bricks": 2,
        "base": False,
    }
    supports = [
        {"id": name, "polygon": [[left, -0.4], [right, -0.4], [right, 0], [left, 0]], "material": "rock", "fixed": True}
        for name, left, right in (("left", -0.1, 0.7735), ("right", 0.7735, 2.1))
    ]
    rules = [{"joint": "bed", "value": 0.779}, {"joint": "head", "value": 0.883}]
    content = {"format": "wall/1", "unit_weight": 20.0, "pattern": pattern, "blocks": supports}
    turn = [{"blocks": ["right"], "rotation": -1.0, "about": [0.76, -0.02]}]
    wall = drystone.build_wall(content | {"friction": {"default": 0.449, "rules": rules}, "settlements": turn})
    found = both(reaction_paths(wall))
    assert values(found)[1] == pytest.approx(found[1].extremes[1], rel=1e-7)


def test_joints_with_strength():
    """The joint of the block with what rests bears T = 0.3 f_t in tension, spread by its two ends."""
    wall = drystone.build_wall(data(DOWN, cohesion=20.0, tensile_strength=2.0))
    low, high = (each.value for each in reactions(wall))  # type: ignore[union-attr]
    found = both(reaction_paths(wall))
    dry = values(both(reaction_paths(drystone.build_wall(data(DOWN)))))
    assert values(found)[0] < dry[0] - 0.1
    assert values(found) == pytest.approx([low, high], rel=EXACT)


def test_what_fe_does_not_take_is_refused():
    with pytest.raises(InputError, match="no support with a joint"):
        reaction_paths(drystone.build_wall(data()))
    tie = {"from": {"block": "left", "at": [0.1, 0]}, "to": {"block": "block", "at": [0.1, 0.2]}, "yield_force": 1}
    with pytest.raises(InputError, match="takes no ties, props and passive fill"):
        reaction_paths(drystone.build_wall(data(DOWN, ties=[tie])))


def test_a_path_without_an_end_has_no_plateau():
    path = support_path(bricks(0.65).assembly, True, GapSpringsSettings(), most=3)
    assert isinstance(path, SupportPath)
    assert (path.mechanism, path.constant_from) == (None, None)
    assert path.reason == "The reaction still changes after 3 steps."
    assert len(path.reaction) == 4


@pytest.mark.parametrize("friction", [0.05, 0.1, 0.3, 0.5])
def test_a_wedge_that_slides_at_rest_slides_back_first(friction: float):
    """At rest it slides down both faces, so that small motions of either sense change no force."""
    assert values(both(reaction_paths(keystone(friction)))) == pytest.approx(thrusts(friction), rel=EXACT)


def test_a_wall_that_falls_has_no_path():
    assert "the wall falls, wherever its supports go" in str(reaction_paths(semicircle(0.2, 100, 0.3)))
    said = reaction_paths(drystone.build_wall(data(DOWN, loads={"gravity": [1, -1]})))
    assert isinstance(said, str)
    assert "No equilibrium within yield exists" in said


def test_judge_rejects_what_is_no_plateau():
    wall = bricks(0.65)
    gives, pushes = both(reaction_paths(wall))
    assert gives.mechanism is not None
    assert pushes.mechanism is not None
    right, value = path_of(gives), float(gives.reaction[-1])

    def accepted(
        *, gives_way: bool = True, extremes: tuple[float, float] = gives.extremes, **other: Any
    ) -> bool | None:
        path = replace(right, **other)
        return judge_plateau(wall.assembly, path, gives_way=gives_way, tolerance=EXACT, extremes=extremes).accepted

    assert accepted()
    assert accepted(constant_from=float(gives.displacement[-1]))
    assert not accepted(constant_from=0.0)
    assert not accepted(constant_from=-1.0)
    assert not accepted(constant_from=2.0 * float(gives.displacement[-1]))
    assert not accepted(reaction=gives.reaction * 1.001)
    assert not accepted(forces=1e200 * gives.forces)
    assert not accepted(forces=pushes.forces)
    assert not accepted(forces=gives.forces * 1.001)
    assert not accepted(mechanism=pushes.mechanism)
    assert not accepted(mechanism=-gives.mechanism, gives_way=False)
    assert not accepted(mechanism=2.0 * gives.mechanism)
    assert not accepted(mechanism=np.where(wall.assembly.fixed[:, None], gives.mechanism, 0.0))
    assert not accepted(extremes=(value + 0.01, 9.0))
    on_the_way = np.arange(len(gives.reaction)) == 1  # its reaction is changing: the end is as it was
    assert not accepted(reaction=np.where(on_the_way, 2.0 * gives.extremes[1], gives.reaction))
    assert not accepted(reaction=np.where(on_the_way, 0.5 * gives.extremes[0], gives.reaction))
    elastic = support_path(wall.assembly, True, GapSpringsSettings(), most=3)
    assert isinstance(elastic, SupportPath)
    assert not accepted(forces=elastic.forces, reaction=elastic.reaction, displacement=elastic.displacement)


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    table, chart = tmp_path / "path.csv", tmp_path / "path.svg"
    done = command("reaction", path, "--path", "-o", table)
    assert done.returncode == 0, done.stderr
    assert "The support gives way: its reaction goes from" in done.stdout
    found = both(reaction_paths(drystone.build_wall(data(DOWN))))
    assert table.read_text(encoding="utf-8") == paths_as_csv(found)
    assert paths_as_csv(found).startswith("support,displacement [m],reaction [kN],slipping_points,open_points\n")
    done = command("reaction", path, "--path", "--json", "-o", chart)
    listed = json.loads(done.stdout)
    assert listed["giving_way"]["value"] == pytest.approx(2.0 / 7.0 * WEIGHT, rel=EXACT)
    assert listed["pushing"]["reaction"] == found[1].reaction.tolist()
    assert chart.read_text(encoding="utf-8").lstrip().startswith("<?xml")


@pytest.mark.parametrize(
    ("options", "words"),
    [(("--path", "--until-collapse"), "different questions"), (("-o", "x.svg"), "two numbers are no curve")],
)
def test_command_refuses_what_does_not_fit_together(tmp_path: Path, options: tuple[str, ...], words: str):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path, *options)
    assert (done.returncode, done.stdout) == (2, "")
    assert words in done.stderr
