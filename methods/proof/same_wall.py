"""Whether the wall in a certificate is a given wall: the same blocks, loads, interfaces and friction.

A number of the certificate is that of the wall if both differ, in fractions, by next to nothing of what the number
belongs to: the size of the block for its centroid, the length of the interface for its ends, the load of the block for
that, the friction itself. So no number counts as the same because another is large: no coordinate far from the origin,
no heavy block elsewhere.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from methods.proof.verify.exact_wall import CertificateError, fractions_of, number, refusal_of

SAME_NUMBER = 1e-11
"""Difference of a number in a certificate from that of the wall, relative to what it belongs to: short fractions lie
within 1e-13 of the float they were read from, and loads are once divided by a unit besides."""


def require_same_wall(document: Any, assembly: Assembly) -> None:
    """Refuse a certificate that is of another wall; whether it proves anything is for `verify`.

    Loads may have another unit, the same for dead and live load: the multiplier does not depend on it.

    Args:
        document: the certificate.
        assembly: the wall it is said to be of.

    Raises:
        CertificateError: naming the first thing that differs.
    """
    _require_dry(assembly)
    try:
        _compare_blocks(document["blocks"], assembly)
        _compare_interfaces(document["interfaces"], assembly)
    except (KeyError, TypeError, ValueError, ZeroDivisionError, AttributeError, IndexError, OverflowError) as error:
        raise refusal_of(error) from error


def _require_dry(assembly: Assembly) -> None:
    """Refuse a wall that no certificate can describe: its joints are dry, do not dilate, and its supports rest.

    A certificate holds the ends of an interface and a side: its normal is across the ends.
    """
    if assembly.dilates:
        raise CertificateError("it is of a wall without dilatancy, and joints of this one have dilatancy")
    if assembly.crushes or not assembly.law.dry.all():
        raise CertificateError("it is of a wall with dry joints, and joints of this one have strength of their own")
    if len(assembly.bars):
        raise CertificateError("it is of a wall without ties and props, and this one has some")
    if np.any(assembly.support_motion):
        raise CertificateError("it is of a wall whose supports rest, and supports of this one move")
    across = np.abs((assembly.tangent * assembly.normal).sum(axis=1))
    if not np.all(across <= SAME_NUMBER):
        raise CertificateError("it is of another wall: the normals of the interfaces are not the same")


def _compare_blocks(blocks: Any, assembly: Assembly) -> None:
    free = assembly.free
    ids = [assembly.block_ids[i] for i in free]
    if [block["id"] for block in blocks] != ids:
        raise CertificateError("it is of another wall: the free blocks are not the same")
    sizes = block_sizes(assembly)[free]
    for block, centroid, size in zip(blocks, assembly.centroid[free], sizes, strict=True):
        _require("centroids", fractions_of(block["centroid"], 2), centroid, size)
    unit = _unit_of_loads(blocks, np.hstack([assembly.dead[free], assembly.live[free]]))
    for name, loads in (("dead", assembly.dead[free]), ("live", assembly.live[free])):
        for block, load, size in zip(blocks, loads, sizes, strict=True):
            given = [unit * value for value in fractions_of(block[name], 3)]
            _require(f"{name} loads", given, load, load_sizes(load, size))


def _unit_of_loads(blocks: Any, loads: FloatArray) -> Fraction:
    """What a load of the certificate is multiplied with, from the largest of all."""
    i, k = np.unravel_index(np.abs(loads).argmax(), loads.shape)
    given = [*fractions_of(blocks[i]["dead"], 3), *fractions_of(blocks[i]["live"], 3)]
    largest = Fraction(float(loads[i, k]))
    if largest * given[k] <= 0:
        raise CertificateError("it is of another wall: the loads are not the same")
    return largest / given[k]


def _compare_interfaces(items: Any, assembly: Assembly) -> None:
    place = {int(block): k for k, block in enumerate(assembly.free)}
    joined = [[place.get(int(a)), place.get(int(b))] for a, b in zip(assembly.block_a, assembly.block_b, strict=True)]
    if [[item["a"], item["b"]] for item in items] != joined:
        raise CertificateError("it is of another wall: the interfaces do not join the same blocks")
    ends, tangent, normal = np.hstack([assembly.end1, assembly.end2]), assembly.tangent, assembly.normal
    sides = np.sign(tangent[:, 0] * normal[:, 1] - tangent[:, 1] * normal[:, 0])
    lengths = interface_lengths(assembly)
    for item, end, length, side, mu in zip(items, ends, lengths, sides, assembly.friction, strict=True):
        _require("ends of interfaces", fractions_of(item["ends"], 4), end, length)
        _require("sides of interfaces", [number(item["side"])], side[None], 0.0)
        _require("friction", [number(item["friction"])], mu[None], mu)


def block_sizes(assembly: Assembly) -> FloatArray:
    """(n,) distances of the farthest vertex of every block from its centroid."""
    pairs = zip(assembly.polygons, assembly.centroid, strict=True)
    return np.array([np.linalg.norm(polygon - centroid, axis=1).max() for polygon, centroid in pairs])


def interface_lengths(assembly: Assembly) -> FloatArray:
    """(m,) distances of the two ends of every interface."""
    return np.asarray(np.linalg.norm(assembly.end2 - assembly.end1, axis=1))


def load_sizes(load: FloatArray, size: float) -> FloatArray:
    """(3,) what the forces and the moment of the load of a block of this size are measured by."""
    force = max(abs(load[0]), abs(load[1]), abs(load[2]) / size)
    return np.array([force, force, force * size])


def same_number(given: Fraction, wanted: float, size: float, part: float) -> bool:
    """Whether a fraction differs from a float by at most this part of a size."""
    return abs(given - Fraction(wanted)) <= Fraction(part) * Fraction(size)


def _require(name: str, given: list[Fraction], wanted: FloatArray, sizes: FloatArray | float) -> None:
    numbers = zip(given, wanted.tolist(), np.broadcast_to(sizes, wanted.shape).tolist(), strict=True)
    if not all(same_number(value, float_value, size, SAME_NUMBER) for value, float_value, size in numbers):
        raise CertificateError(f"it is of another wall: the {name} are not the same")
