"""Fill above a wall: its weight on the faces that look up, exact on flat, inclined and arched tops; what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

import drystone
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.load_cases import named_loads
from harness.model.load_fields import Load
from harness.model.loads import times, together
from harness.model.reading import parse_wall
from tests.walls import built_load_case

GROUND = {"id": "ground", "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]], "fixed": True}
PUSH = {"body": [{"per_weight": [1, 0]}]}
SOIL = {"level": 1.5, "unit_weight": 18.0}


def filled(top: list[list[float]], *fills: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A block of which the top runs along these points, from right to left, with fill above it."""
    block = {"id": "block", "polygon": [[0, 0], [1, 0], *top]}
    loads = {"dead": {"fills": list(fills)}, "live": PUSH}
    return {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [GROUND, block], "loads": loads} | more


def weight_of_fill(data: dict[str, Any]) -> np.ndarray:
    """(n, 3) what the fill adds to the dead load."""
    return build(parse_wall(data | {"loads": data["loads"] | {"gravity": False}}, "")).assembly.dead


FLAT = [[1.0, 0.5], [0.0, 0.5]]


def test_fill_on_a_flat_face_presses_with_its_weight_and_the_block_slides_later():
    """W = 10, fill of 1 x 1 m: F = 18 at the middle; lambda = mu (W + F) / W."""
    np.testing.assert_allclose(weight_of_fill(filled(FLAT, SOIL))[1], [0.0, -18.0, 0.0], atol=1e-13)
    result = drystone.analyse(drystone.build_wall(filled(FLAT, SOIL)), "la-associated")
    assert result.judge.accepted
    assert result.multiplier == pytest.approx(0.5 * 28.0 / 10.0, rel=1e-9)


def test_fill_on_an_inclined_face_presses_with_a_trapezoid():
    """Depths .5 and 1 m at x = 1 and 0: F = .75 gamma, at x = (1/3)(.5 x 2 + 1)/(.5 + 1) = 4/9 from the deep side."""
    data = filled([[1.0, 1.0], [0.0, 0.5]], SOIL)
    centre = build(parse_wall(data, "")).assembly.centroid[1, 0]
    force = 0.75 * 18.0
    np.testing.assert_allclose(weight_of_fill(data)[1], [0.0, -force, -force * (4 / 9 - centre)], rtol=1e-13)


def test_a_level_that_meets_the_face_loads_the_part_below_it():
    """A triangle of depth .25 m over half a metre from x = 0."""
    data = filled([[1.0, 1.0], [0.0, 0.5]], SOIL | {"level": 0.75})
    centre = build(parse_wall(data, "")).assembly.centroid[1, 0]
    force = 18.0 * 0.25 * 0.5 / 2
    np.testing.assert_allclose(weight_of_fill(data)[1], [0.0, -force, -force * (0.5 / 3 - centre)], rtol=1e-13)


def test_fill_counts_thickness_units_factor_and_the_range_it_lies_in():
    np.testing.assert_allclose(weight_of_fill(filled(FLAT, SOIL, thickness=0.3))[1, 1], -18.0 * 0.3, rtol=1e-13)
    kilograms = {"units": {"unit_weight": "kg/m3"}, "unit_weight": 2000}
    by_mass = filled(FLAT, SOIL | {"unit_weight": 1800}, **kilograms)
    np.testing.assert_allclose(weight_of_fill(by_mass)[1, 1], -1.8 * 9.80665, rtol=1e-12)
    part = weight_of_fill(filled(FLAT, SOIL | {"between": [0.75, 2.0], "factor": 2.0}))[1]
    np.testing.assert_allclose(part, [0.0, -9.0, -9.0 * 0.375], rtol=1e-13)
    halves = filled(FLAT, SOIL | {"between": [-1, 0.3]}, SOIL | {"between": [0.3, 1]})
    np.testing.assert_allclose(weight_of_fill(halves), weight_of_fill(filled(FLAT, SOIL)), atol=1e-13)


def test_only_the_highest_face_is_loaded_and_a_block_that_is_not_named_bears_what_is_above_it():
    """A smaller block on the first: it bears the fill above itself, and the first what is beside it."""
    cap = {"id": "cap", "polygon": [[0.25, 0.5], [0.75, 0.5], [0.75, 1.0], [0.25, 1.0]]}
    data = filled(FLAT, SOIL)
    data["blocks"] = [*data["blocks"], cap]
    loads = weight_of_fill(data)
    np.testing.assert_allclose(loads[1:, 1], [-18.0 * 0.5, -18.0 * 0.25], rtol=1e-13)
    named = filled(FLAT, SOIL | {"blocks": ["block"]}) | {"blocks": data["blocks"]}
    np.testing.assert_allclose(weight_of_fill(named)[1:, 1], [-18.0 * 0.5, 0.0], rtol=1e-13)


def arch(level: float, **loads: Any) -> dict[str, Any]:
    ring = {"type": "ring", "inner_radius": 0.9, "outer_radius": 1.1, "count": 20}
    dead = loads or {"fills": [{"level": level, "unit_weight": 16.0}]}
    live = {"live": {"body": [{"per_weight": [1, 0]}]}}
    return {"format": "wall/1", "unit_weight": 20, "friction": 0.8, "pattern": ring, "loads": {"dead": dead} | live}


def columns(level: float) -> tuple[list[dict[str, Any]], float]:
    """The weights of the polygons between each extrados face and the level, as point forces; and that of all fill."""
    wall = build(parse_wall(arch(level, body=[]), "")).assembly
    free = [wall.polygons[k] for k in wall.free]
    points = []
    for k, voussoir in zip(wall.free, free, strict=True):
        left, right = _extrados(voussoir)
        column = shapely.Polygon([left, right, (right[0], level), (left[0], level)])
        at = [column.centroid.x, float(voussoir[:, 1].min())]
        points.append({"block": wall.block_ids[k], "at": at, "force": [0, -16.0 * column.area]})
    below = shapely.union_all([shapely.Polygon(voussoir) for voussoir in free]).convex_hull
    x0, y0, x1, _ = below.bounds
    return points, 16.0 * (shapely.box(x0, y0, x1, level).area - below.area)


def _extrados(polygon: np.ndarray) -> list[tuple[float, float]]:
    """The two vertices of a voussoir that are furthest from the centre, from left to right."""
    outer = sorted(polygon.tolist(), key=lambda p: -np.hypot(*p))[:2]
    return sorted((float(x), float(y)) for x, y in outer)


def test_fill_above_an_arch_weighs_as_the_polygons_above_its_voussoirs():
    """Each polygon between extrados and level weighs at its centroid; all together at the area above the ring."""
    level = 1.4
    points, total = columns(level)
    by_fill = build(parse_wall(arch(level), "")).assembly
    by_points = build(parse_wall(arch(level, points=points), "")).assembly
    np.testing.assert_allclose(by_fill.dead, by_points.dead, atol=1e-12 * total)
    assert (by_fill.dead[:, 1] + by_fill.weight)[by_fill.free].sum() == pytest.approx(-total, rel=1e-12)
    multipliers = [
        drystone.analyse(drystone.build_wall(data), "la-associated").multiplier
        for data in (arch(level), arch(level, points=points), arch(level, body=[]))
    ]
    assert multipliers[0] == pytest.approx(multipliers[1], rel=1e-9)
    assert multipliers[0] != pytest.approx(multipliers[2], rel=1e-2)


def test_fill_belongs_to_load_cases_combinations_and_sums():
    data = filled(FLAT, SOIL) | {
        "loads": {"dead": {"fills": [SOIL]}},
        "load_cases": {"push": {"live": PUSH}, "more": {"dead": {"fills": [SOIL]}, "live": PUSH}},
        "combinations": {"design": {"dead": 1.35, "push": 1.5}},
    }
    wall = parse_wall(data, "")
    cases = named_loads(wall)
    dead = {name: built_load_case(wall, name).assembly.dead[1, 1] for name in cases}
    assert dead["push"] == pytest.approx(-10.0 - 18.0)
    assert dead["more"] == pytest.approx(-10.0 - 36.0)
    assert dead["design"] == pytest.approx(-1.35 * 28.0)
    load = Load.model_validate({"fills": [SOIL]})
    assert [fill.factor for fill in together(load, times(load, -0.5)).fills] == [1.0, -0.5]


@pytest.mark.parametrize(
    ("fill", "words"),
    [
        (SOIL | {"level": 0.5}, "no face of a free block that it may load looks up below its level 0.5"),
        (SOIL | {"between": [2, 3]}, "no face of a free block"),
        (SOIL | {"blocks": []}, "blocks: it has 0 entries"),
        (SOIL | {"between": [1, 0]}, "the first is the smaller"),
        (SOIL | {"blocks": ["block"], "group": "x"}, "either blocks or group"),
        (SOIL | {"blocks": ["ground"]}, 'block "ground" is fixed'),
        (SOIL | {"blocks": ["nobody"]}, 'no block is called "nobody"'),
        (SOIL | {"group": "nobody"}, 'no block is in a group "nobody"'),
        (SOIL | {"kp": 3}, "soil and water that resist"),
        ({"level": 1.0}, "unit_weight"),
    ],
)
def test_a_fill_that_loads_nothing_or_asks_for_more_is_refused(fill: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        build(parse_wall(filled(FLAT, fill), ""))
