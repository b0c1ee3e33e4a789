"""What a person should hear about a wall that can be computed, but may not be the one that was meant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.errors import MOST_NAMED, InputError, first_few
from harness.model.geometry import distances_beyond
from harness.model.load_fields import Load, Loads

_BESIDE = 0.05
"""Distance from its block, in typical block sizes, beyond which a point force or an interface is worth a warning."""
_ASTRAY = 0.5
"""Distance from its blocks, in typical block sizes, beyond which a given interface is refused."""
_SHORT = 1e-3
"""Length of an interface, in typical block sizes, below which it is worth a warning."""

NEAR_MISS = "face each other"
"""Words of a near miss, by which its sentence is known."""


def contact_warnings(assembly: Assembly, corners: IntArray, size: float) -> list[str]:
    """Sentences about contacts at corners, pairs (k, 2) of blocks, and about very short interfaces."""
    sentences = []
    corners = _unbonded(assembly, corners)
    if len(corners):
        shown = first_few([f"{assembly.block_ids[a]}/{assembly.block_ids[b]}" for a, b in corners], 5)
        sentences.append(f"{len(corners)} pair(s) of blocks touch only at a corner, which gives no support: {shown}")
    short = np.flatnonzero(assembly.length < _SHORT * size)
    if len(short):
        p = short[int(np.argmin(assembly.length[short]))]
        sentences.append(
            f"{len(short)} interface(s) are shorter than a thousandth of a block; the shortest, between "
            f"{' and '.join(_blocks_of(assembly, p))}, is {assembly.length[p]:.3g} long: results may depend on it"
        )
    return sentences


def _unbonded(assembly: Assembly, corners: IntArray) -> IntArray:
    """Pairs (k, 2) at a corner that no third block joins: where four bricks meet, the bond holds the corner."""
    neighbours: dict[int, set[int]] = {}
    for a, b in zip(assembly.block_a.tolist(), assembly.block_b.tolist(), strict=True):
        neighbours.setdefault(a, set()).add(b)
        neighbours.setdefault(b, set()).add(a)
    alone = [not neighbours.get(a, set()) & neighbours.get(b, set()) for a, b in corners.tolist()]
    return np.asarray(corners[np.array(alone, dtype=bool)])


def span(values: FloatArray) -> str:
    """The least and the greatest of some numbers (k,), or the one that all are, in three digits."""
    least, greatest = f"{values.min():.3g}", f"{values.max():.3g}"
    return least if least == greatest else f"{least} to {greatest}"


def saying(tolerance: float) -> str:
    """How a file says a tolerance."""
    return f'"interfaces": {{"tolerance": {tolerance:.3g}}} (--tolerance of a drawing)'


def allowing(gap: float) -> str:
    """What a file says so that faces this far apart have a joint."""
    return saying(1.02 * gap)


def near_misses(names: Sequence[str], pairs: IntArray, gaps: FloatArray, greatest: float) -> list[str]:
    """A sentence about pairs (k, 2) of blocks whose faces face each other and have no joint.

    Args:
        names: of the blocks; pairs: (k, 2); gaps: (k,) between them [length]; greatest: gap of a joint [length].
    """
    if not len(pairs):
        return []
    order = np.argsort(gaps, kind="stable")
    shown = first_few([f"{names[pairs[k, 0]]}/{names[pairs[k, 1]]} ({gaps[k]:.3g})" for k in order.tolist()], 5)
    return [
        f"{len(pairs)} pair(s) of faces {NEAR_MISS} {span(gaps)} apart, or overlap by as "
        f"much, and have no joint, because joints are up to {greatest:.3g} wide: {shown}. If they are in contact, the "
        f"answer changes: write {allowing(gaps.max())}"
    ]


def interface_warnings(assembly: Assembly, size: float, first: int = 0) -> list[str]:
    """A sentence about given interfaces, from number `first` on, whose ends lie off their blocks, as over mortar.

    Raises:
        InputError: an end of one lies too far off.
    """
    off = np.zeros(assembly.n_interfaces)
    for block in (assembly.block_a, assembly.block_b):
        for end in (assembly.face1, assembly.face2):
            off = np.maximum(off, distances_beyond(assembly.polygons, block, end, _BESIDE * size))
    off[:first] = 0.0
    if off.max(initial=0.0) > _ASTRAY * size:
        number = int(np.argmax(off))
        raise InputError(
            f"an end of it lies {off[number]:.3g} away from one of its blocks, whose typical size is {size:.3g}",
            'Let "from" and "to" lie on the faces that touch',
            f"interfaces[{number - first}] between {' and '.join(_blocks_of(assembly, number))}",
        )
    beside = np.flatnonzero(off > _BESIDE * size).tolist()
    if not beside:
        return []
    shown = first_few(
        [f"interfaces[{number - first}] ({'/'.join(_blocks_of(assembly, number))})" for number in beside], 5
    )
    return [f"{len(beside)} interface(s) end up to {off.max():.3g} away from a block: a gap, or a coordinate? {shown}"]


def force_warnings(assembly: Assembly, loads: Loads, size: float) -> list[str]:
    """Sentences about point forces that act beside their block."""
    sentences = []
    index = {name: k for k, name in enumerate(assembly.block_ids)}
    for where, load in (("loads.dead", loads.dead), ("loads.live", loads.live or Load())):
        blocks = np.array([index[point.block] for point in load.points], dtype=np.int64)
        places = np.array([point.at for point in load.points], dtype=float).reshape(-1, 2)
        off = distances_beyond(assembly.polygons, blocks, places, _BESIDE * size)
        beside = np.flatnonzero(off).tolist()
        sentences += [
            f'{where}.points[{number}] acts {off[number]:.3g} away from block "{load.points[number].block}": an arm, '
            "or a coordinate?"
            for number in beside[:MOST_NAMED]
        ]
        if len(beside) > MOST_NAMED:
            sentences.append(f"{where}.points: {len(beside) - MOST_NAMED:,} more act away from their blocks")
    return sentences


def _blocks_of(assembly: Assembly, interface: int) -> tuple[str, str]:
    return assembly.block_ids[assembly.block_a[interface]], assembly.block_ids[assembly.block_b[interface]]
