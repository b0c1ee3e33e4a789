"""A wall and its answer for ParaView, through meshio: VTU files and time series of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.bars import bar_tensions
from harness.model.build import Built
from harness.model.displaced import carried, released
from harness.model.joint_margins import as_answered, joint_margins
from harness.model.load_steps import STATES, UNKNOWN, LoadSteps
from harness.model.result import Result, vertex_velocities
from harness.model.writing import replacing, write_whole

_SHOWN = 0.3
"""The fastest vertex of a drawn mechanism is moved by this part of the typical size of a block."""
_STEPS = 20
"""Files of a series that moves the mechanism from nothing to what is drawn."""


@dataclass(frozen=True, eq=False)
class _VtkStep:
    """One file of a series.

    Attributes:
        time: of the series; multiplier: of the live load, not a number where there is none.
        displacement: (k, 2) of the vertices of every block [length].
        forces: (m, 3) contact forces n1, n2, s [force]; states: (m,) places in `STATES`, or `UNKNOWN`.
    """

    time: float
    multiplier: float
    displacement: list[FloatArray]
    forces: FloatArray
    states: IntArray


def _velocities(assembly: Assembly, result: Result | None) -> list[FloatArray]:
    """Velocities (k, 2) of the vertices of every block, zero without a mechanism."""
    if result is None or result.mechanism is None:
        return [np.zeros_like(polygon) for polygon in assembly.polygons]
    return _by_blocks(assembly, np.asarray(result.mechanism, float))


def _by_blocks(assembly: Assembly, motions: FloatArray) -> list[FloatArray]:
    """Small motions (k, 2) of the vertices of every block from those of the blocks (n, 3)."""
    return [
        vertex_velocities(polygon, centroid, motion)
        for polygon, centroid, motion in zip(assembly.polygons, assembly.centroid, motions, strict=True)
    ]


def moved(assembly: Assembly, result: Result | None, part: float = 1.0) -> list[FloatArray]:
    """Polygons of the blocks displaced along the mechanism, as far as it is drawn."""
    scale = part * _SHOWN * assembly.length_scale
    return [p + scale * v for p, v in zip(assembly.polygons, _velocities(assembly, result), strict=True)]


def write_vtu(built: Built, result: Result | None, path: Path) -> None:
    """Blocks as polygons and joints as lines, for ParaView: velocity, displacement, forces and states."""
    assembly = built.assembly
    displacement = [_SHOWN * assembly.length_scale * v for v in _velocities(assembly, result)]
    _write(_mesh(built, result, _frame(assembly, result, 0.0, displacement)), path)


def _write(mesh: Any, path: Path) -> None:
    with replacing(path) as draft:
        mesh.write(draft, file_format="vtu", binary=True)


def _frame(assembly: Assembly, result: Result | None, time: float, displacement: list[FloatArray]) -> _VtkStep:
    """The frame of a wall with the forces and states of its answer."""
    m = assembly.n_interfaces
    given = None if result is None else result.forces
    known = None if result is None else result.states
    return _VtkStep(
        time=time,
        multiplier=np.nan if result is None or result.forces_multiplier is None else result.forces_multiplier,
        displacement=displacement,
        forces=np.zeros((m, 3)) if given is None else np.asarray(given, float),
        states=np.full(m, UNKNOWN) if known is None else np.array([STATES.index(state) for state in known]),
    )


def _mesh(built: Built, result: Result | None, frame: _VtkStep) -> Any:
    """The mesh of a wall in a frame, with the mechanism of its answer."""
    import meshio

    assembly = built.assembly
    bars, m = assembly.bars, assembly.n_interfaces
    polygons, joints = assembly.polygons, np.stack([assembly.face1, assembly.face2], axis=1)
    joints = np.concatenate([joints, np.stack([bars.end1, bars.end2], axis=1)])
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
    forces, states = frame.forces, frame.states
    fields: dict[str, tuple[Any, Any]] = {
        "number": (np.array(order), np.arange(len(joints))),
        "is_joint": (np.zeros(len(order), int), np.ones(len(joints), int)),
        "fixed": (assembly.fixed[order].astype(int), np.zeros(len(joints), int)),
        "weight": (assembly.weight[order], np.zeros(len(joints))),
        "n1": (np.zeros(len(order)), forces[:, 0]),
        "n2": (np.zeros(len(order)), forces[:, 1]),
        "s": (np.zeros(len(order)), forces[:, 2]),
        "state": (np.full(len(order), UNKNOWN), states),
        "multiplier": (np.full(len(order), frame.multiplier), np.full(len(joints), frame.multiplier)),
        "friction": (np.zeros(len(order)), assembly.friction),
    }
    for name, (of_blocks, of_joints) in fields.items():  # what joints alone have is zero at ties and props
        missing = len(joints) - len(of_joints)
        fields[name] = of_blocks, np.concatenate([of_joints, np.zeros(missing, np.asarray(of_joints).dtype)])
    if len(bars):
        tension = bar_tensions(assembly, result)
        of_bars = np.full(len(bars), np.nan) if tension is None else tension
        fields["is_joint"][1][m:] = 0
        fields["tension"] = np.full(len(order), np.nan), np.concatenate([np.full(m, np.nan), of_bars])
    margins = joint_margins(as_answered(assembly, result), built.joint_thickness, forces)
    for name in (
        "eccentricity",
        "shear_utilisation",
        "eccentricity_utilisation",
        "crushing_utilisation",
        "edge_stress",
    ):
        of_joints = np.concatenate([getattr(margins, name), np.full(len(bars), np.nan)])
        fields[name] = np.full(len(order), np.nan), of_joints
    if len(lines):
        cells.append(("line", lines))
    ends = np.cumsum(groups)[:-1]
    data = {
        name: [*np.split(np.asarray(blocks), ends), *([np.asarray(mine)] if len(lines) else [])]
        for name, (blocks, mine) in fields.items()
    }
    flat = np.zeros((len(points), 1))
    across = np.hstack([velocity, flat])
    shift = np.hstack([np.concatenate([*frame.displacement, np.zeros((2 * len(joints), 2))]), flat])
    return meshio.Mesh(
        np.hstack([points, flat]),
        cells,
        point_data={"velocity": across, "displacement": shift},
        cell_data=data,
    )


def write_pvd(built: Built, result: Result | None, path: Path) -> None:
    """A series of VTU files beside a .pvd, one a step.

    A collapse that was followed is the series of its states in its time [sqrt(length scale / gravity)]; load steps
    (`harness.model.load_steps`) are one file a step, with its forces and states, and the time is its number; else the
    mechanism grows, and the time is the part of what is drawn.
    """
    assembly = built.assembly
    rows = []
    for step, frame in enumerate(_frames(assembly, result)):
        name = f"{path.stem}-{step:03d}.vtu"
        _write(_mesh(built, result, frame), path.with_name(name))
        rows.append(f'    <DataSet timestep="{frame.time:.9g}" part="0" file={quoteattr(name)}/>')
    text = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
    write_whole(path, text + "\n".join(rows) + "\n  </Collection>\n</VTKFile>\n")


def _frames(assembly: Assembly, result: Result | None) -> Iterator[_VtkStep]:
    """The frames of the series that an answer has most to show in."""
    followed = None if result is None else released(result, assembly.n_blocks)
    steps = None if result is None else LoadSteps.of(result.details, assembly)
    if result is not None and followed is not None:
        times = result.path.get("time", [])
        if len(times) != len(followed):
            times = list(range(len(followed)))
        for time, places in zip(times, followed, strict=True):
            shift = [p - q for p, q in zip(carried(assembly, places), assembly.polygons, strict=True)]
            yield _frame(assembly, result, float(time), shift)
    elif steps is not None:
        for k, multiplier in enumerate(steps.multiplier.tolist()):
            shift = _by_blocks(assembly, steps.displacements[k])
            yield _VtkStep(float(k), multiplier, shift, steps.forces[k], steps.states[k])
    else:
        drawn = [_SHOWN * assembly.length_scale * v for v in _velocities(assembly, result)]
        for step in range(_STEPS + 1):
            yield _frame(assembly, result, step / _STEPS, [step / _STEPS * v for v in drawn])
