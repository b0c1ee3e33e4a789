"""Whether the wall in a certificate is a given wall: the same blocks, loads, interfaces and friction."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from methods.bound.exact_wall import CertificateError
from methods.bound.tuning import ROUNDING


def require_same_wall(document: Any, assembly: Assembly) -> None:
    """Refuse a certificate that is of another wall; whether it proves anything is for `verify`.

    Loads may have another unit, the same for dead and live load: the multiplier does not depend on it.

    Args:
        document: the certificate.
        assembly: the wall it is said to be of.

    Raises:
        CertificateError: naming the first thing that differs.
    """
    try:
        _compare_blocks(document["blocks"], assembly)
        _compare_interfaces(document["interfaces"], assembly)
    except (KeyError, TypeError, ValueError, ZeroDivisionError, AttributeError, IndexError, OverflowError) as error:
        if isinstance(error, CertificateError):
            raise
        raise CertificateError(str(error)) from error


def _compare_blocks(blocks: Any, assembly: Assembly) -> None:
    free = assembly.free
    ids = [assembly.block_ids[i] for i in free]
    if [block["id"] for block in blocks] != ids:
        raise CertificateError("it is of another wall: the free blocks are not the same")
    _require("centroids", _numbers([block["centroid"] for block in blocks]), assembly.centroid[free])
    given = _numbers([[*block["dead"], *block["live"]] for block in blocks])
    loads = np.hstack([assembly.dead[free], assembly.live[free]])
    unit = float(np.abs(loads).max()) / float(np.abs(given).max())
    for name, columns in (("dead loads", slice(0, 3)), ("live loads", slice(3, 6))):
        _require(name, unit * given[:, columns], loads[:, columns])


def _compare_interfaces(items: Any, assembly: Assembly) -> None:
    if assembly.dilates:
        raise CertificateError("it is of a wall without dilatancy, and joints of this one lift as they slide")
    place = {int(block): k for k, block in enumerate(assembly.free)}
    joined = [[place.get(int(a)), place.get(int(b))] for a, b in zip(assembly.block_a, assembly.block_b, strict=True)]
    if [[item["a"], item["b"]] for item in items] != joined:
        raise CertificateError("it is of another wall: the interfaces do not join the same blocks")
    _require(
        "ends of interfaces", _numbers([item["ends"] for item in items]), np.hstack([assembly.end1, assembly.end2])
    )
    tangent, normal = assembly.tangent, assembly.normal
    side = np.sign(tangent[:, 0] * normal[:, 1] - tangent[:, 1] * normal[:, 0])
    _require("sides of interfaces", _numbers([[item["side"]] for item in items])[:, 0], side)
    _require("friction", _numbers([[item["friction"]] for item in items])[:, 0], assembly.friction)


def _numbers(rows: list[list[Any]]) -> FloatArray:
    return np.array([[float(Fraction(str(value))) for value in row] for row in rows])


def _require(name: str, given: FloatArray, wanted: FloatArray) -> None:
    if given.shape != wanted.shape or not np.allclose(
        given, wanted, rtol=0.0, atol=ROUNDING.wall * max(1e-300, _size(wanted))
    ):
        raise CertificateError(f"it is of another wall: the {name} are not the same")


def _size(values: FloatArray) -> float:
    return float(np.abs(values).max()) if values.size else 0.0
