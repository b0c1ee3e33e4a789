"""What is written of an answer is read by the library that a user would take."""

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
import shapely
from shapely.geometry import shape

from harness.formats.exporting import write_npz
from harness.formats.registry import BY_SUFFIX
from harness.model.build import build
from harness.model.method_registry import load_method
from harness.model.result import Result, result_of
from harness.model.wall import Wall
from tests.formats.drawings import WALL


@pytest.fixture(scope="module")
def answer() -> Result:
    assembly = build(WALL).assembly
    method = load_method("la-associated")
    return result_of(method.solve(assembly, method.Settings()), assembly, case="f", method="la-associated", family="la")


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
