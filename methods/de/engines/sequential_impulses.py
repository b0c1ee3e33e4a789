"""Projected Gauss-Seidel (sequential impulses) on the contacts of a wall of constant geometry, in compiled loops.

A time step solves M (v+ - beta v) = f + C' J with 0 <= J_n, w_n >= 0, J_n w_n = 0 and |J_t| <= mu J_n, J_t against the
slip rate w_t where it slips, w = C v+ (Moreau 1988; Jean 1999). One contact after the other, J_n <- max(J_n - m_n w_n,
0) and J_t <- min(max(J_t - m_t w_t, -mu J_n), mu J_n) with effective masses m_n, m_t, from the impulses of the last
step (E. Catto, Iterative dynamics with temporal coherence, GDC 2005). Joints with strength have J_n >= -T/2 and
|J_t| <= mu J_n + c A/2 at each of their two contacts, for as long as they move. Ties and props are rows without a
normal force, -T_y/2 <= J_t <= P_y/2 at each of their two ends (`harness.model.bars.with_bars_as_joints`): w_t is the
rate of elongation. A contact with the dilatancy psi has w_n - psi |w_t| in the place of w_n: impulses beyond friction
return to |J_t| = mu J_n along the flow, with the effective masses for stiffness (return mapping: J. C. Simo and
T. J. R. Hughes, Computational Inelasticity, 1998). Contacts are constant, so there is no search for them and no
position to integrate. Units: length scale, mean dead load of a block, time step.

Contacts that share no free block do not affect each other, so a sweep visits them level by level, each as early as the
contacts before it in the given order allow (level scheduling: Y. Saad, Iterative Methods for Sparse Linear Systems,
2003, section 11.6). The velocities are those of the given order to the last bit, and the processor need not wait for
one contact before it begins the next.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import MassScaling, courses, masses, number_of_courses
from methods.de.engines.pymunk_joints import polygon_gyration
from methods.de.engines.strips import require_lengths
from methods.numerics.compiled import compiled
from methods.numerics.joint_loops import shear_limit, shear_within


class Rows(NamedTuple):
    """The contact points in the order of the sweeps: k = 2m of them, two an interface.

    Attributes:
        first, second: (k,) bodies; the normal points from the first to the second, where that of the ground is n_free.
        normal: (k, 2) unit normals.
        arms: (k, 4) moments about the centroid of the first and of the second body of a unit force along the normal,
            then along the tangent (the normal turned by +90 degrees).
        across, along: (k,) effective mass of both bodies along normal and tangent.
        friction: (k,) coefficients.
        dilatancy: (k,) coefficients by which a slip opens a contact that bears.
        least: (k,) least normal impulse: minus half the tensile strength of the joint; zero in dry joints.
        cohesion: (k, 2) constant part of the shear impulse against the tangent and along it: half the cohesion of the
            joint, half the range of a bar.
    """

    first: IntArray
    second: IntArray
    normal: FloatArray
    arms: FloatArray
    across: FloatArray
    along: FloatArray
    friction: FloatArray
    dilatancy: FloatArray
    least: FloatArray
    cohesion: FloatArray


class SequentialImpulses:
    """The engine of `de`: see `methods.de.engines.engine.Engine`.

    Args:
        assembly: the wall.
        blocks: (n_free,) free blocks in the order of their bodies.
        joints: (m,) interfaces in the order of the sweeps.
        iterations: sweeps in a time step.
        tuning: masses and damping.

    Raises:
        CannotModel: the two contact points of an interface are not a distance apart.
    """

    def __init__(
        self, assembly: Assembly, blocks: IntArray, joints: IntArray, iterations: int, tuning: MassScaling
    ) -> None:
        require_lengths(assembly)
        self.assembly, self.interfaces, self.steps = assembly, assembly.n_interfaces, 0
        self._unit, self._force = assembly.length_scale, assembly.force_scale / max(assembly.n_free, 1)
        course = courses(assembly)
        self.relaxation, self.courses = 1.0 / (1.0 - tuning.damping), number_of_courses(course)
        self._blocks, self._iterations, self._keep = blocks, iterations, tuning.damping
        self._mass = self._masses(masses(assembly, course, tuning.mass_decay))
        self._inverse = np.zeros((len(blocks) + 1, 3))
        self._inverse[:-1] = 1.0 / self._mass[blocks]
        self._normal = _unit_normals(assembly)
        self._rows = self._contact_points(joints)
        scale = 1.0 / np.array([self._force, self._force, self._force * self._unit])
        self._dead, self._live = np.zeros((2, len(blocks) + 1, 3))
        self._dead[:-1], self._live[:-1] = assembly.dead[blocks] * scale, assembly.live[blocks] * scale
        self._impulses = np.zeros((2 * self.interfaces, 2))
        self._velocity = np.zeros((len(blocks) + 1, 3))
        self.load(0.0)

    def _masses(self, mass: FloatArray) -> FloatArray:
        """(n, 3) masses and moments of inertia; those of fixed blocks count for nothing and are zero."""
        wall, result = self.assembly, np.zeros((self.assembly.n_blocks, 3))
        for i in self._blocks:
            inertia = mass[i] * polygon_gyration((wall.polygons[i] - wall.centroid[i]) / self._unit)
            result[i] = mass[i], mass[i], inertia
        return result

    def _contact_points(self, joints: IntArray) -> Rows:
        """The rows of interfaces (m,) in this order, level by level; notes each row's number among the points."""
        wall = self.assembly
        body = np.full(wall.n_blocks, len(self._blocks))
        body[self._blocks] = np.arange(len(self._blocks))
        blocks = np.repeat(np.stack([wall.block_a[joints], wall.block_b[joints]]), 2, axis=1)
        point = np.stack([wall.end1, wall.end2], axis=1)[joints].reshape(-1, 2)
        normal = np.repeat(self._normal[joints], 2, axis=0)
        tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        arm = (point - wall.centroid[blocks]) / self._unit
        turned = [side[:, 0] * d[:, 1] - side[:, 1] * d[:, 0] for d in (normal, tangent) for side in arm]
        first, second = body[blocks]
        arms = np.stack(turned, axis=1)

        def effective(one: FloatArray, two: FloatArray) -> FloatArray:
            give = self._inverse[first, 0] + self._inverse[second, 0]
            give = give + self._inverse[first, 2] * one**2 + self._inverse[second, 2] * two**2
            mass: FloatArray = np.divide(1.0, give, out=np.zeros_like(give), where=give > 0.0)
            return mass

        friction, dilatancy = np.repeat(np.stack([wall.friction[joints], wall.dilatancy[joints]]), 2, axis=1)
        across, along = effective(*arms[:, :2].T), effective(*arms[:, 2:].T)
        across[np.repeat(wall.is_bar[joints], 2)] = 0.0  # nothing presses in a bar
        law = wall.law.in_units(self._force)
        # A left-handed pair of normal and tangent turns the sign of the shear, and with it the two ends of its range.
        ends = np.where(self._handed[joints, None] > 0.0, law.constant[joints, 2:], law.constant[joints, :1:-1])
        strength = law.least_normal[joints].ravel(), np.repeat(0.5 * ends, 2, axis=0)
        by_level = np.argsort(_levels(first, second, len(self._blocks)), kind="stable")
        self._points = (2 * np.repeat(joints, 2) + np.tile([0, 1], len(joints)))[by_level]
        given = Rows(first, second, normal, arms, across, along, friction, dilatancy, *strength)
        return Rows._make(part[by_level] for part in given)

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        self.multiplier = multiplier
        self._push = (self._dead + multiplier * self._live) * self._inverse

    def advance(self, steps: int) -> None:
        """Make time steps, one call each, so that the alarm of a time limit is heard between them."""
        for _ in range(steps):
            _step(self._velocity, self._impulses, self._rows, self._inverse, self._push, self._keep, self._iterations)
        self.steps += steps

    def velocity(self) -> FloatArray:
        """(n, 3) velocities as out-of-balance accelerations, see `Engine.velocity`."""
        result = np.zeros((self.assembly.n_blocks, 3))
        result[self._blocks] = self._velocity[:-1] / self.relaxation * motion_units(self.assembly)
        return result

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force of this velocity field, see `Engine.unbalance`."""
        return float(np.abs(self._mass * velocity / motion_units(self.assembly)).max(initial=0.0))

    def save(self) -> FloatArray:
        """(2m, 2) normal and tangential impulse of every contact point in the order of the sweeps."""
        return self._impulses.copy()

    def restore(self, state: FloatArray) -> None:
        """Back to rest with these impulses."""
        self._impulses[:] = state
        self._velocity[:] = 0.0

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) of the last time step [force]."""
        force = np.zeros((2 * self.interfaces, 2))
        force[self._points] = self._impulses * self._force
        ends = force.reshape(-1, 2, 2)
        return np.column_stack([ends[:, 0, 0], ends[:, 1, 0], self._handed * ends[:, :, 1].sum(axis=1)])

    @property
    def _handed(self) -> FloatArray:
        """(m,) 1 where the tangent is the normal turned by +90 degrees, -1 where it is turned the other way."""
        normal, tangent = self._normal, self.assembly.tangent
        handed: FloatArray = normal[:, 0] * tangent[:, 1] - normal[:, 1] * tangent[:, 0]
        return handed


def _unit_normals(assembly: Assembly) -> FloatArray:
    """(m, 2) unit normals; of bars, which have none, their axis turned by -90 degrees."""
    axis = assembly.tangent
    across = np.column_stack([axis[:, 1], -axis[:, 0]])
    return np.where(assembly.is_bar[:, None], across, assembly.normal)


@compiled
def _levels(first: IntArray, second: IntArray, ground: int) -> IntArray:
    """(k,) level of each contact: one more than the highest of those before it on either of its free bodies."""
    reached = np.zeros(ground + 1, dtype=np.int64)
    level = np.zeros(len(first), dtype=np.int64)
    for q in range(len(first)):
        a, b = first[q], second[q]
        level[q] = max(reached[a], reached[b])
        reached[a] = reached[b] = level[q] + 1
        reached[ground] = 0
    return level


@compiled
def _step(
    velocity: FloatArray,
    impulses: FloatArray,
    rows: Rows,
    inverse: FloatArray,
    push: FloatArray,
    keep: float,
    iterations: int,
) -> None:
    """One time step: loads and damping, the impulses of the last step, then sweeps that correct them; in place."""
    first, second, normal, arms = rows.first, rows.second, rows.normal, rows.arms
    for i in range(len(velocity)):
        for j in range(3):
            velocity[i, j] = keep * velocity[i, j] + push[i, j]
    for sweep in range(iterations + 1):
        for q in range(len(first)):
            a, b = first[q], second[q]
            nx, ny = normal[q, 0], normal[q, 1]
            if sweep == 0:
                pressed, rubbed = impulses[q, 0], impulses[q, 1]
            else:
                vx, vy = velocity[b, 0] - velocity[a, 0], velocity[b, 1] - velocity[a, 1]
                va, vb = velocity[a, 2], velocity[b, 2]
                opening = vx * nx + vy * ny + vb * arms[q, 1] - va * arms[q, 0]
                slip = vy * nx - vx * ny + vb * arms[q, 3] - va * arms[q, 2]
                normal_force = impulses[q, 0] - opening * rows.across[q]
                shear = impulses[q, 1] - slip * rows.along[q]
                if rows.dilatancy[q] > 0.0:  # what slip is left beyond friction lifts the contact, and so adds to it
                    beyond = abs(shear) - shear_limit(rows.friction[q], normal_force) - rows.cohesion[q, 0]
                    lift = rows.dilatancy[q] * rows.across[q]
                    normal_force += lift * max(beyond, 0.0) / (rows.along[q] + shear_limit(rows.friction[q], lift))
                normal_force = max(normal_force, rows.least[q])
                shear = shear_within(shear, rows.friction[q], normal_force, rows.cohesion[q, 0], rows.cohesion[q, 1])
                pressed, rubbed = normal_force - impulses[q, 0], shear - impulses[q, 1]
                impulses[q, 0], impulses[q, 1] = normal_force, shear
            fx, fy = pressed * nx - rubbed * ny, pressed * ny + rubbed * nx
            velocity[a, 0] -= fx * inverse[a, 0]
            velocity[a, 1] -= fy * inverse[a, 0]
            velocity[a, 2] -= (pressed * arms[q, 0] + rubbed * arms[q, 2]) * inverse[a, 2]
            velocity[b, 0] += fx * inverse[b, 0]
            velocity[b, 1] += fy * inverse[b, 0]
            velocity[b, 2] += (pressed * arms[q, 1] + rubbed * arms[q, 3]) * inverse[b, 2]
