"""The greatest multiplier of statics where joints crush: linear programmes by tangents and by chords, and the gap.

A joint with the compressive strength f_c presses on a part of its depth by f_c, the rectangular stress block, so that
n_i + T/2 >= F^2 / (2 F0) at both ends i, with F = n1 + n2 + T and F0 = f_c A + T (Orduna and Lourenco 2003). The line
through the points of this parabola at forces a and b,

    n_i + T/2 >= ((a + b) F - a b) / (2 F0),

is its tangent for a = b: tangents leave a linear programme with too great a multiplier, and a chain of chords one with
too small a multiplier, whose forces are within the parabolas. The forces that the first leads to become further points
of both (Kelley 1960), until the two agree. The duals of either are a mechanism of associated flow, in which a joint
turns about the edge of its pressed part. By virtual work with the exact law its multiplier bounds the true one from
above, so that the gap to the forces is known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray, IntArray
from methods.numerics.shear_rows import COST, least_shear_slacks, rows_of_blocks, shear_limits

_FIRST = (0.125, 0.25, 0.5)
"""Shares of F0 that both programmes begin with, besides 0 and 1."""
_GAP = 1e-10
"""Of the two multipliers, relative to their size or to the load unit, at which they agree to rounding."""
_EXACT = 1e-6
"""The same from which on vertices are computed to rounding instead of as HiGHS gives them."""
_NEW = 1e-13
"""Distance of a further point from those there are, as a share of F0."""
_ROUNDS = 40
"""Of added points, at most. Each squares the gap, or quarters it where a hinge lies between two points."""


@dataclass(frozen=True, eq=False)
class BlockLimit:
    """The greatest multiplier of a load beside a dead one.

    Attributes:
        outcome: "optimal", "infeasible" (no multiplier is borne), "unbounded" or "unknown".
        multiplier: borne by `forces` (m, 3) [force]; upper: that of `mechanism` (n, 3) by virtual work.
        rounds: of added points.
        inaccurate: the solver ended without its own accuracy, and what it found is only as good as it is checked.
    """

    outcome: str
    multiplier: float = float("nan")
    forces: FloatArray | None = None
    mechanism: FloatArray | None = None
    upper: float = float("nan")
    rounds: int = 0
    inaccurate: bool = False


Greatest = Callable[[Assembly, FloatArray, FloatArray, float], BlockLimit]
"""Solves for the greatest multiplier of a live load (n, 3) beside a dead one (n, 3), up to the one that is given."""


def crushing_force(assembly: Assembly) -> tuple[IntArray, FloatArray]:
    """The interfaces that crush (k,), and their F0 = f_c A + T (k,) [force]."""
    joints = np.flatnonzero(np.isfinite(assembly.crushing))
    return joints, assembly.crushing[joints] + 2.0 * assembly.constant[joints, 0]


def pressed_shares(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(m,) shares F / F0 of the joints that contact forces (m, 3) press; zero where a joint does not crush."""
    tension = assembly.constant[:, 0] + assembly.constant[:, 1]
    share = (forces[:, 0] + forces[:, 1] + tension) / (assembly.crushing + tension)
    return np.where(np.isfinite(assembly.crushing), np.maximum(share, 0.0), 0.0)


def greatest_by_chords(
    assembly: Assembly,
    dead: FloatArray,
    live: FloatArray,
    most: float = np.inf,
) -> BlockLimit:
    """The greatest multiplier up to `most` of live (n, 3) beside dead (n, 3), by linear programmes with a known gap."""
    programme = _LineProgramme(assembly, dead, live, most)
    best, upper, motion = BlockLimit("unknown"), np.inf, None
    size = programme.per_unit
    for rounds in range(1, _ROUNDS + 1):
        exact = upper - best.multiplier <= _EXACT * size
        outer = programme.solve(*programme.tangents(), exact)
        if isinstance(outer, str):
            return BlockLimit(outer, rounds=rounds)
        programme.add_points(outer.forces)
        inner = programme.solve(*programme.chords(), exact)
        if not isinstance(inner, str) and not inner.multiplier <= best.multiplier:
            best = replace(best, outcome="optimal", multiplier=inner.multiplier, forces=inner.forces)
        for found in (outer, inner):
            if not isinstance(found, str):
                above = kinematic_multiplier(assembly, found.motion, dead, live)
                upper, motion = (above, found.motion) if above < upper else (upper, motion)
        best = replace(best, mechanism=motion, upper=upper, rounds=rounds)
        at_most = best.forces is not None and best.multiplier >= most
        size = max(programme.per_unit, abs(upper) if upper < np.inf else 0.0)
        if at_most or upper - best.multiplier <= _GAP * size:
            break
    return best


@dataclass(frozen=True, eq=False)
class _Found:
    """The solution of one programme: its multiplier, forces (m, 3) [force] and motion (n, 3) dual to them."""

    multiplier: float
    forces: FloatArray
    motion: FloatArray


class _LineProgramme:
    """Statics of a wall with lines in place of the parabolas of its k joints that crush; two ends a joint, 2k ends."""

    def __init__(self, assembly: Assembly, dead: FloatArray, live: FloatArray, most: float) -> None:
        self._assembly, m, n = assembly, assembly.n_interfaces, assembly.n_free
        self._column = assembly.velocity_units()
        own, acting = dead[assembly.free].ravel() * self._column, live[assembly.free].ravel() * self._column
        self._unit = (float(abs(own).sum()) or float(abs(acting).sum())) / n
        self.per_unit = self._unit * n / float(abs(acting).sum())
        self._law, self._dead = assembly.law.in_units(self._unit), own / self._unit
        matrix = sp.vstack([(assembly.kinematic_matrix @ sp.diags(self._column)).T, shear_limits(self._law)])
        loads = np.append(acting * (self.per_unit / self._unit), np.zeros(2 * m))
        self._matrix = sp.csc_matrix(sp.hstack([matrix, sp.csc_matrix(loads[:, None])]))
        self._most = most / self.per_unit
        joints, full = crushing_force(assembly)
        self._first, self._full = 3 * np.repeat(joints, 2), np.repeat(full / self._unit, 2)
        self._tension = 2.0 * np.repeat(self._law.constant[joints, 0], 2)
        self._own = self._first + np.tile([0, 1], len(joints))
        start = np.array([0.0, *_FIRST, 1.0])
        self._points = [start * full for full in self._full]

    def tangents(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Ends, and the two equal points of a line each."""
        end = np.repeat(np.arange(len(self._points)), [len(points) for points in self._points])
        points = np.concatenate(self._points)
        return end, points, points

    def chords(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Ends, and the two neighbouring points of a line each."""
        end = np.repeat(np.arange(len(self._points)), [len(points) - 1 for points in self._points])
        low, high = ([points[part] for points in self._points] for part in (slice(-1), slice(1, None)))
        return end, np.concatenate(low), np.concatenate(high)

    def add_points(self, forces: FloatArray) -> None:
        """Points at the forces (m, 3) of each joint, where none are as near."""
        force = (forces / self._unit).ravel()
        at = np.clip(force[self._first] + force[self._first + 1] + self._tension, 0.0, self._full)
        for end, (points, full, new) in enumerate(zip(self._points, self._full, at, strict=True)):
            if abs(points - new).min() > _NEW * full:
                self._points[end] = np.sort(np.append(points, new))

    def solve(self, end: IntArray, a: FloatArray, b: FloatArray, exact: bool) -> _Found | str:
        """The greatest multiplier within these lines, to rounding if `exact`; or how the programme ended."""
        from methods.numerics.linear_programme import INFINITY, Programme  # HiGHS, which few answers need

        m, n = self._assembly.n_interfaces, self._assembly.n_free
        slope, row = (a + b) / (2.0 * self._full[end]), np.arange(len(end))
        entries = np.concatenate([-slope, -slope, np.ones(len(end))])
        places = np.concatenate([self._first[end], self._first[end] + 1, self._own[end]])
        lines = sp.csr_matrix((entries, (np.tile(row, 3), places)), shape=(len(end), 3 * m + 1))
        least = (slope - 0.5) * self._tension[end] - a * b / (2.0 * self._full[end])
        normal = np.column_stack([self._law.least_normal, np.full(m, -INFINITY)]).ravel()
        programme = Programme(
            sp.csc_matrix(sp.vstack([self._matrix, lines])),
            np.append(np.zeros(3 * m), -COST),
            (np.append(normal, -INFINITY), np.append(np.full(3 * m, INFINITY), min(self._most, INFINITY))),
            (
                np.concatenate([-self._dead, least_shear_slacks(self._law), least]),
                np.append(-self._dead, np.full(2 * m + len(least), INFINITY)),
            ),
        )
        status, value, dual = programme.run()
        if status != "optimal":
            return status
        if exact:
            vertex = programme.vertex(np.append(rows_of_blocks(n, m), n + 2 * m + row))
            if vertex is not None and vertex.optimal:
                value, dual = vertex.value, vertex.dual
        motion = np.zeros((self._assembly.n_blocks, 3))
        motion[self._assembly.free] = (-dual[: 3 * n] * self._column).reshape(-1, 3)
        forces = self._law.within(value[:-1].reshape(-1, 3)) * self._unit
        return _Found(float(value[-1]) * self.per_unit, forces, motion)


def block_dissipation(full: FloatArray, opening: FloatArray) -> FloatArray:
    """(k,) greatest -(m1 o1 + m2 o2) over m_i >= F^2 / (2 F0), F = m1 + m2, for openings (k, 2); F0 = full (k,)."""
    low, high = opening.min(axis=1), opening.max(axis=1)
    turn = high - low
    part = np.where(-low < turn, -low / np.where(turn > 0.0, turn, 1.0), 1.0)  # of F0, that is pressed
    return np.asarray(np.where(low < 0.0, full * part * (-low - 0.5 * turn * part), 0.0))


def kinematic_multiplier(assembly: Assembly, motion: FloatArray, dead: FloatArray, live: FloatArray) -> float:
    """The multiplier of a mechanism (n, 3) by virtual work with the exact law; infinite where the live load idles."""
    strains = (assembly.kinematic_matrix @ motion[assembly.free].ravel()).reshape(-1, 3)
    rates = assembly.law.associated.rates(strains)
    opening, slips = rates[:, :2], rates[:, 2:]
    taken = assembly.constant[:, :2] * opening
    joints, full = crushing_force(assembly)
    dry = np.ones(len(opening), dtype=bool)
    dry[joints] = False
    taken[dry] = assembly.constant[dry, :2] * np.maximum(opening[dry], 0.0)
    work = float(taken.sum() + (assembly.constant[:, 2:] * slips).sum()) + float(
        block_dissipation(full, opening[joints]).sum()
    )
    power = float((live * motion).sum())
    return (work - float((dead * motion).sum())) / power if power > 0.0 else float("inf")
