"""A wall as spheres on boxes in MuJoCo: a second engine for the holds of `methods.de.engines.engine`.

Each block has three joints (slide, slide, hinge about its centroid). At each contact point a sphere on block a stands
on the face of a box on block b; explicit pairs with the friction of their interface are all the contacts there are.

MuJoCo's contacts are soft and its friction is viscous below the cone: a normal force needs a penetration, a shear force
needs a creep. Both are made small and not zero. Lengths are in unit lengths and gravity is 1; the time step is so short
that a contact yields about the square of it under a block's weight: geometry stays frozen for any purpose.
Source: E. Todorov, Convex and analytically-invertible dynamics with contacts and constraints, ICRA 2014.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.errors import optional
from methods.de.engines.engine import motion_units
from methods.de.engines.mass_scaling import MassScaling, courses, masses, number_of_courses
from methods.de.engines.pymunk_joints import polygon_gyration
from methods.de.engines.strips import StripShape, require_lengths

_TOLERANCE = 1e-14
"""Of the contact solver."""
_SEARCH_TOLERANCE = 1e-6
"""Of its line search."""
_LOW = 6.0
"""Courses above which friction stiffens with them."""
_FORCE_STEPS = 200
"""Time steps over which contact forces are averaged."""
_EXPLODED = 1e4
"""Acceleration, as a part of gravity, that no wall reaches: a failure of the contact solver, not a collapse."""


@dataclass(frozen=True)
class SoftContacts:
    """How a contact is pulled back: acceleration -(damping v + d stiffness r / time_step) / time_step.

    Of the penetration r and its rate v, with MuJoCo's constraint impedance d.

    Overdamped: contacts that rebound keep the head joints of a wall chattering.

    Attributes:
        time_step: in units of sqrt(length scale / gravity).
        stiffness, damping: as above. Stiffer contacts let large walls vibrate under their dead load.
        wall_impedance, chain_impedance: for walls, and for chains of blocks, whose slow modes want stiffer contacts.
        radius: of a contact sphere, in unit lengths. It does not matter: the sphere touches a flat face at one point.
        overlap: by which a sphere starts inside its face, in unit lengths, so that rounding does not decide which
            contacts start.
        least_friction: of a contact, whose cone is not to vanish.
    """

    time_step: float = 1e-4
    stiffness: float = 0.05
    damping: float = 1.8
    wall_impedance: float = 0.9
    chain_impedance: float = 0.97
    radius: float = 0.05
    overlap: float = 1e-12
    least_friction: float = 1e-12


@dataclass(frozen=True)
class MujocoTuning:
    """The contacts and the contact solver of MuJoCo, and what is read from it.

    Attributes:
        contacts: how they are pulled back; shape: of the strips that they lie on.
        uniform: masses in proportion to areas, for what does not settle with light tops.
    """

    contacts: SoftContacts = SoftContacts()
    shape: StripShape = StripShape()
    uniform: MassScaling = MassScaling(0.0, 0.99)


class SolverFailed(ArithmeticError):
    """MuJoCo's contact solver stopped before it converged, and the motion is not that of the wall."""


def load_mujoco() -> Any:
    """The package mujoco.

    Raises:
        InputError: it is not installed.
    """
    return optional("mujoco", "mujoco", "method de-mujoco")


class MujocoWall:
    """The engine of `de-mujoco`: see `methods.de.engines.engine.Engine`.

    Args:
        assembly: the wall.
        blocks: (n_free,) free blocks in the order in which their bodies are added.
        joints: (m,) interfaces in the order in which their contacts are added.
        iterations: most Newton iterations of a time step.
        tuning: masses and damping.
        impedance: MuJoCo's constraint impedance, below 1; the nearer to 1, the stiffer are the contacts.
        friction_ratio: MuJoCo's impratio: how much stiffer friction is than the normal direction.
        options: of its contacts and their solver.

    Raises:
        CannotModel: an interface has no length.
        InputError: mujoco is not installed.
    """

    def __init__(
        self,
        assembly: Assembly,
        blocks: IntArray,
        joints: IntArray,
        iterations: int,
        tuning: MassScaling,
        impedance: float,
        friction_ratio: float,
        options: MujocoTuning = MujocoTuning(),
    ) -> None:
        self._options, self._contacts = options, options.contacts
        require_lengths(assembly)
        self._mujoco = load_mujoco()
        self.assembly = assembly
        self.interfaces = assembly.n_interfaces
        self.steps = 0
        self._unit = assembly.length_scale
        # Penetrations of 1e-9 vanish in rounding far from the origin.
        self._force = assembly.force_scale / max(assembly.n_free, 1)
        course = courses(assembly)
        self.relaxation = 1.0 / (1.0 - tuning.damping)
        self.courses = number_of_courses(course)
        self._blocks = blocks
        self._drag = (1.0 / tuning.damping - 1.0) / self._contacts.time_step
        corners = [(assembly.polygons[i] - assembly.centroid[i]) / self._unit for i in blocks]
        mass = masses(assembly, course, tuning.mass_decay)[blocks]
        gyration = np.array([polygon_gyration(polygon) for polygon in corners])
        self._mass = np.column_stack([mass, mass, mass * gyration])
        spec = self._specification(iterations, friction_ratio)
        self._add_blocks(spec)
        self._add_contacts(spec, joints, impedance)
        self._model = spec.compile()
        self._data = self._mujoco.MjData(self._model)
        self._end_of = self._ends_by_geom(joints)
        scale = 1.0 / np.array([self._force, self._force, self._force * self._unit])
        self._dead, self._live = assembly.dead[blocks] * scale, assembly.live[blocks] * scale
        self._mean = np.zeros((assembly.n_blocks, 3))
        self._read()
        self.load(0.0)

    def _specification(self, iterations: int, friction_ratio: float) -> Any:
        spec = self._mujoco.MjSpec()
        option = spec.option
        option.timestep = self._contacts.time_step
        option.gravity = [0.0, 0.0, 0.0]
        option.integrator = self._mujoco.mjtIntegrator.mjINT_EULER
        option.cone = self._mujoco.mjtCone.mjCONE_ELLIPTIC
        option.solver = self._mujoco.mjtSolver.mjSOL_NEWTON
        option.impratio = friction_ratio * max(1.0, self.courses / _LOW)
        option.iterations = iterations
        option.tolerance = _TOLERANCE
        option.ls_tolerance = _SEARCH_TOLERANCE
        return spec

    def _add_blocks(self, spec: Any) -> None:
        """Bodies with planar joints; x, y of the wall are x, z of MuJoCo, counter-clockwise is about -y."""
        slide, hinge = self._mujoco.mjtJoint.mjJNT_SLIDE, self._mujoco.mjtJoint.mjJNT_HINGE
        for k, i in enumerate(self._blocks):
            x, y = (self.assembly.centroid[i] - self.assembly.middle) / self._unit
            body = spec.worldbody.add_body(name=f"block {i}", pos=[x, 0.0, y])
            body.explicitinertial = True
            body.mass = float(self._mass[k, 0])
            body.inertia = [float(self._mass[k, 2])] * 3
            for kind, axis, inertia in zip(
                (slide, slide, hinge), ([1, 0, 0], [0, 0, 1], [0, -1, 0]), self._mass[k], strict=True
            ):
                body.add_joint(type=kind, axis=axis, damping=float(inertia * self._drag))

    def _add_contacts(self, spec: Any, joints: IntArray, impedance: float) -> None:
        wall, free = self.assembly, set(self._blocks.tolist())
        contacts, shape = self._contacts, self._options.shape
        sphere, box = self._mujoco.mjtGeom.mjGEOM_SPHERE, self._mujoco.mjtGeom.mjGEOM_BOX

        def add(name: str, block: int, place: FloatArray, **geom: Any) -> None:
            body = spec.body(f"block {block}") if block in free else spec.worldbody
            x, y = (place - (wall.centroid[block] if block in free else wall.middle)) / self._unit
            body.add_geom(name=name, pos=[x, 0.0, y], contype=0, conaffinity=0, **geom)

        for p in joints.tolist():
            a, b = int(wall.block_a[p]), int(wall.block_b[p])
            if a not in free and b not in free:
                continue
            normal, tangent, length = wall.normal[p], wall.tangent[p], float(wall.length[p])
            half = np.arctan2(tangent[1], tangent[0]) / 2.0
            depth = shape.depth * length
            middle = (wall.end1[p] + wall.end2[p]) / 2.0 + depth * normal
            size = [(0.5 + shape.overhang) * length / self._unit, depth / self._unit, depth / self._unit]
            add(f"face {p}", b, middle, type=box, size=size, quat=[np.cos(half), 0.0, -np.sin(half), 0.0])
            friction = max(float(wall.friction[p]), contacts.least_friction)
            for k, end in enumerate((wall.end1[p], wall.end2[p])):
                add(
                    f"end {p} {k}",
                    a,
                    end - contacts.radius * self._unit * normal,
                    type=sphere,
                    size=[contacts.radius + contacts.overlap, 0.0, 0.0],
                )
                spec.add_pair(
                    name=f"contact {p} {k}",
                    geomname1=f"end {p} {k}",
                    geomname2=f"face {p}",
                    condim=3,
                    friction=[friction, friction, 0.0, 0.0, 0.0],
                    # The direct form, which MuJoCo divides by powers of the impedance.
                    solref=[
                        -contacts.stiffness * impedance**2 / contacts.time_step**2,
                        -contacts.damping * impedance / contacts.time_step,
                    ],
                    solimp=[impedance, impedance, 1.0, 0.5, 2.0],
                )

    def _ends_by_geom(self, joints: IntArray) -> IntArray:
        """(geoms,) contact number 2 p + end of each sphere, -1 for boxes."""
        ends = np.full(self._model.ngeom, -1, dtype=np.int64)
        for p in joints.tolist():
            for k in range(2):
                geom = self._mujoco.mj_name2id(self._model, self._mujoco.mjtObj.mjOBJ_GEOM, f"end {p} {k}")
                if geom >= 0:
                    ends[geom] = 2 * p + k
        return ends

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        self.multiplier = multiplier
        self._data.qfrc_applied[:] = (self._dead + multiplier * self._live).ravel()

    def advance(self, steps: int) -> None:
        """Make time steps.

        Raises:
            SolverFailed: the the blocks separated.
        """
        # One call a step, so that the alarm of a time limit is heard between them: walls take 5 ms for each.
        for _ in range(steps):
            self._mujoco.mj_step(self._model, self._data)
        self.steps += steps
        if self._was_reset() or not float(np.abs(self._data.qvel).max(initial=0.0)) * self._drag < _EXPLODED:
            raise SolverFailed("MuJoCo's contact solver did not converge: the blocks separated")

    def _was_reset(self) -> bool:
        """Whether MuJoCo met numbers it cannot go on from: it then starts again at rest, without an error."""
        kind = self._mujoco.mjtWarning
        bad = (kind.mjWARN_BADQPOS, kind.mjWARN_BADQVEL, kind.mjWARN_BADQACC)
        return any(self._data.warning[int(warning)].number > 0 for warning in bad)

    def velocity(self) -> FloatArray:
        """(n, 3) velocities as out-of-balance accelerations, see `Engine.velocity`.

        The mean since the last reading, so that contacts that chatter while a wall slides do not hide its motion.
        """
        if self.steps > self._read_at:
            passed = self._contacts.time_step * (self.steps - self._read_at)
            moved = (self._data.qpos - self._place).reshape(-1, 3) / passed
            self._mean = np.zeros((self.assembly.n_blocks, 3))
            self._mean[self._blocks] = moved * self._drag * motion_units(self.assembly)
            self._read()
        return self._mean

    def _read(self) -> None:
        self._place, self._read_at = self._data.qpos.copy(), self.steps

    def unbalance(self, velocity: FloatArray) -> float:
        """Largest out-of-balance force of this velocity field, see `Engine.unbalance`."""
        return float(np.abs(self._mass * velocity[self._blocks] / motion_units(self.assembly)).max(initial=0.0))

    def save(self) -> FloatArray:
        """(9 n_free,) displacements, velocities and accelerations: penetrations and creep carry the forces."""
        return np.concatenate([self._data.qpos, self._data.qvel, self._data.qacc_warmstart])

    def restore(self, state: FloatArray) -> None:
        """Back to this state; what velocity it has is the creep of a held state, not zero as in pymunk."""
        self._data.qpos[:], self._data.qvel[:], self._data.qacc_warmstart[:] = state.reshape(3, -1)
        self._mean = np.zeros((self.assembly.n_blocks, 3))
        self._read()

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force], the mean over some further time steps.

        What chattering remains in a held state cancels in the mean, which obeys friction as every step does.
        """
        total = np.zeros((self.interfaces, 3))
        for _ in range(_FORCE_STEPS):
            self.advance(1)
            self._add_forces(total)
        return total * (self._force / _FORCE_STEPS)

    def _add_forces(self, total: FloatArray) -> None:
        """Add the contact forces of the last time step.

        MuJoCo gives the force on its second geom, in the frame of the contact, whose first axis points from the first
        geom to the second. Which of the two is the sphere of block a is MuJoCo's choice.
        """
        contact = self._data.contact
        address = np.asarray(contact.efc_address)
        rows = np.flatnonzero(address >= 0)
        frame = np.asarray(contact.frame).reshape(-1, 3, 3)[rows][:, :, [0, 2]]
        local = self._data.efc_force[address[rows][:, None] + np.arange(3)]
        p, end = np.divmod(self._end_of[np.asarray(contact.geom)[rows]].max(axis=1), 2)
        normal, tangent = self.assembly.normal[p], self.assembly.tangent[p]
        force = np.einsum("ci,cij->cj", local, frame) * np.sign(np.sum(frame[:, 0] * normal, axis=1))[:, None]
        np.add.at(total, (p, end), np.sum(force * normal, axis=1))
        np.add.at(total, (p, 2), np.sum(force * tangent, axis=1))
