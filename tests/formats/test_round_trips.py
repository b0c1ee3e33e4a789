"""What is written is read again, by the library a user would take and by the importers."""

from __future__ import annotations

from pathlib import Path

import compas
import ezdxf
import meshio
import numpy as np
import pytest
import shapefile
import shapely
from compas.datastructures import Graph, Mesh
from compas.geometry import Box, Frame, Polyhedron, Translation
from shapely.geometry import mapping

from harness.formats.importing import Layer, Mapping, import_drawing
from harness.formats.registry import BY_SUFFIX
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.geometry import shapes_of
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from tests.formats.drawings import WALL

DATA = Path(__file__).parents[1] / "data"
SAID = Mapping(units="m", friction=0.6, unit_weight=20.0, thickness=0.25, live=(1.0, 0.0))


def _sorted(polygons: list[np.ndarray]) -> list[tuple[float, ...]]:
    return sorted(tuple(np.round(shapely.Polygon(p).normalize().exterior.coords, 9).ravel().tolist()) for p in polygons)


@pytest.mark.parametrize("suffix", [".dxf", ".svg", ".geojson", ".csv", ".json"])
def test_a_wall_written_and_imported_again_is_the_same_wall(suffix: str, tmp_path: Path) -> None:
    built, path = build(WALL), tmp_path / f"wall{suffix}"
    BY_SUFFIX[suffix].write(built, None, path)
    mapping = SAID
    if suffix in (".dxf",):
        mapping = SAID.model_copy(update={"supports": "layer SUPPORTS"})
    elif suffix == ".svg":
        mapping = SAID.model_copy(update={"supports": "layer supports"})
    again = build(import_drawing(path, mapping).wall)
    assert _sorted(list(again.assembly.polygons)) == _sorted(list(built.assembly.polygons))
    assert again.assembly.n_interfaces == built.assembly.n_interfaces
    assert again.assembly.fixed.sum() == built.assembly.fixed.sum()
    method = load_method("la-associated")
    values = [method.solve(item.assembly, method.Settings()).multiplier for item in (built, again)]
    assert values[0] == pytest.approx(values[1], rel=1e-9)  # accuracy of the linear programme


def framed() -> Wall:
    """A stone frame of two openings with a block in one of them, in metres."""
    ground = {"id": "ground", "polygon": [[-1, -0.5], [4, -0.5], [4, 0], [-1, 0]], "fixed": True}
    holes = [[[0.25, 0.25], [1.25, 0.25], [1.25, 1.5], [0.25, 1.5]], [[1.75, 0.25], [2.75, 0.25], [2.25, 1.5]]]
    frame = {"id": "frame", "polygon": [[0, 0], [3, 0], [3, 2], [0, 2]], "holes": holes}
    inner = {"id": "inner", "polygon": [[0.5, 0.25], [0.75, 0.25], [0.75, 1.0], [0.5, 1.0]]}
    return Wall.model_validate(WALL.document() | {"title": "frame", "blocks": [ground, frame, inner]})


@pytest.mark.parametrize("suffix", [".dxf", ".svg", ".geojson", ".csv", ".json", ".wkt", ".shp"])
def test_a_frame_written_and_imported_again_keeps_its_holes(suffix: str, tmp_path: Path) -> None:
    built, path = build(framed()), tmp_path / f"wall{suffix}"
    shapes = shapes_of(built.assembly.polygons)
    if suffix == ".wkt":
        path.write_text("\n".join(item.wkt for item in shapes))
    elif suffix == ".shp":
        with shapefile.Writer(str(path)) as writer:
            writer.field("fixed", "C")
            for item, fixed in zip(shapes, built.assembly.fixed, strict=True):
                writer.shape(mapping(shapely.orient_polygons(item, exterior_cw=True)))
                writer.record(str(bool(fixed)))
    else:
        BY_SUFFIX[suffix].write(built, None, path)
    imported = import_drawing(path, SAID)
    again = build(imported.wall)
    order = [int(np.flatnonzero(shapely.equals(shapes_of(again.assembly.polygons), item))[0]) for item in shapes]
    assert again.assembly.weight[order] == pytest.approx(built.assembly.weight)
    assert again.assembly.n_interfaces == 2


def test_gmsh_surfaces_keep_their_holes(tmp_path: Path) -> None:
    square = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2), (0, -1), (3, -1)]
    geo = [f"Point({k}) = {{{x}, {y}, 0, 1}};" for k, (x, y) in enumerate(square)]
    geo += [
        f"Line({4 * ring + k}) = {{{4 * ring + k}, {4 * ring + (k + 1) % 4}}};" for ring in (0, 1) for k in range(4)
    ]
    geo += ["Line(8) = {0, 8};", "Line(9) = {8, 9};", "Line(10) = {9, 1};"]
    geo += ["Line Loop(0) = {0, 1, 2, 3};", "Line Loop(1) = {4, 5, 6, 7};", "Line Loop(2) = {8, 9, 10, -0};"]
    geo += ["Plane Surface(0) = {0, 1};", "Plane Surface(1) = {2};"]
    (tmp_path / "w.geo").write_text("\n".join(geo))
    around = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [8, 9, 1, 0]]  # four cells round the hole
    data = [np.array([1, 1, 1, 1, 2])]
    points = np.hstack([np.array(square, float), np.zeros((len(square), 1))])
    fields = {"gmsh:physical": data, "gmsh:geometrical": data}
    mesh = meshio.Mesh(points, [("quad", np.array(around))], cell_data=fields)
    meshio.write(tmp_path / "w.msh", mesh, file_format="gmsh22", binary=False)
    for suffix in (".geo", ".msh"):
        weights = build(import_drawing(tmp_path / f"w{suffix}", SAID).wall).assembly.weight
        assert sorted(weights) == pytest.approx([15.0, 40.0]), suffix  # 5 kN/m2 over 3 x 1 and 3 x 3 - 1 x 1


def test_outlines_on_a_layer_of_holes_are_cut_out_of_the_stones_around_them(tmp_path: Path) -> None:
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    space = document.modelspace()
    for layer, x, y, width, height in [
        ("STONES", 0, -1, 4, 1),
        ("STONES", 0, 0, 3, 3),
        ("OPENINGS", 1, 1, 1, 1),
        ("OPENINGS", 9, 9, 1, 1),
    ]:
        corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    document.saveas(tmp_path / "w.dxf")
    said = SAID.model_copy(update={"layers": {"OPENINGS": Layer(use="hole")}})
    imported = import_drawing(tmp_path / "w.dxf", said)
    assert build(imported.wall).assembly.weight[1] == pytest.approx(20.0 * 0.25 * 8.0)
    assert any("lies in no stone, near (9.5, 9.5)" in sentence for sentence in imported.account)


def test_blocks_in_a_graph_are_read_as_compas_writes_them(tmp_path: Path) -> None:
    """Assemblies of compas are graphs whose nodes hold meshes, polyhedra or boxes and say which are supports."""
    ground = Box(4.0, 1.0, 1.0, frame=Frame([0.0, 0.0, -0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]))
    column = Mesh.from_shape(Box(1.0, 1.0, 2.0)).transformed(Translation.from_vector([0.0, 0.0, 1.0]))
    top = Polyhedron.from_platonicsolid(6)
    size = np.ptp(np.array(top.vertices), axis=0).max()
    top.transform(Translation.from_vector([0.0, 0.0, 2.0 + 0.5 * size]))
    graph = Graph()
    for name, solid, held in (("ground", ground, True), ("column", column, False), ("top", top, False)):
        graph.add_node(name, block=solid, is_support=held)
    compas.json_dump(graph, tmp_path / "w.json")
    assembly = build(import_drawing(tmp_path / "w.json", SAID).wall).assembly
    assert assembly.block_ids == ("ground", "column", "top")
    assert assembly.fixed.tolist() == [True, False, False]
    assert assembly.n_interfaces == 2
    assert assembly.weight[1:] == pytest.approx([20.0 * 0.25 * 2.0, 20.0 * 0.25 * size**2])


@pytest.mark.parametrize("name", ["compas_assembly", "compas_dem-contacts", "compas_dem-placed"])
def test_files_that_packages_of_compas_wrote_are_read_with_their_supports(name: str) -> None:
    """Three courses by compas_assembly 0.7.1 and compas_dem 0.6.0: as drawn, with contacts, with placed boxes."""
    wall = import_drawing(DATA / "compas" / f"{name}.json", SAID).wall
    assembly = build(wall).assembly
    assert assembly.fixed.tolist() == [True, False, False, False, False]
    # Two stones on the ground beside each other, two above: three beds of half a stone or more, and head joints.
    assert sorted(assembly.joint).count("head") == 2
    method = load_method("la-associated")
    # All of it slides on the ground, whose friction is .6.
    assert method.solve(assembly, method.Settings()).multiplier == pytest.approx(0.6, abs=1e-9)


def test_wkt_shapefile_and_gmsh_give_the_polygons(tmp_path: Path) -> None:
    polygons = list(build(WALL).assembly.polygons)
    (tmp_path / "w.wkt").write_text("\n".join(shapely.Polygon(p).wkt for p in polygons))
    with shapefile.Writer(str(tmp_path / "w.shp")) as writer:
        writer.field("id", "C")
        for number, polygon in enumerate(polygons):
            writer.poly([polygon.tolist()])
            writer.record(f"b{number}")
    starts = np.cumsum([0, *(len(p) for p in polygons)])
    points = np.hstack([np.concatenate(polygons), np.zeros((starts[-1], 1))])
    cells = [("quad", np.array([range(a, a + 4) for a in starts[:-1]]))]
    tags = np.arange(1, len(polygons) + 1)
    data = {"gmsh:physical": [tags], "gmsh:geometrical": [tags]}
    meshio.write(tmp_path / "w.msh", meshio.Mesh(points, cells, cell_data=data), file_format="gmsh22", binary=False)
    geo = []
    for number, polygon in enumerate(polygons):
        first = 10 * number
        geo += [f"Point({first + k}) = {{{x!r}, {y!r}, 0, 1}};" for k, (x, y) in enumerate(polygon.tolist())]
        geo += [f"Line({first + k}) = {{{first + k}, {first + (k + 1) % 4}}};" for k in range(4)]
        geo.append(f"Line Loop({number}) = {{{first}, {first + 1}, {first + 2}, {first + 3}}};")
        geo.append(f"Plane Surface({number}) = {{{number}}};")
    (tmp_path / "w.geo").write_text("\n".join(geo))
    for suffix in (".wkt", ".shp", ".msh", ".geo"):
        wall = import_drawing(tmp_path / f"w{suffix}", SAID).wall
        assert _sorted([np.array(block.polygon) for block in wall.blocks]) == _sorted(polygons), suffix


def test_dxf_blocks_hatches_arcs_lines_and_units(tmp_path: Path) -> None:
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 4
    stone = document.blocks.new("STONE")
    stone.add_lwpolyline([(0, 0), (1, 0), (1, 1), (0, 1)], close=True)
    space = document.modelspace()
    space.add_blockref("STONE", (0, 0), dxfattribs={"xscale": 500, "yscale": 200, "layer": "ground"})
    space.add_blockref("STONE", (500, 200), dxfattribs={"xscale": 200, "yscale": 500, "rotation": 90, "layer": "wall"})
    hatch = space.add_hatch(dxfattribs={"layer": "wall"})
    hatch.paths.add_polyline_path([(0, 400), (500, 400), (500, 600), (0, 600)], is_closed=True)
    space.add_lwpolyline([(0, 400), (500, 400), (500, 600), (0, 600.2)], close=True, dxfattribs={"layer": "wall"})
    for start, end in [((0, 600), (500, 600)), ((500, 600), (500, 800)), ((0, 800), (0, 600))]:
        space.add_line(start, end, dxfattribs={"layer": "wall"})
    space.add_arc((250, 800), 250, 0, 180, dxfattribs={"layer": "wall"})
    space.add_text("elevation", dxfattribs={"layer": "text"})
    document.saveas(tmp_path / "w.dxf")
    imported = import_drawing(tmp_path / "w.dxf", SAID.model_copy(update={"units": None, "accuracy": 1e-4}))
    assert imported.wall.units.length == "mm"
    assert [block.fixed for block in imported.wall.blocks].count(True) == 1
    assert len(imported.wall.blocks) == 4
    area = max(shapely.Polygon(block.polygon).area for block in imported.wall.blocks)
    exact = 500 * 200 + 0.5 * np.pi * 250**2
    assert exact * (1.0 - 1e-3) < area < exact  # chords of a sag of .1 mm lie within the arc
    told = " ".join(imported.account)
    assert "drawn twice" in told
    assert "TEXT" in told


@pytest.mark.parametrize(("name", "words"), [("w.ifc", "IFC describes"), ("w.dwg", "DXF"), ("w.xyz", "not read")])
def test_what_is_not_read_is_refused_with_a_word_why(name: str, words: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("x")
    with pytest.raises(InputError) as caught:
        import_drawing(tmp_path / name)
    assert words in str(caught.value)


@pytest.mark.parametrize("suffix", [".dxf", ".svg", ".geojson", ".wkt", ".shp", ".csv", ".msh", ".geo", ".json"])
@pytest.mark.parametrize("content", [b"", b"\x00\xff\x00", b"nonsense\n", b"[]", b"{}"])
def test_nonsense_is_an_input_error(suffix: str, content: bytes, tmp_path: Path) -> None:
    (tmp_path / f"w{suffix}").write_bytes(content)
    with pytest.raises(InputError):
        import_drawing(tmp_path / f"w{suffix}")
