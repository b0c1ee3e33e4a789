"""Passive fill: closed forms of one block, an arch by a linear programme written apart, and what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

import drystone
from harness.engine.judge import answered, judge
from harness.engine.symmetry import mirrored
from harness.model.assembly import Assembly
from harness.model.bars import ARRAYS, Bars
from harness.model.build import build
from harness.model.details import BAR_FORCES
from harness.model.errors import InputError
from harness.model.method_registry import check_takes, load_method, method_names, methods_with
from harness.model.reading import parse_wall, wall_json
from harness.model.support_reactions import out_of_balance, support_reactions
from harness.model.wall import Wall
from tests.commands import drystone as command

TAKEN = ("la", "la-associated", "la-associated-cvxpy", "fe", "fe-newton")
EXACT = 1e-9
WIDTH, HEIGHT, WEIGHT, GAMMA, LEVEL, SHARE, K_P = 1.0, 0.8, 16.0, 18.0, 0.6, 0.5, 3.0
FORCE = SHARE * K_P * GAMMA * LEVEL**2 / 2.0
"""The whole passive force on the right of the block, at a third of the depth."""
SOIL = {"level": LEVEL, "unit_weight": GAMMA, "passive": {"mobilised": SHARE, "friction_angle": 30.0}}


def block(friction: float, push: float = 1.0, width: float = WIDTH, **fill: Any) -> dict[str, Any]:
    """A block on a wide base that is pushed, with fill beside it on the right."""
    beside = SOIL | {"between": [width, 3.0]} | fill
    return {
        "format": "wall/1",
        "friction": friction,
        "blocks": [
            {"id": "base", "polygon": [[-3, -1], [3, -1], [3, 0], [-3, 0]], "fixed": True},
            {"id": "block", "polygon": [[0, 0], [width, 0], [width, HEIGHT], [0, HEIGHT]], "weight": WEIGHT},
        ],
        "loads": {"dead": {"fills": [beside]}, "live": {"body": [{"per_weight": [push, 0]}]}},
    }


def built(data: dict[str, Any]) -> Assembly:
    return build(Wall.model_validate(data)).assembly


def asked(method: str, wall: Assembly) -> float:
    """The multiplier of a method, accepted by the judge."""
    result, judgement = answered(load_method(method), wall)
    assert judgement.accepted, (result.sentence, judgement.sentence)
    assert result.multiplier is not None
    return result.multiplier


@pytest.mark.parametrize("method", TAKEN)
def test_block_slides_into_the_fill_at_friction_and_passive_force(method: str):
    assert asked(method, built(block(0.2))) == pytest.approx(0.2 + FORCE / WEIGHT, rel=EXACT)
    assert asked(method, built(block(0.2, push=-1.0))) == pytest.approx(0.2, rel=EXACT), "away from it nothing resists"


@pytest.mark.parametrize("level", [1e-300, 1e-160, 1e-12])
def test_fill_that_reaches_no_more_of_a_face_than_rounding_is_refused(level: float):
    """Its force would be zero, and where it acts a division of zero by zero."""
    with np.errstate(all="raise"), pytest.raises(InputError, match="no face of a free block that it may resist"):
        built(block(0.2, level=level))


@pytest.mark.parametrize("method", TAKEN)
def test_slender_block_topples_against_the_fill_at_a_third_of_its_depth(method: str):
    width = 0.3
    expected = width / HEIGHT + 2.0 * FORCE * LEVEL / 3.0 / (WEIGHT * HEIGHT)
    assert asked(method, built(block(5.0, width=width))) == pytest.approx(expected, rel=EXACT)
    assert asked(method, built(block(5.0, push=-1.0, width=width))) == pytest.approx(width / HEIGHT, rel=EXACT)


def test_mirrored_wall_has_the_mirrored_multiplier():
    wall = built(block(0.2))
    other = block(0.2, push=-1.0, between=[-3.0, 0.0])
    assert asked("la-associated", built(other)) == pytest.approx(asked("la-associated", wall), rel=EXACT)
    assert asked("la-associated", mirrored(wall)) == pytest.approx(asked("la-associated", wall), rel=EXACT)


def test_fill_on_both_sides_resists_each_and_a_factor_multiplies_its_weight_alone():
    wall = built(block(0.2, between=None, factor=2.0))
    assert wall.bars.names == ("fill 1, left of block", "fill 1, right of block")
    np.testing.assert_allclose(wall.bars.least, -FORCE, rtol=1e-12)
    np.testing.assert_allclose(wall.bars.end2, [[0.0, LEVEL / 3.0], [WIDTH, LEVEL / 3.0]], atol=1e-12)
    for push in (1.0, -1.0):
        assert asked("la-associated", built(block(0.2, push, between=None))) == pytest.approx(
            0.2 + FORCE / WEIGHT, rel=EXACT
        )


@pytest.mark.parametrize(
    ("level", "top", "force", "arm"),
    [
        (2.0, 1.0, 1.5, 4.0 / 9.0),  # a trapezium of 1 over 2: its centre is 4/9 above its foot
        (0.5, 1.0, 0.125, 0.5 / 3.0),  # half under the level
    ],
)
def test_inclined_faces_bear_the_pressure_on_their_vertical_projection(
    level: float, top: float, force: float, arm: float
):
    data = block(0.5, level=level, unit_weight=1.0, between=None, passive={"mobilised": 1.0, "coefficient": 1.0})
    data["blocks"][1] |= {"polygon": [[-1, 0], [1, 0], [0, top]]}
    bars = built(data).bars
    np.testing.assert_allclose(bars.least, -force, rtol=1e-12)
    np.testing.assert_allclose(bars.end2[:, 1], arm, rtol=1e-12)
    np.testing.assert_allclose(abs(bars.end2[:, 0]), 1.0 - arm / top, rtol=1e-12)


@pytest.mark.parametrize("lean", [0.0, 1e-12, -1e-12, 0.002, -0.002, 0.1])
def test_resistance_does_not_hang_on_how_upright_a_drawn_face_is(lean: float):
    data = block(0.5, between=None)
    top = [[WIDTH - lean, HEIGHT], [lean, HEIGHT]]
    data["blocks"][1] |= {"polygon": [[0, 0], [WIDTH, 0], *top]}
    wall = built(data)
    np.testing.assert_allclose(wall.bars.least, -FORCE, rtol=1e-9)
    np.testing.assert_allclose(wall.bars.end2[:, 1], LEVEL / 3.0, rtol=1e-9)


def test_faces_of_a_whole_wall_bear_what_one_face_of_its_height_does():
    bond = {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 5, "bricks": 3}
    data = block(0.65, between=None, level=1.2) | {"pattern": bond, "blocks": [], "unit_weight": 20.0}
    bars = built(data).bars
    assert len(bars) == 10
    narrow = json.loads(wall_json(build(Wall.model_validate(data)).wall))
    for each in narrow["blocks"][1:]:
        middle = np.mean([x for x, _ in each["polygon"]])
        each["polygon"] = [[x - 0.005 * np.sign(x - middle), y] for x, y in each["polygon"]]
    apart = built(narrow | {"interfaces": {"tolerance": 0.02}}).bars
    assert apart.names == bars.names, "no fill lies in the joints between bricks that are drawn apart"
    np.testing.assert_allclose(apart.least, bars.least, rtol=1e-9)
    for side in ("left", "right"):
        whole = -sum(least for name, least in zip(bars.names, bars.least, strict=True) if f", {side} of" in name)
        assert whole == pytest.approx(SHARE * K_P * GAMMA * (1.2**2 - 0.2**2) / 2.0)


def test_fill_beside_another_block_resists_above_it_alone():
    data = block(0.2, between=None)
    data["blocks"].append({"id": "low", "polygon": [[1, 0], [2, 0], [2, 0.25], [1, 0.25]], "weight": 1.0})
    bars = built(data).bars
    found = dict(zip(bars.names, -bars.least, strict=True))
    assert found["fill 1, right of block"] == pytest.approx(SHARE * K_P * GAMMA * (LEVEL - 0.25) ** 2 / 2.0)
    assert found["fill 1, right of low"] == pytest.approx(FORCE - found["fill 1, right of block"])
    assert "fill 1, left of low" not in found


def by_a_programme_of_its_own(wall: Assembly, passive: bool) -> float:
    """Greatest multiplier of forces n1, n2 >= 0 and any shear, and pressures from zero to the passive one.

    The passive forces are those of straight faces, summed over their depth by many thin layers.
    """
    free, m = np.flatnonzero(~wall.fixed), wall.n_interfaces
    pressed = []
    for block in free.tolist() if passive else ():
        corners = wall.polygons[block]
        for first, last in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            if min(np.hypot(*first), np.hypot(*last)) < 1.0:
                continue  # no extrados
            t = (np.arange(4000) + 0.5) / 4000
            y = first[1] + t * (last[1] - first[1])
            z = np.maximum(1.3 - y, 0.0)
            force = SHARE * K_P * 16.0 * z * abs(last[1] - first[1]) / 4000
            if force.sum() > 0.0:
                sign = -1.0 if first[0] + last[0] > 0.0 else 1.0
                pressed.append((block, sign, float(force.sum()), float(force @ y / force.sum())))
    columns = np.zeros((3 * wall.n_blocks, 3 * m + len(pressed)))
    for p in range(m):
        normal, tangent = wall.normal[p], wall.tangent[p]
        for k, (point, way) in enumerate(((wall.end1[p], normal), (wall.end2[p], normal), (wall.end1[p], tangent))):
            for b, sign in ((wall.block_a[p], -1.0), (wall.block_b[p], 1.0)):
                arm = point - wall.centroid[b]
                columns[3 * b : 3 * b + 3, 3 * p + k] += sign * np.array([*way, arm[0] * way[1] - arm[1] * way[0]])
    for k, (b, sign, _, y) in enumerate(pressed):
        columns[3 * b : 3 * b + 3, 3 * m + k] = [sign, 0.0, -(y - wall.centroid[b, 1]) * sign]
    rows = np.concatenate([np.arange(3 * b, 3 * b + 3) for b in free])
    matrix = np.column_stack([columns[rows], wall.live.ravel()[rows]])
    bounds = [(0.0, None), (0.0, None), (None, None)] * m + [(0.0, top) for _, _, top, _ in pressed] + [(0.0, None)]
    cost = np.zeros(matrix.shape[1])
    cost[-1] = -1.0
    found = linprog(cost, A_eq=matrix, b_eq=-wall.dead.ravel()[rows], bounds=bounds, method="highs")
    assert found.status == 0, found.message
    return float(-found.fun)


def test_arch_of_the_library_with_and_without_passive_fill_is_that_of_a_programme_written_apart():
    values = []
    for name, passive in (("filled-arch", False), ("filled-arch-passive", True)):
        wall = drystone.library_wall(name)
        values.append(by_a_programme_of_its_own(wall.assembly, passive))
        assert wall.case.file.references[0].value == pytest.approx(values[-1], abs=5e-7)
        assert asked("la-associated", wall.assembly) == pytest.approx(values[-1], rel=1e-8)  # of the thin layers
    assert values[1] > 3.0 * values[0]


@pytest.mark.parametrize("level", [0.45, 0.428380842])
def test_arch_of_few_stones_with_full_dilatancy_bears_the_associated_maximum(level: float):
    """No path of the search ended at a state of this wall; the forces of the associated maximum fit its mechanism."""
    resists = {"mobilised": 0.93413468, "coefficient": 3.48925345}
    arch = {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": {"default": 0.5261532688, "dilatancy": 0.5261532688},
        "pattern": {"type": "ring", "inner_radius": 0.9, "outer_radius": 1.0730222414, "count": 7},
        "loads": {
            "dead": {"fills": [{"level": level, "unit_weight": 6.6976124, "passive": resists}]},
            "live": {"body": [{"per_weight": [-1.0, 0.0]}]},
        },
    }
    wall = built(arch)
    assert asked("la", wall) == pytest.approx(asked("la-associated", wall), rel=EXACT)


def test_judge_rejects_fill_that_pulls_presses_too_much_or_presses_what_moves_away():
    wall = built(block(0.2, between=None))
    result, judgement = answered(load_method("la-associated"), wall)
    assert judgement.accepted
    left, right = result.details[BAR_FORCES]
    assert (left, right) == (pytest.approx(0.0, abs=1e-9), pytest.approx(-FORCE))
    for wrong in ([left, right * 1.01], [0.1, right], [-1.0, right], [left, 0.0]):
        changed = result.model_copy(update={"details": result.details | {BAR_FORCES: wrong}})
        assert judge(wall, changed, 1e-9).accepted is False
    weaker = replace(wall, bars=replace(wall.bars, least=0.9 * wall.bars.least))
    assert judge(weaker, result, 1e-9).accepted is False


def test_reactions_list_what_the_fill_bears_apart_from_the_supports():
    wall = built(block(0.2))
    result, _ = answered(load_method("la-associated"), wall)
    listed = support_reactions(wall, np.asarray(result.forces), tension=np.asarray(result.details[BAR_FORCES]))
    assert [each.support for each in listed] == ["base", "fill 1, right of block"]
    assert [each.fx for each in listed] == pytest.approx([-0.2 * WEIGHT, -FORCE])
    assert out_of_balance(wall, listed, result.multiplier or 0.0) < 1e-9


def test_combination_multiplies_loads_and_not_what_resists():
    """1.35 times the weight slides under 1.5 times the push at mu 1.35/1.5 + P/(1.5 W)."""
    data = block(0.2)
    loads = data.pop("loads")
    combined = {"load_cases": {"push": loads}, "combinations": {"uls": {"dead": 1.35, "push": 1.5}}}
    cases = drystone.build_wall(data | combined, "case").load_cases
    assert asked("la-associated", cases["push"].assembly) == pytest.approx(0.2 + FORCE / WEIGHT, rel=EXACT)
    assert asked("la-associated", cases["uls"].assembly) == pytest.approx((0.27 + FORCE / WEIGHT) / 1.5, rel=EXACT)


def test_every_other_method_refuses_it_by_name():
    wall = built(block(0.2))
    for name in set(method_names()) - set(methods_with("any_bars")):
        with pytest.raises(InputError, match=f"{name} takes no ties, props and passive fill; the wall has fill 1"):
            check_takes(load_method(name), wall)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"passive": {"mobilised": 0.5}}, "either friction_angle or coefficient"),
        ({"passive": {"mobilised": 1.5, "coefficient": 3}}, "less than or equal to 1"),
        ({"passive": {"coefficient": 3}}, "mobilised"),
        ({"passive": {"mobilised": 0.5, "friction_angle": 89.9999999999}}, "no finite K_p"),
        ({"unit_weight": 0.0}, "without weight resists nothing"),
        ({"between": [1.5, 3.0]}, "looks sideways below its level 0.6"),
    ],
)
def test_passive_fill_that_cannot_be_is_refused(change: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        build(parse_wall(block(0.2, **change), "wall"))


def test_a_tie_has_not_the_name_of_what_fill_bears():
    """Tables and the columns of a path know a bar by its name."""
    tie = {"from": {"block": "base", "at": [-1, 0]}, "to": {"block": "block", "at": [0, 0.5]}, "yield_force": 1.0}
    data = block(0.2) | {"ties": [tie | {"id": "fill 1, right of block"}]}
    with pytest.raises(InputError, match='"fill 1, right of block", as is a bar of passive fill'):
        build(parse_wall(data, "wall"))


def test_a_live_fill_does_not_resist():
    data = block(0.2)
    data["loads"]["live"]["fills"] = data["loads"]["dead"].pop("fills")
    with pytest.raises(InputError, match="give it in the dead load"):
        parse_wall(data, "wall")


def test_command_prints_what_the_fill_bears(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(block(0.2)), encoding="utf-8")
    done = command("run", "la-associated", path)
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    assert f"fill 1, right of block, from fill to block: compression {FORCE:.6g} kN, yields" in said
    wall = drystone.read_wall(path)
    again = drystone.build_wall(wall.document(explicit=True), "again")
    np.testing.assert_array_equal(again.assembly.bars.least, wall.assembly.bars.least)


def bond_beside_fill() -> dict[str, Any]:
    """Ten bricks in running bond, pushed into passive fill on their right."""
    height, width = 0.55, 2.0
    ends = [[(0.0, 1.0), (1.0, 2.0)], [(0.0, 0.5), (0.5, 1.5), (1.5, 2.0)]]
    bricks = [
        {"id": f"{course}-{k}", "polygon": [(a, y), (b, y), (b, y + height), (a, y + height)]}
        for course in range(4)
        for y in (course * height,)
        for k, (a, b) in enumerate(ends[course % 2])
    ]
    ground = {"id": "ground", "polygon": [(-3, -1), (8, -1), (8, 0), (-3, 0)], "fixed": True}
    passive = {"mobilised": 0.34, "friction_angle": 30.0}
    fill = {"level": 2.01, "unit_weight": 18.0, "between": (width, 7.0), "passive": passive}
    return {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": 0.9,
        "blocks": [ground, *bricks],
        "loads": {"live": {"body": [{"per_weight": (1.0, 0.0)}]}, "dead": {"fills": [fill]}},
    }


def test_the_least_state_beside_fill_is_not_above_the_plateau_of_the_springs():
    wall = drystone.build_wall(bond_beside_fill(), "bond")
    least, plateau, most = (drystone.analyse(wall, method).multiplier for method in ("la", "fe", "la-associated"))
    assert least is not None
    assert plateau is not None
    assert most is not None
    assert least <= plateau + 1e-9
    assert plateau < 0.98 * most


TIE = {"from": {"block": "block", "at": [0.5, 0.8]}, "to": {"block": "base", "at": [-2.0, -0.5]}, "yield_force": 2.0}


def test_bars_beside_passive_fill_keep_their_stiffness_and_all_else():
    bars = built(block(0.2) | {"ties": [TIE | {"stiffness": 750.0}]}).bars
    assert bars.kinds == ("tie", "fill")
    np.testing.assert_array_equal(bars.stiffness, [750.0, np.nan])
    assert set(ARRAYS) == {name for name, value in vars(Bars()).items() if isinstance(value, np.ndarray)}
    both = bars.followed_by(bars)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(both, name), np.concatenate([getattr(bars, name)] * 2))
