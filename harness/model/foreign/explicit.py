"""A wall as a program in any language reads it: explicit `wall/1`, with the arrays of its assembly beside it.

Every block has its polygon and weight, every interface its two contact points and its friction. Gravity is off: all
loads are forces at points, in the order of the blocks. `metadata.arrays` repeats the wall as flat arrays of numbers
in the conventions of `harness.model.assembly`, so that a program need compute neither centroids nor normals.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray

LISTED = (
    *("centroid", "fixed", "weight", "block_a", "block_b", "end1", "end2", "normal"),
    *("friction", "dilatancy", "constant", "dead", "live"),
)
"""The arrays of an assembly that `metadata.arrays` and the `.npz` hold, under these names."""


def explicit_document(assembly: Assembly) -> dict[str, Any]:
    """A wall as JSON values of format `wall/1`, in the order and the units of its assembly.

    Lengths and forces are those of the user's wall, whose units are not repeated ("1"). The thickness is 1, so that
    cohesion and tensile strength are forces per length of interface.

    Args:
        assembly: the wall; a block with holes is given by its outline, which goes along a cut to each and back.
    """
    ids = assembly.block_ids
    blocks = [
        {"id": ids[i], "polygon": assembly.polygons[i].tolist(), "weight": float(assembly.weight[i])}
        | ({"fixed": True} if assembly.fixed[i] else {})
        for i in range(assembly.n_blocks)
    ]
    interfaces = [_interface(assembly, p) for p in range(assembly.n_interfaces)]
    loads: dict[str, Any] = {"gravity": False, "dead": {"points": _points(assembly, assembly.dead)}}
    if assembly.has_live_load:
        loads["live"] = {"points": _points(assembly, assembly.live)}
    return {
        "format": "wall/1",
        "title": assembly.name,
        "units": {"length": "1", "force": "1"},
        "thickness": 1.0,
        "friction": 0.0,
        "blocks": blocks,
        "interfaces": interfaces,
        "loads": loads,
        "metadata": {"arrays": {name: getattr(assembly, name).astype(float).tolist() for name in LISTED}},
    }


def write_arrays(path: Path, assembly: Assembly) -> None:
    """Write the arrays of a wall as `.npz`: those of `metadata.arrays`, the kinematic matrix and the free loads.

    The matrix C (3m, 3 n_free) of `Assembly.kinematic_matrix` is in compressed sparse rows: `C_data`, `C_indices`,
    `C_indptr`, `C_shape`. `dead_free` and `live_free` (3 n_free,) are the loads in the order of its columns, `free`
    (n_free,) the numbers of the free blocks.
    """
    matrix = assembly.kinematic_matrix
    dead, live = assembly.free_loads()
    arrays = {name: getattr(assembly, name) for name in LISTED}
    arrays |= {"C_data": matrix.data, "C_indices": matrix.indices, "C_indptr": matrix.indptr}
    arrays |= {"C_shape": np.array(matrix.shape), "dead_free": dead, "live_free": live, "free": assembly.free}
    np.savez(path, **arrays)


def _interface(assembly: Assembly, p: int) -> dict[str, Any]:
    """One interface, with dilatancy and strength where it has them."""
    made: dict[str, Any] = {
        "between": [assembly.block_ids[assembly.block_a[p]], assembly.block_ids[assembly.block_b[p]]],
        "from": assembly.end1[p].tolist(),
        "to": assembly.end2[p].tolist(),
        "friction": float(assembly.friction[p]),
        "joint": assembly.joint[p],
    }
    if assembly.dilatancy[p]:
        made["dilatancy"] = float(assembly.dilatancy[p])
    if assembly.constant[p].any():
        made["cohesion"] = float(assembly.constant[p, 2] / assembly.length[p])
        made["tensile_strength"] = float(2.0 * assembly.constant[p, 0] / assembly.length[p])
    return made


def _points(assembly: Assembly, loads: FloatArray) -> list[dict[str, Any]]:
    """Generalised loads (n, 3) as forces at points: one at the centroid, and a couple where there is a moment."""
    points = []
    for i in assembly.free:
        x, y = assembly.centroid[i].tolist()
        fx, fy, moment = loads[i].tolist()
        if fx or fy:
            points.append({"block": assembly.block_ids[i], "at": [x, y], "force": [fx, fy]})
        if moment:
            arm = float(assembly.radius[i])
            for sign in (1.0, -1.0):
                force = [0.0, sign * moment / (2.0 * arm)]
                points.append({"block": assembly.block_ids[i], "at": [x + sign * arm, y], "force": force})
    return points
