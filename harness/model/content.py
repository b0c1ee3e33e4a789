"""Hashes of walls: of what is written, and of what decides the mechanics however it is written."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.wall import Wall

_REMARKS = ("$schema", "comment", "title", "metadata", "doubts")
"""Fields of a wall that decide no answer."""
_STEP = 1.37e-6
"""Values are rounded to this part of their size. No round number of a drawing lies on the edge between two steps."""


def content_of(assembly: Assembly) -> str:
    """A hash of free blocks, interfaces, what joints bear, loads, settlements, bars; names, place, units apart.

    The order of blocks and interfaces does: walls that differ in it have different keys.
    Walls of one key are equal to a few millionths, and nearly all equal walls have one: it is a way to find a wall,
    and no proof that two are the same.
    """
    free = assembly.free
    number = np.full(assembly.n_blocks, -1)
    number[free] = np.arange(len(free))
    points = np.vstack([assembly.centroid[free], assembly.end1, assembly.end2])
    loads = np.hstack([assembly.dead[free, :2], assembly.live[free, :2]])
    load = float(abs(loads).max(initial=0.0)) or 1.0
    digest = hashlib.sha256()
    for joined in (number[assembly.block_a], number[assembly.block_b]):
        digest.update(np.asarray(joined, dtype="<i8").tobytes() + b";")
    origin = points.min(axis=0) if len(points) else 0.0
    besides = [(assembly.constant, load)] if assembly.strong else []
    if assembly.crushes:
        besides.append((np.where(np.isinf(assembly.crushing), -load, assembly.crushing), load))
    if assembly.breaks:
        besides.append((assembly.brittle.astype(float), 1.0))
    if np.any(assembly.support_motion):
        besides.append((assembly.support_motion, float(abs(assembly.support_motion).max())))
    bars = assembly.bars
    if len(bars):
        for joined in (number[bars.block_a], number[bars.block_b]):
            digest.update(np.asarray(joined, dtype="<i8").tobytes() + b";")
        besides.append((np.hstack([bars.end1 - origin, bars.end2 - origin]), assembly.length_scale))
        besides.append((np.column_stack([bars.prestress, bars.least, bars.greatest]), load))
        given = ~np.isnan(bars.stiffness)
        if given.any():
            besides.append((np.where(given, bars.stiffness, -1.0), load / assembly.length_scale))
    for values, size in (
        (points - origin, assembly.length_scale),
        (assembly.normal, 1.0),
        (assembly.friction, 1.0),
        (assembly.dilatancy, 1.0),
        (loads, load),
        *besides,
    ):
        digest.update(np.rint(values / (_STEP * size)).astype("<i8").tobytes() + b";")
    return digest.hexdigest()


def hash_of(wall: Wall) -> str:
    """A hash of all that is written of a wall and decides an answer: titles, remarks and doubts do not enter."""
    written = {name: value for name, value in wall.document().items() if name not in _REMARKS}
    return hashlib.sha256(json.dumps(written, sort_keys=True, allow_nan=False).encode()).hexdigest()


def exact_hash_of(assembly: Assembly) -> str:
    """A hash to the bit of all that an assembly holds but its name: of one that no written wall stands for alone.

    Whatever made it of a wall, and however that is changed, another assembly has another hash.
    """
    digest = hashlib.sha256()
    for each in fields(assembly):
        for part in () if each.name == "name" else _parts(getattr(assembly, each.name)):
            digest.update(part)
    return digest.hexdigest()


def _parts(value: Any) -> Iterator[bytes]:
    """A value as bytes that another does not have."""
    if isinstance(value, np.ndarray):
        yield f"{value.dtype.str}{value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, tuple):
        yield f"{len(value)}:".encode()
        for each in value:
            yield from _parts(each)
    elif is_dataclass(value):
        for field in fields(value):
            yield from _parts(getattr(value, field.name))
    else:
        yield f"{value!r};".encode()
