"""A wall as the gap-spring model sees it: gap points, dimensionless loads and the sparse tangent.

Lengths are measured in the length scale of the wall, forces in the mean weight of a block, displacements in
force / kn, so that kn = 1 inside. The multiplier is untouched by this, and results at two stiffnesses differ by the
scale of the displacements only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.deadline import Deadline
from harness.model.joint_law import JointLaw
from methods.numerics.block_lu import elimination_order
from methods.numerics.vectors import largest
from methods.springs.model.exact_rates import tangent_defect
from methods.springs.model.gap_law import classify, equivalent_end_forces, gap_forces
from methods.springs.model.options import SpringOptions
from methods.springs.model.point_loops import add_changes, add_tangent, point_strains, rank_one_change
from methods.springs.model.points import GapSettings, gap_points
from methods.springs.model.strength import with_strength

_REGULARISATION = 1e-8
"""Stiffness of a block against the ground that a singular tangent is factorised with, in springs of a gap point;
refinement removes its force."""


@dataclass(frozen=True, eq=False)
class WallModel:
    """Arrays of the gap-spring model. N = 3 n_free unknowns, m interfaces, P gap points.

    Attributes:
        assembly: the wall.
        order: (n_free,) block index behind each block of unknowns, in an order that keeps the factors sparse.
        unknown: (m, 6) unknowns of the two blocks of each interface; those of a fixed block repeat the
            other block's, with coefficients 0.
        rows: (m, 3, 6) coefficients of (opening at end 1, at end 2, slip).
        interface: (P,) interface of each point; position: (P,) in [0, 1] from end 1.
        kn, kt, mu: (P,) stiffnesses and friction; psi: (P,) dilatancy, by which a slip lifts a point.
        history: (P,) initial h = T0 - kt s0; initial_opening: (P,) at no displacement, negative where a point carries
            compression before anything has moved.
        middle: (P,) shear that a point bears besides its own, as part of the dead load: the middle of a bar's range.
        dead, live: (N,) dimensionless loads.
        inertia: (N,) dimensionless masses for pseudo-transient relaxation.
        regularised: (N,) stiffness of every block against the ground that a singular tangent is factorised with.
        column_start, row_index: CSC pattern of the tangent; slot: (m, 36) where each interface adds to its values.
        force, length, displacement: what one unit inside is worth outside.
        cohesive: (k,) interfaces with a cohesion spring, and then ties and props: the last k of the points, with rows
            of their own behind the m.
        options: of all that is done with the model.
        deadline: of the run in which it is made; all that goes on for long asks for it.
    """

    assembly: Assembly
    order: IntArray
    unknown: IntArray
    rows: FloatArray
    interface: IntArray
    position: FloatArray
    kn: FloatArray
    kt: FloatArray
    mu: FloatArray
    psi: FloatArray
    history: FloatArray
    initial_opening: FloatArray
    middle: FloatArray
    dead: FloatArray
    live: FloatArray
    inertia: FloatArray
    regularised: FloatArray
    column_start: IntArray
    row_index: IntArray
    slot: IntArray
    force: float
    length: float
    displacement: float
    cohesive: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    options: SpringOptions = SpringOptions()
    deadline: Deadline = field(default_factory=Deadline.of_run)

    @cached_property
    def idle_blocks(self) -> frozenset[str]:
        """Names of free blocks with neither dead nor live load, which may come loose without any force."""
        assembly = self.assembly
        loads = (abs(assembly.dead) + abs(assembly.live)).max(axis=1)
        return frozenset(assembly.block_ids[k] for k in np.flatnonzero((loads == 0.0) & ~assembly.fixed))

    @property
    def n_unknowns(self) -> int:
        """N, three for each free block."""
        return len(self.dead)

    @property
    def n_points(self) -> int:
        """P, the number of gap points."""
        return len(self.kn)

    @property
    def n_contacts(self) -> int:
        """The number of gap points that may open: all but the cohesion springs, which come last."""
        return self.n_points - len(self.cohesive)

    @cached_property
    def n_updated(self) -> int:
        """The number of gap points whose friction history is updated: all but ties and props, which come last.

        A tie that has been slack bears nothing until it is as long as before.
        """
        return self.n_points - int(self.assembly.is_bar.sum())

    def updated(self, history: FloatArray, before: FloatArray) -> FloatArray:
        """The history (P,) after an update from one `before` it."""
        return np.concatenate([history[: self.n_updated], before[self.n_updated :]])

    def bar_tensions(self, trial: FloatArray) -> FloatArray:
        """Tensions of ties and props beyond their prestress [force], at trial shears tau (P,)."""
        if self.n_updated == self.n_points:
            return np.empty(0)
        last, limit = slice(self.n_updated, None), self._bar_limits
        return self.force * (np.clip(trial[last], -limit, limit) + self.middle[last])

    @cached_property
    def _bar_limits(self) -> FloatArray:
        """(k,) shear of the points of ties and props at which they yield either way."""
        return self.law.by_friction(-self.kn * self.initial_opening)[self.n_updated :]

    @cached_property
    def law(self) -> JointLaw:
        """The law of the gap points."""
        return JointLaw(self.mu, self.psi)

    @cached_property
    def lift(self) -> FloatArray:
        """(P,) opening psi / kt by which a unit of shear beyond friction lifts a point."""
        return self.psi / self.kt

    @cached_property
    def dilates(self) -> bool:
        """Whether a slip lifts any point. Its friction history is then not updated: the lift would have to be too."""
        return bool(self.psi.any())

    def strains(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Openings and slips (P,) of the gap points at displacements u (N,)."""
        opening, slip = np.empty(self.n_points), np.empty(self.n_points)
        point_strains(self.unknown, self.rows, self.interface, self.position, u, opening, slip)
        opening += self.initial_opening
        return opening, slip

    def interface_of(self, point: int) -> int:
        """The interface of a gap point, of a cohesion spring the one whose cohesion it bears."""
        row, count = int(self.interface[point]), self.assembly.n_interfaces
        return row if row < count else int(self.cohesive[row - count])

    def states(self, u: FloatArray, history: FloatArray, virgin: bool = False) -> IntArray:
        """States (P,) of the gap points at displacements u with friction history h (P,)."""
        opening, slip = self.strains(u)
        state = np.empty(self.n_points, dtype=np.int64)
        classify(opening, self.kt * slip + history, self.kn, self.mu, self.lift, state, virgin)
        return state

    def forces(self, u: FloatArray, history: FloatArray, state: IntArray) -> tuple[FloatArray, FloatArray]:
        """Compression N and internal shear T (P,) of points held in the given states."""
        opening, slip = self.strains(u)
        normal, shear = np.empty(self.n_points), np.empty(self.n_points)
        gap_forces(opening, self.kt * slip + history, self.kn, self.mu, self.lift, state, normal, shear)
        return normal, shear

    def end_forces(self, normal: FloatArray, shear: FloatArray) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force] from the gap forces N and T (P,)."""
        count = self.assembly.n_interfaces
        if not self.assembly.strong:
            return self.force * equivalent_end_forces(self.position, self.interface, normal, shear, count)
        dry = slice(self.n_contacts)
        ends = equivalent_end_forces(self.position[dry], self.interface[dry], normal[dry], shear[dry], count)
        ends[self.cohesive, 2] -= shear[self.n_contacts :] + self.middle[self.n_contacts :]
        ends *= self.force
        ends[:, :2] -= self.assembly.law.constant[:, :2]  # the clamping, which the springs bear besides
        return ends

    def residual(self, u: FloatArray, multiplier: float, history: FloatArray, state: IntArray) -> FloatArray:
        """Out-of-balance forces (N,): loads minus internal forces of points held in the given states."""
        opening, slip = self.strains(u)
        return self.out_of_balance(opening, self.kt * slip + history, state, multiplier)

    def out_of_balance(
        self, opening: FloatArray, trial: FloatArray, state: IntArray, multiplier: float, dead: float = 1.0
    ) -> FloatArray:
        """dead * dead load + multiplier * live load minus the internal forces of gaps g, tau (P,): (N,)."""
        out = dead * self.dead + multiplier * self.live
        tangent_defect(
            self.unknown,
            self.rows,
            self.interface,
            self.position,
            self.kn,
            self.mu,
            self.lift,
            state,
            opening,
            trial,
            out,
        )
        return out

    def added(self, shift: float, regularised: bool) -> FloatArray:
        """What is added to the diagonal (N,) of the tangent: `shift` times the inertia, the regularisation if asked."""
        return shift * self.inertia + (self.regularised if regularised else 0.0)

    def tangent(self, state: IntArray, shift: float = 0.0, regularised: bool = False) -> sp.csc_matrix:
        """The sparse tangent (N, N) in the given states, with what is `added` to its diagonal."""
        values = np.zeros(len(self.row_index))
        add_tangent(
            self.slot, self.rows, self.interface, self.position, self.kn, self.kt, self.mu, self.lift, state, values
        )
        matrix = sp.csc_matrix((values, self.row_index, self.column_start), shape=(self.n_unknowns, self.n_unknowns))
        if shift or regularised:
            matrix.setdiag(matrix.diagonal() + self.added(shift, regularised))
        return matrix

    def change(self, point: int, old: int, new: int) -> tuple[IntArray, FloatArray, FloatArray]:
        """The rank-one change a b' of the tangent when a point changes its state: (unknowns, a, b), all (6,)."""
        a, b = np.empty(6), np.empty(6)
        rank_one_change(
            self.rows, self.interface, self.position, self.kn, self.kt, self.mu, self.lift, point, old, new, a, b
        )
        return self.unknown[self.interface[point]], a, b

    def add_changes(self, changes: Sequence[tuple[int, int, int]], columns: FloatArray) -> int:
        """Add the vectors a of changes (point, old, new) to the columns of (N, k); returns the first row concerned."""
        springs = self.rows, self.interface, self.position, self.kn, self.kt, self.mu, self.lift
        return add_changes(self.unknown, *springs, np.array(changes), columns)

    def block_displacements(self, u: FloatArray) -> FloatArray:
        """(n, 3) displacements of all blocks [length, length, rad] from the dimensionless unknowns (N,)."""
        out = np.zeros((self.assembly.n_blocks, 3))
        out[self.order] = u.reshape(-1, 3) * self.displacement
        out[:, 2] /= self.length
        return out

    def moving_blocks(self, motion: FloatArray, slowest: float = 1e-6) -> list[str]:
        """Names of the blocks that move in a motion (n, 3): faster than this share of the fastest."""
        speed = np.abs(motion * np.array([1.0, 1.0, self.length])).max(axis=1)
        return [self.assembly.block_ids[i] for i in np.flatnonzero(speed > slowest * speed.max(initial=0.0))]


def build_model(
    assembly: Assembly,
    settings: GapSettings,
    friction_cap: float = np.inf,
) -> WallModel:
    """The gap-spring model of a wall.

    Raises:
        ValueError: no block can move, or a block that can move touches nothing and carries nothing to scale by.
    """
    if assembly.n_free == 0:
        raise ValueError(f"wall {assembly.name!r} has no block that can move")
    length = assembly.length_scale
    force = assembly.force_scale / assembly.n_free
    order = _elimination_order(assembly)
    place = np.full(assembly.n_blocks, -1, dtype=np.int64)
    place[order] = np.arange(len(order))
    unknown, rows = _kinematic_rows(assembly, place, length)
    xi, weights = gap_points(settings.rule, settings.points)
    joints, q = np.flatnonzero(~assembly.is_bar), settings.points
    interface = np.repeat(joints, q)
    if settings.weighting == "point":
        kn = np.tile(weights * q, len(joints))
    else:
        kn = np.tile(weights, len(joints)) * np.repeat(assembly.length[joints] / length, q)
    n = 3 * len(order)
    start, row_index, slot = _pattern(unknown, rows, n)
    scale = np.array([1.0, 1.0, 1.0 / length]) / force
    weight = np.linalg.norm(assembly.dead[order, :2], axis=1) / force
    mass = np.maximum(weight, 1e-3)
    gyration = np.array([np.ptp(assembly.polygons[i], axis=0) @ np.ptp(assembly.polygons[i], axis=0) for i in order])
    lever = gyration / (12.0 * length**2)
    inertia = np.stack([mass, mass, mass * lever], axis=1).ravel()
    regularised = _REGULARISATION * np.stack([np.ones_like(lever), np.ones_like(lever), lever], axis=1).ravel()
    law = assembly.law.with_friction(np.minimum(assembly.friction, friction_cap))
    stiffness = settings.normal_stiffness or 1000.0 * force / length
    model = WallModel(
        assembly=assembly,
        order=order,
        unknown=unknown,
        rows=rows,
        interface=interface,
        position=np.tile(xi, len(joints)),
        kn=kn,
        kt=kn * settings.stiffness_ratio,
        mu=law.friction[interface],
        psi=law.dilatancy[interface],
        history=np.zeros(len(interface)),
        initial_opening=np.zeros(len(interface)),
        middle=np.zeros(len(interface)),
        dead=(assembly.dead[order] * scale).ravel(),
        live=(assembly.live[order] * scale).ravel(),
        inertia=inertia,
        regularised=regularised,
        column_start=start,
        row_index=row_index,
        slot=slot,
        force=force,
        length=length,
        displacement=force / stiffness,
    )
    if not assembly.strong:
        return model
    given = assembly.bar_stiffness / stiffness
    return with_strength(model, np.where(np.isnan(given), settings.points, given))


def load_scale(model: WallModel, multiplier: float) -> float:
    """Size of the loads (dimensionless force)."""
    return largest(model.dead) + abs(multiplier) * largest(model.live) or 1.0


def _kinematic_rows(assembly: Assembly, place: IntArray, length: float) -> tuple[IntArray, FloatArray]:
    """Unknowns (m, 6) and coefficients (m, 3, 6) of the generalised strains of every interface."""
    m = assembly.n_interfaces
    unknown = np.zeros((m, 6), dtype=np.int64)
    rows = np.zeros((m, 3, 6))
    for j, (block, sign) in enumerate(((assembly.block_a, -1.0), (assembly.block_b, 1.0))):
        moving = place[block] >= 0
        columns = slice(3 * j, 3 * j + 3)
        host = np.where(moving, place[block], np.maximum(place[assembly.block_a], place[assembly.block_b]))
        unknown[:, columns] = 3 * np.maximum(host, 0)[:, None] + np.arange(3)
        for k, (direction, point) in enumerate(
            ((assembly.normal, assembly.end1), (assembly.normal, assembly.end2), (assembly.tangent, assembly.end1))
        ):
            arm = (point - assembly.centroid[block]) / length
            lever = arm[:, 0] * direction[:, 1] - arm[:, 1] * direction[:, 0]
            rows[:, k, columns] = sign * moving[:, None] * np.column_stack([direction, lever])
    return unknown, rows


def _elimination_order(assembly: Assembly) -> IntArray:
    """Free blocks in the order in which the tangent is factorised."""
    place = np.full(assembly.n_blocks, -1, dtype=np.int64)
    place[assembly.free] = np.arange(assembly.n_free)
    first, second = place[assembly.block_a], place[assembly.block_b]
    both = (first >= 0) & (second >= 0)
    order = elimination_order(assembly.centroid[assembly.free], first[both], second[both])
    out: IntArray = assembly.free[order]
    return out


def _pattern(unknown: IntArray, rows: FloatArray, n: int) -> tuple[IntArray, IntArray, IntArray]:
    """CSC pattern of the tangent and the slot (m, 36) of every product of two rows in its values."""
    r = np.repeat(unknown, 6, axis=1).ravel()
    c = np.tile(unknown, (1, 6)).ravel()
    diagonal = np.arange(n)
    keys = np.concatenate([c * n + r, diagonal * n + diagonal])
    unique, inverse = np.unique(keys, return_inverse=True)
    start = np.zeros(n + 1, dtype=np.int32)
    start[1:] = np.cumsum(np.bincount(unique // n, minlength=n))
    slot = inverse[: len(r)].reshape(-1, 36).astype(np.int64)
    row_index: IntArray = (unique % n).astype(np.int32)
    return cast(IntArray, start), row_index, slot
