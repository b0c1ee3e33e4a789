"""The limit-analysis problem of an assembly in dimensionless form, with its yield domain and flow rules.

Per interface the forces r = (n1, n2, s) give the yield slacks y = S r + s0 >= 0, and the mechanism u has the strains
C u = E g with rates g >= 0, both as `harness.model.joint_law` says. At collapse y o g = 0.
Source: Baggio and Trovalusci (1995), equations 1 to 7.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.deadline import Deadline
from harness.model.joint_law import JointLaw

_NO_FRICTION = 1e-12
"""Friction coefficients below this are zero to rounding."""

_NO_MULTIPLIER = 1e-15
"""Scaled multipliers up to this are zero to rounding, as of a wall without friction."""

_UNLOADED = 0.05
"""Share of the largest normal force on both its blocks below which a joint counts as unloaded."""


@dataclass(frozen=True, eq=False)
class Problem:
    """An assembly scaled so that mean block weight, typical block size and total live load are of order one.

    n = number of free blocks, m = number of interfaces.

    Attributes:
        assembly: where it comes from.
        kinematic: (3m, 3n) scaled matrix C, strains from velocities (ux, uy, omega * unit_length).
        dead, live: (3n,) scaled loads.
        law: of the joints, its constant parts scaled.
        unit_force: mean dead load of a free block [force].
        unit_length: typical size of a block [length].
        unit_multiplier: multiplier per scaled multiplier.
        deadline: of the run in which it is made; all that goes on for long asks for it.
    """

    assembly: Assembly
    kinematic: sp.csr_matrix
    dead: FloatArray
    live: FloatArray
    law: JointLaw
    unit_force: float
    unit_length: float
    unit_multiplier: float
    deadline: Deadline = field(default_factory=Deadline.of_run)

    @property
    def friction(self) -> FloatArray:
        """(m,) friction coefficients."""
        return self.law.friction

    @property
    def n_interfaces(self) -> int:
        """Number of interfaces m."""
        return len(self.friction)

    @property
    def n_velocities(self) -> int:
        """Number of velocity components, three a free block."""
        return len(self.dead)

    @cached_property
    def statics(self) -> sp.csr_matrix:
        """(3n, 3m) transposed kinematic matrix C'."""
        return self.kinematic.T.tocsr()

    @cached_property
    def unloaded_joints(self) -> BoolArray:
        """Interfaces (m,) that hardly press under dead load, by the forces of least norm that balance it.

        What counts is the largest normal force on either block, so that the light beds of a top course are not among
        them.
        """
        matrix = sp.csc_matrix(self.statics)
        stiffness = (matrix @ matrix.T + 1e-12 * sp.eye(matrix.shape[0])).tocsc()
        forces = -matrix.T @ spsolve(stiffness, self.dead)
        normal = forces.reshape(-1, 3)[:, :2].sum(axis=1)
        assembly = self.assembly
        largest = np.zeros(assembly.n_blocks)
        for blocks in (assembly.block_a, assembly.block_b):
            np.maximum.at(largest, blocks, normal)
        largest[assembly.fixed] = np.inf
        return np.asarray(normal < _UNLOADED * np.minimum(largest[assembly.block_a], largest[assembly.block_b]))

    @cached_property
    def live_work(self) -> float:
        """Live work every mechanism is scaled to: the number of free blocks, so that velocities are of order one."""
        return self.n_velocities / 3.0

    @cached_property
    def rigid_in_shear(self) -> BoolArray:
        """(m,) interfaces without friction and cohesion, whose shear is zero and whose slip is free."""
        return np.asarray((self.friction == 0.0) & (self.law.constant[:, 2:].sum(axis=1) == 0.0))

    def slacks(self, forces: FloatArray) -> FloatArray:
        """(m, 4) yield slacks of forces (m, 3)."""
        return self.law.slacks(forces)

    def forces_of_slacks(self, slack: FloatArray) -> FloatArray:
        """(m, 3) forces of slacks (m, 4)."""
        return self.law.forces_of_slacks(slack)

    @property
    def dilates(self) -> bool:
        """Whether any joint lifts as it slides."""
        return bool(np.any(self.law.dilatancy > 0.0))

    def flow_law(self, associated: bool) -> JointLaw:
        """The law of the joints, of associated flow if so."""
        return self.law.associated if associated else self.law

    def strains_of_rates(self, rates: FloatArray, dilatancy: float) -> FloatArray:
        """(m, 3) strains E g of rates g (m, 4); a slip lifts by `JointLaw.lift` of `dilatancy`."""
        dilation = self.law.lift(dilatancy) * (rates[:, 2] + rates[:, 3])
        return np.column_stack([rates[:, 0] + dilation, rates[:, 1] + dilation, rates[:, 2] - rates[:, 3]])

    def strains(self, velocities: FloatArray) -> FloatArray:
        """(m, 3) strains C u of velocities (3n,)."""
        return np.asarray(self.kinematic @ velocities).reshape(-1, 3)

    def rates_of_velocities(self, velocities: FloatArray, associated: bool) -> FloatArray:
        """(m, 4) smallest rates g with C u = E g; openings come out negative where blocks pass through each other."""
        return self.rates_of_strains(self.strains(velocities), associated)

    def rates_of_strains(self, strain: FloatArray, associated: bool) -> FloatArray:
        """(m, 4) smallest rates g with q = E g of strains q (m, 3), as `rates_of_velocities` gives them."""
        return self.flow_law(associated).rates(strain)

    def imbalance(self, forces: FloatArray, multiplier: float) -> FloatArray:
        """(3n,) out-of-balance loads C' r + dead + multiplier * live."""
        return np.asarray(self.statics @ forces.ravel()) + self.dead + multiplier * self.live

    def to_multiplier(self, multiplier: float) -> float:
        """The multiplier of a scaled one; zero where the live load is rounding beside the dead load."""
        return 0.0 if abs(multiplier) <= _NO_MULTIPLIER else multiplier * self.unit_multiplier

    def to_forces(self, forces: FloatArray) -> FloatArray:
        """(m, 3) contact forces [force] of scaled ones."""
        return forces * self.unit_force

    def to_mechanism(self, velocities: FloatArray) -> FloatArray:
        """(n_blocks, 3) velocities (ux, uy, omega) of all blocks, scaled to a largest component of one."""
        motion = np.zeros((self.assembly.n_blocks, 3))
        moving = self.velocities_of_blocks(velocities)
        largest = abs(moving).max(initial=0.0)
        motion[self.assembly.free] = moving / (largest or 1.0)
        return motion

    def velocities_of_blocks(self, velocities: FloatArray) -> FloatArray:
        """(n, 3) velocities (ux, uy, omega) of the free blocks."""
        moving = velocities.reshape(-1, 3).copy()
        moving[:, 2] /= self.unit_length
        return moving

    def with_friction(self, friction: FloatArray) -> Problem:
        """The same wall with other friction (m,) in its joints, which springs in them have too."""
        return replace(self, law=self.law.with_friction(friction), assembly=replace(self.assembly, friction=friction))

    def from_mechanism(self, mechanism: FloatArray) -> FloatArray:
        """(3n,) scaled velocities of block velocities (n_blocks, 3)."""
        moving = mechanism[self.assembly.free].copy()
        moving[:, 2] *= self.unit_length
        return np.asarray(moving.ravel())


def make_problem(assembly: Assembly) -> Problem:
    """The scaled limit-analysis problem of an assembly, whose ties and props are rows of the law of joints.

    Raises:
        ValueError: it has bars that are not (`harness.model.bars.with_bars_as_joints`).
    """
    if len(assembly.bars):
        raise ValueError(f"{assembly.name} has ties or props that are no rows of the law of its joints")
    unit_force = assembly.force_scale / max(assembly.n_free, 1)
    unit_length = assembly.length_scale or 1.0
    column = np.tile([1.0, 1.0, 1.0 / unit_length], assembly.n_free)
    dead, live = assembly.free_loads()
    dead = dead * column / unit_force
    live = live * column / unit_force
    size = float(abs(live.reshape(-1, 3)).sum())
    friction = np.where(abs(assembly.friction) < _NO_FRICTION, 0.0, assembly.friction)
    unit_multiplier = assembly.n_free / size if size > 0.0 else 1.0
    return Problem(
        assembly=assembly,
        kinematic=(assembly.kinematic_matrix @ sp.diags(column)).tocsr(),
        dead=dead,
        live=live * unit_multiplier,
        law=assembly.law.with_friction(friction).in_units(unit_force),
        unit_force=unit_force,
        unit_length=unit_length,
        unit_multiplier=unit_multiplier,
    )
