"""The interaction domain of two live loads: closed forms of one block, rays of bonded walls, and what is refused."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.errors import InputError
from tests import commands
from tests.walls import stack, wedge

WEIGHT, WIDTH, HEIGHT, FRICTION = 16.0, 0.4, 2.0, 0.5


def force(y: float, x: float = 1.0) -> dict[str, Any]:
    """A horizontal live force on the block at this height."""
    return {"live": {"points": [{"block": "1", "at": [WIDTH / 2.0, y], "force": [x, 0.0]}]}}


def document(**cases: Any) -> dict[str, Any]:
    """A block of 0.4 x 2 m and 16 kN, with friction 0.5 below, under load cases."""
    made = {"format": "wall/1", "unit_weight": 20, "friction": FRICTION, "pattern": stack(1, WIDTH, HEIGHT)}
    return {**made, "load_cases": cases or {"top": force(HEIGHT), "foot": force(0.0)}}


BLOCK = drystone.build_wall(document(), "block")
FLAT = drystone.new_wall("stack", count=1, width=1.0, height=0.2, friction=0.3)
CORNERS = np.array([(1.6, 6.4), (-1.6, 9.6), (-1.6, -6.4), (1.6, -9.6)])
"""Overturning: |x| h <= W b / 2; sliding: |x + y| <= mu W."""


def ray(edges: np.ndarray, direction: np.ndarray) -> float:
    """How far a direction goes in the polygon that these normals bound."""
    return float(1.0 / (edges @ direction).max())


def test_block_pushed_at_top_and_foot_overturns_or_slides():
    found = drystone.domain(BLOCK)
    assert found.exact
    assert found.reason == ""
    order = np.lexsort(found.vertices.T)
    np.testing.assert_allclose(found.vertices[order], CORNERS[np.lexsort(CORNERS.T)], rtol=1e-9)
    assert len(found.edges) == 4
    np.testing.assert_allclose(abs(found.edges @ CORNERS.T).max(axis=1), 1.0, rtol=1e-9)
    assert len(found.unbounded) == 0


@pytest.mark.parametrize("height", [0.2, 5.0], ids=["slides", "overturns"])
def test_weights_of_a_block_bound_a_cone(height: float):
    """|x| <= (1 + y) min(mu, b / h), y downwards: nothing is borne upwards beyond the weight, everything downwards."""
    found = drystone.domain(drystone.new_wall("stack", count=1, width=1.0, height=height, friction=0.3))
    limit = min(0.3, 1.0 / height)
    np.testing.assert_allclose(found.vertices, [(0.0, -1.0)], atol=1e-9)
    slope = found.unbounded[:, 0] / found.unbounded[:, 1]
    np.testing.assert_allclose(sorted(slope), [-limit, limit], rtol=1e-6)
    assert "unbounded" in found.sentence


def test_scale_of_a_load_scales_its_axis_only():
    found = drystone.domain(drystone.build_wall(document(top=force(HEIGHT, 1e-3), foot=force(0.0)), "block"))
    scaled = CORNERS * [1e3, 1.0]
    np.testing.assert_allclose(found.vertices[np.lexsort(found.vertices.T)], scaled[np.lexsort(scaled.T)], rtol=1e-7)


@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_loads_of_very_different_size_bound_the_same_polygon(factor: float):
    """|x| h <= W b / 2 and |x + k y| <= mu W; and of weights |x| <= mu (1 + k y), which is open."""
    found = drystone.domain(drystone.build_wall(document(top=force(HEIGHT), foot=force(0.0, factor)), "block"))
    scaled = CORNERS / [1.0, factor]
    np.testing.assert_allclose(found.vertices[np.lexsort(found.vertices.T)], scaled[np.lexsort(scaled.T)], rtol=1e-7)
    assert found.reason == ""
    weights = drystone.domain(FLAT, live=((1.0, 0.0), (0.0, -factor)))
    np.testing.assert_allclose(weights.vertices * [1.0, factor], [(0.0, -1.0)], atol=1e-9)
    assert len(weights.edges) == len(weights.unbounded) == 2


@pytest.mark.parametrize("second", [2.0, -1.0])
def test_equal_and_opposite_loads_bound_a_strip(second: float):
    """|x + k y| <= mu of a block that slides."""
    found = drystone.domain(FLAT, live=((1.0, 0.0), (second, 0.0)))
    np.testing.assert_allclose(abs(found.edges), np.array([[1.0, abs(second)]] * 2) / 0.3, rtol=1e-9)
    np.testing.assert_allclose(found.edges[0], -found.edges[1], rtol=1e-9)
    assert "strip between two parallel edges" in found.sentence


def test_a_load_that_lifts_bounds_a_half_plane():
    """x - y <= 1: weights upwards and downwards."""
    found = drystone.domain(FLAT, live=((0.0, 1.0), (0.0, -1.0)))
    np.testing.assert_allclose(found.edges, [(1.0, -1.0)], rtol=1e-9)
    assert "half-plane" in found.sentence
    assert "It is an upper bound" in found.sentence
    assert found.as_json()["bounds_above"] is True


def test_loads_that_are_multiples_to_rounding_bound_a_strip_too():
    """Along it they cancel but for the last digits, which are no load: one was borne up to 1e15 times."""
    way = np.array([29.434197616676265, -5.798966344310792])
    for share in (-0.3, 0.7):
        points = [
            {"block": "1", "at": [0.0, 0.3643701576766467], "force": force.tolist()} for force in (way, share * way)
        ]
        cases = {name: {"live": {"points": [point]}} for name, point in zip("ab", points, strict=True)}
        found = drystone.domain(drystone.build_wall(document(**cases), "block"))
        assert (found.reason, len(found.edges)) == ("", 2)
        np.testing.assert_allclose(found.edges[:, 1], share * found.edges[:, 0], rtol=1e-9)


def test_a_wall_that_bears_both_loads_either_way_has_no_boundary():
    """A block between fixed ones bears any load by friction, wedged by as much self-stress as that needs."""
    held = {"type": "panel", "cell_length": 1.0, "cell_height": 1.0, "layout": ["LMR", "LBR"], "fixed": "LBR"}
    wall = drystone.build_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "pattern": held}, "held")
    found = drystone.domain(wall, live=((1.0, -1.0), (1.0, 0.0)))
    assert found.as_json()["exact"]
    assert "bears every pair" in found.sentence
    assert "upper bound" not in found.sentence


def test_edges_that_do_not_fit_the_vertices_are_no_polygon():
    """Loads that differ by 1e-12 have a vertex at 1e12, where lines have no digits."""
    near = drystone.domain(FLAT, live=((1.0, 0.0), (1.0, 1e-12)))
    assert "make no whole polygon" in near.reason
    assert near.as_json()["exact"] is False


def arch_under_two_forces() -> Any:
    """A ring of many short edges: forces at its quarters, one of them inclined."""
    ring = {"type": "ring", "inner_radius": 1, "outer_radius": 1.2, "count": 25}
    forces = {"left": ("v7", [-0.8, 0.85], [0, -1]), "right": ("v19", [0.8, 0.85], [0.3, -1])}
    cases = {
        name: {"live": {"points": [{"block": block, "at": at, "force": way}]}}
        for name, (block, at, way) in forces.items()
    }
    made = {"format": "wall/1", "unit_weight": 20, "friction": 0.6, "pattern": ring, "load_cases": cases}
    return drystone.build_wall(made, "arch")


def test_a_coarse_polygon_is_whole_and_says_how_coarse_it_is():
    """Short edges are left out; the others are lines that the finer polygon has or touches, and meet at its corners."""
    wall, accuracy = arch_under_two_forces(), 1e-2
    fine, coarse = drystone.domain(wall), drystone.domain(wall, accuracy=accuracy)
    for found in (fine, coarse):
        assert found.reason == ""
        assert len(found.edges) == len(found.vertices) + len(found.unbounded) == len(found.points)
    assert len(coarse.edges) < len(fine.edges)
    assert coarse.runs < fine.runs
    assert (coarse.edges @ fine.vertices.T).max() <= 1.0 + 1e-7
    assert (fine.edges @ coarse.vertices.T).max() <= 1.0 + 1e-7
    at_corners = np.sort(coarse.edges @ coarse.vertices.T, axis=0)[-2:]
    assert at_corners.min() >= 1.0 - accuracy
    assert 0.0 < coarse.excess <= accuracy
    assert "inside the lines of its edges by up to" in coarse.sentence


def test_the_coarsest_accuracy_leaves_the_polygon_of_a_block_whole():
    found = drystone.domain(BLOCK, accuracy=0.9)
    assert found.reason == ""
    assert len(found.edges) == len(found.vertices) >= 3
    assert (found.edges @ CORNERS.T).max() <= 1.0 + 1e-9


def test_polygon_of_a_bonded_wall_is_what_single_directions_give():
    wall = drystone.new_wall("running-bond", length=1.5, height=0.8)
    blocks = [wall.assembly.block_ids[k] for k in wall.assembly.free]
    cases = {
        name: {"live": {"points": [{"block": block, "at": centre, "force": way}]}}
        for name, block, centre, way in (
            ("a", blocks[-1], wall.assembly.centroid[wall.assembly.free[-1]].tolist(), [1.0, 0.0]),
            ("b", blocks[0], wall.assembly.centroid[wall.assembly.free[0]].tolist(), [0.6, -0.8]),
        )
    }
    given = json.loads(wall.case.wall.model_dump_json(exclude_unset=True, by_alias=True))
    given.pop("loads", None)
    found = drystone.domain(drystone.build_wall({**given, "load_cases": cases}, "bond"))
    assert found.reason == ""
    assert len(found.edges) >= 4
    loads = [case["live"]["points"][0] for case in cases.values()]
    for angle in np.radians([17.0, 101.0, 203.0, 318.0]):
        x, y = np.cos(angle), np.sin(angle)
        points = [
            {**load, "force": (share * np.array(load["force"])).tolist()}
            for load, share in zip(loads, (x, y), strict=True)
        ]
        alone = drystone.build_wall({**given, "loads": {"live": {"points": points}}}, "alone")
        single = drystone.analyse(alone, "la-associated-cvxpy")
        reach = ray(found.edges, np.array([x, y]))
        if single.multiplier is None:
            assert reach > 100.0 or reach < 0.0
        else:
            assert reach == pytest.approx(single.multiplier, rel=1e-6)


def test_points_of_the_least_known_states_lie_on_the_closed_form():
    found = drystone.domain(BLOCK, "la", accuracy=0.05)
    assert not found.exact
    overturns = abs(found.vertices[:, 0]) * HEIGHT / (WEIGHT * WIDTH / 2.0)
    slides = abs(found.vertices.sum(axis=1)) / (FRICTION * WEIGHT)
    np.testing.assert_allclose(np.maximum(overturns, slides), 1.0, rtol=1e-7)
    assert "points of the boundary" in found.sentence


def test_points_leave_no_unbounded_cone_out_between_a_near_and_a_far_one():
    """|x - .4 y| <= .3 (1 + y - x / 4), open towards (1.4, 2) to (4, 37): a chord to a far point hid most of it."""
    found = drystone.domain(FLAT, "la", live=((1.0, 0.25), (-0.4, -1.0)), accuracy=0.05)
    assert found.reason == ""
    x, y = found.vertices.T
    np.testing.assert_allclose(abs(x - 0.4 * y), 0.3 * (1.0 + y - 0.25 * x), rtol=1e-6, atol=1e-9)
    angle = np.arctan2(found.unbounded[:, 1], found.unbounded[:, 0])
    ends = np.arctan2([1.075, 0.7], [0.7, 0.1])
    assert [angle.min(), angle.max()] == pytest.approx(sorted(ends), abs=0.05)


def test_points_near_the_limit_on_one_side_are_followed_on_the_others():
    """A column with a load that all but overturns it: |x| h <= (1 + y) b / 2 less what the load does."""
    made = document() | {"load_cases": {}}
    at_limit = {"points": [{"block": "1", "at": [WIDTH / 2.0, HEIGHT], "force": [1.599, 0.0]}]}
    cases = {"right": [1.0, 0.0], "down": [0.0, -1.0]}
    made["load_cases"] = {
        name: {"dead": at_limit, "live": {"body": [{"per_weight": way}]}} for name, way in cases.items()
    }
    found = drystone.domain(drystone.build_wall(made, "near"), "la", load_cases=("right", "down"), accuracy=0.05)
    assert found.reason == ""
    x, y = found.vertices.T
    push = WEIGHT * x + 1.599
    moment = WEIGHT * x * HEIGHT / 2.0 + 1.599 * HEIGHT
    used = np.maximum(abs(moment) / (WIDTH / 2.0), abs(push) / FRICTION) / (WEIGHT * (1.0 + y))
    np.testing.assert_allclose(used, 1.0, rtol=1e-6)
    assert (x < 0.0).sum() > 10


def test_a_direction_without_an_answer_leaves_the_others():
    """On a slope a load normal to the plane takes friction away and does no work on the slip: `la` knows no state."""
    slope = document() | {"load_cases": {}, "loads": {"gravity": [-math.sin(0.35), -math.cos(0.35)]}}
    slope["pattern"] = stack(1, 1.0, 0.2)
    found = drystone.domain(drystone.build_wall(slope, "slope"), "la", accuracy=0.05)
    assert "In the direction (0, -1) there is no accepted answer" in found.reason
    x, y = found.vertices.T
    used = abs(x - math.sin(0.35)) / (FRICTION * (math.cos(0.35) + y))
    np.testing.assert_allclose(used, 1.0, rtol=1e-6)
    assert len(found.vertices) > 10


def test_points_beside_unbounded_directions_reach_far_out():
    """A block glued between two fixed ones, drawn down by x W and pushed by y W / 2: W (1 + x) = 2 c A + mu |y| W / 2.

    Without glue it falls, which springs do not prove: that is no fault of the glued wall. Far points elsewhere ended
    the boundary at (0.5, 0).
    """
    found = drystone.domain(
        drystone.build_wall(wedge() | {"cohesion": 15.0}), "fe", live=((0, -1), (0.5, 0)), accuracy=0.05
    )
    assert found.reason == ""
    down = found.vertices[found.vertices[:, 0] > 0.0]
    np.testing.assert_allclose(down[:, 0], 0.5 + 0.25 * abs(down[:, 1]), rtol=1e-6)
    assert abs(down[:, 1]).max() > 20.0


def test_wall_that_falls_has_no_domain():
    made = document()
    made["load_cases"]["top"]["gravity"] = made["load_cases"]["foot"]["gravity"] = [1.0, -0.1]
    found = drystone.domain(drystone.build_wall(made, "falls"))
    assert len(found.vertices) == 0
    assert "falls under its dead load" in found.sentence


def test_runs_are_limited_and_the_sentence_says_so():
    found = drystone.domain(BLOCK, most=5)
    assert found.runs == 5
    assert "stopped after 5 runs" in found.sentence
    assert found.as_json()["exact"] is False


@pytest.mark.parametrize(
    ("cases", "asked", "said"),
    [
        ({}, {"load_cases": ("top", "top")}, "two different load cases"),
        ({}, {"load_cases": ("top", "fot")}, 'Did you mean "foot"'),
        ({}, {"live": ((1.0, 0.0),)}, "two different live loads"),
        ({}, {"load_cases": ("top", "foot"), "live": ((1.0, 0.0), (0.0, 1.0))}, "both given"),
        ({"top": force(2.0)}, {}, "1 load cases with a live load"),
        ({"top": force(2.0), "foot": {**force(0.0), "gravity": [0.1, -1.0]}}, {}, "dead loads"),
    ],
)
def test_loads_that_make_no_domain_are_refused(cases: dict[str, Any], asked: dict[str, Any], said: str):
    with pytest.raises(InputError, match=said):
        drystone.domain(drystone.build_wall(document(**cases), "block"), **asked)


def test_command_prints_draws_and_lists(tmp_path: Path):
    wall = tmp_path / "block.json"
    wall.write_text(json.dumps(document()))
    done = commands.drystone("domain", wall, "--json", "-o", tmp_path / "domain.csv")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["exact"] is True
    assert len(told["edges"]) == 4
    rows = (tmp_path / "domain.csv").read_text().splitlines()
    assert rows[0].startswith("direction_x")
    assert len(rows) == 5
    drawn = commands.drystone("domain", wall, "-o", tmp_path / "domain.svg")
    assert drawn.returncode == 0, drawn.stderr
    assert "1.6" in drawn.stdout
    assert "<svg" in (tmp_path / "domain.svg").read_text()
    assert commands.drystone("domain", wall, "--most", "4").returncode == 1
    assert commands.drystone("domain", wall, "--load-cases", "top").returncode == 2
