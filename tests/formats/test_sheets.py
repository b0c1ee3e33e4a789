"""Where a drawing lies: scale, unit, gravity, plane, system of coordinates, and the frame of its sheet."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from harness.formats.importing import Mapping, import_drawing
from harness.model.build import build
from harness.model.errors import InputError
from tests.commands import drystone
from tests.formats.drawings import DATA, Box, boxes, csv, dxf, read, square

COLUMN = ((-1.0, -1.0, 2.0, 0.0), (0.0, 0.0, 1.0, 1.0), (0.0, 1.0, 1.0, 2.0))


def turned(stones: tuple[Box, ...], quarter: int, *, mirrored: bool = False) -> list[Box]:
    """The stones mirrored in y, if asked for, and turned anticlockwise by quarters of a circle."""
    made = []
    for left, low, right, high in stones:
        points = np.array([[left, low], [right, high]]) * (1.0, -1.0 if mirrored else 1.0)
        for _ in range(quarter):
            points = np.stack([-points[:, 1], points[:, 0]], axis=1)
        made.append((*points.min(axis=0).tolist(), *points.max(axis=0).tolist()))
    return made  # type: ignore[return-value]


DIRECTIONS = {0: (0.0, -1.0), 1: (1.0, 0.0), 2: (0.0, 1.0), 3: (-1.0, 0.0)}
"""Gravity of a drawing turned by so many quarters."""


@pytest.mark.parametrize("quarter", DIRECTIONS)
def test_lowest_course_and_ground_line_look_along_gravity(quarter: int, tmp_path: Path) -> None:
    stones = turned(COLUMN, quarter)
    gravity = DIRECTIONS[quarter]
    level = -0.3 if quarter in (0, 3) else 0.3  # the coordinate along gravity of a line within the ground stone
    for supports in (None, f"ground-line {level}"):
        imported = read(tmp_path / "d.csv", csv(*stones), gravity=gravity, supports=supports)
        assert [block.fixed for block in imported.wall.blocks] == [True, False, False]
        assembly = build(imported.wall).assembly
        live, dead = assembly.live[1, :2], assembly.dead[1, :2]
        assert float(live @ dead) == pytest.approx(0.0, abs=1e-12)  # rounding of products with one
        assert np.linalg.norm(live) == pytest.approx(np.linalg.norm(dead))
        assert set(assembly.joint) == {"bed"}


def test_pixels_have_the_ground_at_the_greater_y_and_their_load_to_the_right(tmp_path: Path) -> None:
    stones = turned(COLUMN, 0, mirrored=True)
    imported = read(tmp_path / "d.csv", csv(*stones), gravity=(0.0, 1.0), supports="ground-line 0.3")
    assert [block.fixed for block in imported.wall.blocks] == [True, False, False]
    assert build(imported.wall).assembly.live[1, 0] > 0.0


def test_rules_of_friction_for_beds_and_heads_turn_with_gravity(tmp_path: Path) -> None:
    rules = [{"joint": "bed", "value": 0.7}, {"joint": "head", "value": 0.2}]
    imported = read(tmp_path / "d.csv", csv(*turned(COLUMN, 1)), gravity=(1.0, 0.0), rules=rules)
    assert build(imported.wall).assembly.friction.tolist() == [0.7, 0.7]


def test_a_gravity_without_direction_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="gravity: it has no direction"):
        read(tmp_path / "d.csv", csv(*COLUMN), gravity=(0.0, 0.0))


@pytest.mark.parametrize("scale", [50, "1:50", "2:100", "50"])
def test_a_scale_multiplies_every_length(scale: Any, tmp_path: Path) -> None:
    imported = read(tmp_path / "d.csv", csv(*COLUMN), scale=scale, units="mm", tolerance=2.0, thickness=300.0)
    assert boxes(imported) == [tuple(50.0 * value for value in box) for box in sorted(COLUMN)]
    assert (imported.wall.thickness, imported.wall.interfaces.tolerance) == (300.0, 2.0)  # type: ignore[union-attr]
    assert "at a scale of 50" in " ".join(imported.account)


def test_a_scale_is_an_option_and_curves_keep_their_accuracy_on_the_wall(tmp_path: Path) -> None:
    (tmp_path / "d.csv").write_text(csv(*COLUMN))
    done = drystone("import", "d.csv", "--scale", "1:20", "-o", "wall.json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "wall.json").read_text())["blocks"][1]["polygon"][2] == [20.0, 20.0]
    assert drystone("import", "d.csv", "--scale", "1:x", cwd=tmp_path).returncode == 2

    def draw(_: Any, space: Any) -> None:
        space.add_circle((0, 0), 1.0)

    for factor in (1.0, 100.0):
        polygon = dxf(tmp_path / "c.dxf", draw, units="m", scale=factor).wall.blocks[0].polygon
        ends = np.array(polygon)
        middles = 0.5 * (ends + np.roll(ends, -1, axis=0))
        sag = factor - np.linalg.norm(middles, axis=1).min()
        assert 0.0 < sag <= 0.0011  # one millimetre, and rounding of the number of chords


GEOGRAPHIC = ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4258", "CRS84",
              "http://www.opengis.net/def/crs/EPSG/0/4326"]  # fmt: skip
PROJECTED = ["EPSG:25832", "urn:ogc:def:crs:EPSG::3857", "urn:ogc:def:crs:EPSG:9.6:2154", "EPSG:32633"]


def geojson(stones: Any, name: str = "") -> str:
    features = [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [
            [[left, low], [right, low], [right, high], [left, high], [left, low]]]}}
        for left, low, right, high in stones
    ]  # fmt: skip
    crs = {"crs": {"type": "name", "properties": {"name": name}}} if name else {}
    return json.dumps({"type": "FeatureCollection", "features": features} | crs)


@pytest.mark.parametrize("name", GEOGRAPHIC)
def test_geographic_systems_of_coordinates_are_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"its coordinates are degrees.*Project it"):
        read(tmp_path / "d.geojson", geojson(COLUMN, name))


@pytest.mark.parametrize("name", PROJECTED)
def test_projected_systems_of_coordinates_are_in_metres_and_told(name: str, tmp_path: Path) -> None:
    far = [tuple(value + offset for value, offset in zip(box, (5e5, 5e6) * 2, strict=True)) for box in COLUMN]
    imported = read(tmp_path / "d.geojson", geojson(far, name))
    assert imported.wall.units.length == "m"
    assert any(name in doubt for doubt in imported.wall.doubts)
    assert not any("declares no unit" in doubt for doubt in imported.wall.doubts)


@pytest.mark.parametrize("suffix", [".csv", ".geojson"])
def test_coordinates_that_look_like_degrees_are_refused_and_lengths_are_not(suffix: str, tmp_path: Path) -> None:
    make = csv if suffix == ".csv" else lambda *stones: geojson(stones)
    degrees = [(12.5 + 1e-5 * a, 42.0 + 1e-5 * b, 12.5 + 1e-5 * c, 42.0 + 1e-5 * d) for a, b, c, d in COLUMN]
    path = tmp_path / f"d{suffix}"
    with pytest.raises(InputError, match=r"look like degrees.*--units"):
        read(path, make(*degrees))
    assert read(path, make(*degrees), units="km").wall.units.length == "km"
    near = [tuple(12.5 + value for value in box) for box in COLUMN]
    assert len(read(path, make(*near)).wall.blocks) == 3
    small = [tuple(0.005 * value for value in box) for box in COLUMN]
    assert len(read(path, make(*small)).wall.blocks) == 3


def framed(*frames: Box) -> str:
    wall = [(10.0 + x, 10.0 + y, 11.0 + x, 11.0 + y) for x in range(3) for y in range(3)]
    return csv(*frames, *wall, (40.0, 1.0, 49.0, 5.0))


@pytest.mark.parametrize("frames", [((0.0, 0.0, 50.0, 30.0),), ((0.0, 0.0, 50.0, 30.0), (0.5, 0.5, 49.5, 29.5))])
def test_the_frame_of_a_sheet_is_refused_in_one_sentence(frames: tuple[Box, ...], tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path / "d.csv", framed(*frames))
    assert f"{len(frames)} outline(s) enclose all 10 others, the outer from (0, 0) on 50 wide" in str(caught.value)
    assert "Erase it" in str(caught.value)
    assert len(caught.value.faults) == 1


def test_a_frame_on_a_layer_of_its_own_is_ignored_as_the_sentence_says(tmp_path: Path) -> None:
    def draw(_: Any, space: Any) -> None:
        square(space, -1, -1, 9, layer="SHEET")
        for k in range(3):
            square(space, 0, k, layer="WALL")

    with pytest.raises(InputError, match=r'\[layers."SHEET"\] use = "ignore"'):
        dxf(tmp_path / "d.dxf", draw)
    assert len(dxf(tmp_path / "d.dxf", draw, layers={"SHEET": {"use": "ignore"}}).wall.blocks) == 3


def test_a_stone_with_an_outline_within_it_is_no_frame(tmp_path: Path) -> None:
    assert len(read(tmp_path / "d.csv", csv((0.0, 0.0, 9.0, 9.0), (1.0, 1.0, 2.0, 2.0))).wall.blocks) == 2


@pytest.mark.parametrize("plane", ["xz", "yz"])
def test_polylines_in_a_standing_plane_are_read_there_and_else_refused(plane: str, tmp_path: Path) -> None:
    def draw(_: Any, space: Any) -> None:
        for low in (0.0, 1.0):
            ring = [(0.0, low), (1.0, low), (1.0, low + 1.0), (0.0, low + 1.0)]
            points = [(u, 5.0, v) if plane == "xz" else (5.0, u, v) for u, v in ring]
            space.add_polyline3d(points, close=True)

    with pytest.raises(InputError, match=rf"lies in another plane.*--plane {plane}"):
        dxf(tmp_path / "d.dxf", draw)
    assert boxes(dxf(tmp_path / "d.dxf", draw, plane=plane)) == [(0, 0, 1, 1), (0, 1, 1, 2)]


def test_compas_meshes_in_a_dictionary_are_read() -> None:
    imported = import_drawing(DATA / "cj-blocks-min.json")
    assert boxes(imported) == [(-1, -0.5, 2, 0), (0, 0, 0.5, 1)]


def test_an_elevation_in_space_has_the_multiplier_of_the_wall(tmp_path: Path) -> None:
    done = drystone("import", DATA / "xz-poly3d.dxf", "--plane", "xz", "-o", "wall.json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    run = drystone("run", "la-associated", "wall.json", "--json", cwd=tmp_path)
    assert json.loads(run.stdout)["multiplier"] == pytest.approx(0.3, abs=1e-9)  # accuracy of the programme


def test_joints_that_the_finder_makes_have_a_length() -> None:
    with pytest.raises(InputError) as caught:
        build(import_drawing(DATA / "zero-joint-min.geojson", Mapping(tolerance=0.04)).wall)
    assert "from" not in str(caught.value)
    assert "Allow less than 0.00404" in str(caught.value)


def loose(gaps: list[float]) -> str:
    """A column of squares with gaps between them."""
    stones, low = [(-1.0, -1.0, 2.0, 0.0)], 0.0
    for gap in gaps:
        stones.append((0.0, low + gap, 1.0, low + gap + 1.0))
        low += gap + 1.0
    return csv(*stones)


def test_near_misses_are_one_sentence_with_one_tolerance_that_joins_them(tmp_path: Path) -> None:
    gaps = [0.0101, 0.0123, 0.0087, 0.0111, 0.0093, 0.0107]
    (tmp_path / "d.csv").write_text(loose(gaps))
    said = drystone("import", "d.csv", "-o", "wall.json", cwd=tmp_path)
    assert said.returncode == 2
    (sentence,) = [line for line in said.stderr.splitlines() if "have no joint" in line]
    assert "which joins all of them" in sentence
    tolerance = float(sentence.partition('"tolerance": ')[2].partition("}")[0])
    # The widest range is from the widest gap to what swallows a stone or is not tried any more, a tenth of its size.
    assert 0.0123 < tolerance < 0.1
    assert tolerance == pytest.approx(np.sqrt(0.0123 * 0.1), rel=0.2)  # tolerances tried differ by a third
    told = json.loads(drystone("validate", "d.csv", "--json", cwd=tmp_path).stdout)
    assert told["suggested_tolerance"] == pytest.approx(tolerance, rel=0.01)  # three digits are printed
    mended = drystone("import", "d.csv", "--tolerance", str(tolerance), "-o", "wall.json", cwd=tmp_path)
    assert mended.returncode == 0, mended.stderr
    assert "have no joint" not in mended.stderr
