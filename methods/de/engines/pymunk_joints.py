"""A wall as contact strips in a pymunk space, at frozen geometry.

Gravity is scaled down until displacements vanish in rounding (1e-12 unit lengths per unit time squared): what is left
is the velocity problem M (v+ - beta v) = dt f + C' J with Coulomb contact, which the engine's sequential impulses
solve with the impulses of the last step as their start. At rest, J / dt are contact forces in equilibrium with f.
Source: E. Catto, Iterative dynamics with temporal coherence, GDC 2005 (the solver of Chipmunk).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pymunk
from pymunk import batch

from harness.model.assembly import Assembly, FloatArray, IntArray
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import MassScaling, courses, masses, number_of_courses
from methods.de.engines.strips import CannotModel, StripShape, build_strips
from methods.numerics.failures import NumericalFailure

_TIME_STEP = 1e-2
"""In unit times."""
_GRAVITY = 1e-12
"""In unit lengths per unit time squared: displacements vanish in rounding."""
_SLOP = 10.0
"""Overlap that Chipmunk leaves, in radii of the strips: more than any there is, so that it pushes nothing."""


_REST = (
    batch.BodyFields.POSITION | batch.BodyFields.ANGLE | batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
)
_VELOCITY = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_FORCE = batch.BodyFields.FORCE | batch.BodyFields.TORQUE


class PymunkJoints:
    """The engine of `de`: see `methods.de.engines.engine.Engine`.

    Args:
        assembly: the wall.
        blocks: (n_free,) free blocks in the order in which their bodies are added.
        joints: (m,) interfaces in the order in which their strips are added.
        iterations: sweeps of the contact solver in a time step.
        tuning: masses and damping.
        shape: how the strips are drawn.

    Raises:
        CannotModel: joints have strength or dilatancy, or the wall ties or props; or see
            `methods.de.engines.strips.build_strips`.
    """

    def __init__(
        self,
        assembly: Assembly,
        blocks: IntArray,
        joints: IntArray,
        iterations: int,
        tuning: MassScaling,
        shape: StripShape = StripShape(),
    ) -> None:
        if assembly.is_bar.any():
            raise CannotModel("contacts in pymunk are no ties or props; take the engine 'sweeps'")
        if assembly.dilates:
            raise CannotModel("contacts in pymunk do not dilate; take the engine 'sweeps'")
        if assembly.strong:
            raise CannotModel("contacts in pymunk have no strength beside friction; take the engine 'sweeps'")
        self._shape = shape
        self.assembly = assembly
        self.interfaces = assembly.n_interfaces
        self.steps = 0
        self._unit = assembly.length_scale
        self._force = assembly.force_scale / max(assembly.n_free, 1)
        course = courses(assembly)
        self.relaxation = 1.0 / (1.0 - tuning.damping)
        self.courses = number_of_courses(course)
        self._blocks = blocks
        self._space = pymunk.Space()
        self._space.iterations = iterations
        self._space.gravity = (0.0, 0.0)
        self._space.damping = tuning.damping ** (1.0 / _TIME_STEP)
        if not self._space.damping > 0.0:
            raise NumericalFailure("the damping of the pymunk space underflows to zero")
        self._space.collision_slop = _SLOP * self._shape.rounding
        self._ground = self._space.static_body
        self._mass = np.zeros((assembly.n_blocks, 3))
        self._bodies = self._add_bodies(masses(assembly, course, tuning.mass_decay))
        self._joint_of: dict[pymunk.Shape, int] = {}
        self._add_strips(joints)
        scale = _GRAVITY / np.array([self._force, self._force, self._force * self._unit])
        # One row more than there are bodies: pymunk's batches end with the static body.
        self._dead, self._live = np.zeros((2, len(blocks) + 1, 3))
        self._dead[:-1] = assembly.dead[blocks] * scale
        self._live[:-1] = assembly.live[blocks] * scale
        self._rest = np.zeros((len(blocks) + 1, 6))
        self._rest[:-1, :2] = (assembly.centroid[blocks] - assembly.middle) / self._unit
        self._out, self._in, self._loads = batch.Buffer(), batch.Buffer(), batch.Buffer()
        self.load(0.0)
        self._space.step(_TIME_STEP)
        self._space.step(_TIME_STEP)
        self._records = self._find_records()
        self._at_rest()

    def _add_bodies(self, mass: FloatArray) -> dict[int, pymunk.Body]:
        bodies: dict[int, pymunk.Body] = {}
        for i in self._blocks:
            corners = (self.assembly.polygons[i] - self.assembly.centroid[i]) / self._unit
            inertia = mass[i] * polygon_gyration(corners)
            self._mass[i] = mass[i], mass[i], inertia
            body = pymunk.Body(mass[i], inertia)
            body.position = tuple((self.assembly.centroid[i] - self.assembly.middle) / self._unit)
            self._space.add(body)
            bodies[int(i)] = body
        return bodies

    def _add_strips(self, joints: IntArray) -> None:
        strips = build_strips(self.assembly, self._unit, self._shape)
        for p in joints:
            category = 1 << int(strips.colour[p])
            for block, vertices in (
                (int(self.assembly.block_a[p]), strips.on_a[p]),
                (int(self.assembly.block_b[p]), strips.on_b[p]),
            ):
                body = self._bodies.get(block, self._ground)
                origin = np.array(body.position)
                shape = pymunk.Poly(body, [tuple(v) for v in vertices - origin], radius=self._shape.rounding)
                shape.friction = float(np.sqrt(self.assembly.friction[p]))
                shape.elasticity = 0.0
                shape.filter = pymunk.ShapeFilter(categories=category, mask=category)
                self._space.add(shape)
                self._joint_of[shape] = int(p)

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        self.multiplier = multiplier
        self._now = np.ascontiguousarray(self._dead + multiplier * self._live).ravel()
        self._loads.set_float_buf(self._now)

    def advance(self, steps: int) -> None:
        """Make time steps."""
        for _ in range(steps):
            batch.set_space_bodies(self._space, _FORCE, self._loads)
            self._space.step(_TIME_STEP)
        self.steps += steps

    def velocity(self) -> FloatArray:
        """(n, 3) velocities as out-of-balance accelerations, see `Engine.velocity`."""
        self._out.clear()
        batch.get_space_bodies(self._space, _VELOCITY, self._out)
        result = np.zeros((self.assembly.n_blocks, 3))
        read = np.frombuffer(self._out.float_buf()).reshape(-1, 3)
        own = read[: len(self._blocks)] / (self.relaxation * _GRAVITY * _TIME_STEP)
        result[self._blocks] = own * motion_units(self.assembly)
        return result

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force of this velocity field, see `Engine.unbalance`."""
        return float(np.abs(self._mass * velocity / motion_units(self.assembly)).max(initial=0.0))

    def save(self) -> FloatArray:
        """(m, 2, 2) normal and tangential impulse of both contact points of every interface."""
        impulses = np.zeros((self.interfaces, 2, 2))
        for p, end, contact in self._contacts():
            impulses[p, end] = contact.jnAcc, contact.jtAcc
        return impulses

    def restore(self, state: FloatArray) -> None:
        """Back to rest with these impulses."""
        self._at_rest()
        for p, end, contact in self._contacts():
            contact.jnAcc, contact.jtAcc = state[p, end]

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) of the last time step [force].

        Chipmunk's tangent is the normal turned by +90 degrees, whichever of the two shapes comes first.
        """
        force = self.save() * (self._force / (_GRAVITY * _TIME_STEP))
        normal, tangent = self.assembly.normal, self.assembly.tangent
        sign = normal[:, 0] * tangent[:, 1] - normal[:, 1] * tangent[:, 0]
        return np.column_stack([force[:, 0, 0], force[:, 1, 0], sign * force[:, :, 1].sum(axis=1)])

    def _at_rest(self) -> None:
        self._in.set_float_buf(self._rest.ravel())
        batch.set_space_bodies(self._space, _REST, self._in)

    def _contacts(self) -> Iterator[tuple[int, int, Any]]:
        """Interface, end (0 or 1) and engine record of every contact point."""
        for p, first_is_one, record in self._records:
            yield p, 0 if first_is_one else 1, record.contacts[0]
            yield p, 1 if first_is_one else 0, record.contacts[1]

    def _find_records(self) -> list[tuple[int, bool, Any]]:
        """Interface, whether its first contact is end 1, and the engine's record of both; of all, or an error.

        The engine keeps a record as long as its shapes touch, which at frozen geometry is for ever. They are asked for
        once only, because what is raised inside a call back from the engine, as by the alarm of a time limit, is lost.

        Raises:
            NumericalFailure: the engine lost a contact, which frozen geometry forbids.
        """
        found: dict[int, Any] = {}

        def note(arbiter: pymunk.Arbiter, _: None) -> None:
            # The public interface gives the impulse of the pair only; the record below it has both points.
            found[self._joint_of[arbiter.shapes[0]]] = arbiter._arbiter

        for body in self._bodies.values():
            body.each_arbiter(note, None)
        if len(found) != self._loaded_interfaces:
            raise NumericalFailure(f"pymunk sees {len(found)} of {self._loaded_interfaces} interfaces")
        for p, record in found.items():
            if record.count != 2:
                raise NumericalFailure(f"pymunk sees {record.count} of 2 contact points of interface {p}")
        return [(p, self._first_contact_is_end_one(p, record), record) for p, record in found.items()]

    @property
    def _loaded_interfaces(self) -> int:
        fixed = self.assembly.fixed
        return int(np.sum(~(fixed[self.assembly.block_a] & fixed[self.assembly.block_b])))

    def _first_contact_is_end_one(self, p: int, record: Any) -> bool:
        one, two = record.contacts[0].r1, record.contacts[1].r1
        tangent = self.assembly.tangent[p]
        return bool((two.x - one.x) * tangent[0] + (two.y - one.y) * tangent[1] > 0.0)


def polygon_gyration(corners: FloatArray) -> float:
    """Square of the radius of gyration about the origin of a polygon (k, 2) [length^2]; convex or not."""
    x, y = corners.T
    x2, y2 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y2 - x2 * y
    squares = x * x + x * x2 + x2 * x2 + y * y + y * y2 + y2 * y2
    return float(np.sum(cross * squares) / (6.0 * np.sum(cross)))
