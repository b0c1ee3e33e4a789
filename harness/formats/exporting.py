"""A wall and its answer for other programs: VTU, DXF, SVG, GeoJSON, CSV, COMPAS JSON, NumPy and MATLAB matrices."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.build import Built
from harness.model.displaced import carried, released
from harness.model.errors import InputError, did_you_mean
from harness.model.result import Result, vertex_velocities
from harness.model.rings import rings_of

STATES = {"stick": 0, "slip": 1, "rock": 2, "open": 3}
"""Numbers of the states of joints in fields."""
SHOWN = 0.3
"""The fastest vertex of a drawn mechanism is moved by this part of the typical size of a block."""
STEPS = 20
"""Files of a series that moves the mechanism from nothing to what is drawn."""


def _velocities(assembly: Assembly, result: Result | None) -> list[FloatArray]:
    """Velocities (k, 2) of the vertices of every block, zero without a mechanism."""
    if result is None or result.mechanism is None:
        return [np.zeros_like(polygon) for polygon in assembly.polygons]
    motions = np.asarray(result.mechanism, float)
    return [
        vertex_velocities(polygon, centroid, motion)
        for polygon, centroid, motion in zip(assembly.polygons, assembly.centroid, motions, strict=True)
    ]


def moved(assembly: Assembly, result: Result | None, part: float = 1.0) -> list[FloatArray]:
    """Polygons of the blocks displaced along the mechanism, as far as it is drawn."""
    scale = part * SHOWN * assembly.length_scale
    return [p + scale * v for p, v in zip(assembly.polygons, _velocities(assembly, result), strict=True)]


def write_vtu(built: Built, result: Result | None, path: Path) -> None:
    """Blocks as polygons and joints as lines, for ParaView: velocity, displacement, forces and states."""
    displacement = [SHOWN * built.assembly.length_scale * v for v in _velocities(built.assembly, result)]
    _mesh(built.assembly, result, displacement).write(path, file_format="vtu", binary=True)


def _mesh(assembly: Assembly, result: Result | None, displacement: list[FloatArray]) -> Any:
    """The mesh of a wall with its answer and displacements (k, 2) of the vertices of every block [length]."""
    import meshio

    polygons, joints = assembly.polygons, np.stack([assembly.face1, assembly.face2], axis=1)
    starts = np.cumsum([0, *(len(polygon) for polygon in polygons)])
    points = np.concatenate([*polygons, joints.reshape(-1, 2)])
    velocity = np.concatenate([*_velocities(assembly, result), np.zeros((2 * len(joints), 2))])
    order = sorted(range(len(polygons)), key=lambda i: (len(polygons[i]), i))
    cells: list[tuple[str, Any]] = []
    for size in sorted({len(polygon) for polygon in polygons}):
        mine = [i for i in order if len(polygons[i]) == size]
        kind = {3: "triangle", 4: "quad"}.get(size, "polygon")
        cells.append((kind, np.array([np.arange(starts[i], starts[i] + size) for i in mine])))
    lines = starts[-1] + np.arange(2 * len(joints)).reshape(-1, 2)
    groups = [len(cell) for _, cell in cells]
    forces = np.zeros((len(joints), 3)) if result is None or result.forces is None else np.asarray(result.forces, float)
    states = (
        np.full(len(joints), -1)
        if result is None or result.states is None
        else np.array([STATES[state] for state in result.states])
    )
    fields: dict[str, tuple[Any, Any]] = {
        "number": (np.array(order), np.arange(len(joints))),
        "is_joint": (np.zeros(len(order), int), np.ones(len(joints), int)),
        "fixed": (assembly.fixed[order].astype(int), np.zeros(len(joints), int)),
        "weight": (assembly.weight[order], np.zeros(len(joints))),
        "n1": (np.zeros(len(order)), forces[:, 0]),
        "n2": (np.zeros(len(order)), forces[:, 1]),
        "s": (np.zeros(len(order)), forces[:, 2]),
        "state": (np.full(len(order), -1), states),
        "friction": (np.zeros(len(order)), assembly.friction),
    }
    if len(lines):
        cells.append(("line", lines))
    ends = np.cumsum(groups)[:-1]
    data = {
        name: [*np.split(np.asarray(blocks), ends), *([np.asarray(mine)] if len(lines) else [])]
        for name, (blocks, mine) in fields.items()
    }
    flat = np.zeros((len(points), 1))
    across = np.hstack([velocity, flat])
    shift = np.hstack([np.concatenate([*displacement, np.zeros((2 * len(joints), 2))]), flat])
    return meshio.Mesh(
        np.hstack([points, flat]),
        cells,
        point_data={"velocity": across, "displacement": shift},
        cell_data=data,
    )


def write_pvd(built: Built, result: Result | None, path: Path) -> None:
    """A series of VTU files beside a .pvd, one a step.

    A collapse that was followed is the series of its states in its time [sqrt(length scale / gravity)]; else the
    mechanism grows, and the time is the part of what is drawn.
    """
    assembly = built.assembly
    rows = []
    for step, (time, displacement) in enumerate(_steps(assembly, result)):
        name = f"{path.stem}-{step:03d}.vtu"
        _mesh(assembly, result, displacement).write(path.with_name(name), file_format="vtu", binary=True)
        rows.append(f'    <DataSet timestep="{time:.9g}" part="0" file={quoteattr(name)}/>')
    text = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
    path.write_text(text + "\n".join(rows) + "\n  </Collection>\n</VTKFile>\n", encoding="utf-8")


def _steps(assembly: Assembly, result: Result | None) -> list[tuple[float, list[FloatArray]]]:
    """Times and displacements (k, 2) of the vertices of every block [length]."""
    followed = None if result is None else released(result, assembly.n_blocks)
    if result is None or followed is None:
        velocities = [SHOWN * assembly.length_scale * v for v in _velocities(assembly, result)]
        parts = [step / STEPS for step in range(STEPS + 1)]
        return [(part, [part * v for v in velocities]) for part in parts]
    times = result.path.get("time", [])
    if len(times) != len(followed):
        times = list(range(len(followed)))
    return [
        (float(time), [p - q for p, q in zip(carried(assembly, places), assembly.polygons, strict=True)])
        for time, places in zip(times, followed, strict=True)
    ]


def write_dxf(built: Built, result: Result | None, path: Path) -> None:
    """Layers BLOCKS, SUPPORTS, JOINTS and, with a mechanism, MECHANISM; the unit of length is declared."""
    import ezdxf

    assembly = built.assembly
    codes = {"in": 1, "ft": 2, "mm": 4, "cm": 5, "m": 6, "km": 7, "yd": 10, "dm": 14}
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = codes.get(built.wall.units.length, 0)
    for name, colour in (("BLOCKS", 7), ("SUPPORTS", 8), ("JOINTS", 5), ("MECHANISM", 1)):
        document.layers.add(name, color=colour)
    space = document.modelspace()
    for polygon, fixed in zip(assembly.polygons, assembly.fixed, strict=True):
        layer = {"layer": "SUPPORTS" if fixed else "BLOCKS"}
        outer, *holes = (ring.tolist() for ring in rings_of(polygon))
        if not holes:
            space.add_lwpolyline(outer, close=True, dxfattribs=layer)
            continue
        hatch = space.add_hatch(dxfattribs=layer)  # a polyline within another would be a stone within it
        hatch.paths.add_polyline_path(outer, is_closed=True, flags=1)
        for hole in holes:
            hatch.paths.add_polyline_path(hole, is_closed=True, flags=0)
    for start, end in zip(assembly.face1, assembly.face2, strict=True):
        space.add_line(start.tolist(), end.tolist(), dxfattribs={"layer": "JOINTS"})
    if result is not None and result.mechanism is not None:
        for polygon in moved(assembly, result):
            space.add_lwpolyline(polygon.tolist(), close=True, dxfattribs={"layer": "MECHANISM"})
    document.saveas(path)


def write_svg(built: Built, result: Result | None, path: Path) -> None:
    """A picture in layers of Inkscape, one unit of the picture a unit of length; y is turned downward."""
    assembly = built.assembly
    layers = {
        "blocks": [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if not fixed],
        "supports": [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if fixed],
    }
    if result is not None and result.mechanism is not None:
        layers["mechanism"] = moved(assembly, result)
    everything = np.concatenate([polygon for polygons in layers.values() for polygon in polygons])
    low, high = everything.min(axis=0), everything.max(axis=0)
    line = 0.02 * assembly.length_scale
    looks = {"blocks": ("#eae6df", "#14202b"), "supports": ("#8a96a1", "#14202b"), "mechanism": ("none", "#a63c06")}
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
        f'viewBox="{low[0]:.17g} {-high[1]:.17g} {high[0] - low[0]:.17g} {high[1] - low[1]:.17g}">'
    ]
    for name, polygons in layers.items():
        fill, stroke = looks[name]
        parts.append(
            f'<g inkscape:groupmode="layer" inkscape:label="{name}" fill="{fill}" stroke="{stroke}" '
            f'stroke-width="{line:.3g}" stroke-linejoin="round">'
        )
        parts += [
            '<path d="'
            + " ".join(
                "M" + " ".join(f"{x:.17g},{0.0 - y:.17g}" for x, y in ring.tolist()) + "z" for ring in rings_of(p)
            )
            + '"/>'
            for p in polygons
        ]
        parts.append("</g>")
    path.write_text("\n".join([*parts, "</svg>"]) + "\n", encoding="utf-8")


def write_geojson(built: Built, result: Result | None, path: Path) -> None:
    """A feature a block (id, material, fixed, weight, motion) and one a joint (blocks, friction, forces, state)."""
    assembly = built.assembly
    features: list[dict[str, Any]] = []
    for number, (name, polygon) in enumerate(zip(assembly.block_ids, assembly.polygons, strict=True)):
        properties: dict[str, Any] = {
            "id": name,
            "material": built.wall.blocks[number].material,
            "fixed": bool(assembly.fixed[number]),
            "weight": float(assembly.weight[number]),
        }
        if result is not None and result.mechanism is not None:
            properties["mechanism"] = list(result.mechanism[number])
        rings = [[*ring.tolist(), ring[0].tolist()] for ring in rings_of(polygon)]
        features.append(_feature({"type": "Polygon", "coordinates": rings}, properties))
    for number in range(assembly.n_interfaces):
        ends = [assembly.face1[number].tolist(), assembly.face2[number].tolist()]
        joint: dict[str, Any] = {
            "between": [assembly.block_ids[assembly.block_a[number]], assembly.block_ids[assembly.block_b[number]]],
            "friction": float(assembly.friction[number]),
        }
        if result is not None and result.forces is not None:
            joint["n1"], joint["n2"], joint["s"] = result.forces[number]
        if result is not None and result.states is not None:
            joint["state"] = result.states[number]
        features.append(_feature({"type": "LineString", "coordinates": ends}, joint))
    data = {"type": "FeatureCollection", "features": features}
    path.write_text(json.dumps(data, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def _feature(geometry: dict[str, Any], properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def write_csv(built: Built, result: Result | None, path: Path) -> None:
    """A row a vertex: block, ring (0 the outline, then its holes), x, y, material, fixed, and vx, vy of a mechanism."""
    assembly = built.assembly
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["block", "ring", "x", "y", "material", "fixed", "vx", "vy"])
    speeds = np.zeros((assembly.n_blocks, 3)) if result is None or result.mechanism is None else result.mechanism
    rows = zip(assembly.block_ids, assembly.polygons, assembly.centroid, speeds, built.wall.blocks, strict=True)
    for name, polygon, centroid, speed, block in rows:
        for number, ring in enumerate(rings_of(polygon)):
            velocity = vertex_velocities(ring, centroid, np.asarray(speed, float))
            for point, v in zip(ring.tolist(), velocity.tolist(), strict=True):
                writer.writerow([name, number, *point, block.material, int(block.fixed), *v])
    path.write_text(file.getvalue(), encoding="utf-8")


def write_compas(built: Built, result: Result | None, path: Path) -> None:
    """A list of compas 2 meshes, one a block in its thickness, upright in the plane xz; `compas.json_load` reads it."""
    assembly = built.assembly
    meshes = []
    for number, (name, polygon) in enumerate(zip(assembly.block_ids, assembly.polygons, strict=True)):
        deep = 0.5 * (built.wall.blocks[number].thickness or built.wall.thickness or built.wall.units.metre)
        count = len(polygon)
        corners = [(x, y, z) for y in (-deep, deep) for x, z in polygon.tolist()]
        sides = [[i, (i + 1) % count, count + (i + 1) % count, count + i] for i in range(count)]
        faces = [list(range(count)), list(range(2 * count - 1, count - 1, -1)), *(side[::-1] for side in sides)]
        attributes: dict[str, Any] = {"name": name, "is_support": bool(assembly.fixed[number])}
        if result is not None and result.mechanism is not None:
            attributes["mechanism"] = list(result.mechanism[number])
        data = {
            "attributes": attributes,
            "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
            "default_edge_attributes": {},
            "default_face_attributes": {},
            "vertex": {str(k): dict(zip("xyz", corner, strict=True)) for k, corner in enumerate(corners)},
            "face": {str(k): face for k, face in enumerate(faces)},
            "facedata": {},
            "edgedata": {},
            "max_vertex": len(corners) - 1,
            "max_face": len(faces) - 1,
        }
        meshes.append({"dtype": "compas.datastructures/Mesh", "data": data, "name": name})
    path.write_text(json.dumps(meshes, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def matrices(built: Built, result: Result | None) -> dict[str, Any]:
    """Arrays for a solver of one's own.

    Rows of C are (opening 1, opening 2, slip) of every joint, columns (ux, uy, omega) of every free block, so that
    C^T (n1, n2, s) + dead + multiplier x live = 0, with compression positive and |s| <= friction (n1 + n2).
    """
    assembly = built.assembly
    dead, live = assembly.free_loads()
    arrays: dict[str, Any] = {
        "C": assembly.kinematic_matrix,
        "dead": dead,
        "live": live,
        "friction": assembly.friction,
        "weight": assembly.weight[assembly.free],
        "centroid": assembly.centroid[assembly.free],
        "block_ids": np.array([assembly.block_ids[i] for i in assembly.free]),
        "block_a": assembly.block_a,
        "block_b": assembly.block_b,
        "free": assembly.free,
        "end1": assembly.end1,
        "end2": assembly.end2,
        "normal": assembly.normal,
    }
    if result is not None and result.multiplier is not None:
        arrays["multiplier"] = np.array(result.multiplier)
    if result is not None and result.forces is not None:
        arrays["forces"] = np.asarray(result.forces, float)
        arrays["forces_multiplier"] = np.array(result.forces_multiplier)
    if result is not None and result.mechanism is not None:
        arrays["mechanism"] = np.asarray(result.mechanism, float)[assembly.free]
    return arrays


def write_npz(built: Built, result: Result | None, path: Path) -> None:
    """The matrices for NumPy; C as C_data, C_row, C_col and C_shape of a sparse matrix in coordinates."""
    arrays = matrices(built, result)
    sparse = arrays.pop("C").tocoo()
    sizes = {"C_data": sparse.data, "C_row": sparse.row, "C_col": sparse.col, "C_shape": np.array(sparse.shape)}
    with open(path, "wb") as file:
        np.savez_compressed(file, **sizes, **arrays)


def write_mat(built: Built, result: Result | None, path: Path) -> None:
    """The matrices for MATLAB and Octave; indices count from 0."""
    from scipy.io import savemat

    arrays = matrices(built, result)
    arrays["block_ids"] = arrays["block_ids"].astype(object)
    savemat(path, arrays, oned_as="column", do_compression=True)


WRITERS: dict[str, Callable[[Built, Result | None, Path], None]] = {
    ".vtu": write_vtu,
    ".pvd": write_pvd,
    ".dxf": write_dxf,
    ".svg": write_svg,
    ".geojson": write_geojson,
    ".csv": write_csv,
    ".json": write_compas,
    ".npz": write_npz,
    ".mat": write_mat,
}
"""Writers by the ending of the file's name."""


def writer_of(path: Path) -> Callable[[Built, Result | None, Path], None]:
    """The writer that the ending of a name asks for.

    Raises:
        InputError: none, naming those there are.
    """
    suffix = path.suffix.lower()
    if suffix not in WRITERS:
        hint = f"{did_you_mean(suffix, WRITERS)} There are: {', '.join(WRITERS)}".strip()
        raise InputError(f'a file that ends in "{suffix}" is not written', hint, source=str(path))
    return WRITERS[suffix]
