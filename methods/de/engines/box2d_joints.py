"""A wall as contact strips in Box2D 3.1 (`pyb2d3`): a second engine in the plane for the holds of `de`.

Gravity is so small that displacements vanish in rounding: geometry stays frozen. Box2D's soft contacts are made rigid
(a damping ratio without measure and no push out of an overlap), so that what is left is the velocity problem that
`methods.de.engines.pymunk_joints` states, solved in single precision by two sweeps over the contacts in each sub-step.

Box2D lets nobody set contact impulses: a state is kept as the loads and time steps that led to it and made again from
the start, which is exact because Box2D repeats itself. It tells contact impulses through its debug drawing alone, as
lines: the total of the normal impulse over all sweeps of a time step, and the friction impulse of the last sub-step.
Source: E. Catto, Solver2D, 2024 (the "soft step" of Box2D 3).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.errors import optional
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import MassScaling, courses, masses, number_of_courses
from methods.de.engines.pymunk_joints import polygon_gyration
from methods.de.engines.strips import StripShape, build_strips
from methods.numerics.failures import NumericalFailure

_UNIT = 100.0
"""Length scale of the wall in Box2D's lengths, whose smallest is 0.005."""
_SUB_STEP = 1e-2
"""Time of a sub-step."""
_GRAVITY = 1e-10
"""In Box2D's lengths per unit time squared: displacements vanish in rounding."""
_HERTZ = 1e9
"""Of the contacts, which Box2D caps by the sub-step."""
_DAMPING_RATIO = 1e6
"""Of the contacts: it makes them rigid."""
_OVERLAP = 64.0
"""Of the strips' faces, in roundings of the greatest coordinate: contacts never open by rounding."""
_DRAWN = 1e4
"""Length of the line that draws the impulse of a mean block, in greatest coordinates, so that the rounding of its ends
does not show."""


def load_box2d() -> Any:
    """The package pyb2d3.

    Raises:
        InputError: it is not installed.
    """
    return optional("pyb2d3", "box2d", "method de-box2d")


@cache
def _drawing() -> Any:
    """The class that keeps the lines with which Box2D draws contact impulses."""
    box2d = load_box2d()

    class Lines(box2d.DebugDraw):  # type: ignore[misc, name-defined]
        def __init__(self, reach: float) -> None:
            super().__init__()
            self.lines: list[tuple[float, float, float, float]] = []
            self.draw_shapes = False
            self.draw_contacts = self.draw_contact_impulses = self.draw_friction_impulses = True
            self.drawing_bounds = box2d.aabb((-reach, -reach), (reach, reach))

        def draw_segment(self, p1: Any, p2: Any, color: Any) -> None:
            self.lines.append((p1[0], p1[1], p2[0], p2[1]))

    return Lines


class Box2dJoints:
    """The engine of `de-box2d`: see `methods.de.engines.engine.Engine`.

    Args:
        assembly: the wall.
        blocks: (n_free,) free blocks in the order in which their bodies are added.
        joints: (m,) interfaces in the order in which their strips are added.
        sub_steps: of a time step.
        tuning: masses and damping.

    Raises:
        CannotModel: see `methods.de.engines.strips.build_strips`.
        InputError: pyb2d3 is not installed.
    """

    def __init__(
        self,
        assembly: Assembly,
        blocks: IntArray,
        joints: IntArray,
        sub_steps: int,
        tuning: MassScaling,
    ) -> None:
        self._box2d, self._sub_steps = load_box2d(), sub_steps
        self.assembly = assembly
        self.interfaces = assembly.n_interfaces
        self.steps = 0
        self.relaxation = 1.0 / (1.0 - tuning.damping)
        course = courses(assembly)
        self.courses = number_of_courses(course)
        self._blocks, self._joints = blocks, joints
        # Kept in a sub-step: 1 / (1 + sub-step x drag), as Box2D damps.
        self._drag = (tuning.damping ** (-1.0 / sub_steps) - 1.0) / _SUB_STEP
        self._scale = _UNIT / assembly.length_scale
        reach = float(np.abs(np.concatenate(assembly.polygons) - assembly.middle).max()) * self._scale
        self._reach, self._overlap = reach, _OVERLAP * float(np.finfo(np.float32).eps) * reach
        self._force = assembly.force_scale / max(assembly.n_free, 1)
        self._impulse = _DRAWN * reach
        weight = self._impulse / _SUB_STEP
        corners = [(assembly.polygons[i] - assembly.centroid[i]) * self._scale for i in blocks]
        self._mass = masses(assembly, course, tuning.mass_decay)[blocks]
        self._gyration = np.array([polygon_gyration(polygon) for polygon in corners])
        self._body_mass = self._mass * weight / _GRAVITY
        margin = StripShape().rounding
        self._strips = build_strips(
            assembly,
            assembly.length_scale,
            StripShape(rounding=margin, overlap=2.0 * margin + self._overlap / _UNIT),
        )
        ends = np.stack([assembly.end1, assembly.end2], axis=1) - assembly.middle
        self._ends = KDTree((ends * self._scale).reshape(-1, 4))
        scale = weight / self._force * np.array([1.0, 1.0, self._scale])
        self._dead, self._live = assembly.dead[blocks] * scale, assembly.live[blocks] * scale
        self._begin()
        self.load(0.0)

    def _begin(self) -> None:
        """A world at rest, without impulses."""
        box2d = self._box2d
        self._history: list[list[float]] = []
        self._world = box2d.World(gravity=(0.0, 0.0))
        self._world.set_contact_tuning(_HERTZ, _DAMPING_RATIO, 0.0)
        self._world.sleeping_enabled = self._world.continuous_enabled = False
        ground = self._world.create_static_body(position=(0.0, 0.0))
        self._bodies, body_of = [], {}
        self._all = box2d.Bodies()
        for k, i in enumerate(self._blocks):
            place = self._place(int(i))
            body = self._world.create_dynamic_body(position=place, enable_sleep=False)
            body.linear_damping = body.angular_damping = self._drag
            self._bodies.append(body)
            body_of[int(i)] = k
        for p in self._joints:
            bits = 1 << int(self._strips.colour[p])
            definition = box2d.shape_def(
                density=0.0,
                material=box2d.surface_material(friction=float(self.assembly.friction[p]), restitution=0.0),
                filter=box2d.make_filter(category_bits=bits, mask_bits=bits),
            )
            for block, vertices in (
                (int(self.assembly.block_a[p]), self._strips.on_a[p]),
                (int(self.assembly.block_b[p]), self._strips.on_b[p]),
            ):
                free = block in body_of
                local = vertices * _UNIT - (np.array(self._place(block)) if free else 0.0)
                polygon = box2d.polygon(np.asarray(local, dtype=np.float32))
                (self._bodies[body_of[block]] if free else ground).create_polygon_shape(definition, polygon)
        for k, body in enumerate(self._bodies):
            data = box2d.MassData()
            data.mass, data.center = float(self._body_mass[k]), (0.0, 0.0)
            data.rotational_inertia = float(self._body_mass[k] * self._gyration[k])
            body.mass_data = data
            self._all.append(body.id)

    def _place(self, block: int) -> tuple[float, float]:
        x, y = (self.assembly.centroid[block] - self.assembly.middle) * self._scale
        return float(np.float32(x)), float(np.float32(y))

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        self.multiplier = multiplier
        now = (self._dead + multiplier * self._live).tolist()
        self._now = [((fx, fy), moment) for fx, fy, moment in now]

    def advance(self, steps: int) -> None:
        """Make time steps."""
        if self._history and self._history[-1][0] == self.multiplier:
            self._history[-1][1] += steps
        else:
            self._history.append([self.multiplier, steps])
        self._make(steps)

    def _make(self, steps: int) -> None:
        time, pairs = _SUB_STEP * self._sub_steps, list(zip(self._bodies, self._now, strict=True))
        step = self._world.step
        for _ in range(steps):
            for body, (force, moment) in pairs:
                body.apply_force_to_center(force)
                body.apply_torque(moment)
            step(time, self._sub_steps)
        self.steps += steps

    def velocity(self) -> FloatArray:
        """(n, 3) velocities as out-of-balance accelerations, see `Engine.velocity`."""
        result = np.zeros((self.assembly.n_blocks, 3))
        if self._bodies:
            linear = np.asarray(self._all.get_linear_velocities(), dtype=np.float64)
            angular = np.asarray(self._all.get_angular_velocities(), dtype=np.float64) * _UNIT
            own = np.column_stack([linear, angular]) * (self._drag / _GRAVITY)
            result[self._blocks] = own * motion_units(self.assembly)
        return result

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force of this velocity field, see `Engine.unbalance`."""
        mass = self._mass[:, None] * np.column_stack([np.ones((len(self._mass), 2)), self._gyration / _UNIT**2])
        return float(np.abs(mass * velocity[self._blocks] / motion_units(self.assembly)).max(initial=0.0))

    def save(self) -> FloatArray:
        """(k, 2) multipliers and how many time steps were made under each, in turn."""
        return np.array(self._history).reshape(-1, 2)

    def restore(self, state: FloatArray) -> None:
        """The state that these time steps lead to, made again from a world at rest."""
        self._begin()
        for multiplier, steps in state:
            self.load(float(multiplier))
            self.advance(int(steps))

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) of the last time step [force].

        Box2D draws a line for the normal impulse of a contact point and one for its friction impulse, then those of the
        other point, all as the impulse on its second shape.

        Raises:
            ArithmeticError: it does not draw two contact points on the ends of an interface.
        """
        drawing = _drawing()(2.0 * self._reach)
        self._world.draw(drawing, False)
        lines = np.array(drawing.lines).reshape(-1, 4, 4)
        forces = np.zeros((self.interfaces, 3))
        points = lines[:, ::2, :2].reshape(-1, 4)
        wall = self.assembly
        near = np.stack([self._ends.query(points)[k] for k in (0, 1)])
        swapped = np.stack(self._ends.query(points[:, [2, 3, 0, 1]]))
        turn = swapped[0] < near[0]
        distance, p = np.where(turn, swapped, near)
        p = p.astype(np.int64)
        between_free = ~(wall.fixed[wall.block_a] & wall.fixed[wall.block_b])
        if float(distance.max(initial=0.0)) > 4.0 * self._overlap or len(np.unique(p)) != between_free.sum():
            raise NumericalFailure(f"Box2D draws {len(np.unique(p))} of {between_free.sum()} interfaces")
        impulse = (lines[:, :, 2:] - lines[:, :, :2]) * (self._force / self._impulse)
        across = np.einsum("ckj,cj->ck", impulse[:, ::2], wall.normal[p]) / (2.0 * self._sub_steps)
        along = np.einsum("ckj,cj->c", impulse[:, 1::2], wall.tangent[p])
        sign = np.sign(across.sum(axis=1))
        across = np.where(turn[:, None], across[:, ::-1], across)
        forces[p, :2], forces[p, 2] = sign[:, None] * across, sign * along
        return forces
