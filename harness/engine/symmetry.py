"""The same wall seen otherwise: mirrored, moved, turned, scaled, re-ordered. Its multiplier must not change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from harness.model.assembly import OF_BLOCKS, Assembly, FloatArray


def _mapped(assembly: Assembly, matrix: FloatArray, shift: FloatArray, length: float, flip: bool) -> Assembly:
    """The wall under x -> length * matrix x + shift; `flip` where the matrix reverses orientation."""

    def place(points: FloatArray) -> FloatArray:
        return np.asarray(length * points @ matrix.T + shift)

    sign = -1.0 if flip else 1.0

    def load(values: FloatArray) -> FloatArray:
        return np.column_stack([values[:, :2] @ matrix.T, sign * length * values[:, 2]])

    def motion(values: FloatArray) -> FloatArray:
        return np.column_stack([length * values[:, :2] @ matrix.T, sign * values[:, 2]])

    bars = assembly.bars
    return replace(
        assembly,
        polygons=tuple(place(polygon)[::-1] if flip else place(polygon) for polygon in assembly.polygons),
        centroid=place(assembly.centroid),
        end1=place(assembly.end1),
        end2=place(assembly.end2),
        face1=place(assembly.face1),
        face2=place(assembly.face2),
        normal=assembly.normal @ matrix.T,
        dead=load(assembly.dead),
        live=load(assembly.live),
        support_motion=motion(assembly.support_motion),
        bars=replace(bars, end1=place(bars.end1), end2=place(bars.end2), stiffness=bars.stiffness / length),
    )


def mirrored(assembly: Assembly) -> Assembly:
    """Left becomes right."""
    return _mapped(assembly, np.diag([-1.0, 1.0]), np.zeros(2), 1.0, True)


def _translated(assembly: Assembly) -> Assembly:
    """Moved by some block sizes."""
    return _mapped(assembly, np.eye(2), assembly.length_scale * np.array([7.3, -4.1]), 1.0, False)


def turned(assembly: Assembly, angle: float) -> Assembly:
    """The whole problem, loads included, turned by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return _mapped(assembly, np.array([[c, -s], [s, c]]), np.zeros(2), 1.0, False)


def _rotated(assembly: Assembly) -> Assembly:
    """The whole problem, loads included, turned by 0.7 rad."""
    return turned(assembly, 0.7)


def _scaled(assembly: Assembly) -> Assembly:
    """A thousand times as large, as if drawn in millimetres."""
    return _mapped(assembly, np.eye(2), np.zeros(2), 1000.0, False)


def _heavier(assembly: Assembly) -> Assembly:
    """All loads and strengths 250 times as great."""
    forces = ("weight", "dead", "live", "constant", "crushing")
    of_bars = ("prestress", "least", "greatest", "stiffness")
    bars = replace(assembly.bars, **{name: 250.0 * getattr(assembly.bars, name) for name in of_bars})
    return replace(assembly, bars=bars, **{name: 250.0 * getattr(assembly, name) for name in forces})


def renumbered(assembly: Assembly, seed: int = 1) -> Assembly:
    """Blocks and interfaces in another order, and the two sides of every second interface exchanged."""
    rng = np.random.default_rng(seed)
    blocks = rng.permutation(assembly.n_blocks)
    place = np.argsort(blocks)
    joints = rng.permutation(assembly.n_interfaces)
    swap = np.arange(assembly.n_interfaces) % 2 == 1
    a, b = place[assembly.block_a[joints]], place[assembly.block_b[joints]]
    wall = assembly.with_joints(joints)
    return replace(
        wall,
        block_ids=tuple(assembly.block_ids[k] for k in blocks),
        polygons=tuple(assembly.polygons[k] for k in blocks),
        **{name: getattr(assembly, name)[blocks] for name in OF_BLOCKS if name != "polygons"},
        block_a=np.where(swap, b, a),
        block_b=np.where(swap, a, b),
        normal=np.where(swap[:, None], -1.0, 1.0) * wall.normal,
        constant=np.where(swap[:, None], wall.constant[:, [0, 1, 3, 2]], wall.constant),
        bars=assembly.bars.chosen(rng.permutation(len(assembly.bars)), place),
    )


VIEWS: dict[str, Callable[[Assembly], Assembly]] = {
    "mirrored": mirrored,
    "translated": _translated,
    "rotated": _rotated,
    "scaled": _scaled,
    "heavier": _heavier,
    "renumbered": renumbered,
}
"""Every view, by name."""
