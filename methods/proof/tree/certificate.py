"""A certificate that a state is the least, in fractions, from the leaves of a tree.

Linear programmes find for every leaf the velocities or forces that exclude it; their vertices are solved for in
fractions. What is written is what `methods/proof/verify/checker.py` accepts, which shares nothing with this.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, BoolArray, FloatArray
from methods.numerics.failures import NumericalFailure
from methods.numerics.linear_programme import INFINITY, Programme
from methods.numerics.vertex import BASIC
from methods.proof.same_wall import block_sizes, interface_lengths, load_sizes, same_number
from methods.proof.tree.sparse_fractions import DENOMINATOR, Row, solve_sparse
from methods.proof.verify.checker import check_state, verify
from methods.proof.verify.document import FORMAT, digest
from methods.proof.verify.exact_wall import CertificateError, ExactWall

_SHORT = 1e-13
"""Difference of a short fraction from the float that stands for it, relative to what it belongs to: a hundredth of
what a certificate may differ by from its wall."""


_BELOW = Fraction(2, 10**6)
"""Relative distance of the certified bound below the state: twice what the tree closes to."""


def tree_certificate(
    assembly: Assembly,
    unit: float,
    least: tuple[float, BoolArray],
    leaves: Iterable[tuple[BoolArray, BoolArray]],
    end: float,
) -> dict[str, Any] | None:
    """The certificate of a wall from what a tree has found; None where it does not exist in fractions.

    Args:
        assembly: the wall, whose numbers must be short fractions.
        unit: of force [force].
        least: the least state: multiplier, and (m, 4) contacts in which it moves.
        leaves: slacks held at zero and rates held at zero, (m, 4) each, of every part of the tree.
        end: CPU time of this process [s] after which no further leaf is begun, and there is no certificate.
    """
    try:
        document = wall_document(assembly, unit)
        wall = Fractions(document)
        upper, state = with_state(document, *least)
        bound = upper * (1 - _BELOW)
        proved: list[dict[str, Any]] = []
        for tight, still in leaves:
            proved += _leaves(wall, bound, (tight.ravel(), still.ravel()), end)
        document |= state | {"bound": str(bound), "leaves": proved}
        document["digest"] = digest(document)
        verify(document)
    except (ArithmeticError, CertificateError):
        return None
    return document


def with_state(document: dict[str, Any], multiplier: float, moving: BoolArray) -> tuple[Fraction, dict[str, Any]]:
    """Multiplier and state of a certificate, in fractions; where they do not exist so, the multiplier of floats alone.

    Args:
        document: the part of a certificate that says which wall it is of.
        multiplier: of the state in floats; moving: (m, 4) contacts in which it moves.
    """
    try:
        exact, state = exact_state(Fractions(document), moving.ravel())
        check_state(ExactWall(document), exact, state)
    except (ArithmeticError, CertificateError):
        return Fraction(multiplier), {}
    return exact, {"multiplier": str(exact), "state": state}


def wall_document(assembly: Assembly, unit: float) -> dict[str, Any]:
    """The part of a certificate that says which wall it is of, with loads in this unit of force."""
    place = {int(block): k for k, block in enumerate(assembly.free)}

    def text(values: FloatArray, sizes: FloatArray) -> list[str]:
        return [str(_exact(*pair)) for pair in zip(values.tolist(), np.broadcast_to(sizes, values.shape), strict=True)]

    size = block_sizes(assembly)
    blocks = [
        {
            "id": assembly.block_ids[i],
            "centroid": text(assembly.centroid[i], size[i]),
            "dead": text(assembly.dead[i] / unit, load_sizes(assembly.dead[i] / unit, size[i])),
            "live": text(assembly.live[i] / unit, load_sizes(assembly.live[i] / unit, size[i])),
        }
        for i in assembly.free
    ]
    length = interface_lengths(assembly)
    interfaces = []
    for p in range(assembly.n_interfaces):
        tangent, normal = assembly.tangent[p], assembly.normal[p]
        side = 1 if tangent[0] * normal[1] - tangent[1] * normal[0] > 0 else -1
        interfaces.append(
            {
                "a": place.get(int(assembly.block_a[p])),
                "b": place.get(int(assembly.block_b[p])),
                "ends": text(np.concatenate([assembly.end1[p], assembly.end2[p]]), length[p]),
                "side": side,
                "friction": str(_exact(float(assembly.friction[p]), float(assembly.friction[p]))),
            }
        )
    return {"format": FORMAT, "wall": assembly.name, "blocks": blocks, "interfaces": interfaces}


def _exact(value: float, size: float) -> Fraction:
    """The short fraction that a float was written as, or the binary fraction that it is.

    Args:
        value: the float.
        size: what it is small against where it is rounding: of the block, its load, or the length of the interface.
    """
    short = Fraction(value).limit_denominator(DENOMINATOR)
    return short if same_number(short, value, size, _SHORT) else Fraction(value)


class Fractions:
    """Strain rows as sparse fractions, for unit normals times the length of the interface."""

    def __init__(self, document: dict[str, Any]) -> None:
        self.dead = [Fraction(x) for block in document["blocks"] for x in block["dead"]]
        self.live = [Fraction(x) for block in document["blocks"] for x in block["live"]]
        self.friction = [Fraction(item["friction"]) for item in document["interfaces"]]
        centroid = [[Fraction(x) for x in block["centroid"]] for block in document["blocks"]]
        self.rows: list[Row] = []
        for item in document["interfaces"]:
            x1, y1, x2, y2 = (Fraction(x) for x in item["ends"])
            dx, dy, side = x2 - x1, y2 - y1, item["side"]
            for x, y, vx, vy in (
                (x1, y1, -side * dy, side * dx),
                (x2, y2, -side * dy, side * dx),
                ((x1 + x2) / 2, (y1 + y2) / 2, dx, dy),
            ):
                row: Row = {}
                for block, sense in ((item["a"], -1), (item["b"], 1)):
                    if block is not None:
                        lever = (x - centroid[block][0]) * vy - (y - centroid[block][1]) * vx
                        row |= {3 * block: sense * vx, 3 * block + 1: sense * vy, 3 * block + 2: sense * lever}
                self.rows.append({k: value for k, value in row.items() if value})


Limits = tuple[Fraction | None, Fraction | None]


ZERO, ONE = Fraction(0), Fraction(1)


_EQUAL: Limits = (ZERO, ZERO)


_POSITIVE: Limits = (ZERO, None)


_NEGATIVE: Limits = (None, ZERO)


_ENOUGH = Fraction(1000)
"""Work of the loads at the bound, in that of the dead load, that no leaf needs more of: it may have no limit."""


def exact_state(wall: Fractions, moving: BoolArray) -> tuple[Fraction, dict[str, Any]]:
    """Multiplier, forces and velocities of the collapse state that moves in these contacts (4m,).

    Raises:
        ArithmeticError: there is none in fractions.
    """
    m = len(wall.friction)
    rows: list[tuple[Row, Limits]] = [
        (row, (-dead, -dead)) for row, dead in zip(_balance(wall, {3 * m: wall.live}), wall.dead, strict=True)
    ]
    for p, mu in enumerate(wall.friction):
        a, b, s = 3 * p, 3 * p + 1, 3 * p + 2
        slacks: list[Row] = [{a: ONE}, {b: ONE}, {a: mu, b: mu, s: ONE}, {a: mu, b: mu, s: -ONE}]
        rows += [(slack, _EQUAL if moving[4 * p + k] else _POSITIVE) for k, slack in enumerate(slacks)]
    forces = _vertex(rows, 3 * m + 1, {3 * m: ONE})
    rows = [(_sparse(wall.live), (ONE, ONE))]
    for p in range(m):
        open1, open2, slip = wall.rows[3 * p : 3 * p + 3]
        rows += [(row, _POSITIVE if moving[4 * p + k] else _EQUAL) for k, row in enumerate((open1, open2))]
        forward, back = moving[4 * p + 2], moving[4 * p + 3]
        rows.append((slip, _POSITIVE if forward and not back else _NEGATIVE if back and not forward else _EQUAL))
    velocities = _vertex(rows, len(wall.dead), {})
    return forces[3 * m], {"forces": _text(forces[: 3 * m]), "velocities": _text(velocities)}


def _leaves(wall: Fractions, bound: Fraction, held: tuple[BoolArray, BoolArray], end: float) -> list[dict[str, Any]]:
    """A leaf, or the leaves that it is divided into where it has no proof in fractions.

    What is degenerate in floats may be neither forces nor mechanisms in fractions. A half holds one contact more, so
    more is a proof of it. It is divided where one half has a proof, and the other half in turn.

    Args:
        wall: in fractions; bound: that is to be proved.
        held: (4m,) contacts without slack, and without rate.
        end: CPU time of this process [s] after which no further leaf is begun.

    Raises:
        ArithmeticError: no half has a proof in fractions, or the time is over.
    """
    if time.process_time() > end:
        raise ArithmeticError("the time is over")
    try:
        return [_leaf(wall, bound, *held)]
    except ArithmeticError:
        for half, other in _halves(*held):
            try:
                proved = _leaf(wall, bound, *half)
            except ArithmeticError:
                continue
            return [proved, *_leaves(wall, bound, other, end)]
        raise


def _halves(tight: BoolArray, still: BoolArray) -> Iterator[tuple[tuple[BoolArray, BoolArray], ...]]:
    """Both halves of a leaf, in either order, for every contact at which it may be divided."""
    for contact in np.flatnonzero(~(tight | still)):
        one = np.arange(len(tight)) == contact
        halves = (tight | one, still), (tight, still | one)
        yield halves
        yield halves[::-1]


def _leaf(wall: Fractions, bound: Fraction, tight: BoolArray, still: BoolArray) -> dict[str, Any]:
    """A leaf with the velocities that exclude its forces, or the forces that exclude its mechanisms."""
    contacts: dict[str, Any] = {"tight": np.flatnonzero(tight).tolist(), "still": np.flatnonzero(still).tolist()}
    try:
        return contacts | {"velocities": _text(_velocities(wall, bound, tight))}
    except ArithmeticError:
        forces = _forces(wall, bound, still)
        return contacts | {"forces": _text(forces[:-2]), "parts": _text(forces[-2:])}


def _velocities(wall: Fractions, bound: Fraction, tight: BoolArray) -> list[Fraction]:
    """Velocities on which forces of a leaf do no positive work, and the loads negative work from zero to the bound.

    The work of the dead load is -1, and that of the loads at the bound as far below zero as it may be.
    """
    n = len(wall.dead)
    at_zero = _sparse([-d for d in wall.dead])
    at_bound = _sparse([-d - bound * f for d, f in zip(wall.dead, wall.live, strict=True)])
    rows: list[tuple[Row, Limits]] = [(at_zero, (ONE, ONE)), (at_bound, _POSITIVE), (at_bound, (None, _ENOUGH))]
    for p, mu in enumerate(wall.friction):
        open1, open2, slip = wall.rows[3 * p : 3 * p + 3]
        back = {k: -value for k, value in slip.items()}
        for k, (row, weight) in enumerate(((open1, -mu), (open2, -mu), (slip, ONE), (back, ONE))):
            if not tight[4 * p + k]:
                rows.append((row | {n + p: weight}, _NEGATIVE))
    return _vertex(rows, n + len(wall.friction), {k: -value for k, value in at_bound.items()})[:n]


def _forces(wall: Fractions, bound: Fraction, still: BoolArray) -> list[Fraction]:
    m = len(wall.friction)
    dead = [d + bound * f for d, f in zip(wall.dead, wall.live, strict=True)]
    rows = [(row, _EQUAL) for row in _balance(wall, {3 * m: dead, 3 * m + 1: wall.live})]
    rows += [({3 * m: ONE}, _POSITIVE), ({3 * m + 1: ONE}, _POSITIVE), ({3 * m: ONE, 3 * m + 1: ONE}, (ONE, ONE))]
    for p in range(m):
        for k, (column, sign) in enumerate(((0, ONE), (1, ONE), (2, ONE), (2, -ONE))):
            if not still[4 * p + k]:
                rows.append(({3 * p + column: sign}, _POSITIVE))
    return _vertex(rows, 3 * m + 2, {3 * m: -ONE})


def _balance(wall: Fractions, loads: dict[int, list[Fraction]]) -> list[Row]:
    """Rows of C' r plus further columns of loads."""
    rows: list[Row] = [{} for _ in wall.dead]
    for k, strain in enumerate(wall.rows):
        for dof, value in strain.items():
            rows[dof][k] = value
    for column, load in loads.items():
        for dof, value in enumerate(load):
            if value:
                rows[dof][column] = value
    return rows


def _vertex(rows: list[tuple[Row, Limits]], count: int, cost: Row) -> list[Fraction]:
    """An optimal vertex of free columns in fractions.

    Raises:
        ArithmeticError: the programme has none, or its basis is not one in fractions.
    """
    entries = [(i, k, float(value)) for i, (row, _) in enumerate(rows) for k, value in row.items()]
    i, k, values = zip(*entries, strict=True)
    matrix = sp.csc_matrix((values, (i, k)), shape=(len(rows), count))
    weights = np.zeros(count)
    for column, value in cost.items():
        weights[column] = float(value)
    lower = np.array([-INFINITY if low is None else float(low) for _, (low, _) in rows])
    upper = np.array([INFINITY if high is None else float(high) for _, (_, high) in rows])
    programme = Programme(matrix, weights, (np.full(count, -INFINITY), np.full(count, INFINITY)), (lower, upper))
    status, point, _ = programme.run()
    if status != "optimal":
        raise NumericalFailure(f"the programme is {status}")
    basis = programme.highs.getBasis()
    fixed = {k for k, state in enumerate(basis.col_status) if int(state) != BASIC}
    equations: list[Row] = []
    right: list[Fraction] = []
    for slack, ((row, (low, high)), state) in enumerate(zip(rows, basis.row_status, strict=True), start=count):
        if int(state) == BASIC and low != high:
            continue
        equation = {k: value for k, value in row.items() if k not in fixed}
        if low != high:
            equation[slack] = -ONE if low is not None else ONE
        equations.append(equation)
        right.append((low if low is not None else high) or ZERO)
    solution = solve_sparse(equations, right, point)
    vertex = [ZERO if k in fixed else solution.get(k, ZERO) for k in range(count)]
    for row, (low, high) in rows:
        value = sum((entry * vertex[k] for k, entry in row.items()), ZERO)
        if (low is not None and value < low) or (high is not None and value > high):
            raise ArithmeticError("a vertex in floats is none in fractions")
    return vertex


def _sparse(values: list[Fraction]) -> Row:
    return {k: value for k, value in enumerate(values) if value}


def _text(values: list[Fraction]) -> list[str]:
    return [str(value) for value in values]
