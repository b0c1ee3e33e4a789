"""`la-associated` and `la-associated-cvxpy` on walls whose joints crush, held by the judge.

Closed forms of the rectangular stress block; other values by second-order cone programmes of other code.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from harness.engine.crushing import block_excess, block_power
from harness.engine.judge import answered, judge
from harness.engine.symmetry import VIEWS
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method import Finding
from harness.model.method_registry import load_method, method_names
from harness.model.result import residual_of
from harness.model.wall import Wall
from methods.numerics.stress_blocks import block_dissipation, greatest_by_chords
from tests.bonded_walls import BOND
from tests.commands import drystone
from tests.pressed_walls import DIGITS, SEMICIRCLES, arch, found
from tests.walls import assembly, running_bond, stack, wall_data

HANGS = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
TAKE = ("la-associated", "la-associated-cvxpy")
GAP = 1e-6
"""Stated by both methods, and what the judge accepts between forces and mechanism."""


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("height", "value"), [(2.0, 0.16), (4.0, 0.06), (8.0, 0.01)])
def test_pier_overturns_about_the_edge_of_its_pressed_strip(name: str, height: float, value: float):
    """b / H - gamma b / f_c."""
    wall = assembly(stack(1, 0.4, height), 1.0, compressive_strength=200.0)
    assert found(name, wall).multiplier == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize("name", TAKE)
def test_tension_widens_the_pressed_strip(name: str):
    """(F b - F^2 / (f_c + f_t)) / (W h) with F = W + f_t b; the residual wall keeps its compressive strength."""
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0, compressive_strength=200.0)
    force = 16.0 + 1.6
    result = found(name, wall)
    assert result.multiplier == pytest.approx((force * 0.4 - force**2 / 204.0) / 32.0, rel=1e-9)
    residual = residual_of(result)
    assert residual is not None
    assert residual.multiplier == pytest.approx(0.16, rel=1e-9)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("strength", "value", "digits"), [(100.0, 0.571732, 5e-7), (20.0, 0.51801, 5e-6)])
def test_wall_of_21_bricks(name: str, strength: float, value: float, digits: float):
    wall = assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=strength)
    assert found(name, wall).multiplier == pytest.approx(value, abs=digits)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("thickness", "strength", "value"), SEMICIRCLES)
def test_semicircle(name: str, thickness: float, strength: float | None, value: float):
    assert found(name, arch(thickness, strength)).multiplier == pytest.approx(value, abs=DIGITS)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("thickness", "least"), [(0.15, 4.1981), (0.2, 2.6466)])
def test_semicircle_falls_below_the_least_strength_and_stands_above(name: str, thickness: float, least: float):
    digit = 1e-4  # of the last one recorded
    assert found(name, arch(thickness, least - digit, loads={})).finding is Finding.FALLS
    assert found(name, arch(thickness, least - digit)).finding is Finding.FALLS
    assert found(name, arch(thickness, least + digit, loads={})).finding is Finding.STANDS


def test_chords_and_cones_agree_on_random_walls():
    generator = np.random.default_rng(5)
    for _ in range(4):
        friction, strength = generator.uniform(0.4, 0.9), 10.0 ** generator.uniform(1.5, 4.0)
        cohesion = float(generator.uniform(0.0, 3.0))
        tension = float(generator.uniform(0.0, 1.0) * cohesion / friction)
        wall = assembly(
            running_bond(3, 2),
            float(friction),
            cohesion=cohesion,
            tensile_strength=tension,
            compressive_strength=float(strength),
        )
        one, other = (found(name, wall) for name in TAKE)
        assert one.multiplier == pytest.approx(other.multiplier, rel=2 * GAP)
        rigid = replace(wall, crushing=np.full(wall.n_interfaces, np.inf))
        without = found("la-associated", rigid).multiplier
        assert without is not None
        assert one.multiplier is not None
        assert one.multiplier <= without * (1.0 + 1e-9)


def test_chords_state_a_gap_that_holds_the_exact_value():
    """Forces bear less, and the mechanism takes more, than the multiplier of the cone programme."""
    wall = assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=20.0)
    exact = found("la-associated-cvxpy", wall).multiplier
    result = found("la-associated", wall)
    assert result.multiplier is not None
    assert exact is not None
    assert result.details["duality_gap"] <= GAP
    assert result.multiplier <= exact + 1e-9
    assert result.details["upper_bound"] >= exact - 1e-9


@pytest.mark.parametrize("view", sorted(VIEWS))
def test_views_of_a_wall_crush_alike(view: str):
    wall = assembly(running_bond(3, 2), 0.6, cohesion=1.0, tensile_strength=1.0, compressive_strength=60.0)
    seen, own = found("la-associated", VIEWS[view](wall)).multiplier, found("la-associated", wall).multiplier
    assert seen == pytest.approx(own, rel=2 * GAP)


@pytest.mark.parametrize("name", TAKE)
def test_only_joints_that_do_not_crush_bear_a_load_without_end(name: str):
    press = {"loads": {"live": {"body": [{"per_weight": [0, -1]}]}}}
    wall = assembly(stack(1, 1.0, 0.2), 0.5, compressive_strength=40.0, **press)
    assert found(name, wall).multiplier == pytest.approx(9.0, rel=1e-8)  # f_c A = 40 is ten weights


def test_block_that_hangs_is_not_crushed():
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    wall = assembly(HANGS, 0.5, cohesion=10.0, tensile_strength=6.0, compressive_strength=50.0, loads=loads)
    result = found("la-associated", wall)
    assert result.multiplier == pytest.approx(0.5, rel=1e-9)
    residual = residual_of(result)
    assert residual is not None
    assert residual.finding is Finding.FALLS


def test_components_are_put_together_with_forces_within_their_stress_blocks():
    def pier(name: str, x: float, height: float) -> list[dict[str, Any]]:
        ground = [[x, -1], [x + 0.4, -1], [x + 0.4, 0], [x, 0]]
        box = [[x, 0], [x + 0.4, 0], [x + 0.4, height], [x, height]]
        return [{"id": f"g{name}", "polygon": ground, "fixed": True}, {"id": name, "polygon": box}]

    data = wall_data({}, 1.0, compressive_strength=200.0, blocks=pier("low", 0.0, 2.0) + pier("high", 3.0, 4.0))
    del data["pattern"]
    assert found("la-associated", build(Wall.model_validate(data)).assembly).multiplier == pytest.approx(0.06, rel=1e-9)


@pytest.mark.parametrize("change", ["forces", "multiplier", "mechanism", "weaker"])
def test_wrong_answers_are_rejected(change: str):
    wall = arch(0.2, 20.0)
    result = found("la-associated", wall)
    assert result.multiplier is not None
    changed, judged = result, wall
    if change == "forces":  # those without crushing, in equilibrium at their own multiplier
        rigid = found("la-associated", replace(wall, crushing=np.full(wall.n_interfaces, np.inf)))
        changed = result.model_copy(
            update={"forces": rigid.forces, "multiplier": rigid.multiplier, "forces_multiplier": rigid.multiplier}
        )
    elif change == "multiplier":
        more = result.multiplier * (1.0 + 1e-5)
        changed = result.model_copy(update={"multiplier": more, "forces_multiplier": more})
    elif change == "mechanism":  # hinges at the ends of joints
        rigid = found("la-associated", replace(wall, crushing=np.full(wall.n_interfaces, np.inf)))
        changed = result.model_copy(update={"mechanism": rigid.mechanism})
    else:
        judged = replace(wall, crushing=0.999 * wall.crushing)
    assert judge(judged, changed, 1e-9).accepted is False


def test_fall_by_a_mechanism_that_crushing_outweighs_is_no_fall():
    wall, falls = arch(0.15, 4.3, loads={}), found("la-associated", arch(0.15, 4.1, loads={}))
    assert judge(wall, falls, 1e-9).accepted is False


def test_stress_block_of_the_judge_by_hand():
    """A joint of F0 = 8 under N = 2: |n1 - n2| <= 2 (1 - 2 / 8) = 1.5."""
    wall = replace(assembly(stack(1, 1.0, 0.2), 0.5), crushing=np.array([8.0]))
    assert block_excess(wall, np.array([[1.75, 0.25, 0.0]])) == pytest.approx(0.0, abs=1e-15)
    assert block_excess(wall, np.array([[1.8, 0.2, 0.0]])) == pytest.approx(0.05)
    assert block_excess(wall, np.array([[5.0, 5.0, 0.0]])) == pytest.approx(1.25)  # 10 on 8
    # One end closes by 1 and the other opens by 3: a quarter of the joint closes, by 1/2 in the mean.
    for opening, power in (([-1.0, 3.0], 1.0), ([3.0, -1.0], 1.0), ([-1.0, -3.0], 16.0), ([0.5, 2.0], 0.0)):
        assert block_power(wall, np.array([opening])) == pytest.approx(power)
        assert block_dissipation(np.array([8.0]), np.array([opening])) == pytest.approx(power)


def test_dissipation_is_the_greatest_over_the_stress_block():
    generator = np.random.default_rng(1)
    force = np.linspace(0.0, 3.0, 4001)
    for opening in generator.normal(size=(20, 2)):
        edge = force**2 / 6.0
        power = np.maximum(
            -(edge * opening[0] + (force - edge) * opening[1]), -((force - edge) * opening[0] + edge * opening[1])
        )
        # The greatest of 4001 points lies below the maximum of a parabola by the square of their distance at most.
        assert block_dissipation(np.array([3.0]), opening[None]) == pytest.approx(power.max(), abs=1e-6)


@pytest.mark.parametrize("name", sorted(set(method_names()) - set(TAKE)))
def test_other_methods_refuse_by_name(name: str):
    wall = assembly(stack(1, 0.4, 2.0), 1.0, compressive_strength=200.0)
    if load_method(name).traits.any_crushing:
        return
    with pytest.raises(
        InputError, match=f"{name} takes joints that do not crush.*la, la-associated, la-associated-cvxpy"
    ):
        answered(load_method(name), wall)


def test_commands_answer_or_refuse(tmp_path: Path):
    path = tmp_path / "pier.json"
    path.write_text(json.dumps(wall_data(stack(1, 0.4, 4.0), 1.0, compressive_strength=200.0)))
    done = drystone("run", "la-associated", path)
    assert done.returncode == 0, done.stderr
    assert "0.06" in done.stdout
    assert "fe-newton takes joints that do not crush" in drystone("run", "fe-newton", path).stderr
    data = json.loads(path.read_text())
    moving = tmp_path / "moving.json"
    moving.write_text(json.dumps(data | {"settlements": [{"blocks": ["base"], "translation": [0, -1]}]}))
    for command in (
        ["factor", path, "--method", "de-soft"],
        ["bound", path, "-o", tmp_path / "b.json"],
        ["reaction", moving],
    ):
        refused = drystone(*command)
        assert refused.returncode == 2, refused.stdout
        assert "compressive strength" in refused.stderr
    assert "--method de" in drystone("factor", path, "--method", "de-soft").stderr


def test_strength_far_above_the_loads_is_refused_with_the_joint():
    with pytest.raises(InputError, match="crushes under more than 100000 times the dead load"):
        assembly(stack(1, 0.4, 4.0), 1.0, compressive_strength=1e9)


@pytest.mark.parametrize(
    ("friction", "bed", "head"),
    [
        ({"default": 0.5, "compressive_strength": 90.0}, 90.0, 90.0),
        ({"default": 0.5, "rules": [{"joint": "bed", "value": 0.4, "compressive_strength": 90.0}]}, 90.0, np.inf),
        ({"default": 0.5, "compressive_strength": 90.0, "rules": [{"joint": "bed", "value": 0.4}]}, np.inf, 90.0),
    ],
)
def test_strength_stands_wherever_friction_may(friction: dict[str, Any], bed: float, head: float):
    built = build(Wall.model_validate(wall_data(running_bond(2, 2), friction, thickness=0.3)))
    wall = built.assembly
    beds = np.array(wall.joint) == "bed"
    stress = wall.crushing / (0.3 * wall.length)
    np.testing.assert_allclose(stress[beds], bed, rtol=1e-12)
    np.testing.assert_allclose(stress[~beds], head, rtol=1e-12)
    again = build(Wall.model_validate(built.wall.document())).assembly
    np.testing.assert_array_equal(again.crushing, wall.crushing)


def test_programmes_need_few_rounds():
    """Each round about squares the gap; ten are far more than the walls of this file take."""
    wall = assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=100.0)
    limit = greatest_by_chords(wall, wall.dead, wall.live)
    assert limit.rounds <= 10
    assert limit.upper - limit.multiplier <= 1e-9
