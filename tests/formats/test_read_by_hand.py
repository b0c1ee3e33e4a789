"""Drawings whose stones, names and accounts are known by hand, a few strokes each."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import shapely

from harness.formats.importing import Imported, import_drawing
from harness.model.build import build
from harness.model.errors import InputError
from tests.formats.drawings import boxes, csv, dxf, read, square, svg

COLUMN = ((-1.0, -1.0, 2.0, 0.0), (0.0, 0.0, 1.0, 1.0), (0.0, 1.0, 1.0, 2.0))


def sag_of(imported: Imported, radius: float) -> float:
    """Greatest distance of the chords of the one circle of a drawing, about the origin, from it."""
    (block,) = imported.wall.blocks
    ends = np.array(block.polygon)
    return float(radius - np.linalg.norm(0.5 * (ends + np.roll(ends, -1, axis=0)), axis=1).min())


@pytest.mark.parametrize(("unit", "metre"), [("m", 1.0), ("mm", 1000.0)])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_chords_of_a_circle_leave_the_sag_that_was_asked(
    accuracy: float, unit: str, metre: float, tmp_path: Path
) -> None:
    body = f'<circle cx="0" cy="0" r="{4.0 * metre}"/>'
    sag = sag_of(read(tmp_path / "c.svg", svg(body), units=unit, accuracy=accuracy), 4.0 * metre) / metre
    assert 0.5 * accuracy < sag < 1.05 * accuracy  # no more than asked; less only as the number is rounded up
    drawn = dxf(tmp_path / "c.dxf", lambda _, space: space.add_circle((0, 0), 4.0 * metre), units=unit,
                accuracy=accuracy)  # fmt: skip
    assert 0.2 * accuracy < sag_of(drawn, 4.0 * metre) / metre < 1.05 * accuracy  # quarters are halved until it is met


def test_curves_that_bend_unevenly_are_as_near_as_curves_that_do_not(tmp_path: Path) -> None:
    # A flat arc of a parabola, P0 (0, 0), P1 (9, 0), P2 (10, 10), closed by lines: y = f(x) is known.
    body = '<path d="M0 0 Q9 0 10 10 L0 10 z"/>'
    (block,) = read(tmp_path / "c.svg", svg(body), units="m", accuracy=0.01).wall.blocks
    curve = np.array([point for point in block.polygon if point[1] > -10.0 or point[0] < 10.0])
    t = np.linspace(0.0, 1.0, 4001)[:, None]
    exact = (2 * t * (1 - t)) * np.array([9.0, 0.0]) + t**2 * np.array([10.0, -10.0])
    line = np.array(block.polygon + block.polygon[:1])
    near = []
    for point in exact:  # the nearest of the chords
        a, b = line[:-1], line[1:]
        along = np.clip(((point - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0.0, 1.0)
        near.append(np.linalg.norm(a + along[:, None] * (b - a) - point, axis=1).min())
    assert 0.002 < max(near) <= 0.0105
    assert 10 < len(curve) < 60


LENGTHS = {"": 1.0, "px": 1.0, "in": 96.0, "cm": 96.0 / 2.54, "mm": 9.6 / 2.54, "pt": 96.0 / 72.0, "pc": 16.0}
"""User units of a length, as CSS has them: 96 to an inch, of 72 points and of 6 picas."""


@pytest.mark.parametrize("unit", LENGTHS)
def test_a_window_has_its_size_in_the_unit_that_is_written(unit: str, tmp_path: Path) -> None:
    body = f'<svg x="0" y="0" width="2{unit}" height="4{unit}" viewBox="0 0 1 2"><rect width="1" height="2"/></svg>'
    (box,) = boxes(read(tmp_path / "d.svg", svg(body), units="m"))
    assert box == pytest.approx((0.0, -4.0 * LENGTHS[unit], 2.0 * LENGTHS[unit], 0.0), abs=1e-5)


@pytest.mark.parametrize(
    ("fit", "box"),
    [
        ("xMinYMin", (0, -10, 10, 0)),
        ("xMinYMid meet", (0, -10, 10, 0)),
        ("xMidYMin", (15, -10, 25, 0)),
        ("xMaxYMax meet", (30, -10, 40, 0)),
        ("", (15, -10, 25, 0)),
        ("xMidYMin slice", (0, -40, 40, 0)),
        ("xMidYMid slice", (0, -25, 40, 15)),
        ("xMidYMax slice", (0, -10, 40, 30)),
        ("none", (0, -10, 40, 0)),
    ],
)  # fmt: skip
def test_a_picture_lies_in_its_window_as_it_says(fit: str, box: tuple[float, ...], tmp_path: Path) -> None:
    # A square of 2 in a window of 40 by 10: as large as fits, 10, with 30 to spare across, or as large as fills it, 40.
    how = f'preserveAspectRatio="{fit}"' if fit else ""
    body = f'<svg width="40" height="10" viewBox="0 0 2 2" {how}><rect width="2" height="2"/></svg>'
    assert boxes(read(tmp_path / "d.svg", svg(body), units="m")) == [pytest.approx(box)]


def test_only_the_first_of_a_switch_is_shown_and_cuts_are_told(tmp_path: Path) -> None:
    body = '<switch><rect width="1" height="1"/><g><rect x="1" width="1" height="1"/></g></switch>'
    imported = read(tmp_path / "d.svg", svg(body), units="m")
    assert boxes(imported) == [(0, -1, 1, 0)]
    assert not any("is not evaluated" in doubt for doubt in imported.wall.doubts)
    for cut in ('clip-path="url(#c)"', 'style="fill: red; clip-path : url(#c)"'):
        imported = read(tmp_path / "d.svg", svg(f'<rect width="1" height="1" {cut}/>'), units="m")
        assert any("a clip-path is not evaluated" in doubt for doubt in imported.wall.doubts)


def test_layers_of_inkscape_are_groups_and_an_unlabelled_group_lies_on_the_one_around_it(tmp_path: Path) -> None:
    label = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:label="stones"'
    body = f'<g id="layer7" {label}><g><rect width="1" height="1"/></g></g>'
    body += '<g id="plain"><rect x="1" width="1" height="1"/></g>'
    blocks = read(tmp_path / "d.svg", svg(body), units="m").wall.blocks
    assert [block.groups for block in blocks] == [["stones"], ["plain"]]


def test_rules_of_a_medium_are_told_and_rules_behind_them_followed(tmp_path: Path) -> None:
    style = "<style>@media print {.a {display: none}} .b {display: none} .c {fill: red}</style>"
    body = style + "".join(f'<rect class="{k}" x="{n}" width="1" height="1"/>' for n, k in enumerate("abc"))
    imported = read(tmp_path / "d.svg", svg(body), units="m")
    assert boxes(imported) == [(0, -1, 1, 0), (2, -1, 3, 0)]
    assert [doubt for doubt in imported.wall.doubts if "is ignored" in doubt] == [
        'the style of "@media print" is ignored: it may hide or show shapes'
    ]


def test_rings_within_rings_are_holes_and_stones_by_turns(tmp_path: Path) -> None:
    def ring(half: float) -> str:
        return f"M{50 - half} {50 - half} h{2 * half} v{2 * half} h{-2 * half} z"

    halves = (16.0, 8.0, 4.0, 2.0)
    path = f'<path d="{" ".join(ring(half) for half in halves)}"/>'
    blocks = read(tmp_path / "d.svg", svg(path), units="m").wall.blocks
    areas = [shapely.Polygon(block.polygon, block.holes).area for block in blocks]
    assert sorted(areas) == pytest.approx([8.0**2 - 4.0**2, 32.0**2 - 16.0**2])


HOLES: dict[str, tuple[list[tuple[float, float]], bool]] = {
    "within": ([(1, 1), (2, 1), (2, 2), (1, 2)], True),
    "beside": ([(7, 1), (8, 1), (8, 2), (7, 2)], False),
    "across": ([(3, 1), (7, 1), (7, 2), (3, 2)], False),
    "a line": ([(1, 1), (2, 1)], False),
}


@pytest.mark.parametrize("name", HOLES)
def test_a_hole_is_kept_where_it_is_a_polygon_within_its_stone_and_told_where_it_is_not(
    name: str, tmp_path: Path
) -> None:
    hole, kept = HOLES[name]
    outer = [(0, 0), (4, 0), (4, 4), (0, 4)]
    rows = ["block,ring,x,y", *(f"a,{k},{x},{y}" for k, ring in enumerate((outer, hole)) for x, y in ring)]
    imported = read(tmp_path / "d.csv", "\n".join(rows), units="m")
    assert [len(block.holes) for block in imported.wall.blocks] == [int(kept)]
    told = [line for line in imported.account if line.startswith("left out 1 ")]
    reason = "left out 1 x hole of polygon: it is no polygon within the outline, and is filled"
    assert told == ([] if kept else [reason])


def test_the_account_counts_every_outline_and_every_thing_left_out(tmp_path: Path) -> None:
    def draw(_: Any, space: Any) -> None:
        square(space, 0, 0, layer="S")
        square(space, 0, 1, layer="S")
        space.add_lwpolyline([(5, 5), (7, 7), (7, 5), (5, 6)], close=True, dxfattribs={"layer": "S"})
        space.add_lwpolyline([(3, 3)], dxfattribs={"layer": "S"})
        space.add_text("a", dxfattribs={"layer": "S"})

    told = dxf(tmp_path / "d.dxf", draw, units="m").account
    assert told[0] == 'read 2 x LWPOLYLINE on layer "S"'
    left = [line for line in told if line.startswith("left out 1 x ")]
    assert len(left) == 3
    assert any("it crosses itself near" in line for line in left)
    assert any('LWPOLYLINE on layer "S": it is a point' in line for line in left)
    assert any('TEXT on layer "S": no outline' in line for line in left)
    spike = [(0, 0), (4, 0), (4, 4), (0, 4), (0.02, 4.02), (-0.01, 3.9)]  # its tip lies over the upper edge
    rows = ["block,x,y", *(f"a,{x},{y}" for x, y in spike)]
    told = read(tmp_path / "d.csv", "\n".join(rows), units="m").account
    assert told[0] == "read 1 x polygon"
    assert any(line.startswith("polygon mended: it crosses itself by a spike near") for line in told)
    text = json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": None, "properties": None},
        {"type": "Feature", "id": "s", "geometry": _square(0.0), "properties": None},
        {"type": "Feature", "geometry": _square(1.0), "properties": {"name": "t", "layer": "L", "fixed": True}},
        {"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 0]}, "properties": {}}]})  # fmt: skip
    imported = read(tmp_path / "d.geojson", text, units="m")
    left = [line for line in imported.account if line.startswith("left out")]
    assert left[:2] == ["left out 1 x feature without a geometry", "left out 1 x Point: no area"]
    s, t = imported.wall.blocks
    assert (s.id, s.groups, s.fixed) == ("s", [], False)
    assert (t.id, t.groups, t.fixed) == ("t", ["L"], True)


def _square(low: float) -> dict[str, Any]:
    ring = [[0, low], [1, low], [1, low + 1], [0, low + 1], [0, low]]
    return {"type": "Polygon", "coordinates": [ring]}


@pytest.mark.parametrize("away", [0.0, 10.0])
def test_a_line_that_ends_where_it_began_is_closed_and_one_that_does_not_is_open(away: float, tmp_path: Path) -> None:
    ring = [(away, away), (away + 1, away), (away + 1, away + 1), (away, away + 1)]

    def draw(end: tuple[float, float]) -> Callable[[Any, Any], None]:
        def made(_: Any, space: Any) -> None:
            square(space, away, away - 1)
            space.add_lwpolyline([*ring, end])

        return made

    assert len(dxf(tmp_path / "d.dxf", draw(ring[0]), units="m").wall.blocks) == 2
    near = (away, away + 0.4)
    assert len(dxf(tmp_path / "d.dxf", draw(near), units="m").wall.blocks) == 1
    for end, count in ((ring[0], 2), (near, 1)):
        path = "M" + " L".join(f"{x} {y}" for x, y in [*ring, end])
        stone = f'<rect x="{away}" y="{away - 1}" width="1" height="1"/>'
        imported = read(tmp_path / "d.svg", svg(stone + f'<path d="{path}"/>'), units="m")
        assert len(imported.wall.blocks) == count
        assert [line for line in imported.account if line.startswith("read ")][count - 1 :] == [
            "read 1 x Path" if count == 2 else "read 1 x Rect"
        ]


def boxed(x: float, z: float, size: tuple[float, float, float], **said: Any) -> dict[str, Any]:
    """A box of COMPAS about a point of the plane y = 5."""
    frame = {"point": [x, 5.0, z], "xaxis": [1.0, 0.0, 0.0], "yaxis": [0.0, 1.0, 0.0]}
    data = {"frame": frame} | dict(zip(("xsize", "ysize", "zsize"), size, strict=True))
    return {"dtype": "compas.geometry/Box", "data": data} | said


def test_boxes_of_compas_have_their_sizes_about_their_middles(tmp_path: Path) -> None:
    solids = [boxed(0.0, -0.5, (4.0, 2.0, 1.0), name="g", is_support=True), boxed(0.5, 1.0, (1.0, 6.0, 2.0), name="s")]
    imported = read(tmp_path / "d.json", json.dumps(solids), units="m")
    assert boxes(imported) == [(-2, -1, 2, 0), (0, 0, 1, 2)]
    assert [(block.id, block.fixed) for block in imported.wall.blocks] == [("g", True), ("s", False)]


@pytest.mark.parametrize(("at", "width"), [(None, 2.0), (4.5, 3.0), (5.5, 1.0)])
def test_a_solid_is_cut_where_the_plane_lies(at: float | None, width: float, tmp_path: Path) -> None:
    # A wedge between y = 4 and y = 6, at which its width is 4 and 0; its height is 1.
    corners = [(-2, 4, 0), (2, 4, 0), (0, 6, 0), (-2, 4, 1), (2, 4, 1), (0, 6, 1)]
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]
    data = {
        "vertex": {str(k): dict(zip("xyz", map(float, corner), strict=True)) for k, corner in enumerate(corners)},
        "face": {str(k): face for k, face in enumerate(faces)},
        "attributes": {"name": "wedge", "is_support": True},
    }
    text = json.dumps([{"dtype": "compas.datastructures/Mesh", "data": data}])
    imported = read(tmp_path / "d.json", text, units="m", at=at)
    assert boxes(imported) == [(-0.5 * width, 0.0, 0.5 * width, 1.0)]
    (block,) = imported.wall.blocks
    assert (block.id, block.fixed) == ("wedge", True)


def test_physical_groups_of_gmsh_are_layers(tmp_path: Path) -> None:
    points = np.array([(x, y, 0.0) for y in range(3) for x in range(2)], float)
    tags = [np.array([1, 2])]
    mesh = meshio.Mesh(
        points,
        [("quad", np.array([[0, 1, 3, 2], [2, 3, 5, 4]]))],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"ground": np.array([1, 2]), "wall": np.array([2, 2]), "edge": np.array([2, 1])},
    )
    meshio.write(tmp_path / "w.msh", mesh, file_format="gmsh22", binary=False)
    blocks = import_drawing(tmp_path / "w.msh").wall.blocks
    assert [block.groups for block in blocks] == [["ground"], ["wall"]]


def test_stones_whose_middle_lies_below_the_ground_line_are_supports(tmp_path: Path) -> None:
    raised = [(a, b + 10.0, c, d + 10.0) for a, b, c, d in COLUMN]  # middles at 9.5, 10.5 and 11.5
    for level, held in ((9.6, 1), (10.6, 2), (12.0, 3)):
        imported = read(tmp_path / "d.csv", csv(*raised), units="m", supports=f"ground-line {level}")
        assert sum(block.fixed for block in imported.wall.blocks) == held


def test_a_layer_gives_its_stones_a_weight(tmp_path: Path) -> None:
    def draw(_: Any, space: Any) -> None:
        for k, layer in enumerate(("LIGHT", "HEAVY")):
            square(space, 0, k, layer=layer)

    said = {"units": "m", "thickness": 1.0, "unit_weight": 20.0, "layers": {"HEAVY": {"unit_weight": 27.0}}}
    assembly = build(dxf(tmp_path / "d.dxf", draw, **said).wall).assembly
    assert assembly.weight.tolist() == [20.0, 27.0]


@pytest.mark.parametrize(("step", "taken"), [(0.01, 0.015), (0.001, 0.0015), (0.0001, 0.00015)])
def test_the_tolerance_of_rounded_coordinates_is_one_and_a_half_steps(
    step: float, taken: float, tmp_path: Path
) -> None:
    draw = np.random.default_rng(7).integers(1, 9, 12)  # one digit of each coordinate at the last place
    stones = [
        (0.0, 0.9 * k + step * int(draw[k]), 0.9 + step * int(draw[k + 4]), 0.9 * k + 0.88 + step * int(draw[k + 8]))
        for k in range(4)
    ]
    stones = [tuple(round(value, 6) for value in stone) for stone in stones]
    imported = read(tmp_path / "d.csv", csv(*stones), units="m")  # type: ignore[arg-type]
    assert imported.wall.interfaces.tolerance == pytest.approx(taken)  # type: ignore[union-attr]
    assert f"because the coordinates are rounded to {step:g}" in " ".join(imported.account)


@pytest.mark.parametrize("shift", [(12.5, 42.0), (12.5, 89.9)])
def test_small_walls_far_from_the_origin_are_degrees_only_where_a_latitude_can_be(
    shift: tuple[float, float], tmp_path: Path
) -> None:
    def far(x: float, y: float) -> str:
        return csv(*((x + 1e-5 * a, y + 1e-5 * b, x + 1e-5 * c, y + 1e-5 * d) for a, b, c, d in COLUMN))

    with pytest.raises(Exception, match="look like degrees"):
        read(tmp_path / "d.csv", far(*shift))
    assert len(read(tmp_path / "d.csv", far(shift[0], 95.0)).wall.blocks) == 3


def triangle(**members: Any) -> str:
    """GeoJSON of one triangle on the ground, with other members."""
    ring = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]
    return json.dumps({"type": "Polygon", "coordinates": [ring]} | members)


@pytest.mark.parametrize("wrong", ["0", True, None, {}, "", [True, 0.0], [0.0, "1"]])
def test_coordinates_of_geojson_that_are_no_numbers_are_refused(wrong: Any, tmp_path: Path) -> None:
    path = tmp_path / "t.geojson"
    position = wrong if isinstance(wrong, list) else [0.0, wrong]
    for geometry in (
        {"coordinates": [[[0.0, 0.0], [1.0, 0.0], position, [0.0, 0.0]]]},
        {"type": "GeometryCollection", "geometries": [json.loads(triangle(coordinates=[[[0, 0], [1, 0], position]]))]},
    ):
        path.write_text(triangle(**geometry))
        with pytest.raises(InputError, match="coordinates hold"):
            import_drawing(path)
    path.write_text(triangle())
    assert len(import_drawing(path).wall.blocks) == 1


@pytest.mark.parametrize(
    "crs",
    ["EPSG:25832", 25832, True, [], {}, {"type": "name"}, {"properties": "EPSG:25832"}, {"properties": {"name": 3}},
     {"properties": {"name": " "}}, {"type": "link", "properties": {"href": "http://example.org/crs"}}],
)  # fmt: skip
def test_a_crs_of_geojson_that_names_no_system_is_refused(crs: Any, tmp_path: Path) -> None:
    path = tmp_path / "t.geojson"
    path.write_text(triangle(crs=crs))
    with pytest.raises(InputError, match="names no system"):
        import_drawing(path)
    path.write_text(triangle(crs=None))  # GeoJSON 1.0: null is a system that is not known
    assert len(import_drawing(path).wall.blocks) == 1
