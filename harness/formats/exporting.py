"""A wall and its answer for other programs: DXF, SVG, GeoJSON, CSV, COMPAS JSON, NumPy and MATLAB matrices."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from harness.formats.paraview import moved
from harness.model.bars import bar_tensions, with_bars_as_joints
from harness.model.build import Built
from harness.model.result import Result, vertex_velocities
from harness.model.rings import rings_of
from harness.model.writing import cell, replacing, write_whole


def write_dxf(built: Built, result: Result | None, path: Path) -> None:
    """Layers BLOCKS, SUPPORTS, JOINTS, TIES, PROPS and, with a mechanism, MECHANISM; the unit of length is declared."""
    import ezdxf

    assembly = built.assembly
    from harness.formats.dxf import UNITS

    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = UNITS.get(built.wall.units.length, 0)
    layers = [("BLOCKS", 7), ("SUPPORTS", 8), ("JOINTS", 5), ("MECHANISM", 1)]
    layers += [(name, 6) for name in sorted({_layer_of_bars(kind) for kind in assembly.bars.kinds})]
    for name, colour in layers:
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
    for kind, start, end in zip(assembly.bars.kinds, assembly.bars.end1, assembly.bars.end2, strict=True):
        space.add_line(start.tolist(), end.tolist(), dxfattribs={"layer": _layer_of_bars(kind)})
    if result is not None and result.mechanism is not None:
        for polygon in moved(assembly, result):
            space.add_lwpolyline(polygon.tolist(), close=True, dxfattribs={"layer": "MECHANISM"})
    with replacing(path) as draft:
        document.saveas(draft)


def _layer_of_bars(kind: str) -> str:
    return f"{kind.upper()}S"


def write_svg(built: Built, result: Result | None, path: Path) -> None:
    """A picture in layers of Inkscape, one unit of the picture a unit of length; y is turned downward."""
    assembly = built.assembly
    layers = {
        "blocks": [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if not fixed],
        "supports": [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if fixed],
    }
    if result is not None and result.mechanism is not None:
        layers["mechanism"] = moved(assembly, result)
    outlines = [polygon for polygons in layers.values() for polygon in polygons]
    everything = np.concatenate([*outlines, assembly.bars.end1, assembly.bars.end2])
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
    if len(assembly.bars):
        lines = zip(assembly.bars.end1.tolist(), assembly.bars.end2.tolist(), strict=True)
        parts.append(
            f'<g inkscape:groupmode="layer" inkscape:label="ties and props" fill="none" stroke="#6d2077" '
            f'stroke-width="{2.0 * line:.3g}">'
        )
        parts += [f'<path d="M{a:.17g},{0.0 - b:.17g} {c:.17g},{0.0 - d:.17g}"/>' for (a, b), (c, d) in lines]
        parts.append("</g>")
    write_whole(path, "\n".join([*parts, "</svg>"]) + "\n")


def write_geojson(built: Built, result: Result | None, path: Path) -> None:
    """A feature a block (id, material, fixed, weight, motion) and one a joint (blocks, friction, forces, state).

    Joints with strength have the tension and the cohesion that they bear besides friction too, and the compression at
    which they crush [force]. Ties and props are features of their own, with the range of their tension and, of an
    answer, the tension.
    """
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
        if assembly.strong:
            joint["tension"] = 2.0 * float(assembly.constant[number, 0])
            joint["cohesion"] = float(assembly.constant[number, 2])
        if assembly.brittle[number]:
            joint["brittle"] = True
        if np.isfinite(assembly.crushing[number]):
            joint["crushing"] = float(assembly.crushing[number])
        if result is not None and result.forces is not None:
            joint["n1"], joint["n2"], joint["s"] = result.forces[number]
        if result is not None and result.states is not None:
            joint["state"] = result.states[number]
        features.append(_feature({"type": "LineString", "coordinates": ends}, joint))
    bars = assembly.bars
    tension = bar_tensions(assembly, result)
    for k, (name, kind) in enumerate(zip(bars.names, bars.kinds, strict=True)):
        properties = {
            kind: name,
            "between": [assembly.block_ids[bars.block_a[k]], assembly.block_ids[bars.block_b[k]]],
            "least": float(bars.prestress[k] + bars.least[k]),
            "greatest": float(bars.prestress[k] + bars.greatest[k]),
        }
        if tension is not None:
            properties["tension"] = float(tension[k])
        ends = [bars.end1[k].tolist(), bars.end2[k].tolist()]
        features.append(_feature({"type": "LineString", "coordinates": ends}, properties))
    data = {"type": "FeatureCollection", "features": features}
    write_whole(path, json.dumps(data, ensure_ascii=False, allow_nan=False) + "\n")


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
                writer.writerow([cell(name), number, *point, cell(block.material), int(block.fixed), *v])
    write_whole(path, file.getvalue())


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
    write_whole(path, json.dumps(meshes, ensure_ascii=False, allow_nan=False) + "\n")


def matrices(built: Built, result: Result | None) -> dict[str, Any]:
    """Arrays for a solver of one's own.

    Rows of C are (opening 1, opening 2, slip) of every joint, columns (ux, uy, omega) of every free block, so that
    C^T (n1, n2, s) + dead + multiplier x live = 0, with compression positive and |s| <= friction (n1 + n2).
    Where joints have strength, `constant` holds what is added to n1, n2 and to both limits of s, and `crushing` the
    compression at which they crush. Rows of `B` are the elongations of ties and props: their tensions beyond the
    prestress, which is in `dead`, add -B^T T, and lie between `bar_least` and `bar_greatest`.
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
    if assembly.strong:
        arrays["constant"] = assembly.constant
    if assembly.breaks:
        arrays["brittle"] = assembly.brittle
    if assembly.crushes:
        arrays["crushing"] = assembly.crushing
    if len(assembly.bars):
        arrays["B"] = with_bars_as_joints(assembly).kinematic_matrix[3 * assembly.n_interfaces + 2 :: 3].toarray()
        arrays["bar_least"], arrays["bar_greatest"] = assembly.bars.least, assembly.bars.greatest
        arrays["bar_prestress"] = assembly.bars.prestress
        if (tension := bar_tensions(assembly, result)) is not None:
            arrays["bar_tension"] = tension
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
    with replacing(path) as draft:
        np.savez_compressed(draft, **sizes, **arrays)


def write_mat(built: Built, result: Result | None, path: Path) -> None:
    """The matrices for MATLAB and Octave; indices count from 0."""
    from scipy.io import savemat

    arrays = matrices(built, result)
    arrays["block_ids"] = arrays["block_ids"].astype(object)
    with replacing(path) as draft:
        savemat(draft, arrays, oned_as="column", do_compression=True)
