"""A wall with deformable joints between blocks of rounded corners, followed through large displacements.

The blocks are rigid. At each end of an interface a rounded corner of one block touches the face of the other: a spring
across the contact takes no tension, one along it slips at the Coulomb limit. The motion is explicit, M dv/dt = p -
alpha |p| ((1 - b) sign(v) - b sign(dp/dt)) with the out-of-balance force p = f0 + lambda fL + C' r: damping is
proportional to the imbalance, so a wall at rest is not damped (P. A. Cundall and O. D. L. Strack, A discrete numerical
model for granular assemblies, Geotechnique 29 (1979) 47-65; P. A. Cundall, Distinct element models of rock and soil
structure, 1987, for damping and corners). The sign of dp/dt is opposite to that of v in an oscillation about any steady
velocity, so that vibrations are damped in blocks that drift, too (combined damping: Itasca, PFC, Theory and Background,
Mechanical damping).
Equilibrium contains neither masses nor time: masses are in proportion to the stiffness around a block, so that one time
step suits all.

A rounded corner is a disk, and a rounded face all points at the radius of the disk from a line that ends in the disks
of its own corners. So corners roll, and one that is pushed over the end of a face rolls off it. Where corners of both
blocks meet, the one that lies within the other's face is the one that touches.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.displaced import DisplacedState
from methods.de.engines.edges import SAME, edge_of
from methods.numerics.compiled import compiled
from methods.numerics.joint_loops import shear_within

_SLIPS = 1e-2
"""Share of the friction that a contact may lack to count as one that slips: blocks swing back as they come to rest."""


@dataclass(frozen=True)
class ExplicitTuning:
    """The explicit motion.

    Attributes:
        inertia: masses as a share of the stiffness around a block; time_step: with a quarter of it the fastest
            oscillation takes 4.4.
        damping: force of the damping as a share of the force out of balance (Cundall 1987).
        combined: share of it that follows the rate of that force under a live load. A dead load acts at once and in
            full: with less damping of the velocity itself walls overshoot and fall under it.
        combined_step: time step with it; the fastest oscillation takes 6.3. At 4.4 arches vibrate for ever.
        steps_at_once: made in one call, so that the time limit is checked often and calls cost little.
    """

    inertia: float = 0.25
    time_step: float = 0.5
    damping: float = 0.8
    combined: float = 0.5
    combined_step: float = 0.35
    steps_at_once: int = 20


class ElasticContacts(NamedTuple):
    """The contacts of rounded corners with faces, two an interface: 2m of them.

    Attributes:
        corner, face: (2m,) the block whose corner touches, and the block whose face it touches.
        centre: (2m, 2) centre of the corner's disk from the centroid of its block [length].
        start, reach: (2m, 2), (2m,) where the line under the face starts, from the centroid of its block, and how long
            it is [length].
        own_reach: (2m,) length of the line under the face of the corner's own block, which starts at the disk, where a
            corner of the other block meets this one at the start of its line; -1 where none does [length].
        along: (2m, 2) direction of both lines, into the interface, before anything has moved.
        side: (2m,) 1 where that direction turned left by a right angle points from the corner's block into the face's,
            -1 where it points back.
        radius: (2m,) of the corners [length].
        kn, kt: (2m,) stiffness [force/length]; friction: (2m,) coefficients.
    """

    corner: IntArray
    face: IntArray
    centre: FloatArray
    start: FloatArray
    reach: FloatArray
    own_reach: FloatArray
    along: FloatArray
    side: FloatArray
    radius: FloatArray
    kn: FloatArray
    kt: FloatArray
    friction: FloatArray


def _contacts_of(assembly: Assembly, stiffness: float, shear_ratio: float, least_radius: float) -> ElasticContacts:
    """The contacts of a wall.

    A contact point that is set in from the end of its face is where a round of that radius begins; other corners are
    rounded by the least radius.

    Args:
        assembly: the wall.
        stiffness: of the joints, per length of joint [force/length^2]; half the joint belongs to each end.
        shear_ratio: stiffness along over stiffness across.
        least_radius: of a corner [length].
    """
    rows: list[ElasticContacts] = []
    small = SAME * assembly.length_scale
    for p in range(assembly.n_interfaces):
        faces = np.array([assembly.face1[p], assembly.face2[p]])
        length = float(np.linalg.norm(faces[1] - faces[0]))
        for end, far, point in ((*faces, assembly.end1[p]), (*faces[::-1], assembly.end2[p])):
            along = (far - end) / length
            radius = max(float(np.linalg.norm(point - end)), least_radius)
            corner, face, normal = assembly.block_a[p], assembly.block_b[p], assembly.normal[p]
            own, other = (_extent(assembly, block, p, end, along) for block in (corner, face))
            if abs(own[0]) > small >= abs(other[0]):
                corner, face, normal, own, other = face, corner, -normal, other, own
            shared = abs(own[0]) <= small >= abs(other[0])
            kn = 0.5 * length * stiffness
            contact = {
                "corner": corner,
                "face": face,
                "centre": end + radius * (along - normal) - assembly.centroid[corner],
                "start": end + (other[0] + radius) * along + radius * normal - assembly.centroid[face],
                "reach": max(other[1] - other[0] - 2.0 * radius, 0.0),
                "own_reach": max(own[1] - own[0] - 2.0 * radius, 0.0) if shared else -1.0,
                "along": along,
                "side": np.sign(along[0] * normal[1] - along[1] * normal[0]),
                "radius": radius,
                "kn": kn,
                "kt": shear_ratio * kn,
                "friction": assembly.friction[p],
            }
            rows.append(ElasticContacts(**{name: np.asarray(value) for name, value in contact.items()}))
    return ElasticContacts(*(np.array(column) for column in zip(*rows, strict=True)))


def _extent(assembly: Assembly, block: int, p: int, end: FloatArray, along: FloatArray) -> tuple[float, float]:
    """From where to where a block's edge runs on which interface p lies, along it from one of its ends [length].

    Where the interface lies on no edge of the block, it is itself the edge.
    """
    edge = edge_of(assembly, block, p)
    ends = np.array([assembly.face1[p], assembly.face2[p]]) if edge is None else assembly.polygons[block][list(edge)]
    low, high = sorted(((ends - end) @ along).tolist())
    return low, high


class SoftWall:
    """A wall with deformable joints under a load.

    Attributes:
        places: (n, 3) displacements (x, y) [length] and rotations of the blocks.
        shear: (2m,) shear forces of the contacts, on the face, along the normal turned by a right angle [force].
        multiplier: of the live load that acts now.
        steps: time steps made.
    """

    def __init__(
        self,
        assembly: Assembly,
        stiffness: float,
        shear_ratio: float,
        least_radius: float,
        options: ExplicitTuning = ExplicitTuning(),
    ) -> None:
        """The wall before anything has moved.

        Args:
            assembly: the wall; stiffness, shear_ratio, least_radius: as for `_contacts_of`.
            options: of its motion.
        """
        self._options = options
        self.assembly = assembly
        self.contacts = _contacts_of(assembly, stiffness, shear_ratio, least_radius)
        self.places = np.zeros((assembly.n_blocks, 3))
        self.shear = np.zeros(len(self.contacts.kn))
        self.steps, self.multiplier = 0, 0.0
        self._velocity = np.zeros_like(self.places)
        self._unbalanced = np.zeros_like(self.places)
        self._loads = assembly.dead.copy()
        self._mass = self._masses()
        self._unit = assembly.force_scale / max(assembly.n_free, 1)

    def load(self, multiplier: float) -> None:
        """Put dead + multiplier x live on the blocks from now on."""
        self.multiplier = multiplier
        self._loads = self.assembly.dead + multiplier * self.assembly.live

    @property
    def _time_step(self) -> float:
        return self._options.combined_step if self.multiplier else self._options.time_step

    def advance(self, steps: int) -> float:
        """Make time steps; the largest force out of balance at the last, over the mean dead load of a block.

        Moments count divided by the length scale.
        """
        wall, options = self.assembly, self._options
        self.steps += steps
        moving = self.places, self._velocity, self.shear, self._unbalanced
        arrays = *moving, self.contacts, wall.centroid, self._loads, self._mass
        combined = options.combined if self.multiplier else 0.0
        worst = 0.0
        # One call a few steps, so that the alarm of a time limit is heard between them.
        for done in range(0, steps, options.steps_at_once):
            some = min(options.steps_at_once, steps - done)
            worst = _advance(*arrays, wall.length_scale, some, self._time_step, options.damping, combined)
        return float(worst) / self._unit

    def carry(self, motion: FloatArray, steps: int) -> None:
        """Carry the fixed blocks through a motion (n, 3) at constant velocity in so many time steps; then they rest."""
        fixed = self.assembly.fixed
        self._velocity[fixed] = motion[fixed] / (steps * self._time_step)
        self.advance(steps)
        self._velocity[fixed] = 0.0

    def state(self) -> DisplacedState:
        """The contacts and their forces as the wall is."""
        contacts, centroid = self.contacts, self.assembly.centroid

        def turned(block: IntArray, vector: FloatArray) -> FloatArray:
            c, s = np.cos(self.places[block, 2]), np.sin(self.places[block, 2])
            return np.stack([c * vector[:, 0] - s * vector[:, 1], s * vector[:, 0] + c * vector[:, 1]], axis=1)

        a, b = contacts.corner, contacts.face
        disk = centroid[a] + self.places[a, :2] + turned(a, contacts.centre)
        line = centroid[b] + self.places[b, :2] + turned(b, contacts.start)
        own, other = turned(a, contacts.along), turned(b, contacts.along)
        ahead = ((disk - line) * other).sum(axis=1)
        beyond = (ahead < 0.0) & (contacts.own_reach >= 0.0)
        within = np.clip(((line - disk) * own).sum(axis=1), 0.0, contacts.own_reach)
        disk = np.where(beyond[:, None], disk + within[:, None] * own, disk)
        line = np.where(beyond[:, None], line, line + np.clip(ahead, 0.0, contacts.reach)[:, None] * other)
        flat = np.where(beyond[:, None], own, other)
        normal = contacts.side[:, None] * np.stack([-flat[:, 1], flat[:, 0]], axis=1)
        apart = line - disk
        past = np.where(
            beyond, (within <= 0.0) | (within >= contacts.own_reach), (ahead <= 0.0) | (ahead >= contacts.reach)
        )
        distance = (apart * normal).sum(axis=1)
        radial = past & (distance > 0.0)
        distance = np.where(radial, np.linalg.norm(apart, axis=1), distance)
        normal = np.where(radial[:, None], apart / np.where(radial, distance, 1.0)[:, None], normal)
        pressed = np.maximum(contacts.kn * (2.0 * contacts.radius - distance), 0.0)
        shear = np.where(pressed > 0.0, self.shear, 0.0)
        along = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        return DisplacedState(
            places=self.places.copy(),
            interface=np.repeat(np.arange(self.assembly.n_interfaces), 2),
            onto=b,
            point=0.5 * (disk + line),
            normal=normal,
            force=pressed[:, None] * normal + shear[:, None] * along,
        )

    def contact_forces(self) -> FloatArray:
        """(m, 3) contact forces (n1, n2, s) [force] as on the wall that has not moved, see `MeasuredState`."""
        now, wall = self.state(), self.assembly
        sign = np.where(now.onto == wall.block_b[now.interface], 1.0, -1.0)[:, None]
        force = (sign * now.force).reshape(-1, 2, 2)
        normal = np.sum(force * wall.normal[:, None], axis=2)
        return np.column_stack([normal, np.sum(force.sum(axis=1) * wall.tangent, axis=1)])

    def slipping_and_open(self) -> tuple[int, int]:
        """Numbers of contacts that slip, and of contacts that bear nothing."""
        now, contacts = self.state(), self.contacts
        pressed = (now.force * now.normal).sum(axis=1)
        slips = (pressed > 0.0) & (abs(self.shear) >= (1.0 - _SLIPS) * contacts.friction * pressed)
        return int(np.count_nonzero(slips)), int(np.count_nonzero(pressed <= 0.0))

    def save(self) -> tuple[FloatArray, FloatArray]:
        """Places and shears, to be given to `restore`."""
        return self.places.copy(), self.shear.copy()

    def restore(self, state: tuple[FloatArray, FloatArray]) -> None:
        """Back to rest at these places with these shears."""
        self.places, self.shear = state[0].copy(), state[1].copy()
        self._velocity = np.zeros_like(self.places)
        self._unbalanced = np.zeros_like(self.places)

    def _masses(self) -> FloatArray:
        """(n, 3) masses and moments of inertia: a share of the stiffness around a block; infinite if it is fixed."""
        contacts, count = self.contacts, self.assembly.n_blocks
        mass = np.zeros((count, 3))
        stiffness = self._options.inertia * (contacts.kn + contacts.kt)
        for block, arm, reach in (
            (contacts.corner, contacts.centre, np.maximum(contacts.own_reach, 0.0)),
            (contacts.face, contacts.start, contacts.reach),
        ):
            longest = np.hypot(*arm.T) + reach + contacts.radius
            np.add.at(mass[:, 0], block, stiffness)
            np.add.at(mass[:, 2], block, stiffness * longest**2)
        mass[:, 1] = mass[:, 0]
        mass[self.assembly.fixed] = np.inf
        return mass


@compiled
def _advance(
    places: FloatArray,
    velocity: FloatArray,
    shear: FloatArray,
    unbalanced: FloatArray,
    contacts: ElasticContacts,
    centroid: FloatArray,
    loads: FloatArray,
    mass: FloatArray,
    size: float,
    steps: int,
    time_step: float,
    damping: float,
    combined: float,
) -> float:
    """Make time steps in place; the largest force, or moment over the size, out of balance at the last [force]."""
    corner, face, centre, start = contacts.corner, contacts.face, contacts.centre, contacts.start
    reach, own_reach, along, side = contacts.reach, contacts.own_reach, contacts.along, contacts.side
    radius, kn, kt, friction = contacts.radius, contacts.kn, contacts.kt, contacts.friction
    n = len(loads)
    out = np.empty((n, 3))
    cosine, sine = np.empty(n), np.empty(n)
    worst = 0.0
    for _ in range(steps):
        for i in range(n):
            cosine[i], sine[i] = np.cos(places[i, 2]), np.sin(places[i, 2])
            for j in range(3):
                out[i, j] = loads[i, j]
        for q in range(len(kn)):
            a, b = corner[q], face[q]
            # From the centre of the disk to the start of the line, then between the points nearest to each other.
            ax = cosine[a] * centre[q, 0] - sine[a] * centre[q, 1]
            ay = sine[a] * centre[q, 0] + cosine[a] * centre[q, 1]
            bx = cosine[b] * start[q, 0] - sine[b] * start[q, 1]
            by = sine[b] * start[q, 0] + cosine[b] * start[q, 1]
            dx = (centroid[b, 0] + places[b, 0] + bx) - (centroid[a, 0] + places[a, 0] + ax)
            dy = (centroid[b, 1] + places[b, 1] + by) - (centroid[a, 1] + places[a, 1] + ay)
            tx = cosine[b] * along[q, 0] - sine[b] * along[q, 1]
            ty = sine[b] * along[q, 0] + cosine[b] * along[q, 1]
            s, longest = -(dx * tx + dy * ty), reach[q]
            if s >= 0.0 or own_reach[q] < 0.0:
                s = min(max(s, 0.0), longest)
                bx += s * tx
                by += s * ty
                dx += s * tx
                dy += s * ty
            else:
                tx = cosine[a] * along[q, 0] - sine[a] * along[q, 1]
                ty = sine[a] * along[q, 0] + cosine[a] * along[q, 1]
                longest = own_reach[q]
                s = min(max(dx * tx + dy * ty, 0.0), longest)
                ax += s * tx
                ay += s * ty
                dx -= s * tx
                dy -= s * ty
            # Across the line, or from disk to disk beyond its ends.
            nx, ny = -side[q] * ty, side[q] * tx
            distance = dx * nx + dy * ny
            if s == 0.0 or s == longest:
                apart = np.sqrt(dx * dx + dy * dy)
                if apart > 0.0 and distance > 0.0:
                    nx, ny, distance = dx / apart, dy / apart, apart
            if distance >= 2.0 * radius[q]:
                shear[q] = 0.0
                continue
            # Arms of the contact point, half way between, and the velocity of the face there.
            half = 0.5 * distance
            ax += half * nx
            ay += half * ny
            bx -= half * nx
            by -= half * ny
            vx = velocity[b, 0] - velocity[b, 2] * by - velocity[a, 0] + velocity[a, 2] * ay
            vy = velocity[b, 1] + velocity[b, 2] * bx - velocity[a, 1] - velocity[a, 2] * ax
            pressed = kn[q] * (2.0 * radius[q] - distance)
            force = shear[q] - kt[q] * time_step * (vy * nx - vx * ny)
            force = shear_within(force, friction[q], pressed, 0.0, 0.0)
            shear[q] = force
            fx, fy = pressed * nx - force * ny, pressed * ny + force * nx
            out[b, 0] += fx
            out[b, 1] += fy
            out[b, 2] += bx * fy - by * fx
            out[a, 0] -= fx
            out[a, 1] -= fy
            out[a, 2] -= ax * fy - ay * fx
        worst = 0.0
        for i in range(n):
            if mass[i, 0] == np.inf:
                for j in range(3):
                    places[i, j] += time_step * velocity[i, j]
                continue
            for j in range(3):
                force = out[i, j]
                worst = max(worst, abs(force) / (size if j == 2 else 1.0))
                rising = np.sign(force - unbalanced[i, j])
                sense = (1.0 - combined) * np.sign(velocity[i, j]) - combined * rising
                unbalanced[i, j] = force
                damped = force - damping * abs(force) * sense
                velocity[i, j] += time_step * damped / mass[i, j]
                places[i, j] += time_step * velocity[i, j]
    return worst
