"""What is written is read again, by the library a user would take and by the importers."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import compas
import ezdxf
import meshio
import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
import shapefile
import shapely
from click.testing import CliRunner
from compas.datastructures import Graph, Mesh
from compas.geometry import Box, Frame, Polyhedron, Translation
from shapely.geometry import mapping, shape

from cases.start import STARTS, facade, flemish, laid
from drystone.cli.main import main
from harness.formats.exporting import write_npz
from harness.formats.importing import Layer, Mapping, import_drawing
from harness.formats.registry import BY_SUFFIX
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.geometry import shapes_of
from harness.model.method_registry import load_method
from harness.model.result import Result, result_of
from harness.model.wall import Wall

DATA = Path(__file__).parents[1] / "data"
WALL = flemish(length=1.0, height=0.45)
SAID = Mapping(units="m", friction=0.6, unit_weight=20.0, thickness=0.25, live=(1.0, 0.0))


@pytest.fixture(scope="module")
def answer() -> Result:
    assembly = build(WALL).assembly
    method = load_method("la-associated")
    return result_of(method.solve(assembly, method.Settings()), assembly, case="f", method="la-associated", family="la")


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


def test_paraview_s_file_holds_velocities_forces_and_states(answer: Result, tmp_path: Path) -> None:
    built = build(WALL)
    BY_SUFFIX[".vtu"].write(built, answer, tmp_path / "w.vtu")
    mesh = meshio.read(tmp_path / "w.vtu")
    assert sum(len(block.data) for block in mesh.cells if block.type != "line") == built.assembly.n_blocks
    lines = next(number for number, block in enumerate(mesh.cells) if block.type == "line")
    assert answer.forces is not None
    assert np.array_equal(mesh.cell_data["n1"][lines], np.asarray(answer.forces)[:, 0])
    assert np.linalg.norm(mesh.point_data["velocity"], axis=1).max() == pytest.approx(1.0)


def test_a_series_of_the_mechanism_grows_from_nothing(answer: Result, tmp_path: Path) -> None:
    BY_SUFFIX[".pvd"].write(build(WALL), answer, tmp_path / "w.pvd")
    files = sorted(tmp_path.glob("w-*.vtu"))
    assert all(file.name in (tmp_path / "w.pvd").read_text() for file in files)
    sizes = [np.abs(meshio.read(file).point_data["displacement"]).max() for file in (files[0], files[10], files[-1])]
    assert sizes[0] == 0.0
    assert sizes[2] == pytest.approx(2.0 * sizes[1])


def test_a_collapse_that_was_followed_is_a_series_in_its_time(answer: Result, tmp_path: Path) -> None:
    built = build(WALL)
    assembly = built.assembly
    angles, times = [0.0, 0.2, 0.5], [0.0, 1.5, 2.5]
    frames = [[[0.1 * a, 0.0, a] if free else [0.0, 0.0, 0.0] for free in ~assembly.fixed] for a in angles]
    followed = answer.model_copy(update={"details": {"release": {"frames": frames}}, "path": {"time": times}})
    BY_SUFFIX[".pvd"].write(built, followed, tmp_path / "w.pvd")
    rows = ElementTree.parse(tmp_path / "w.pvd").getroot().findall(".//DataSet")
    assert [float(row.attrib["timestep"]) for row in rows] == times
    points = [meshio.read(tmp_path / row.attrib["file"]) for row in rows]
    block = int(assembly.free[0])
    middle = assembly.centroid[block]
    first = sum(len(polygon) for polygon in assembly.polygons[:block])
    own = slice(first, first + len(assembly.polygons[block]))
    for mesh, angle in zip(points, angles, strict=True):
        turned = (mesh.points + mesh.point_data["displacement"])[own, :2] - middle - [0.1 * angle, 0.0]
        arm = assembly.polygons[block] - middle
        assert np.hypot(*turned.T) == pytest.approx(np.hypot(*arm.T))  # a rigid motion keeps distances
        cross = arm[:, 0] * turned[:, 1] - arm[:, 1] * turned[:, 0]
        assert np.arctan2(cross, (arm * turned).sum(axis=1)) == pytest.approx(angle)


def test_ezdxf_reads_blocks_joints_and_mechanism(answer: Result, tmp_path: Path) -> None:
    built = build(WALL)
    BY_SUFFIX[".dxf"].write(built, answer, tmp_path / "w.dxf")
    document = ezdxf.readfile(tmp_path / "w.dxf")  # type: ignore[attr-defined]
    space = document.modelspace()
    assert not document.audit().errors
    assert len(space.query('LWPOLYLINE[layer=="MECHANISM"]')) == built.assembly.n_blocks
    assert len(space.query('LINE[layer=="JOINTS"]')) == built.assembly.n_interfaces


def test_shapely_reads_the_geojson(answer: Result, tmp_path: Path) -> None:
    built = build(WALL)
    BY_SUFFIX[".geojson"].write(built, answer, tmp_path / "w.geojson")
    shapes = [shape(item["geometry"]) for item in json.loads((tmp_path / "w.geojson").read_text())["features"]]
    assert [item.geom_type for item in shapes].count("Polygon") == built.assembly.n_blocks
    assert all(item.is_valid for item in shapes)


def test_compas_reads_the_blocks_as_closed_meshes(answer: Result, tmp_path: Path) -> None:
    built = build(WALL)
    BY_SUFFIX[".json"].write(built, answer, tmp_path / "w.json")
    meshes = compas.json_load(tmp_path / "w.json")
    assert len(meshes) == built.assembly.n_blocks
    volumes = [mesh.volume() for mesh in meshes]
    areas = [shapely.Polygon(polygon).area * 0.25 for polygon in built.assembly.polygons]
    assert volumes == pytest.approx(areas)  # outward faces: volumes are positive


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


@pytest.mark.parametrize("suffix", [".npz", ".mat"])
def test_matrices_are_in_equilibrium_with_the_answer(suffix: str, answer: Result, tmp_path: Path) -> None:
    BY_SUFFIX[suffix].write(build(WALL), answer, tmp_path / f"w{suffix}")
    if suffix == ".npz":
        data = np.load(tmp_path / "w.npz")
        matrix = sp.coo_matrix((data["C_data"], (data["C_row"], data["C_col"])), shape=data["C_shape"])
    else:
        data = scipy.io.loadmat(tmp_path / "w.mat")
        matrix = data["C"]
    load = np.ravel(data["dead"]) + float(np.ravel(data["forces_multiplier"])[0]) * np.ravel(data["live"])
    rest = matrix.T @ np.asarray(data["forces"]).ravel() + load
    assert abs(rest).max() < 1e-9 * abs(load).sum()
    compression, shear = np.asarray(data["forces"])[:, :2].sum(axis=1), np.asarray(data["forces"])[:, 2]
    assert (abs(shear) <= np.ravel(data["friction"]) * compression + 1e-9 * abs(load).sum()).all()


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


@pytest.mark.parametrize("kind", STARTS)
def test_every_kind_of_new_wall_builds_and_every_block_is_held(kind: str) -> None:
    assembly = build(STARTS[kind]()).assembly  # refuses overlaps
    touched = {*assembly.block_a.tolist(), *assembly.block_b.tolist()}
    assert set(assembly.free.tolist()) <= touched


def test_headers_of_flemish_bond_lie_on_the_middle_of_stretchers() -> None:
    assert laid("flemish", 1, 0.0, 4.0) == [0.0, 1.0, 1.5, 2.5, 3.0, 4.0]
    assert laid("flemish", 2, 0.0, 4.0) == [0.0, 0.25, 0.75, 1.75, 2.25, 3.25, 3.75, 4.0]


def test_a_facade_has_openings_under_lintels() -> None:
    wall = facade(storeys=1, openings=2, opening_width=0.5, opening_height=0.3, spandrel_height=0.3)
    assert sum("lintel" in block.id for block in wall.blocks) == 2


def test_commands_go_from_numbers_to_drawing_to_answer(tmp_path: Path) -> None:
    run = CliRunner()
    wall, drawing = tmp_path / "wall.json", tmp_path / "wall.dxf"
    assert run.invoke(main, ["new", "stack", "--count", "2", "-o", str(wall)]).exit_code == 0
    assert run.invoke(main, ["export", str(wall), "-o", str(drawing)]).exit_code == 0
    done = run.invoke(main, ["run", "la-associated", str(drawing), "--json"])
    assert done.exit_code == 0, done.output
    assert "friction is given for the drawing" in done.output
    again = run.invoke(main, ["import", str(drawing), "--supports", "layer SUPPORTS", "-o", str(tmp_path / "a.json")])
    assert again.exit_code == 0, again.output
    assert json.loads((tmp_path / "a.json").read_text())["units"]["unit_weight"] == "kN/m3"


def test_write_npz_without_answer_holds_no_forces(tmp_path: Path) -> None:
    write_npz(build(WALL), None, tmp_path / "w.npz")
    assert "forces" not in np.load(tmp_path / "w.npz")


def test_velocities_of_a_csv_are_those_of_rigid_blocks(answer: Result, tmp_path: Path) -> None:
    assembly = build(WALL).assembly
    for result, moves in ((answer, True), (None, False)):
        BY_SUFFIX[".csv"].write(build(WALL), result, tmp_path / "w.csv")
        rows = list(csv.DictReader(io.StringIO((tmp_path / "w.csv").read_text())))
        assert any(float(row["vx"]) != 0.0 for row in rows) is moves
        for row in rows:
            number = assembly.block_ids.index(row["block"])
            ux, uy, omega = answer.mechanism[number] if moves else (0.0, 0.0, 0.0)  # type: ignore[index]
            x, y = (float(row[name]) - centre for name, centre in zip("xy", assembly.centroid[number], strict=True))
            assert (float(row["vx"]), float(row["vy"])) == pytest.approx((ux - omega * y, uy + omega * x), abs=1e-12)


@pytest.mark.parametrize("metre", [1.0, 1000.0])
def test_pictures_of_a_mechanism_are_in_proportion_to_the_stones_in_any_unit(metre: float, tmp_path: Path) -> None:
    blocks = [
        {"id": name, "fixed": name == "g", "polygon": [[metre * x, metre * y] for x, y in corners]}
        for name, corners in (("g", [(-1, -1), (2, -1), (2, 0), (-1, 0)]), ("s", [(0, 0), (1, 0), (1, 1), (0, 1)]))
    ]
    built = build(Wall.model_validate(WALL.document() | {"blocks": blocks, "unit_weight": 20.0 / metre**3}))
    motion = np.zeros((2, 3))
    motion[1] = (1.0, 0.0, 0.0)
    method = load_method("la-associated")
    result = result_of(
        method.solve(built.assembly, method.Settings()), built.assembly, case="f", method="m", family="m"
    )
    result = result.model_copy(update={"mechanism": motion.tolist()})
    BY_SUFFIX[".vtu"].write(built, result, tmp_path / "w.vtu")
    BY_SUFFIX[".pvd"].write(built, result, tmp_path / "w.pvd")
    last = max(tmp_path.glob("w-*.vtu"))
    for path in (tmp_path / "w.vtu", last):
        mesh = meshio.read(path)
        assert {block.type for block in mesh.cells} == {"quad", "line"}
        shift = np.abs(mesh.point_data["displacement"]).max()
        assert 0.1 * metre < shift < 0.6 * metre  # a part of a stone that is seen
        assert shift == pytest.approx(0.3 * built.assembly.length_scale)
    BY_SUFFIX[".svg"].write(built, result, tmp_path / "w.svg")
    widths = re.findall(r'stroke-width="([^"]*)"', (tmp_path / "w.svg").read_text())
    assert len(widths) == 3
    assert all(0.005 * metre < float(width) < 0.1 * metre for width in widths)
